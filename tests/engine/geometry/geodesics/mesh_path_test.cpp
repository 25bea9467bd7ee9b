// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <gtest/gtest.h>

#include "tests/support/mesh_shapes.h"

namespace catena::geodesics {
namespace mesh_path_test {

TEST(MeshPath, IsTheGreatCircleOnASphere) {
  const mesh::MeshPtr ball = *mesh::make_mesh(test::sphere_soup(24), "ball");
  for (const double angle : {0.1, 0.5, 1.5, 3.0}) {
    const auto path = path_on_mesh(*ball, {1, 0, 0}, Vec3(std::cos(angle), 0.28 * std::sin(angle), 0.96 * std::sin(angle)));
    ASSERT_FALSE(path.empty()) << angle;
    EXPECT_NEAR(path_length(path), angle, 4e-3 * angle) << "the mesh lies within the sphere by 1e-3";
  }
}

TEST(MeshPath, IsStraightOnTheUnfoldedFacesOfABox) {
  const mesh::MeshPtr box = *mesh::make_mesh(test::box_soup(), "box");
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, 0, 0}, {0, 0.5, 0})), 1, 1e-2);
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, 0.1, -0.3}, {0.1, 0.5, 0.2})), std::hypot(0.4 + 0.4, 0.5), 1e-2);
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, -0.4, 0}, {0.5, 0.3, 0.1})), std::hypot(0.7, 0.1), 1e-6) << "on one face";
}

TEST(MeshPath, DisconnectedPiecesHaveNoPath) {
  mesh::TriangleSoup soup;
  test::add_box(soup, Vec3(-0.5), Vec3(0.5));
  test::add_box(soup, {2, -0.5, -0.5}, {3, 0.5, 0.5});
  const mesh::MeshPtr two = *mesh::make_mesh(soup, "two");
  EXPECT_TRUE(path_on_mesh(*two, {0, 0, 0.5}, {2.5, 0, 0.5}).empty());
  EXPECT_FALSE(path_on_mesh(*two, {2.2, 0, 0.5}, {2.5, 0, 0.5}).empty());
  EXPECT_TRUE(path_on_mesh(*two, {std::nan(""), 0, 0.5}, {2.5, 0, 0.5}).empty());
}

}  // namespace mesh_path_test
}  // namespace catena::geodesics
