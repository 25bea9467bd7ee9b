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
struct LinkOrder {
  std::array<std::int8_t, kMaxLinks> links{};  ///< indices into HapticProgram::links
  std::array<std::uint8_t, kMaxLinks>
      shape_revisions{};  ///< of a widget's link: counts the shapes that it was put on; another one is another link
  std::int8_t count = 0;  ///< how many run
  std::int8_t mode = -1;  ///< the mode that orders them; -1: none
  bool operator==(const LinkOrder&) const = default;
  /// Puts a link behind those that are there.
  void add(std::size_t link, std::uint8_t take = 0) noexcept {
    shape_revisions[static_cast<std::size_t>(count)] = take;
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
      if (links[k] == static_cast<int>(link) && shape_revisions[k] == take) return true;
    return false;
  }
};

/// Steps all switches by the buttons now and the last tick's force; returns the order of the links that are switched on.
LinkOrder step_switches(const HapticProgram& program, std::uint32_t buttons, double last_force_n, SwitchState& state) noexcept;

}  // namespace catena::haptics
