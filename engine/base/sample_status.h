// SPDX-License-Identifier: MIT
/// Status of a field sample: the reason that a line ends or a link cannot continue at a position, in addition to the status of the line or
/// link.
#pragma once
#include <cstdint>

namespace catena {

/// Reason that the field has no usable sample at a position.
enum class SampleStatus : std::uint8_t {
  ok,           ///< usable sample
  zero,         ///< no direction: |v| (or the gradient) vanishes, or the speed is not above min_speed
  incoherent,   ///< no unique direction: the axes of a line field disagree there, or a surface normal jumps
  masked,       ///< outside of the valid voxels
  outside_box,  ///< outside of the domain's box
  not_finite,   ///< a value, or the probe position, is not finite
  parallel,     ///< the criterion of a vortex core holds at every position
};

/// Returns NONE ZERO INCOHERENT MASK BOX NOT_FINITE PARALLEL.
inline const char* to_string(SampleStatus reason) {
  constexpr const char* words[] = {"NONE", "ZERO", "INCOHERENT", "MASK", "BOX", "NOT_FINITE", "PARALLEL"};
  return words[static_cast<int>(reason)];
}

}  // namespace catena
