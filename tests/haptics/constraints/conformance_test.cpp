// SPDX-License-Identifier: MIT
// Requirements of every constraint: finite output, rest when the probe rests, bounded evaluations, no allocation, bit-identical
// output for the same input. Fails for a registered type without examples.
#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests::conformance_test {

TEST(ConformanceTable, EveryRegisteredTypeHasExamples) {
  const auto table = examples();
  for (const ConstraintType& type : constraint_types()) EXPECT_TRUE(table.contains(std::string(type.type))) << type.type;
}

/// A hand's path with rests and pushes, then jumps, singular points, and positions far outside.
const std::vector<Vec3>& probes() {
  static const std::vector<Vec3> list = [] {
    std::vector<Vec3> out;
    Random random(21);
    Vec3 p(0.6, 0.2, 0.1), v = random.unit() * 0.004;
    for (int i = 0; i < 600; ++i) {
      v = direction(v + random.unit() * 0.001) * (i % 100 < 50 ? 0.004 : 0.03);
      p = norm(p + v) > 1.9 ? p * 0.9 : p + v;
      out.push_back(p);
      if (i % 50 == 49) out.insert(out.end(), 3, p);
    }
    for (int i = 0; i < 200; ++i) out.push_back(random.box(2.5));
    const double huge = 1e6;
    for (const Vec3& q : {Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-0.0, 0.0, -0.0), Vec3(2, 2, 2), Vec3(-2, -2, -2), Vec3(huge, 0, 0),
                          Vec3(-huge, huge, huge), Vec3(0.0), Vec3(1e-300, 0, 0), Vec3(1e-12, 1e-12, 0), Vec3(1e150, -1e150, 1),
                          Vec3(1e300, 1e300, 1e300), Vec3(0.5, 0.5, 0.5), Vec3(huge, 1, 1), Vec3(0.3, 0.3, 0.3)})
      out.insert(out.end(), 2, q);
    return out;
  }();
  return list;
}

class Conformance : public testing::TestWithParam<Example> {
 protected:
  void SetUp() override {
    constraint_ = build_example(GetParam().type, GetParam().body);
    ASSERT_NE(constraint_, nullptr);
  }
  ConstraintPtr constraint_;
};

TEST_P(Conformance, IsFiniteBoundedAndAllocatesNothing) {
  Rig rig(constraint_);
  const auto& path = probes();
  AllocationCounter guard;
  for (std::size_t i = 0; i < path.size(); ++i) {
    rig.tick(path[i]);
    const LinkState& s = rig.state;
    ASSERT_TRUE(is_finite(s.proxy)) << "tick " << i;
    ASSERT_TRUE(std::isfinite(s.residual)) << "tick " << i;
    ASSERT_GE(s.evaluations, 0);
    ASSERT_LE(s.evaluations, kMaxEvaluations) << "tick " << i;
    ASSERT_LE(s.work(), kMaxWork) << "tick " << i;
    const bool passes =
        s.released || s.status == LinkStatus::free || s.status == LinkStatus::released || s.status == LinkStatus::no_surface;
    ASSERT_TRUE(!passes || bitwise_equal(s.proxy, path[i])) << "tick " << i;
    ASSERT_EQ(s.released, s.status == LinkStatus::released) << "tick " << i;
    ASSERT_NE(s.status, LinkStatus::bad_probe);
    ASSERT_TRUE(constraint_->is_sane(s)) << "tick " << i;
  }
  EXPECT_EQ(guard.count(), 0u);
}

// the probe jumps to a random position in every tick, as after a device's return or a change of mode
TEST_P(Conformance, WorkIsBoundedUnderTeleports) {
  Rig rig(constraint_);
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const double half = i % 3 == 0 ? 0.3 : i % 3 == 1 ? 2 : 6;
    ASSERT_LE(rig.tick(random.box(half)).work(), kMaxWork) << "tick " << i;
    ASSERT_LE(rig.state.evaluations, kMaxEvaluations) << "tick " << i;
  }
}

// released from any held feature and state
TEST_P(Conformance, ReleasesWhenTheHandLeaves) {
  if (GetParam().body.find("\"release\"") == std::string::npos) return;  // never releases
  Random random(32);
  for (int run = 0; run < 20; ++run) {
    Rig rig(constraint_);
    Vec3 probe = random.box(1), step = random.unit() * 0.01;
    for (int i = 0; i < 200; ++i) rig.tick(probe = probe + (step = direction(step + random.unit() * 0.005) * 0.01));
    // moves away at a hand's speed, to far outside of all features
    const Vec3 away = direction(probe) * 0.05;
    for (int i = 0; i < 400; ++i) rig.tick(probe = probe + away);
    for (int i = 0; i < 60 && rig.state.status == LinkStatus::budget; ++i) rig.tick(probe);
    // a formula may have a surface at the end of the path
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, probe) || norm(rig.state.proxy - probe) < 0.5)
        << "run " << run << " " << static_cast<int>(rig.state.status);
  }
}

