// SPDX-License-Identifier: MIT
/// The linear primitives that approximate curves and surfaces at a position, for the baselines.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::primitive_test {

Fields with_vector(const std::string& name) {
  Fields fields;
  fields.named["v"] = *field::make_analytic(name);
  return fields;
}

ConstraintPtr circle(const std::string& more) {
  return build(R"({"name": "a", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.25])" + more + "}", with_vector("circle"));
}

TEST(Primitive, OfAStreamlineIsTheTangentAtTheClosestPoint) {
  for (const char* more : {"", R"(, "follow": "online")", R"(, "method": "dp54")"}) {
    Rig rig(circle(more));
    Random random(2);
    for (int i = 0; i < 50; ++i) {
      const double a = 0.1 * i;
      rig.tick({0.6 * std::cos(a), 0.6 * std::sin(a), 0.2});
      const LinkState before = rig.state;
      const double b = a + random.uniform(-0.2, 0.2);
      Primitive line;
      ASSERT_TRUE(rig.constraint->primitive({0.4 * std::cos(b), 0.4 * std::sin(b), 0}, rig.state, rig.scratch, line));
      EXPECT_EQ(line.kind, Primitive::Kind::line);
      EXPECT_LE(norm(line.origin - Vec3(0.5 * std::cos(b), 0.5 * std::sin(b), 0.25)),
                *more ? 1e-7 : 1e-8);  // online: 4e-9 per step, accumulated
      EXPECT_LE(norm(line.axis - Vec3(-std::sin(b), std::cos(b), 0)), 1e-7);
      EXPECT_TRUE(bitwise_equal(rig.state.proxy, before.proxy));
      EXPECT_LE(rig.state.evaluations, kMaxEvaluations);
    }
  }
}

TEST(Primitive, OfAnOnlineStreamlineAtItsOwnProxyIsTheFieldThere) {
  Rig rig(circle(R"(, "method": "linear")"));
  rig.tick({0.5, 0.1, 0.25});
  rig.state.proxy = {0, 0.7, 0.3};  // moved by the linear baseline
  Primitive line;
  ASSERT_TRUE(rig.constraint->primitive(rig.state.proxy, rig.state, rig.scratch, line));
  EXPECT_LE(norm(line.axis - Vec3(-1, 0, 0)), 1e-15);
  rig.state.proxy = {0, 0, 0};  // the centre of the circles has no direction
  EXPECT_FALSE(rig.constraint->primitive(rig.state.proxy, rig.state, rig.scratch, line));
  EXPECT_EQ(rig.state.status, LinkStatus::critical);
}

TEST(Primitive, OfAnOpenEndIsAPoint) {
  for (const char* more : {"", R"(, "follow": "online")"}) {
    Rig rig(
        build(std::string(R"({"name": "a", "type": "streamline", "field": "v", "seed": [0.5, 0, 0])") + more + "}", with_vector("node")));
    for (int i = 0; i < 20; ++i) rig.tick({-0.5, 0, 0});  // moves to the node and is held there
    ASSERT_EQ(rig.state.status, LinkStatus::critical);
    Primitive end;
    ASSERT_TRUE(rig.constraint->primitive({-0.1, 0, 0}, rig.state, rig.scratch, end));
    EXPECT_EQ(end.kind, Primitive::Kind::point);
    EXPECT_LE(norm(end.origin), 4e-6);
  }
}

TEST(Primitive, OfAnIsosurfaceIsTheTangentPlaneByOneSample) {
  for (const auto& sphere : {analytic_field("sphere"), sampled_field("sphere", 64)}) {
    const double tolerance = sphere->is_grid() ? 1e-2 : 1e-15;
    Rig rig(isosurface(sphere, 1));
    Random random(3);
    for (int i = 0; i < 100; ++i) {
      const Vec3 n = random.unit(), at = n * random.uniform(0.8, 1.2);
      const int before = rig.state.evaluations;
      Primitive plane;
      ASSERT_TRUE(rig.constraint->primitive(at, rig.state, rig.scratch, plane));
      EXPECT_EQ(plane.kind, Primitive::Kind::plane);
      EXPECT_LE(norm(plane.origin - n), tolerance);
      EXPECT_LE(norm(plane.axis - n), 20 * tolerance);
      EXPECT_EQ(rig.state.evaluations, before + 1);
      rig.state.begin_tick();
    }
    rig.state.evaluations = kMaxEvaluations;
    Primitive plane;
    EXPECT_FALSE(rig.constraint->primitive({1, 0, 0}, rig.state, rig.scratch, plane));
    EXPECT_EQ(rig.state.evaluations, kMaxEvaluations);
  }
  Rig flat(isosurface(analytic_field("sphere"), 1));
  Primitive plane;
  EXPECT_FALSE(flat.constraint->primitive({0, 0, 0}, flat.state, flat.scratch, plane));  // no gradient
  EXPECT_EQ(flat.state.status, LinkStatus::critical);
}

}  // namespace catena::haptics::tests::primitive_test
