// SPDX-License-Identifier: MIT
/// A link with only an axis, for closed-form tests of the rotational chain.
#pragma once
#include <memory>
#include <string>

#include "haptics/chain/program.h"

namespace catena::test {

/// Holds the proxy at the probe, with an axis; each query of the axis costs `cost` evaluations.
class AxisConstraint final : public haptics::Constraint {
 public:
  AxisConstraint(const Vec3& axis, haptics::Primitive::Kind kind, int cost = 0) : axis_(direction(axis)), kind_(kind), cost_(cost) {}
  void start(const Vec3&, haptics::LinkState&, haptics::LinkScratch&) const noexcept override {}
  void advance(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override {
    state.proxy = probe;
    state.status = reported_status;
    state.evaluations += evaluations_per_tick;
  }
  bool primitive(const Vec3& at, haptics::LinkState& state, haptics::LinkScratch&, haptics::Primitive& out) const noexcept override {
    state.evaluations += cost_;
    state.status = catena::LinkStatus::critical;  // must not reach the link
    out = {kind_, at, axis_};
    return true;
  }
  bool has_primitive() const noexcept override { return true; }
  mutable catena::LinkStatus reported_status = catena::LinkStatus::ok;
  mutable int evaluations_per_tick = 0;

 private:
  Vec3 axis_;
  haptics::Primitive::Kind kind_;
  int cost_;
};

inline haptics::Link axis_link(const std::string& name, const Vec3& axis, double kappa,
                               haptics::Align::Sign sign = haptics::Align::Sign::either, const Vec3& tool = {0, 0, 1},
                               haptics::Primitive::Kind kind = haptics::Primitive::Kind::plane, int cost = 0) {
  haptics::Link link;
  link.name = name;
  link.constraint = std::make_shared<AxisConstraint>(axis, kind, cost);
  link.align = {true, direction(tool), kappa, sign};
  return link;
}

}  // namespace catena::test
