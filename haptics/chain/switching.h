// SPDX-License-Identifier: MIT
/// Selects the links that run in a tick and their order: switches by button or by force, and the modes of operation (paper, section 6.2).
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// State of all switches between ticks.
struct SwitchState {
  std::uint32_t buttons = 0;              ///< buttons of the last tick; bit n - 1: button n is down
  std::array<bool, kMaxLinks> link_on{};  ///< state of each link's switch
  std::array<bool, kMaxModes> mode_on{};  ///< state of each mode's switch
};

/// Links that run in a tick, in order. The proxy of every other link equals its probe.
struct LinkOrder {
  std::array<std::int8_t, kMaxLinks> links{};  ///< indices into HapticProgram::links; the first `count` are used
  /// Links of widgets: number of shapes that the link has been given. Another revision counts as another link.
  std::array<std::uint8_t, kMaxLinks> shape_revisions{};
  std::int8_t count = 0;  ///< number of links that run
  std::int8_t mode = -1;  ///< index of the mode that sets the order; -1: none
  bool operator==(const LinkOrder&) const = default;
  /// Appends a link.
  void add(std::size_t link, std::uint8_t shape_revision = 0) noexcept {
    shape_revisions[static_cast<std::size_t>(count)] = shape_revision;
    links[static_cast<std::size_t>(count++)] = static_cast<std::int8_t>(link);
  }
  /// Returns whether the link runs.
  bool contains(std::size_t link) const noexcept {
    for (int k = 0; k < count; ++k)
      if (links[static_cast<std::size_t>(k)] == static_cast<int>(link)) return true;
    return false;
  }
  /// Returns whether the link runs with the shape of revision `shape_revision`.
  bool contains(std::size_t link, std::uint8_t shape_revision) const noexcept {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      if (links[k] == static_cast<int>(link) && shape_revisions[k] == shape_revision) return true;
    return false;
  }
};

/// Steps all switches from the present buttons and the magnitude of the last tick's chain force; returns the order of the scene's links
/// that are on.
CATENA_EXPORT LinkOrder step_switches(const HapticProgram& program, std::uint32_t buttons, double last_force_n,
                                      SwitchState& state) noexcept;

}  // namespace catena::haptics
