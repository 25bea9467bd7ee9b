// SPDX-License-Identifier: MIT
/// A probe that drives widgets in the tick.
#pragma once
#include <gtest/gtest.h>

#include "haptics/constraints/widget_link.h"
#include "tests/haptics/chain/chain_driver.h"

namespace catena::test {

inline widget::Spec make_widget_spec(widget::Kind kind, const Vec3& a = Vec3(0.0), const Vec3& b = Vec3(0.0)) {
  widget::Spec spec;
  spec.kind = kind;
  spec.pose.points = {a, b};
  const bool plane = kind == widget::Kind::cutting_plane;
  spec.radius = plane ? 0.48 : 0.048;
  spec.snap = 0.08;
  spec.release = 0.2;
  spec.grab_distance = plane ? 0.08 : 0.12;
  spec.step = 0.08;
  return spec;
}

inline haptics::HapticProgram make_widget_program(std::vector<widget::Spec> specs, std::vector<haptics::Link> links = {},
                                                  double ramp_s = 0) {
  haptics::HapticProgram program;
  program.links = std::move(links);
  program.coupling.ramp_s = ramp_s;
  program.coupling.max_force_n = 500;
  for (std::size_t i = 0; i < specs.size(); ++i) program.widget_names.push_back("w" + std::to_string(i));
  program.widgets = std::move(specs);
  haptics::add_widget_links(program);
  return program;
}

struct WidgetProbe : ChainDriver {
  Vec3 position{0.0};

  using ChainDriver::ChainDriver;
  explicit WidgetProbe(std::vector<widget::Spec> specs) : ChainDriver(make_widget_program(std::move(specs))) {}

  const WidgetReport& step(const Vec3& probe, std::uint32_t buttons = 0, double dt = 1e-3) {
    position = probe;
    ChainDriver::step(probe, buttons, dt);
    return out.widgets[0];
  }
  /// Presses button 1 at a place.
  const WidgetReport& grab(const Vec3& at) {
    step(at);
    return step(at, 1);
  }
  /// A tick, and then the first widget's mode and the active links.
  void expect(const Vec3& probe, std::uint32_t buttons, const std::string& mode, const std::string& order) {
    step(probe, buttons);
    EXPECT_EQ(mode_name(), mode);
    EXPECT_EQ(link_order(), order);
  }
  /// Moves in `n` steps from the current position.
  const WidgetReport& move_to(const Vec3& to, std::uint32_t buttons = 0, int n = 50) {
    const Vec3 from = position;
    for (int k = 1; k <= n; ++k) step(k == n ? to : from + (to - from) * (static_cast<double>(k) / n), buttons);
    return out.widgets[0];
  }
  const WidgetReport& report(std::size_t i = 0) const { return out.widgets[i]; }
  const Vec3& widget_position(std::size_t i = 0) const { return out.widgets[i].pose.points[0]; }
  std::string mode_name(std::size_t i = 0) const { return to_string(out.widgets[i].mode); }
  /// Names of the active links, in order.
  std::string link_order() const {
    std::string names;
    for (int k = 0; k < state.order.count; ++k)
      names += (k > 0 ? " " : "") + program.links[static_cast<std::size_t>(state.order.links[static_cast<std::size_t>(k)])].name;
    return names;
  }
};

/// Rotation of the tilted frame of most tests.
inline const Quat kTilted = normalized(Quat(0.8, 0.3, -0.4, 0.35));

inline double distance_between(const Vec3& a, const Vec3& b) { return norm(a - b); }

}  // namespace catena::test
