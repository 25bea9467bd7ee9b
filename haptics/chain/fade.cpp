#include "haptics/chain/fade.h"

namespace catena::haptics {

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
