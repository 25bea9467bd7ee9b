// SPDX-License-Identifier: MIT
/// Links whose order matters: projections on planes that are not perpendicular to each other.
#pragma once
#include <gtest/gtest.h>

#include "tests/haptics/chain/chain_driver.h"

namespace catena::test {

class HoldPlane final : public haptics::Constraint {
 public:
  HoldPlane(const Vec3& normal, double height) : normal_(direction(normal)), height_(height) {}
  void start(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch& scratch) const noexcept override {
    advance(probe, state, scratch);
  }
  void advance(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override {
    state.proxy = probe - normal_ * (dot(normal_, probe) - height_);
    state.status = catena::LinkStatus::ok;
    state.limit = 0.4;
  }

 private:
  Vec3 normal_;
  double height_;
};

inline haptics::Link hold_plane(const std::string& name, const Vec3& normal, double height, double stiffness = 100) {
  haptics::Link link;
  link.name = name;
  link.constraint = std::make_shared<HoldPlane>(normal, height);
  link.stiffness_n_per_m = stiffness;
  return link;
}

/// Four planes; buttons 1 and 2 switch two of them, buttons 3 and 4 select modes with other orders of the links.
inline haptics::HapticProgram make_order_program(double ramp_s) {
  haptics::HapticProgram program;
  program.links = {hold_plane("a", {1, 0.2, 0}, 0.1), hold_plane("b", {0.3, 1, 0.1}, -0.2, 150), hold_plane("c", {0.2, 0.5, 1}, 0.3, 80),
                   hold_plane("d", {-0.4, 0.1, 1}, 0.15, 120)};
  program.links[1].active_when.button = 1;
  program.links[3].active_when.button = 2;
  program.modes = {{"turned", {3, 2, 1, 0}, {.button = 3}}, {"few", {2, 0}, {.button = 4}}};
  program.coupling.ramp_s = ramp_s;
  program.coupling.max_force_n = 1e9;
  return program;
}

}  // namespace catena::test
