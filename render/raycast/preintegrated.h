// SPDX-License-Identifier: MIT
/// Transfer functions for the fast raycast, whose volumes hold 8-bit codes: pre-integrated over pairs of codes. CPU code.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/residency/voxel_block.h"

namespace catena::render {

/// Returns the sub-interval of `values` in which the image depends on the value: below and above it the transfer function has a constant
/// color and extinction (or is zero). `shaded`: visible values also depend on the gradient, so that only invisible values are left out, and
/// two codes are classified alike only if they are equal.
ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded);

/// Transfer function, pre-integrated over pairs of codes of a packed volume (a at one end of a segment, b at the other):
///   sigma(a, b) = mean over values from a to b of sigma(v)      color(a, b) = mean of sigma(v) color(v) / sigma(a, b)
/// so that a segment of length L has the optical depth sigma L: the table does not depend on the step. Engel et al. 2001, without the
/// attenuation within a segment; the means are exact, however narrow the features of the function. 256 x 256 entries: sigma as float bits |
/// red 11 bits, green 11, blue 10.
struct PreintegratedTable {
  std::vector<std::array<std::uint32_t, 2>> entries;  ///< index a + 256 b
  CodeAppearance appearance;
  double max_sigma = 0;
};

/// Returns the mean change of what a ray of `length` through a constant value shows (the larger of opacity and color, 0 to 1) if the values
/// are rounded to 256 codes spanning `active`.
double quantization_change(const TransferTable& table, const ValueInterval& active, std::span<const float> values, double length);
/// Returns whether 256 codes spanning `active` resolve the function: each of its points that is a peak or a gap is reproduced, to a tenth,
/// within a sixteenth of a code.
bool resolves_transfer_function(const TransferTable& table, const ValueInterval& active);
/// Builds the table. `lo`, `per_code`: value scale of the packed volume (CodeScale).
PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded);

}  // namespace catena::render
