/// A transfer function, integrated beforehand over pairs of codes of a packed volume (a at one end of a segment, b at the other):
///   sigma(a, b) = mean over values from a to b of sigma(v)      colour(a, b) = mean of sigma(v) colour(v) / sigma(a, b)
/// so that a segment of length L has the optical depth sigma L: the table does not depend on the step. Engel et al. 2001, without
/// the attenuation within a segment. 256 x 256 entries: sigma as float bits | red 11 bits, green 11, blue 10.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/mirror/packed_volume.h"

namespace catena::render {

/// Where the picture depends on the value: the transfer function is one colour and density (or nothing) below and above.
/// Within `values`; resolved to 1 / 4096 of it. `shaded`: what is visible depends on the gradient too, so that only what is invisible
/// is left out, and no two codes look alike unless they are.
ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded);

struct PreintegratedTable {
  std::vector<std::array<std::uint32_t, 2>> entries;  ///< a + 256 b
  std::array<std::uint16_t, 256> look{};              ///< for make_plain_map
  double greatest_sigma = 0;
};

/// `lo`, `per_code`: of the packed volume.
PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded);

}  // namespace catena::render
