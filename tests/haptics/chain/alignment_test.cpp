// SPDX-License-Identifier: MIT
/// The rotational chain against closed forms, on constraints with a fixed or rotating axis.
#include "haptics/chain/alignment.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "haptics/chain/state_hash.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/support/axis_link.h"
#include "tests/support/simple_links.h"

namespace alignment_test {

using namespace catena;
using namespace catena::haptics;

constexpr double kPi = 3.14159265358979323846;

const test::AxisConstraint& constraint_of(const Link& link) { return static_cast<const test::AxisConstraint&>(*link.constraint); }
using test::axis_link;
using test::expect_near;

struct Hand : test::ChainDriver {
  explicit Hand(std::vector<Link> links = {}) : ChainDriver(std::move(links), 8) {}
  const HapticState& step(double time, const Quat& q, std::uint32_t buttons = 0, const Vec3& p = Vec3(0.0)) {
    return at(time, p, buttons, q);
  }
};

std::vector<Quat> orientations() {
  std::vector<Quat> out = {kIdentityRotation};
  for (int k = 1; k < 40; ++k)
    out.push_back(rotation_from_vector(Vec3(std::sin(1.7 * k), std::cos(2.3 * k), std::sin(0.9 * k + 1)) * (0.08 * k)));
  return out;
}

TEST(Alignment, TheToolsAxisAlignsWithTheNormalAndTheTorqueIsKappaTimesTheAngle) {
  const Vec3 normal = direction({1, -2, 0.5}), tool = direction({0.3, 0.1, -0.8});
  for (const Align::Sign sign : {Align::Sign::either, Align::Sign::same})
    for (const Primitive::Kind kind : {Primitive::Kind::plane, Primitive::Kind::line})
      for (const Quat& q : orientations()) {
        Hand run({axis_link("a", normal, 0.7, sign, tool, kind)});
        run.step(0, q);
        const Vec3 before = rotate(q, tool), after = rotate(run.link().orientation, tool);
        const Vec3 goal = sign == Align::Sign::either && dot(before, normal) < 0 ? -normal : normal;
        expect_near(after, goal, 1e-12);
        // the torque acts about the common perpendicular, by the angle between the axes
        const double angle = std::atan2(norm(cross(before, goal)), dot(before, goal));
        expect_near(run.out.torque_nm, direction(cross(before, goal)) * (0.7 * angle), 1e-12);
        expect_near(run.link().torque_nm, run.out.torque_nm, 0);
        EXPECT_EQ(run.link().status, LinkStatus::ok);
      }
}

TEST(Alignment, RotationalProxiesFormAChain) {
  // first the tool's z onto world x, then its x onto world y, about the first axis
  Hand run({axis_link("a", {1, 0, 0}, 0.5, Align::Sign::same, {0, 0, 1}), axis_link("b", {0, 1, 0}, 0.25, Align::Sign::same, {1, 0, 0}),
            test::hold_height("c", 0)});
  const Quat q = rotation_from_vector({0.2, 0.4, -0.3});
  run.step(0, q);
  const Quat q1 = run.link().orientation, q2 = run.link(1).orientation;
  expect_near(rotate(q1, {0, 0, 1}), {1, 0, 0}, 1e-12);
  expect_near(rotate(q2, {1, 0, 0}), {0, 1, 0}, 1e-12);
  expect_near(rotate(q2, {0, 0, 1}), {1, 0, 0}, 1e-12);  // the second rotates about the first's axis, so both hold
  EXPECT_EQ(run.link(2).orientation, q2);                // a link without "align" passes the orientation on
  expect_near(run.out.torque_nm, 0.5 * rotation_vector(q1 * glm::conjugate(q)) + 0.25 * rotation_vector(q2 * glm::conjugate(q1)), 1e-12);
}

TEST(Alignment, TheSpringIsConservativeExceptWhereTheSignSwitches) {
  // torque = -dV/dangle of V = 1/2 kappa angle^2, so that a closed path does no work: trapezoidal sum, O(1/n^2)
  const auto work_of = [](Align::Sign sign, double far) {
    Hand run({axis_link("a", {0.2, -0.1, 1}, 0.7, sign)});
    const int n = 20000;
    double work = 0;
    Quat last = kIdentityRotation;
    Vec3 last_torque(0.0);
    for (int k = 0; k <= n; ++k) {
      const double u = 2 * kPi * k / n;
      const Quat q = rotation_from_vector(Vec3(far * std::sin(u), 0.8 * std::sin(2 * u), std::cos(u) - 1));
      run.step(1e-3 * k, q);
      if (k > 0) work += 0.5 * dot(run.out.torque_nm + last_torque, rotation_vector(q * glm::conjugate(last)));
      last = q;
      last_torque = run.out.torque_nm;
    }
    return work;
  };
  EXPECT_NEAR(work_of(Align::Sign::either, 0.9), 0, 1e-6);
  EXPECT_NEAR(work_of(Align::Sign::same, 2.5), 0, 1e-6);
  // four sign switches at 90 + 10 degrees, each of which loses the energy down to 90 - 10 degrees
  const double past = kPi / 2 + kPi / 18, before = kPi - past;
  EXPECT_NEAR(work_of(Align::Sign::either, 2.5), -4 * 0.5 * 0.7 * (past * past - before * before), 2e-3);
}

TEST(Alignment, ThroughHalfATurnTheTorqueStaysBounded) {
  for (const Align::Sign sign : {Align::Sign::either, Align::Sign::same}) {
    Hand run({axis_link("a", {0, 0, 1}, 1, sign)});
    const double max_angle = sign == Align::Sign::either ? kPi / 2 : kPi;
    double largest = 0;
    for (int k = -1000; k <= 1000; ++k) {
      ASSERT_TRUE(is_finite(run.step(1e-3 * (k + 1000), rotation_from_vector({kPi + 1e-6 * k, 0, 0})).torque_nm));
      ASSERT_LE(norm(run.out.torque_nm), max_angle + 1e-12);
      largest = std::max(largest, norm(run.out.torque_nm));
    }
    // near 180 degrees the opposite sign of the axis applies
    EXPECT_NEAR(largest, sign == Align::Sign::same ? kPi : 0, sign == Align::Sign::same ? 1e-9 : 1.1e-3);
  }
}

TEST(Alignment, TheToolIsFreeWhileTheLinkDoesNotHold) {
  Hand run({axis_link("a", {1, 0, 0}, 1)});
  const Quat q = rotation_from_vector({0.2, 0.4, -0.3});
  for (const LinkStatus status : {LinkStatus::free, LinkStatus::released, LinkStatus::no_surface}) {
    constraint_of(run.program.links[0]).reported_status = status;
    EXPECT_EQ(run.step(0, q).torque_nm, Vec3(0.0));
    EXPECT_EQ(run.link().orientation, q);
  }
  constraint_of(run.program.links[0]).reported_status = LinkStatus::ok;
  EXPECT_GT(norm(run.step(0, q).torque_nm), 0.1);
}

TEST(Alignment, AxisEvaluationsAreCountedAndAtTheCapTheLastAxisIsKept) {
  Hand run({axis_link("a", {1, 0, 0}, 1, Align::Sign::same, {0, 0, 1}, Primitive::Kind::plane, 3)});
  EXPECT_EQ(run.step(0, kIdentityRotation).links[0].evaluations, 3);
  constraint_of(run.program.links[0]).evaluations_per_tick = kMaxEvaluations;
  EXPECT_EQ(run.step(1e-3, kIdentityRotation).links[0].evaluations, kMaxEvaluations);
  EXPECT_NEAR(norm(run.out.torque_nm), kPi / 2, 1e-12);
}

TEST(Alignment, ASwitchRampsTheTorqueInAndOut) {
  Hand run({axis_link("a", {1, 0, 0}, 1, Align::Sign::same)});
  run.program.links[0].active_when.button = 1;
  run.program.coupling.ramp_s = 0.01;
  double last = 0;
  for (int k = 0; k < 60; ++k) {
    run.step(1e-3 * k, kIdentityRotation, k >= 10 && k < 30 ? 1 : 0);
    const double now = norm(run.out.torque_nm);
    EXPECT_LE(std::fabs(now - last), kPi / 2 * 0.1 + 1e-12) << k;
    // half way up and down, at full weight, and off
    const double expected = k == 14 || k == 34 ? kPi / 2 * 0.5 : k == 25 ? kPi / 2 : k < 10 || k > 45 ? 0 : now;
    EXPECT_NEAR(now, expected, expected > 0 ? 1e-12 : 0) << k;
    last = now;
  }
}

TEST(Alignment, TheTorqueRampsOutUnderAProgramWithoutTheLink) {
  Hand run({axis_link("a", {1, 0, 0}, 1, Align::Sign::same)});
  run.program.coupling.ramp_s = 0.01;
  for (int k = 0; k < 5; ++k) run.step(1e-3 * k, kIdentityRotation);
  HapticProgram next = run.program;
  next.links.clear();
  run.replace(next);
  double last = kPi / 2;
  for (int k = 5; k < 30; ++k) {
    EXPECT_LE(last - norm(run.step(1e-3 * k, kIdentityRotation).torque_nm), kPi / 2 * 0.1 + 1e-12);
    last = norm(run.out.torque_nm);
  }
  EXPECT_EQ(last, 0);
}

TEST(Alignment, TheDevicesLimitCapsTheStiffness) {
  Hand run({axis_link("a", {1, 0, 0}, 5, Align::Sign::same)});
  run.program.limits.max_rotational_stiffness_nm_per_rad = 0.4;
  EXPECT_NEAR(norm(run.step(0, kIdentityRotation).torque_nm), 0.4 * kPi / 2, 1e-12);
}

TEST(Alignment, DampingOpposesTheRotation) {
  Hand run;
  run.program.coupling.rotational_damping_nms_per_rad = 2e-3;
  EXPECT_EQ(run.step(0, kIdentityRotation).torque_nm, Vec3(0.0));
  run.step(1e-3, rotation_from_vector({0, 0.01, 0}));
  expect_near(run.out.torque_nm, {0, -2e-3 * 0.01 / 1e-3, 0}, 1e-15);
  run.step(2e-3, rotation_from_vector({0, 0.01, 0}));
  expect_near(run.out.torque_nm, Vec3(0.0), 1e-15);
}

TEST(Alignment, ANonFiniteOrientationIsABadProbe) {
  Hand run({axis_link("a", {1, 0, 0}, 1)});
  run.step(0, rotation_from_vector({0.3, 0, 0}));
  EXPECT_EQ(run.step(1e-3, Quat(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0)).torque_nm, Vec3(0.0));
  EXPECT_EQ(run.link().torque_nm, Vec3(0.0));
  EXPECT_EQ(run.link().status, LinkStatus::bad_probe);
  run.step(2e-3, Quat(0, 0, 0, 0));  // a zero quaternion counts as no rotation
  EXPECT_TRUE(is_finite(run.out.torque_nm));
}

TEST(Alignment, AlignmentDoesNotChangeForcesAndProxies) {
  const auto hash_of = [](bool aligns, bool turns) {
    Hand run({test::hold_height("a", 1), axis_link("b", {1, 0, 0}, 1)});
    run.program.links[1].align.enabled = aligns;
    StateHash hash;
    for (int k = 0; k < 100; ++k) {
      run.step(1e-3 * k, turns ? rotation_from_vector({0.01 * k, 0.2, 0}) : kIdentityRotation, 0, {0.01 * k, 0, 0.3});
      hash.add(run.out);
      if (!aligns && run.out.torque_nm != Vec3(0.0)) return std::uint64_t{0};
    }
    return hash.value();
  };
  EXPECT_EQ(hash_of(false, false), hash_of(true, true));
  EXPECT_EQ(hash_of(false, true), hash_of(true, false));
  EXPECT_NE(hash_of(false, true), 0u);
}

TEST(Alignment, AllocatesNothingAndRepeatsToTheBit) {
  Hand a({axis_link("a", {1, 0, 2}, 1), axis_link("b", {0, 1, 0}, 1, Align::Sign::same, {1, 0, 0}, Primitive::Kind::line)});
  a.program.coupling.rotational_damping_nms_per_rad = 1e-3;
  a.step(0, kIdentityRotation);
  Hand b = a;
  for (int k = 1; k < 200; ++k) {
    const Quat q = rotation_from_vector({0.1 * k, 0.03 * k, -0.02 * k});
    const AllocationCounter guard;
    a.step(1e-3 * k, q);
    ASSERT_EQ(guard.count(), 0u);
    ASSERT_EQ(std::memcmp(&a.out.torque_nm, &b.step(1e-3 * k, q).torque_nm, sizeof(Vec3)), 0);
  }
}

}  // namespace alignment_test