TEST_P(Conformance, RestsWhenTheProbeRests) {
  // Eqs. 1-2 as printed (method "linear") never come to rest; they are the baseline
  if (GetParam().body.find("\"linear\"") != std::string::npos) return;
  Rig rig(constraint_);
  const auto& path = probes();
  for (std::size_t i = 0; i < path.size(); i += 23) {
    // the ticks of a walk over budget, one tick for a release, then nothing moves
    rig.tick(path[i]);
    rig.tick(path[i]);
    for (int k = 0; k < 20 && (rig.state.status == LinkStatus::budget || rig.state.released); ++k) rig.tick(path[i]);
    if (rig.state.status == LinkStatus::budget) continue;  // a walk of length 1e300 does not arrive
    const Vec3 rest = rig.state.proxy;
    const LinkStatus status = rig.state.status;
    for (int k = 0; k < 5; ++k) {
      ASSERT_TRUE(bitwise_equal(rig.tick(path[i]).proxy, rest)) << "probe " << i << " status " << to_string(status);
      ASSERT_EQ(rig.state.status, status) << "probe " << i;
    }
  }
}

TEST_P(Conformance, IsRepeatableBitForBit) {
  Rig first(constraint_), second(constraint_), fresh_scratch(constraint_), used_scratch(constraint_);
  for (const Vec3& probe : probes()) used_scratch.tick(probe);
  used_scratch.state = LinkState{};
  for (const Vec3& probe : probes()) {
    first.tick(probe);
    second.tick(probe);
    fresh_scratch.scratch = LinkScratch{};
    fresh_scratch.tick(probe);
    used_scratch.tick(probe);
    for (const Rig* other : {&second, &fresh_scratch, &used_scratch}) {
      ASSERT_TRUE(bitwise_equal(first.state.proxy, other->state.proxy));
      ASSERT_EQ(first.state.status, other->state.status);
      ASSERT_EQ(first.state.released, other->state.released);
      ASSERT_EQ(first.state.evaluations, other->state.evaluations);
      ASSERT_EQ(std::memcmp(&first.state.residual, &other->state.residual, sizeof(double)), 0);
    }
  }
}

/// Returns false for types whose proxy depends on its past, so that it has no derivative, for the baseline that never rests (Eqs. 1-2 as
/// printed), and for a segment so long that differences are rounding.
bool is_projection(const Example& example) {
  if (example.body.find("\"linear\"") != std::string::npos || example.body.find("1e300") != std::string::npos) return false;
  for (const char* type : {"friction", "modulated_friction", "texture", "drag", "viscosity", "gradient_force"})
    if (example.type == type) return false;
  return true;
}

// virtual work: the force on the probe is J^T f, J by differences of the proxy of a resting link
TEST_P(Conformance, ThePulledBackForceIsTheTransposeOfTheProxysDerivative) {
  if (!is_projection(GetParam())) return;
  constexpr double kStep = 1e-6;
  Rig rig(constraint_);
  Random random(33);
  std::vector<double> errors;
  for (std::size_t i = 0; i < 600; i += 7) {
    for (int k = 0; k < 3; ++k) rig.tick(probes()[i]);
    if (rig.state.status != LinkStatus::ok || rig.state.released) continue;
    const auto proxy_after = [&](const Vec3& move) {
      Rig moved = rig;
      return moved.tick(probes()[i] + move).proxy;
    };
    const Vec3 f = random.unit();
    Vec3 expected(0.0), at_half_step(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 e(0.0);
      e[axis] = kStep;
      expected[axis] = dot(f, proxy_after(e) - proxy_after(-e)) / (2 * kStep);
      at_half_step[axis] = dot(f, proxy_after(0.5 * e) - proxy_after(-0.5 * e)) / kStep;
    }
    if (norm(expected - at_half_step) > 1e-4) continue;  // a corner or an edge
    Rig copy = rig;
    const PulledBackForce pulled = constraint_->pull_back(probes()[i], f, copy.state, copy.scratch);
    errors.push_back(norm(pulled.force + pulled.truncated - expected));
  }
  // a proxy in a rough field may still move slowly; without pull_back the median is about 0.5
  EXPECT_LT(errors.empty() ? 0 : quantile(errors, 0.5), 5e-3);
}

INSTANTIATE_TEST_SUITE_P(All, Conformance, testing::ValuesIn(all_examples()),
                         [](const auto& test) { return test.param.type + "_" + std::to_string(test.index); });

}  // namespace catena::haptics::tests::conformance_test
