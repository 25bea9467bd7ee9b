// SPDX-License-Identifier: MIT
#include "haptics/chain/switching.h"

namespace catena::haptics {

namespace {

bool step(const ActivationSwitch& on, bool was, std::uint32_t before, std::uint32_t now, double force_n) noexcept {
  if (on.disabled) return false;
  if (on.button > 0) {
    const std::uint32_t bit = 1u << (on.button - 1);
    if (!on.toggle) return (now & bit) != 0;
    return (now & ~before & bit) != 0 ? !was : was;
  }
  if (on.force_above_n > 0) return was ? force_n > on.force_below_n : force_n > on.force_above_n;
  return true;
}

}  // namespace

LinkOrder step_switches(const HapticProgram& program, std::uint32_t buttons, double last_force_n, SwitchState& state) noexcept {
  for (std::size_t i = 0; i < program.scene_link_count(); ++i)
    state.link_on[i] = step(program.links[i].active_when, state.link_on[i], state.buttons, buttons, last_force_n);
  LinkOrder order;
  for (std::size_t m = 0; m < program.modes.size(); ++m) {
    state.mode_on[m] = step(program.modes[m].active_when, state.mode_on[m], state.buttons, buttons, last_force_n);
    if (state.mode_on[m] && order.mode < 0) order.mode = static_cast<std::int8_t>(m);
  }
  state.buttons = buttons;

  const auto add = [&](std::size_t link) {
    if (state.link_on[link]) order.add(link);
  };
  if (order.mode < 0) {
    for (std::size_t i = 0; i < program.scene_link_count(); ++i) add(i);
  } else {
    for (const int i : program.modes[static_cast<std::size_t>(order.mode)].links) add(static_cast<std::size_t>(i));
  }
  return order;
}

}  // namespace catena::haptics
