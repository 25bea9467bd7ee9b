/// Why a line ends or a link cannot go on, beside its status: what the field says at that place.
#pragma once
#include <cstdint>

namespace catena {

/// Why the field says nothing at a place.
enum class SampleStatus : std::uint8_t {
  ok,
  zero,         ///< no direction: |v| (or the gradient) vanishes, or the speed is not above min_speed
  incoherent,   ///< no single direction: the axes of a line field disagree there, or a normal jumps
  masked,       ///< beside the valid voxels
  outside_box,  ///< beside the domain's box
  not_finite,   ///< a value, or the probe, is not a finite number
  parallel,     ///< every place satisfies the criterion of a vortex core
};

/// NONE ZERO INCOHERENT MASK BOX NOT_FINITE PARALLEL
inline const char* to_string(SampleStatus reason) {
  constexpr const char* words[] = {"NONE", "ZERO", "INCOHERENT", "MASK", "BOX", "NOT_FINITE", "PARALLEL"};
  return words[static_cast<int>(reason)];
}

}  // namespace catena
