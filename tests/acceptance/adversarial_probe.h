// SPDX-License-Identifier: MIT
/// A hostile hand: jumps, rests, 1e300, denormals, non-finite probes, random buttons, clocks that stop or run backwards.
#pragma once
#include <limits>

#include "haptics/chain/tick.h"
#include "tests/acceptance/chain_fixture.h"

namespace catena::acceptance {

class AdversarialProbe {
 public:
  explicit AdversarialProbe(std::uint64_t seed) : random_(seed) {}
  haptics::ProbeSample next() {
    if (ticks_left_-- <= 0) {
      behavior_ = static_cast<int>(random_.uniform(0, 9));
      ticks_left_ = static_cast<int>(random_.uniform(1, behavior_ < 4 ? 120 : 25));
    }
    Vec3 p = position_;
    const double inf = std::numeric_limits<double>::infinity();
    static constexpr double odd[] = {0.0, -0.0, 5e-324, -1e-310, 1e-300, 0.5,   1.0,    -2.0,
                                     2.0, 1e6,  -1e9,   1e154,   -1e160, 1e300, -1e300, 1.7e308};
    const auto from_odd = [&] { return odd[static_cast<std::size_t>(random_.uniform(0, 16))]; };
    switch (behavior_) {
      case 0:  // a smooth motion
      case 1:
        velocity_ = velocity_ * 0.95 + random_.box(2e-4);
        p = norm(position_ + velocity_) < 2.2 ? position_ + velocity_ : Vec3(0.3, 0.2, 0.1);
        break;
      case 2:  // a trembling motion
        p = position_ + random_.box(1e-9);
        break;
      case 3:  // at rest
        break;
      case 4:  // jumps
        p = random_.box(2.5);
        break;
      case 5:  // extreme numbers
        p = {from_odd(), from_odd(), from_odd()};
        break;
      case 6:  // far away
        p = random_.unit() * (random_.uniform(0, 1) < 0.5 ? 1e3 : 1e280);
        break;
      case 7:  // pushes on one axis
        p = position_ + Vec3(0, 0, random_.uniform(-0.05, 0.05));
        break;
      default:  // not finite
        p = {random_.uniform(0, 1) < 0.5 ? inf : position_.x, random_.uniform(0, 1) < 0.5 ? -inf : position_.y,
             std::numeric_limits<double>::quiet_NaN()};
    }
    if (is_finite(p)) position_ = norm(p) < 10 ? p : Vec3(0.4, -0.3, 0.2);
    if (random_.uniform(0, 1) < 0.01) buttons_ = static_cast<std::uint32_t>(random_.engine());
    const double clock = random_.uniform(0, 1);
    t_s_ = clock < 0.97    ? t_s_ + 1e-3
           : clock < 0.98  ? t_s_
           : clock < 0.99  ? t_s_ - random_.uniform(0, 3)
           : clock < 0.995 ? t_s_ + 1e-320
                           : t_s_ + 1e6;
    const bool broken_clock = random_.uniform(0, 1) < 1e-3;
    return {broken_clock ? -inf : t_s_, p, buttons_};
  }

 private:
  haptics::tests::Random random_;
  Vec3 position_{0.3, 0.2, 0.1}, velocity_{0.0};
  int behavior_ = 0, ticks_left_ = 0;
  std::uint32_t buttons_ = 0;
  double t_s_ = 0;
};

/// Checks the invariants after a tick: the first violated one, or null.
inline const char* find_violation(const HapticProgram& program, const haptics::ProbeSample& probe, const HapticState& out) {
  const bool bad = !is_finite(probe.position) || !std::isfinite(probe.t_s);
  if (!is_finite(out.force_n)) return "force";
  if (!(norm(out.force_n) <= program.coupling.max_force_n * (1 + 1e-12))) return "force above its limit";
  if (bad && max_abs(out.force_n) != 0) return "force of a bad probe";
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkReport& link = out.links[i];
    if (!is_finite(link.proxy)) return "proxy";
    if (std::isnan(link.gap) || std::isnan(link.force_n.x) || std::isnan(link.force_n.y) || std::isnan(link.force_n.z)) return "share";
    if (!(link.residual >= 0) || !std::isfinite(link.residual)) return "residual";
    if (!(link.weight >= 0 && link.weight <= 1)) return "weight";
    if (link.evaluations < 0 || link.evaluations > haptics::kMaxEvaluations) return "evaluations";
    if (bad != (link.status == LinkStatus::bad_probe)) return "status";
  }
  return nullptr;
}

}  // namespace catena::acceptance
