// SPDX-License-Identifier: MIT
/// Checks of plain data that comes from a file, and the hash of the ticks' results.
/// Reading a bool or an enumerator that has none of its values is undefined behavior, so the checks inspect the bytes. Off the tick.
#pragma once
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "engine/base/haptic_state.h"
#include "engine/base/hash.h"

namespace catena::haptics {

/// Returns whether every flag has the byte 0 or 1.
template <class... Flags>
bool are_valid_bools(const Flags&... flags) noexcept {
  static_assert((std::is_same_v<Flags, bool> && ...));
  const auto is_one = [](const bool& flag) {
    unsigned char byte;
    std::memcpy(&byte, &flag, 1);
    return byte <= 1;
  };
  return (is_one(flags) && ...);
}

/// Returns whether every element of an array has the byte 0 or 1.
template <std::size_t n>
bool are_valid_bools(const std::array<bool, n>& flags) noexcept {
  for (std::size_t i = 0; i < n; ++i)
    if (!are_valid_bools(flags.data()[i])) return false;
  return true;
}

/// Returns whether the value is one of the enumerators from 0 to `last`.
template <class Enum>
bool is_valid_enum(const Enum& word, Enum last) noexcept {
  std::underlying_type_t<Enum> value;
  std::memcpy(&value, &word, sizeof value);
  return value >= 0 && value <= static_cast<std::underlying_type_t<Enum>>(last);
}

/// Computes `state_hash`: FNV-1a-64 over the bytes of proxies, force, active and status of every tick (no timings), and of the points,
/// orientation, value, mode, handle and active_planes of every widget. Equal hashes mean bit-identical behavior.
class StateHash {
 public:
  /// Adds the result of one tick.
  void add(const HapticState& state) noexcept {
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
      const WidgetReport& w = state.widgets[static_cast<std::size_t>(i)];
      for (const Vec3& point : w.pose.points) vector(point);
      for (const double v : {w.pose.orientation.w, w.pose.orientation.x, w.pose.orientation.y, w.pose.orientation.z, w.value}) fnv_.add(v);
      for (const int v : {static_cast<int>(w.mode), static_cast<int>(w.handle), static_cast<int>(w.active_planes)})
        fnv_.add(static_cast<std::uint8_t>(v));
    }
  }
  /// Returns the hash of the ticks so far.
  std::uint64_t value() const noexcept { return fnv_.value; }

 private:
  Fnv1a fnv_;
};

}  // namespace catena::haptics
