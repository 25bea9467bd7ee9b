// SPDX-License-Identifier: MIT
#include "haptics/chain/baseline.h"

#include <limits>

#include "engine/base/memory_limit.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::baseline_test {

constexpr CouplingMethod kAll[] = {CouplingMethod::pipe, CouplingMethod::balance, CouplingMethod::closest, CouplingMethod::linear};

struct Hand : catena::test::ChainDriver {
  explicit Hand(CouplingMethod method, const std::vector<ConstraintPtr>& constraints = {}) {
    program.coupling.method = method;
    for (const ConstraintPtr& constraint : constraints) add(constraint);
  }
  const Vec3& at(const Vec3& probe, std::uint32_t buttons = 0) {
    step(probe, buttons);
    return link().proxy;
  }
  LinkStatus status(std::size_t i = 0) const { return out.links[i].status; }
};

ConstraintPtr plane(const Vec3& point, const Vec3& normal, const std::string& more = "") {
  return build(R"({"name": "a", "type": "plane", "point": )" + to_json(point) + R"(, "normal": )" + to_json(normal) + more + "}");
}
ConstraintPtr point(const Vec3& position) { return build(R"({"name": "a", "type": "point", "position": )" + to_json(position) + "}"); }
/// A streamline of a uniform field: a straight line.
ConstraintPtr line(const Vec3& seed, const Vec3& along, const std::string& more = "") {
  Fields fields;
  fields.named["v"] = *field::make_analytic("uniform", {.scale = 1, .direction = along, .part = {}});
  return build(R"({"name": "a", "type": "streamline", "field": "v", "seed": )" + to_json(seed) + more + "}", fields);
}
ConstraintPtr circle(const Vec3& seed, const std::string& more = "") {
  Fields fields;
  fields.named["v"] = *field::make_analytic("circle");
  return build(R"({"name": "a", "type": "streamline", "field": "v", "seed": )" + to_json(seed) + more + "}", fields);
}

using catena::test::expect_near;

TEST(PrimitiveSpan, ShortestStepOntoAllAndRemainingFreeDirections) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Primitive a{Primitive::Kind::plane, random.box(1), random.unit()}, b{Primitive::Kind::plane, random.box(1), random.unit()};
    const Vec3 from = random.box(2), axis = cross(a.axis, b.axis);
    if (norm(axis) < 0.1) continue;
    ConstrainedSubspace span;
    span.add(a, from);
    span.add(b, from);
    const Vec3 p = from + span.shortest_step();
    EXPECT_LE(distance_to(a, p) + distance_to(b, p), 1e-13);
    EXPECT_NEAR(dot(axis, span.shortest_step()), 0, 1e-13);
    EXPECT_LE(norm(span.project_free(axis) - axis), 1e-13);
    span.add({Primitive::Kind::line, random.box(1), random.unit()}, p);
    EXPECT_EQ(span.project_free(Vec3(1, 2, 3)), Vec3(0.0));
  }
}

TEST(Pipe, OnTwoPlanesFindsTheNearestPointOfTheirLine) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 n = random.unit(), m = random.unit(), o = random.box(1);
    const Vec3 along = direction(cross(n, m));
    if (norm(cross(n, m)) < 0.1) continue;
    Hand hand(CouplingMethod::pipe, {plane(o, n), plane(o, m)});
    const Vec3 x = random.box(2);
    expect_near(hand.at(x), o + along * dot(along, x - o), 1e-10);
    EXPECT_EQ(hand.status(), LinkStatus::ok);
    EXPECT_TRUE(bitwise_equal(hand.link().proxy, hand.link(1).proxy));
    expect_near(hand.out.force_n, 500.0 * (hand.link().proxy - x), 1e-9);
  }
}

