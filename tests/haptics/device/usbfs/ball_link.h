// SPDX-License-Identifier: MIT
/// The ball of servo_fixture.h as a minimal constraint, so that the thread sanitizer's program needs no scene.
#pragma once
#include "haptics/chain/program.h"

namespace catena::haptics::tests {

class OneSidedBall final : public Constraint {
 public:
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override { advance(probe, state, scratch); }
  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    const bool inside = norm(probe) < 0.5;
    state.proxy = inside ? direction(probe) * 0.5 : probe;
    state.evaluations += 1;
    state.status = inside ? LinkStatus::ok : LinkStatus::free;
  }
};

inline std::shared_ptr<const HapticProgram> ball_link_program() {
  auto program = std::make_shared<HapticProgram>();
  Link link;
  link.name = "ball";
  link.constraint = std::make_shared<OneSidedBall>();
  link.stiffness_n_per_m = 400;
  program->links.push_back(std::move(link));
  program->meters_per_unit = 0.04;
  program->workspace_origin = {0, 0, -3};
  return program;
}

}  // namespace catena::haptics::tests
