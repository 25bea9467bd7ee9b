/// TransferEditor functions for the fast raycast, whose volumes hold codes of 8 bits: integrated over pairs of codes. Plain CPU code.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/residency/voxel_block.h"

namespace catena::render {

/// Where the picture depends on the value: the transfer function is one colour and density (or nothing) below and above.
/// CellFinder `values`. `shaded`: what is visible depends on the gradient too, so that only what is invisible
/// is left out, and no two codes look alike unless they are.
ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded);

/// A transfer function, integrated beforehand over pairs of codes of a packed volume (a at one end of a segment, b at the other):
///   sigma(a, b) = mean over values from a to b of sigma(v)      colour(a, b) = mean of sigma(v) colour(v) / sigma(a, b)
/// so that a segment of length L has the optical depth sigma L: the table does not depend on the step. Engel et al. 2001, without
/// the attenuation within a segment; the means are exact, however narrow the function's parts. 256 x 256 entries: sigma as float bits |
/// red 11 bits, green 11, blue 10.
struct PreintegratedTable {
  std::vector<std::array<std::uint32_t, 2>> entries;  ///< a + 256 b
  CodeAppearance appearance;
  double max_sigma = 0;
};

/// What rounding `values` to codes from one end to the other of `active` changes, 0 to 1: the mean change of what a ray of `length` through
/// one value would show, opacity or colour.
double quantization_change(const TransferTable& table, const ValueInterval& active, std::span<const float> values, double length);
/// Whether codes that lie from one end to the other of `active` show the function: each of its points that is a peak or a gap is met, to a
/// tenth, within a sixteenth of a code.
bool resolves_transfer_function(const TransferTable& table, const ValueInterval& active);
/// `lo`, `per_code`: of the packed volume.
PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded);

}  // namespace catena::render
