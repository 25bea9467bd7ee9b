// SPDX-License-Identifier: MIT
/// Resolution levels: a grid reduced to every 2nd, 4th or 8th node, for both rendering and haptics.
///   level L retains the nodes 0, f, 2 f, ... of each axis, f = 2^L; the domain ends at the last of them. Axes of one node, and of two (an
///           image is stored as two slices), are not reduced
///   scalars a tent filter over the nodes less than f away, with weights (f - |k|) / f^2 per axis; near a face it is as wide as the
///           distance to the face. A node contributes only together with the opposite one, if both have values, so that a linear
///           field is reproduced exactly, also next to missing values
///   vectors, and scalars with nearest interpolation (label maps): the value of the retained node itself, so that line fields (axes
///           without a sign) and labels stay valid
/// A node without a value stays without one. Off the haptic thread; any thread.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Highest resolution level; level L has every 2^L-th node.
inline constexpr int kMaxLevels = 3;

/// Reduces a grid with linear or nearest interpolation to `level` 1 to kMaxLevels; `cubic`: the result is interpolated by cubic cells.
/// Appends a note: the number of remaining voxels and the difference from the data. Returns an Error that begins with `path` when an axis
/// has too few nodes, no value remains, or the memory budget is too small.
Result<AnyField> downsample_to_level(const std::string& path, AnyField field, int level, bool cubic = false);

/// Difference between two grids at the voxels of `fine` where both have values: at every voxel of small grids, at a regular subset of
/// large ones.
struct GridDifference {
  /// Root mean square and maximum of the difference; of vectors: of its length.
  double rms = 0, max = 0;
};
GridDifference compute_difference(const ScalarGrid& fine, const ScalarGrid& coarse);
GridDifference compute_difference(const VectorGrid& fine, const VectorGrid& coarse);

}  // namespace catena::field