TEST(Pipe, FindsTheIntersectionOfThreePlanesAndOfAPlaneAndALine) {
  Hand corner(CouplingMethod::pipe, {plane({1, 0, 0}, {1, 0, 0}), plane({0, 2, 0}, {0.3, 1, 0}), plane({0, 0, 3}, {0.2, 0.4, 1})});
  const Vec3 p = corner.at({5, 5, 5});
  EXPECT_NEAR(p.x, 1, 1e-11);
  EXPECT_NEAR(p.y, 2 - 0.3, 1e-11);
  EXPECT_NEAR(p.z, 3 - 0.2 - 0.4 * 1.7, 1e-11);
  for (const double degrees : {2.0, 5.0, 20.0, 60.0, 90.0}) {
    const double a = degrees * M_PI / 180;
    for (const char* more : {"", R"(, "follow": "online")"}) {
      Hand hand(CouplingMethod::pipe,
                {line({0.5 * std::cos(a), 0, 0.5 * std::sin(a)}, {std::cos(a), 0, std::sin(a)}, more), plane({0, 0, 0}, {0, 0, 1})});
      expect_near(hand.at({-0.03 * std::cos(a), 0.01, -0.03 * std::sin(a)}), Vec3(0.0), 1e-10 / std::sin(a));
      EXPECT_EQ(hand.status(1), LinkStatus::ok) << degrees;
    }
  }
}

TEST(Pipe, FindsTheIntersectionOfCurvedConstraints) {
  Hand hand(CouplingMethod::pipe, {circle({0.8, 0, 0.3}), plane({0.4, 0, 0}, {1, 0, 0})});
  expect_near(hand.at({0.5, 0.7, 0.2}), {0.4, std::sqrt(0.64 - 0.16), 0.3}, 1e-9);
  EXPECT_EQ(hand.status(), LinkStatus::ok);
  for (const auto& sphere : {analytic_field("sphere"), sampled_field("sphere", 64)}) {
    Hand two(CouplingMethod::pipe, {isosurface(sphere, 1), plane({0, 0, 0.6}, {0, 0, 1})});
    const Vec3 p = two.at({1, 0.5, 0.9});
    EXPECT_NEAR(p.z, 0.6, 1e-10);
    EXPECT_NEAR(norm(p), 1, sphere->is_grid() ? 1e-3 : 1e-10);
    EXPECT_EQ(two.link().status, LinkStatus::ok);
    EXPECT_LE(two.link().residual, 4e-11);
  }
}

TEST(Pipe, HoldsOnTheEdgeOfTwoFreeSides) {
  Hand hand(CouplingMethod::pipe);
  for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) hand.add(plane({0, 0, 0}, up, R"(, "free": "above")")).one_sided = true;
  expect_near(hand.at({0.25, -0.5, -0.125}), {0.25, 0, 0}, 0);
  EXPECT_EQ(hand.status(), LinkStatus::ok);
  EXPECT_EQ(hand.status(1), LinkStatus::ok);
  expect_near(hand.at({0.25, 0.5, -0.125}), {0.25, 0.5, 0}, 0);
  EXPECT_EQ(hand.status(1), LinkStatus::free);
  expect_near(hand.at({0.25, 0.5, 0.5}), {0.25, 0.5, 0.5}, 0);
}

TEST(Pipe, WithoutAnIntersectionReportsBudget) {
  Hand hand(CouplingMethod::pipe, {plane({0, 0, 0}, {0, 0, 1}), plane({0, 0, 1}, {0, 0, 1})});
  const Vec3 p = hand.at({0, 0, 3});
  EXPECT_EQ(hand.status(), LinkStatus::budget);
  EXPECT_TRUE(is_finite(p));
}

TEST(Pipe, ReleasesByTheDistanceToTheProxyNotByDepth) {
  const double a = 30 * M_PI / 180;
  Hand hand(CouplingMethod::pipe, {line({0.5 * std::cos(a), 0, 0.5 * std::sin(a)}, {std::cos(a), 0, std::sin(a)})});
  Link& floor = hand.add(plane({0, 0, 0}, {0, 0, 1}, R"(, "free": "above")"));
  floor.release = 0.05;
  floor.one_sided = true;
  // a position on the line, the proxy's, and the floor's status; one-sided, it re-arms only on the free side
  const std::tuple<double, double, LinkStatus> steps[] = {
      {0.1, 0.1, kFree},
      {-0.049, 0, kOk},
      {-0.051, -0.051, kReleased},  // released in the tick that reaches the distance; the depth is half of it
      {-0.001, -0.001, kReleased},
      {0.01, 0.01, kFree},
      {-0.02, 0, kOk}};
  const auto along = [&](double s) { return Vec3(s * std::cos(a), 0, s * std::sin(a)); };
  for (const auto& [probe, proxy, status] : steps) {
    expect_near(hand.at(along(probe)), along(proxy), 1e-10);
    EXPECT_EQ(hand.status(1), status) << probe;
    EXPECT_EQ(hand.link(1).active, status != kReleased) << probe;
    EXPECT_TRUE(hand.link().active);
    EXPECT_TRUE(status != kFree || hand.link(1).force_n == Vec3(0.0));
  }
}

