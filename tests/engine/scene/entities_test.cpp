// SPDX-License-Identifier: MIT
#include "engine/scene/entity_store.h"

#include <gtest/gtest.h>

#include <string>

namespace catena::scene::entities_test {

TEST(EntityStore, KeepsComponentsByEntityInOrderOfInsertion) {
  EntityStore world;
  const Entity a = world.create(), b = world.create(), c = world.create();
  world.emplace<int>(c, 3);
  world.emplace<int>(a, 1);
  world.emplace<std::string>(b, "b");
  EXPECT_TRUE(world.has<int>(a));
  EXPECT_FALSE(world.has<int>(b));
  EXPECT_FALSE(world.has<double>(a));
  std::vector<int> seen;
  world.each<int>([&](Entity, int& value) { seen.push_back(value); });
  EXPECT_EQ(seen, (std::vector<int>{3, 1}));
  EXPECT_EQ(world.count<int>(), 2u);
  EXPECT_EQ(world.count<double>(), 0u);
}

TEST(EntityStore, RemovalKeepsTheOthers) {
  EntityStore world;
  std::vector<Entity> entities;
  for (int i = 0; i < 5; ++i) world.emplace<int>(entities.emplace_back(world.create()), i);
  world.remove<int>(entities[1]);
  world.remove<int>(entities[4]);
  world.remove<int>(entities[4]);
  EXPECT_EQ(world.count<int>(), 3u);
  for (int i : {0, 2, 3}) EXPECT_EQ(world.get<int>(entities[static_cast<std::size_t>(i)]), i);
  world.emplace<int>(entities[1], 7);
  EXPECT_EQ(world.get<int>(entities[1]), 7);
}

}  // namespace catena::scene::entities_test
