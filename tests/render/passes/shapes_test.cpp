// SPDX-License-Identifier: MIT
#include "render/passes/cursor_parts.h"
#include "render/passes/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace catena::render::shapes_test {

constexpr double kPi = std::numbers::pi;

std::vector<Vec3> helix(int n, double turns = 2) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    const double a = 2 * kPi * turns * i / n;
    points.push_back({std::cos(a), std::sin(a), 0.3 * a});
  }
  return points;
}

std::vector<Vec3> knotted_loop(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n;
    points.push_back({(2 + std::cos(3 * a)) * std::cos(2 * a), (2 + std::cos(3 * a)) * std::sin(2 * a), std::sin(3 * a)});
  }
  points.push_back(points.front());
  return points;
}

ShapeMesh tube(std::vector<Vec3> points, double radius, int sides = 12) {
  ShapeMesh shape;
  add_tube(shape, {std::move(points), radius, {1, 0, 0}}, sides);
  return shape;
}

/// Checks that the mesh is closed: every edge (by position) occurs once in each direction.
void expect_closed(const ShapeMesh& shape) {
  using Key = std::array<double, 3>;
  std::map<std::pair<Key, Key>, int> edges;
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = shape.vertices[i].position;
    return Key{p.x, p.y, p.z};
  };
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3)
    for (int k = 0; k < 3; ++k) {
      const auto a = key(shape.triangles[t + k]), b = key(shape.triangles[t + (k + 1) % 3]);
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  for (const auto& [edge, sum] : edges) ASSERT_EQ(sum, 0) << edge.first[0] << " " << edge.first[1] << " " << edge.first[2];
}

double volume_of(const ShapeMesh& shape) {
  double volume = 0;
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const Vec3 &a = shape.vertices[shape.triangles[t]].position, &b = shape.vertices[shape.triangles[t + 1]].position,
               &c = shape.vertices[shape.triangles[t + 2]].position;
    volume += dot(a, cross(b, c)) / 6;
  }
  return volume;
}

/// Checks that the mesh is closed, and that the triangles' winding agrees with the unit vertex normals.
void expect_closed_and_outward(const ShapeMesh& shape) {
  expect_closed(shape);
  for (const MeshVertex& v : shape.vertices) ASSERT_NEAR(norm(v.normal), 1, 1e-12);
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const MeshVertex &a = shape.vertices[shape.triangles[t]], &b = shape.vertices[shape.triangles[t + 1]],
                     &c = shape.vertices[shape.triangles[t + 2]];
    const Vec3 face = direction(cross(b.position - a.position, c.position - a.position));
    for (const MeshVertex* v : {&a, &b, &c}) ASSERT_GT(dot(face, v->normal), 0.2);
  }
}

double distance_to(const Vec3& p, const std::vector<Vec3>& line) {
  double best = 1e300;
  for (const Vec3& q : line) best = std::min(best, norm(p - q));
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 d = line[i + 1] - line[i];
    if (!(dot(d, d) > 0)) continue;
    const double t = std::clamp(dot(p - line[i], d) / dot(d, d), 0.0, 1.0);
    best = std::min(best, norm(p - line[i] - t * d));
  }
  return best;
}

TEST(Shapes, ATubeIsClosedAndOutward) {
  for (const auto& points : {helix(200), knotted_loop(400), std::vector<Vec3>{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}}) {
    const ShapeMesh shape = tube(points, 0.05);
    expect_closed_and_outward(shape);
    EXPECT_GT(volume_of(shape), 0);
  }
}

TEST(Shapes, TubeVerticesAreAtTheRadius) {
  const auto points = helix(1000, 0.25);
  const ShapeMesh shape = tube(points, 0.05);
  for (const MeshVertex& v : shape.vertices) ASSERT_NEAR(distance_to(v.position, points), 0.05, 1e-6 * 0.05);
}