TEST(Balance, IsTheWeightedMeanOfTwoPlanes) {
  Hand hand(CouplingMethod::balance);
  hand.program.coupling.stiffness_n_per_m = 400;
  hand.add(plane({0, 0, 0}, {0, 0, 1}), 100);
  hand.add(plane({0, 0, 1}, {0, 0, 1}), 300);
  expect_near(hand.at({0.2, 0.3, 3}), {0.2, 0.3, (400 * 3 + 300 * 1) / 800.0}, 1e-14);
  EXPECT_NEAR(hand.out.force_n.z, 400 * (1.875 - 3), 1e-11);
  EXPECT_NEAR(hand.link(1).residual, 0.875, 1e-14);
  EXPECT_NEAR(norm(hand.link().force_n + hand.link(1).force_n - hand.out.force_n), 0, 1e-11);
}

TEST(Balance, OfALineAPlaneAndAPointHasAClosedForm) {
  Hand hand(CouplingMethod::balance);
  hand.add(line({0, 0, 0}, {1, 0, 0}), 1000);
  hand.add(plane({1, 0, 0}, {1, 0, 0}), 250);
  hand.add(point({0, 0, 1}), 500);
  const Vec3 x(3, 2, 4);
  // per axis: weighted mean of the probe and the springs of that axis
  expect_near(hand.at(x), {(500 * 3 + 250 * 1) / 1250.0, 500 * 2 / 2000.0, (500 * 4 + 500 * 1) / 2000.0}, 1e-13);
}

TEST(Balance, OfAnyPrimitivesIsTheMinimumOfTheEnergy) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = random.unit(), m = random.unit(), t = random.unit(), o = random.box(1), q = random.box(1), x = random.box(2);
    const double k[] = {random.uniform(1, 1000), random.uniform(1, 1000), random.uniform(1, 1000)};
    Hand hand(CouplingMethod::balance);
    hand.add(plane(o, n), k[0]);
    hand.add(plane(q, m), k[1]);
    hand.add(line(o, t), k[2]);
    hand.at(x);
    const Vec3 p = hand.at(x), e = p - o;
    const Vec3 gradient = 500.0 * (p - x) + k[0] * dot(n, e) * n + k[1] * dot(m, p - q) * m + k[2] * (e - dot(t, e) * t);
    EXPECT_LE(norm(gradient), 1e-8) << i;
  }
}

TEST(Balance, ViolatesBothConstraints) {
  const double a = 30 * M_PI / 180;
  Hand hand(CouplingMethod::balance);
  hand.add(line({0, 0, 0}, {std::cos(a), 0, std::sin(a)}), 10);
  hand.add(plane({0, 0, 0}, {0, 0, 1}));
  const Vec3 p = hand.at({-0.05 * std::cos(a), 0, -0.05 * std::sin(a)});
  EXPECT_GT(hand.link().residual, 0.005);
  EXPECT_LT(p.z, -0.005);
}

TEST(Closest, ProjectsOntoTheNearerOfTwoLines) {
  Hand hand(CouplingMethod::closest, {line({0, 0, 0}, {1, 0, 0}), line({0, 0, 1}, {0, 1, 0})});
  expect_near(hand.at({0.3, 0.1, 0.2}), {0.3, 0, 0}, 1e-12);
  expect_near(hand.at({0.3, 0.1, 0.9}), {0, 0.1, 1}, 1e-12);
  EXPECT_EQ(hand.link().force_n, Vec3(0.0));
  EXPECT_NE(hand.link(1).force_n, Vec3(0.0));
  EXPECT_TRUE(bitwise_equal(hand.link().proxy, hand.link(1).proxy));
}

TEST(Linear, MovesAlongTheFreeDirections) {
  Hand hand(CouplingMethod::linear, {plane({0, 0, 0}, {0, 0, 1})});
  expect_near(hand.at({1, 2, 3}), {1, 2, 0}, 1e-14);
  hand.add(plane({0, 0, 0}, {0, 1, 0}));
  const Vec3 p = hand.at({4, 5, 6});
  EXPECT_NEAR(p.x, 4, 1e-14);
  EXPECT_NEAR(p.y, 0, 1e-14);  // projected onto the added plane
  Hand fixed(CouplingMethod::linear, {point({1, 1, 1})});
  expect_near(fixed.at({4, 5, 6}), {1, 1, 1}, 0);
}

