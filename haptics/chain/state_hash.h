/// `state_hash`: FNV-1a-64 over the bytes of proxies, force, active, status of every tick (no timings), and where there are widgets of
/// their points, orientation, value, mode, handle and held. Equal hashes mean
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
    for (int i = 0; i < state.widget_count; ++i) {
      const exchange::WidgetReport& w = state.widgets[static_cast<std::size_t>(i)];
      for (const Vec3& point : w.pose.points) vector(point);
      for (const double v : {w.pose.orientation.w, w.pose.orientation.x, w.pose.orientation.y, w.pose.orientation.z, w.value}) fnv_.add(v);
      for (const int v : {static_cast<int>(w.mode), static_cast<int>(w.handle), static_cast<int>(w.held)})
        fnv_.add(static_cast<std::uint8_t>(v));
    }
  }
  std::uint64_t value() const noexcept { return fnv_.value; }

 private:
  Fnv1a fnv_;
};

}  // namespace catena::haptics