TEST(Shapes, AStraightTubeKeepsTheRadiusThroughSharpCorners) {
  const std::vector<Vec3> corner{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  const ShapeMesh shape = tube(corner, 0.05);
  expect_closed(shape);
  for (const MeshVertex& v : shape.vertices) EXPECT_LE(distance_to(v.position, corner), 0.05 * (1 + 1e-12));
}

TEST(Shapes, TheVolumeOfATubeIsThatOfACapsule) {
  const double r = 0.1, l = 2;
  const ShapeMesh shape = tube({{0.0, 0.0, 0.0}, {0.0, 0.0, l}}, r, 48);
  EXPECT_NEAR(volume_of(shape), kPi * r * r * l + 4.0 / 3 * kPi * r * r * r, 0.01 * kPi * r * r * l);
}

TEST(Shapes, AClosedLineIsJoinedWithoutCaps) {
  const int n = 300, sides = 12;
  const ShapeMesh shape = tube(knotted_loop(n), 0.1, sides);
  EXPECT_EQ(shape.vertices.size(), std::size_t(n) * sides);
  EXPECT_EQ(shape.triangles.size(), std::size_t(n) * sides * 6);
  expect_closed(shape);
}

TEST(Shapes, FramesDoNotTwist) {
  // along a planar curve the transported normal keeps its angle to the plane
  std::vector<Vec3> arc;
  for (int i = 0; i <= 100; ++i) arc.push_back({std::cos(0.03 * i), std::sin(0.03 * i), 0.0});
  const int sides = 8;
  const ShapeMesh shape = tube(arc, 0.01, sides);
  for (int i = 1; i <= 100; ++i) EXPECT_NEAR(shape.vertices[i * sides].normal.z, shape.vertices[0].normal.z, 1e-12);
}

TEST(Shapes, TheTriangleCountIsBounded) {
  for (const int sides : {8, 12, 16}) {
    const ShapeMesh shape = tube(helix(500), 0.01, sides);
    EXPECT_LE(shape.triangles.size() / 3, std::size_t(2 * sides * (500 + sides)));
  }
  EXPECT_EQ(tube_sides(1, 1), 0) << "a pixel: a ribbon";
  EXPECT_EQ(tube_sides(4, 1), 12);
  EXPECT_EQ(tube_sides(50, 1), 16);
  EXPECT_EQ(tube_sides(0.001, 0), 16) << "the eye is among them";
}

TEST(Shapes, DegenerateTubesAreHandled) {
  EXPECT_TRUE(tube({}, 0.1).triangles.empty());
  EXPECT_TRUE(tube(helix(10), 0).triangles.empty());
  const ShapeMesh point = tube({{1.0, 2.0, 3.0}}, 0.1);
  expect_closed(point);
  EXPECT_FALSE(point.triangles.empty());
  const ShapeMesh repeated = tube({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 0.1);
  expect_closed_and_outward(repeated);
  const ShapeMesh there_and_back = tube({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, 0.1);
  expect_closed(there_and_back);
  for (const MeshVertex& v : there_and_back.vertices) ASSERT_TRUE(is_finite(v.position) && is_finite(v.normal));
}

TEST(ShapesDeathTest, NonFinitePointsFailAnAssertion) { EXPECT_DEATH(tube({{0.0, 0.0, 0.0}, {std::nan(""), 0.0, 0.0}}, 0.1), "is_finite"); }

TEST(Shapes, BallCylinderConeAreClosedAndOutward) {
  ShapeMesh ball, cylinder, cone;
  add_sphere(ball, {1.0, 2.0, 3.0}, 0.5, {}, 40);
  add_cylinder(cylinder, {0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, 0.2, {}, 40);
  add_cone(cone, {0.0, 0.0, 0.0}, {0.0, -1.0, 0.5}, 0.3, {}, 40);
  for (const ShapeMesh* s : {&ball, &cylinder, &cone}) {
    expect_closed_and_outward(*s);
  }
  EXPECT_NEAR(volume_of(ball), 4.0 / 3 * kPi * 0.125, 0.02);
  EXPECT_NEAR(volume_of(cylinder), kPi * 0.04 * std::sqrt(2.0), 0.002);
  EXPECT_NEAR(volume_of(cone), kPi * 0.09 * std::sqrt(1.25) / 3, 0.002);
  for (const MeshVertex& v : ball.vertices) EXPECT_NEAR(norm(v.position - Vec3(1.0, 2.0, 3.0)), 0.5, 1e-14);
  ShapeMesh none;
  add_cylinder(none, Vec3(1.0), Vec3(1.0), 0.1, {});
  add_sphere(none, Vec3(0.0), 0, {});
  EXPECT_TRUE(none.vertices.empty());
}

ShapeMesh shape_of(const CursorItem& item) {
  ShapeMesh shape;
  add_cursor(shape, item);
  return shape;
}

CursorItem cursor() { return {{0.0, 0.0, 0.0}, {{1.0, 0.0, 0.0}, {1.0, 2.0, 0.0}}, {true, false}, {0.0, 0.0, 3.0}, 0.1, {}}; }

TEST(Shapes, TheCursorShowsEveryProxyAndTheForce) {
  const ShapeMesh shape = shape_of(cursor());
  expect_closed_and_outward(shape);
  // the first proxy's ball has the colour of link 0, the second's the dimmed colour of link 1
  int first = 0, second = 0;
  double highest = 0;
  for (const MeshVertex& v : shape.vertices) {
    if (v.color == link_color(0, true)) {
      ++first;
      EXPECT_LE(norm(v.position - Vec3(1.0, 0.0, 0.0)), 0.1);
    }
    if (v.color == link_color(1, false)) {
      ++second;
      EXPECT_LE(norm(v.position - Vec3(1.0, 2.0, 0.0)), 0.1);
    }
    highest = std::max(highest, v.position.z);
  }
  EXPECT_GT(first, 50);
  EXPECT_GT(second, 50);
  EXPECT_NEAR(highest, cursor_arrow_length(3, 0.1), 1e-12);
}

int vertices_of(const ShapeMesh& shape, const Color& c) {
  int count = 0;
  for (const MeshVertex& v : shape.vertices) count += v.color == c;
  return count;
}

TEST(Shapes, ALinkNearItsReleaseIsHighlighted) {
  CursorItem item = cursor();
  const ShapeMesh calm = shape_of(item);
  item.release_ratios = {0.5, 0};
  const ShapeMesh near = shape_of(item);
  item.release_ratios = {0, 1};  // link 1 is released and not active
  const ShapeMesh gone = shape_of(item);
  EXPECT_GT(vertices_of(calm, release_color(0)), 0);
  EXPECT_EQ(vertices_of(near, release_color(0)), 0);
  EXPECT_GT(vertices_of(near, release_color(0.5)), 0);
  EXPECT_EQ(vertices_of(calm, release_color(1)), 0);
  EXPECT_GT(vertices_of(gone, release_color(1)), 100) << "rings around the place";
  expect_closed_and_outward(gone);
  EXPECT_GT(release_color(1).r - release_color(1).g, 0.5f);
}

TEST(Shapes, ADropLineEndsInACross) {
  CursorItem item = cursor();
  item.foot_point = Vec3(0.0, 0.0, -5.0);
  const ShapeMesh shape = shape_of(item);
  expect_closed_and_outward(shape);
  double lowest = 0, widest = 0, thickest = 0;
  for (const MeshVertex& v : shape.vertices) {
    lowest = std::min(lowest, v.position.z);
    if (v.position.z < -4.9) widest = std::max(widest, std::hypot(v.position.x, v.position.y));
    if (v.position.z < -4.9) thickest = std::max(thickest, std::fabs(v.position.z + 5));
  }
  EXPECT_NEAR(lowest, -5.015, 1e-6);
  EXPECT_NEAR(widest, std::hypot(0.15, 0.015), 1e-6);
  EXPECT_NEAR(thickest, 0.015, 1e-6);
  item.foot_point = item.probe;
  EXPECT_EQ(shape_of(item).vertices.size(), shape_of(cursor()).vertices.size());
}

TEST(Shapes, ACrosshairIsThreeRodsIndependentOfTheForce) {
  CursorItem item = cursor();
  item.is_crosshair = true;
  const ShapeMesh held = shape_of(item);
  item.proxies.clear();
  item.link_active.clear();
  item.force_n = Vec3(0.0);
  item.force_ratio = 0.7;
  const ShapeMesh free = shape_of(item);
  expect_closed_and_outward(held);
  ASSERT_EQ(held.vertices.size(), free.vertices.size());
  Vec3 longest(0.0);
  for (std::size_t i = 0; i < held.vertices.size(); ++i) {
    const Vec3 p = held.vertices[i].position;
    EXPECT_EQ(p, free.vertices[i].position);
    for (int axis = 0; axis < 3; ++axis) longest[axis] = std::max(longest[axis], std::fabs(p[axis]));
    const double off = std::min({std::hypot(p.x, p.y), std::hypot(p.y, p.z), std::hypot(p.z, p.x)});
    EXPECT_NEAR(off, 0, 0.0061) << "on one of the rods";
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(longest[axis], 0.1, 1e-12);
}

TEST(Shapes, WithoutADeviceColorsShowTheForce) {
  CursorItem item = cursor();
  item.link_active = {true, true};
  const auto reddest_far_from = [](const ShapeMesh& shape, const Vec3& probe) {
    float maximum = -1;
    for (const MeshVertex& v : shape.vertices) {
      const bool of_a_link = v.color.r == link_color(0, true).r || v.color.r == link_color(1, true).r;
      if (!of_a_link && norm(v.position - probe) > 0.3) maximum = std::max(maximum, v.color.r - v.color.b);
    }
    return maximum;
  };
  item.force_ratio = 0;
  const ShapeMesh calm = shape_of(item);
  item.force_ratio = 0.5;
  const ShapeMesh half = shape_of(item);
  item.force_ratio = 1;
  const ShapeMesh maximum = shape_of(item);
  // the cursor is at the last proxy; the probe is the smaller ball
  double at_proxy = 0, at_probe = 0, highest = 0;
  for (const MeshVertex& v : calm.vertices) {
    const double from_proxy = norm(v.position - Vec3(1.0, 2.0, 0.0)), from_probe = norm(v.position);
    if (from_proxy < 0.101) at_proxy = std::max(at_proxy, from_proxy);
    if (from_probe < 0.09) at_probe = std::max(at_probe, from_probe);
    highest = std::max(highest, v.position.z);
  }
  EXPECT_NEAR(highest, cursor_arrow_length(norm(item.force_n), item.radius), 1e-9) << "the arrow begins where the hand is held";
  EXPECT_NEAR(at_proxy, 0.1, 1e-6);
  EXPECT_NEAR(at_probe, 0.045, 1e-3);
  expect_closed_and_outward(maximum);
  EXPECT_LT(reddest_far_from(calm, item.probe), 0.5f) << "green, and the calm colour";
  EXPECT_GT(reddest_far_from(half, item.probe), 0.6f);
  EXPECT_GT(reddest_far_from(maximum, item.probe), 0.85f);
}

TEST(Shapes, ArrowLengthFollowsTheForceWithinLimits) {
  EXPECT_EQ(cursor_arrow_length(0, 1), 0);
  EXPECT_EQ(cursor_arrow_length(std::nan(""), 1), 0);
  EXPECT_EQ(cursor_arrow_length(0.001, 1), 2);
  EXPECT_DOUBLE_EQ(cursor_arrow_length(2, 1), 5);
  EXPECT_DOUBLE_EQ(cursor_arrow_length(4, 1), 10);
  EXPECT_EQ(cursor_arrow_length(1e6, 1), 16);
}

TEST(Shapes, ACursorWithoutSizeOrPositionIsNotDrawn) {
  CursorItem item = cursor();
  item.radius = 0;
  EXPECT_TRUE(shape_of(item).vertices.empty());
  item = cursor();
  item.probe.x = std::nan("");
  EXPECT_TRUE(shape_of(item).vertices.empty());
}

TEST(Shapes, LinkColorsDiffer) {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Color a = link_color(i, true), b = link_color(j, true);
      EXPECT_GT(std::fabs(a.r - b.r) + std::fabs(a.g - b.g) + std::fabs(a.b - b.b), 0.15f);
    }
  EXPECT_LT(link_color(0, false).r, link_color(0, true).r);
}

TEST(Tube, EveryRingHasItsPointsColor) {
  ShapeMesh shape;
  TubeItem item{helix(20), 0.05, {0.5f, 0.5f, 0.5f}};
  for (std::size_t i = 0; i < item.points.size(); ++i) item.colors.push_back({static_cast<float>(i), 0, 0});
  add_tube(shape, item, 8);
  expect_closed(shape);
  for (const MeshVertex& v : shape.vertices) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < item.points.size(); ++i)
      if (norm(item.points[i] - v.position) < norm(item.points[nearest] - v.position)) nearest = i;
    EXPECT_EQ(v.color.r, static_cast<float>(nearest));
  }
}

}  // namespace catena::render::shapes_test