TEST(Linear, DriftsOffACircleLikeTheLinearMethod) {
  Hand hand(CouplingMethod::linear), follow(CouplingMethod::chain);
  hand.add(circle({0.05, 0, 0}, R"(, "follow": "online")"));
  follow.add(circle({0.05, 0, 0}, R"(, "method": "linear")"));
  double worst = 0;
  for (int k = 0; k <= 1571; ++k) {
    const double angle = 0.2 * 1e-3 * k / 0.05;
    const Vec3 x(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0);
    expect_near(hand.at(x), follow.at(x), 1e-15);
    worst = std::max(worst, norm(hand.link().proxy) - 0.05);
  }
  EXPECT_NEAR(worst, 0.63e-3, 0.02e-3);
}

TEST(Linear, DriftsOffASphere) {
  Hand hand(CouplingMethod::linear, {isosurface(analytic_field("sphere"), 1)});
  double worst = 0;
  for (int k = 0; k <= 100; ++k) worst = std::max(worst, std::fabs(norm(hand.at({std::cos(0.01 * k), std::sin(0.01 * k), 0.1})) - 1));
  EXPECT_GT(worst, 1e-4);
  EXPECT_LT(worst, 1e-1);
}

TEST(Baseline, TwoSidedLinksReArmNearOrAcross) {
  struct {
    double height, proxy, tolerance;
    LinkStatus status;
  } const steps[] = {{0.2, 0, 1e-3, kOk},   {0.3, 0.3, 0, kReleased}, {0.026, 0.026, 0, kReleased},
                     {0.024, 0, 2e-5, kOk}, {0.3, 0.3, 0, kReleased}, {-0.1, 0, 1e-4, kOk}};
  for (const CouplingMethod combination : kAll) {
    Hand hand(combination);
    hand.add(plane({0, 0, 0}, {0, 0, 1}), 1e6).release = 0.25;
    for (const auto& s : steps) {
      expect_near(hand.at({0, 0, s.height}), {0, 0, s.proxy}, s.tolerance);
      EXPECT_EQ(hand.status(), s.status) << s.height;
    }
  }
}

TEST(Baseline, FreeSidesPassTheProbeThrough) {
  for (const CouplingMethod combination : kAll) {
    for (const ConstraintPtr& floor :
         {plane({0, 0, 0}, {0, 0, 1}, R"(, "free": "above")"), isosurface(analytic_field("plane"), 0, R"(, "free": "above")")}) {
      Hand hand(combination);
      hand.add(floor, 1e6).one_sided = true;
      EXPECT_TRUE(bitwise_equal(hand.at({0.1, 0.2, 0.3}), Vec3(0.1, 0.2, 0.3)));
      EXPECT_EQ(hand.status(), LinkStatus::free);
      EXPECT_EQ(hand.out.force_n, Vec3(0.0));
      expect_near(hand.at({0.1, 0.2, -0.3}), {0.1, 0.2, 0}, 2e-4);  // within the tick of the crossing
      EXPECT_EQ(hand.status(), LinkStatus::ok);
      EXPECT_TRUE(bitwise_equal(hand.at({0.1, 0.2, 1e-9}), Vec3(0.1, 0.2, 1e-9)));
    }
  }
}

TEST(Baseline, SwitchedLinksJoinAndLeave) {
  for (const CouplingMethod combination : kAll) {
    Hand hand(combination);
    hand.add(plane({0, 0, 0}, {0, 0, 1}), 1e6);
    hand.add(plane({0, 0, 0}, {0, 1, 0}), 1e6).active_when.button = 1;
    const bool nearest = combination == CouplingMethod::closest;
    expect_near(hand.at({1, 2, 3}), {1, 2, 0}, 2e-3);
    expect_near(hand.at({1, 2, 3}, 1), {1, 0, nearest ? 3.0 : 0.0}, 2e-3);
    expect_near(hand.at({1, 2, 3}, 0), {1, 2, 0}, 2e-3);
    EXPECT_FALSE(hand.link(1).active);
    EXPECT_TRUE(bitwise_equal(hand.link().proxy, hand.link(1).proxy));
  }
}

