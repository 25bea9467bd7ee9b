/// `state_hash`: FNV-1a-64 over the bytes of proxies, force, active, status of every tick (no timings). Equal hashes mean
/// equal behaviour to the bit.
#pragma once
#include "engine/base/hash.h"
#include "engine/exchange/haptic_state.h"

namespace catena::haptics {

class StateHash {
 public:
  void add(const exchange::HapticState& state) noexcept {
    const auto vector = [&](const Vec3& v) {
      fnv_.add(v.x);
      fnv_.add(v.y);
      fnv_.add(v.z);
    };
    for (int i = 0; i < state.link_count; ++i) vector(state.links[static_cast<std::size_t>(i)].proxy);
    vector(state.force_n);
    for (int i = 0; i < state.link_count; ++i) fnv_.add(static_cast<std::uint8_t>(state.links[static_cast<std::size_t>(i)].active));
    for (int i = 0; i < state.link_count; ++i) fnv_.add(static_cast<std::uint8_t>(state.links[static_cast<std::size_t>(i)].status));
  }
  std::uint64_t value() const noexcept { return fnv_.value; }

 private:
  Fnv1a fnv_;
};

}  // namespace catena::haptics
