// SPDX-License-Identifier: MIT
/// Scenes from text, their components, the form of error messages, and small data files.
#pragma once
#include <gtest/gtest.h>

#include "engine/io/volume/load_field.h"
#include "engine/scene/scene.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::scene {
inline namespace tests {

using test::has;
using test::message_of;
using test::value_of;

/// A case with a folder of its own.
class InFolder : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

inline Scene parsed(const std::string& text, const std::string& path = "s.json") { return value_of(parse_scene(text, path)); }

template <class T>
std::vector<Entity> entities_of(const Scene& scene) {
  std::vector<Entity> all;
  scene.entities.each<T>([&](Entity e, const T&) { all.push_back(e); });
  return all;
}

/// Components in the scene's order.
template <class T>
std::vector<T> all_of(const Scene& scene) {
  std::vector<T> all;
  scene.entities.each<T>([&](Entity, const T& item) { all.push_back(item); });
  return all;
}

/// The only component of its type.
template <class T>
T only(const Scene& scene) {
  std::vector<T> all = all_of<T>(scene);
  EXPECT_EQ(all.size(), 1u);
  return all.empty() ? T{} : std::move(all.front());
}

/// Expects one line that starts with `start` and contains all parts.
inline void expect_message(const std::string& message, const std::string& start, const std::vector<std::string>& parts) {
  EXPECT_TRUE(message.starts_with(start)) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : parts) EXPECT_TRUE(has(message, part));
}

template <class T>
void expect_error(const Result<T>& result, const std::string& start, const std::vector<std::string>& parts) {
  EXPECT_FALSE(result);
  expect_message(message_of(result), start, parts);
}

/// Writes a scalar grid "ball" of a sphere and a vector grid "flow" of a circular flow into one file.
inline void write_grids(const std::string& path) {
  const auto ball = *field::make_analytic("sphere"), swirl = *field::make_analytic("circle");
  const field::AnyField a{field::sample_on_grid(*ball.scalar, 9, -2, 2), nullptr},
      b{nullptr, field::sample_on_grid(*swirl.vector, 9, -2, 2)};
  const auto written = field::write_vdb(path, {{b, "flow"}, {a, "ball"}});
  ASSERT_TRUE(written) << written.error().message;
}

/// An .obj file of the rectangle from (0, 0, 0) to (2, 1, 0).
inline const std::string kQuad = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n";

}  // namespace tests
}  // namespace catena::scene