TEST(Baseline, ASwitchRampsTheForce) {
  Hand hand(CouplingMethod::pipe);
  hand.program.coupling.ramp_s = 0.02;
  hand.add(plane({0, 0, 0}, {0, 0, 1}));
  hand.add(plane({0, 0, 0}, {0, 1, 0})).active_when.button = 1;
  hand.at({0, 0.01, 0.01});
  Vec3 last = hand.out.force_n;
  for (int k = 0; k < 60; ++k) {
    hand.at({0, 0.01, 0.01}, k / 25 % 2 == 0 ? 1 : 0);
    EXPECT_LE(norm(hand.out.force_n - last), hand.program.coupling.max_force_n * 0.05 + 1e-12) << k;
    last = hand.out.force_n;
  }
}

TEST(Baseline, TheProxyRestsWhileTheProbeRests) {
  for (const CouplingMethod combination : {CouplingMethod::pipe, CouplingMethod::closest}) {
    Hand hand(combination, {line({0.2, 0.1, 0}, {1, 0.4, 0.2}, R"(, "method": "rkf34")"), isosurface(sampled_field("sphere", 32), 0.9)});
    hand.add(plane({0.1, 0, 0}, {1, 0.3, 0})).active_when.button = 1;
    Random random(3);
    int budget = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec3 x = random.box(1);
      Vec3 p = hand.at(x);
      const auto out_of_budget = [&] { return hand.status() == LinkStatus::budget || hand.status(1) == LinkStatus::budget; };
      for (int k = 0; k < 4 && out_of_budget(); ++k) p = hand.at(x);
      if (out_of_budget() && ++budget > 0) continue;
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(bitwise_equal(hand.at(x), p)) << static_cast<int>(combination) << " " << i;
    }
    EXPECT_LE(budget, 5);
  }
}

TEST(Baseline, StaysFiniteBoundedAndAllocatesNothing) {
  const double wild[] = {0.0, -0.0, 5e-324, 1e-300, 1e-9, 0.4, 3, 1e9, 1e160, 1e300, 1.7e308};
  for (const CouplingMethod combination : kAll) {
    Hand hand(combination, {circle({0.7, 0, 0}, R"(, "method": "rkf34")")});
    Link& shell = hand.add(isosurface(sampled_field("sphere", 32), 0.8, R"(, "free": "above")"));
    shell.one_sided = true;
    shell.release = 0.3;
    hand.add(plane({0.1, 0, 0}, {1, 0.3, 0})).release = 0.5;
    hand.add(line({0, 0, 0.2}, {1, 1, 1})).active_when.button = 2;
    hand.add(point({0, 0, 0})).active_when.button = 3;
    hand.program.coupling.damping_ns_per_m = 1;
    hand.program.coupling.max_force_n = 8;
    Random random(7);
    for (int i = 0; i < 3000; ++i) {
      Vec3 x = random.box(1);
      if (i % 3 == 0) x = {wild[random.engine() % 11], -wild[random.engine() % 11], wild[random.engine() % 11]};
      const AllocationCounter guard;
      hand.at(x, static_cast<std::uint32_t>(random.engine() & 7));
      ASSERT_EQ(guard.count(), 0u);
      for (std::size_t k = 0; k < 5; ++k) {
        ASSERT_TRUE(is_finite(hand.link(k).proxy)) << static_cast<int>(combination) << " " << i;
        ASSERT_LE(hand.link(k).evaluations, kMaxEvaluations);
      }
      ASSERT_TRUE(is_finite(hand.out.force_n));
      ASSERT_LE(norm(hand.out.force_n), 8 * (1 + 1e-12));
    }
    const Vec3 before = hand.link().proxy;
    hand.at({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    EXPECT_TRUE(bitwise_equal(hand.link().proxy, before));
    EXPECT_EQ(hand.status(), LinkStatus::bad_probe);
    EXPECT_EQ(hand.out.force_n, Vec3(0.0));
  }
}

TEST(Baseline, NoLinksIsFreeMotion) {
  for (const CouplingMethod combination : kAll) {
    Hand hand(combination);
    hand.at({1, 2, 3});
    EXPECT_EQ(hand.out.force_n, Vec3(0.0));
  }
}

}  // namespace catena::haptics::tests::baseline_test
