/// Which links run in this tick, and in which order: switches by button or by force, and the modes of operation (section 6.2).
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/program.h"

namespace catena::haptics {

/// What the switches remember.
struct SwitchState {
  std::uint32_t buttons = 0;              ///< of the last tick
  std::array<bool, kMaxLinks> link_on{};  ///< by link
  std::array<bool, kMaxModes> mode_on{};  ///< by mode
};

/// The links that run, in order; the others pass their probe through.
struct Order {
  std::array<std::int8_t, kMaxLinks> links{};   ///< indices into Program::links
  std::array<std::uint8_t, kMaxLinks> takes{};  ///< of a widget's link: counts the shapes that it was put on; another one is another link
  std::int8_t count = 0;                        ///< how many run
  std::int8_t mode = -1;                        ///< the mode that orders them; -1: none
  bool operator==(const Order&) const = default;
  /// Puts a link behind those that are there.
  void add(std::size_t link, std::uint8_t take = 0) noexcept {
    takes[static_cast<std::size_t>(count)] = take;
    links[static_cast<std::size_t>(count++)] = static_cast<std::int8_t>(link);
  }
  /// Whether the link runs.
  bool contains(std::size_t link) const noexcept {
    for (int k = 0; k < count; ++k)
      if (links[static_cast<std::size_t>(k)] == static_cast<int>(link)) return true;
    return false;
  }
  /// The same, on this shape.
  bool contains(std::size_t link, std::uint8_t take) const noexcept {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      if (links[k] == static_cast<int>(link) && takes[k] == take) return true;
    return false;
  }
};

/// Steps all switches by the buttons now and the last tick's force; returns the order of the links that are switched on.
Order step_switches(const Program& program, std::uint32_t buttons, double last_force_n, SwitchState& state) noexcept;

/// No force jump where links are switched, reordered or replaced: what the step would have been is added and fades to zero,
/// linearly, over the coupling's ramp.
///   at a change:  fade_n = (shares before) - (shares after), of the links that the change moves;  F = sum of shares + fade_n f
/// A link that is switched on needs none: its own weight rises from 0. Haptic thread: no allocation, lock or throw.
struct Fade {
  std::array<Vec3, kMaxLinks> shares{};  ///< of the last tick, newtons
  Order order;                           ///< of the last tick
  Vec3 force_n{0.0};                     ///< fade_n
  double left = 0;                       ///< f, 1..0
  bool replaced = false;                 ///< another program has taken over since
};

/// Steps the fade by `ramp_step` (dt / ramp_s, 1: at once) and books what this tick changes. Returns the force to add.
Vec3 step_fade(Fade& fade, const Order& order, const std::array<Vec3, kMaxLinks>& shares, double ramp_step) noexcept;

}  // namespace catena::haptics
