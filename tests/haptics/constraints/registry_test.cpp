// SPDX-License-Identifier: MIT
#include <set>

#include "engine/schema/documents.h"
#include "haptics/constraints/presets/mode_presets.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::registry_test {

TEST(Registry, TypesAreUniqueAndFound) {
  std::set<std::string> seen;
  for (const ConstraintType& type : constraint_types()) {
    EXPECT_TRUE(seen.insert(type.type).second) << type.type;
    EXPECT_EQ(find_constraint_type(type.type), &type);
    EXPECT_NE(type.build, nullptr);
    for (const schema::Key& key : type.keys)
      for (const schema::Key& common : common_keys()) EXPECT_NE(key.name, common.name) << type.type;
  }
  for (const char* type : {"point", "plane", "isosurface"}) EXPECT_NE(find_constraint_type(type), nullptr) << type;
  EXPECT_EQ(find_constraint_type("spline"), nullptr);
}

TEST(Registry, UnknownTypeNamesTheKnownOnes) { expect_refused("{\n\"name\": \"a\",\n\"type\": \"spline\"}", 3, {"isosurface", "spline"}); }

TEST(Registry, UnknownKeyNamesItsLine) {
  expect_refused("{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n\n\"positon\": 1}", 3, {"positon"});
}

TEST(Registry, SchemaIsJsonWithEveryTypeAndKey) {
  const std::string text = schema::json_schema(chain_component());
  const auto schema = json::parse(text, "schema");
  ASSERT_TRUE(schema) << schema.error().message << "\n" << text;
  const json::Node& list = *schema->find("items")->find("oneOf");
  ASSERT_EQ(list.items.size(), constraint_types().size() + mode_presets().size());
  for (std::size_t i = 0; i < constraint_types().size(); ++i) {
    const ConstraintType& type = constraint_types()[i];
    const json::Node& properties = *list.items[i].find("properties");
    EXPECT_EQ(properties.find("type")->find("const")->string, type.type);
    for (const schema::Key& key : type.keys) ASSERT_NE(properties.find(key.name), nullptr) << key.name;
    for (const schema::Key& key : common_keys()) ASSERT_NE(properties.find(key.name), nullptr) << key.name;
    EXPECT_FALSE(list.items[i].find("additionalProperties")->boolean);
    std::set<std::string> required;
    for (const json::Node& word : list.items[i].find("required")->items) required.insert(word.string);
    for (const schema::Key& key : type.keys) EXPECT_EQ(required.contains(key.name), key.is_required) << key.name;
  }
}

}  // namespace catena::haptics::tests::registry_test
