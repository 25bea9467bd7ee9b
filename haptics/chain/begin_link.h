// SPDX-License-Identifier: MIT
/// Initialization of a link that has just been switched on. Haptic thread: no allocation, lock, throw.
#pragma once
#include "haptics/chain/program.h"

namespace catena::haptics {

/// Resets the state of a link to its initial values, with the proxy at the incoming probe, and calls the constraint's `start`. The weight
/// starts at 0, or at 1 in the first tick of the chain.
inline void begin_link(const Link& spec, const Vec3& incoming, bool first_tick, LinkState& link, LinkScratch& scratch) noexcept {
  link.switched_on = true;
  link.started = true;
  link.released = false;
  link.status = LinkStatus::ok;
  link.weight = first_tick ? 1 : 0;
  link.limit = 0;
  link.proxy = incoming;
  link.memory.fill(std::byte{0});
  link.wrapper_memory.fill(std::byte{0});
  link.stiffness_n_per_m = spec.stiffness_n_per_m.at(incoming, scratch.stiffness_cursor, link.evaluations);
  spec.constraint->start(incoming, link, scratch);
}

}  // namespace catena::haptics
