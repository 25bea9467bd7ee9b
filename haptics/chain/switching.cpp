#include "haptics/chain/switching.h"

namespace catena::haptics {

namespace {

bool step(const Switch& on, bool was, std::uint32_t before, std::uint32_t now, double force_n) noexcept {
  if (on.never) return false;
  if (on.button > 0) {
    const std::uint32_t bit = 1u << (on.button - 1);
    if (!on.toggle) return (now & bit) != 0;
    return (now & ~before & bit) != 0 ? !was : was;
  }
  if (on.force_above_n > 0) return was ? force_n > on.force_below_n : force_n > on.force_above_n;
  return true;
}

}  // namespace

Order step_switches(const Program& program, std::uint32_t buttons, double last_force_n, SwitchState& state) noexcept {
  for (std::size_t i = 0; i < program.scene_links(); ++i)
    state.link_on[i] = step(program.links[i].on, state.link_on[i], state.buttons, buttons, last_force_n);
  Order order;
  for (std::size_t m = 0; m < program.modes.size(); ++m) {
    state.mode_on[m] = step(program.modes[m].on, state.mode_on[m], state.buttons, buttons, last_force_n);
    if (state.mode_on[m] && order.mode < 0) order.mode = static_cast<std::int8_t>(m);
  }
  state.buttons = buttons;

  const auto add = [&](std::size_t link) {
    if (state.link_on[link]) order.add(link);
  };
  if (order.mode < 0) {
    for (std::size_t i = 0; i < program.scene_links(); ++i) add(i);
  } else {
    for (const int i : program.modes[static_cast<std::size_t>(order.mode)].links) add(static_cast<std::size_t>(i));
  }
  return order;
}

namespace {

/// The force step that a change of the order makes. Links before the first change keep their probe, so theirs are not counted;
/// neither is a link that has just been switched on, or put on another shape.
Vec3 step_of(const Fade& fade, const Order& order, const std::array<Vec3, kMaxLinks>& shares) noexcept {
  Vec3 step(0.0);
  if (fade.replaced) {
    for (std::size_t i = 0; i < kMaxLinks; ++i) step += fade.shares[i] - shares[i];
    return step;
  }
  int same = 0;
  while (same < order.count && same < fade.order.count &&
         order.links[static_cast<std::size_t>(same)] == fade.order.links[static_cast<std::size_t>(same)] &&
         order.takes[static_cast<std::size_t>(same)] == fade.order.takes[static_cast<std::size_t>(same)])
    ++same;
  for (int k = same; k < fade.order.count; ++k)
    step += fade.shares[static_cast<std::size_t>(fade.order.links[static_cast<std::size_t>(k)])];
  for (int k = same; k < order.count; ++k) {
    const auto link = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
    if (fade.order.contains(link, order.takes[static_cast<std::size_t>(k)])) step -= shares[link];
  }
  return step;
}

}  // namespace

Vec3 step_fade(Fade& fade, const Order& order, const std::array<Vec3, kMaxLinks>& shares, double ramp_step) noexcept {
  fade.left = fade.left > ramp_step ? fade.left - ramp_step : 0;
  if ((fade.replaced || !(order == fade.order)) && ramp_step < 1) {
    const Vec3 step = step_of(fade, order, shares);
    fade.force_n = fade.force_n * fade.left + step;
    fade.left = 1 - ramp_step;
    if (!is_finite(fade.force_n)) fade.left = 0;
  }
  fade.order = order;
  fade.shares = shares;
  fade.replaced = false;
  return fade.left > 0 ? fade.force_n * fade.left : Vec3(0.0);
}

}  // namespace catena::haptics
