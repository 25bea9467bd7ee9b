// SPDX-License-Identifier: MIT
/// Minimal constraints, for tests of the chain, the tick and the servo.
#pragma once
#include <memory>
#include <string>

#include "haptics/chain/program.h"

namespace catena::test {

/// Holds the proxy on the plane z = height.
class HoldHeight final : public haptics::Constraint {
 public:
  explicit HoldHeight(double height) : height_(height) {}
  void start(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override {
    state.proxy = {probe.x, probe.y, height_};
  }
  void advance(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override {
    state.proxy = {probe.x, probe.y, height_};
    state.evaluations += 1;
    state.status = catena::LinkStatus::ok;
  }

 private:
  double height_;
};

inline haptics::Link hold_height(const std::string& name, double height, double stiffness = 500) {
  haptics::Link link;
  link.name = name;
  link.constraint = std::make_shared<HoldHeight>(height);
  link.stiffness_n_per_m = stiffness;
  return link;
}

}  // namespace catena::test
