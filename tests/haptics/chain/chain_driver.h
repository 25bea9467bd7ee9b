// SPDX-License-Identifier: MIT
/// Drives a program tick by tick.
#pragma once
#include <gtest/gtest.h>

#include "haptics/chain/tick.h"

namespace catena::test {

struct ChainDriver {
  haptics::HapticProgram program;
  haptics::ChainState state;
  haptics::ChainScratch scratch;
  HapticState out;
  double t = 0;  ///< of the last tick

  explicit ChainDriver(haptics::HapticProgram p) : program(std::move(p)) {}
  explicit ChainDriver(std::vector<haptics::Link> links = {}, double max_force_n = 1e9) {
    program.links = std::move(links);
    program.coupling.max_force_n = max_force_n;
  }
  /// Adds a link, named "a", "b", ... in order.
  haptics::Link& add(std::shared_ptr<const haptics::Constraint> constraint, double stiffness = 500) {
    haptics::Link& link = program.links.emplace_back();
    link.name = std::string(1, static_cast<char>('a' + program.links.size() - 1));
    link.constraint = std::move(constraint);
    link.stiffness_n_per_m = stiffness;
    return link;
  }
  /// A tick at a time.
  const HapticState& at(double time, const Vec3& probe, std::uint32_t buttons = 0, const Quat& orientation = kIdentityRotation,
                        TickCondition condition = TickCondition::normal) {
    haptics::tick(program, {t = time, probe, buttons, orientation, condition}, state, scratch, out);
    return out;
  }
  /// A tick `dt` after the last one; returns the force.
  const Vec3& step(const Vec3& probe, std::uint32_t buttons = 0, double dt = 1e-3) { return at(t + dt, probe, buttons).force_n; }
  const LinkReport& link(std::size_t i = 0) const { return out.links[i]; }
  void replace(const haptics::HapticProgram& next) {
    haptics::rebind_program(program, next, state, scratch);
    program = next;
  }
};

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

}  // namespace catena::test
