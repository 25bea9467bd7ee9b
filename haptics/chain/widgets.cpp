// SPDX-License-Identifier: MIT
#include "haptics/chain/widgets.h"

namespace catena::haptics {

namespace {

std::size_t count_of(const HapticProgram& program) noexcept {
  return std::min(program.widgets.size(), static_cast<std::size_t>(kMaxWidgets));
}

// Adds the scene links that constrain a ruler's end, as far as they are switched on.
void add_along(const widget::Spec& spec, const HapticProgram& program, const SwitchState& switches, LinkOrder& order) noexcept {
  for (const int link : spec.along_links) {
    const auto i = static_cast<std::size_t>(link);
    if (link >= 0 && i < program.scene_link_count() && switches.link_on[i] && !order.contains(i)) order.add(i);
  }
}

}  // namespace

LinkOrder engage_widgets(const HapticProgram& program, const WidgetsInput& input, const LinkOrder& scene, const SwitchState& switches,
                         std::array<LinkState, kMaxLinks>& links, WidgetsState& state) noexcept {
  const std::size_t count = count_of(program);
  if (!state.has_probe) state.last_probe = input.probe;
  state.engaged =
      static_cast<std::int8_t>(widget::step_modes({program.widgets.data(), count}, {state.widgets.data(), count},
                                                  {input.probe, state.last_probe, input.buttons, state.last_buttons, state.probe_lost}));
  state.last_probe = input.probe;
  state.last_buttons = input.buttons;
  state.has_probe = true;
  state.probe_lost = false;
  if (state.engaged < 0) return scene;

  const auto w = static_cast<std::size_t>(state.engaged);
  const widget::ChainRequest plan = widget::plan_chain(program.widgets[w], state.widgets[w], input.probe);
  LinkOrder order = scene;
  if (plan.disables_scene_links) order.count = 0, order.links = {}, order.shape_revisions = {};
  if (plan.uses_along_links) add_along(program.widgets[w], program, switches, order);
  for (int k = 0; k < plan.count; ++k) {
    const auto slot = static_cast<std::size_t>(plan.order[static_cast<std::size_t>(k)]);
    const std::size_t i = program.scene_link_count() + slot;
    if (!(links[i].shape == plan.shapes[slot])) {
      links[i].shape = plan.shapes[slot];
      links[i].started = false;
      ++state.shape_revisions[slot];
    }
    order.add(i, state.shape_revisions[slot]);
  }
  return order;
}

void move_widgets(const HapticProgram& program, const Vec3& last_proxy, WidgetsState& state) noexcept {
  if (state.engaged < 0) return;
  const auto w = static_cast<std::size_t>(state.engaged);
  widget::update_pose(program.widgets[w], state.widgets[w], last_proxy);
}

void pause_widgets(WidgetsState& state) noexcept { state.probe_lost = state.has_probe; }

void report_widgets(const HapticProgram& program, const WidgetsState& state, HapticState& out) noexcept {
  const std::size_t count = count_of(program);
  out.widget_count = static_cast<std::int32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    widget::State begun;
    if (!state.widgets[i].is_initialized) widget::reset_state(program.widgets[i], begun);
    out.widgets[i] = widget::make_report(state.widgets[i].is_initialized ? state.widgets[i] : begun);
  }
}

void rebind_widgets(const HapticProgram& from, const HapticProgram& to, WidgetsState& state) noexcept {
  const WidgetsState old = state;
  state.widgets = {};
  state.engaged = -1;
  for (std::size_t i = 0; i < count_of(to); ++i)
    for (std::size_t k = 0; k < count_of(from); ++k)
      if (from.widget_names[k] == to.widget_names[i] && from.widgets[k].kind == to.widgets[i].kind &&
          to.widgets[i].revision <= old.widgets[k].revision)
        state.widgets[i] = old.widgets[k];
}

}  // namespace catena::haptics
