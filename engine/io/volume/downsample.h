/// ResolutionLevels of detail: a grid with every 2nd, 4th or 8th node of its own, for the eye and the hand alike.
///   level L keeps the nodes 0, f, 2 f, ... of each axis, f = 2^L; its domain ends at the last of them. Axes of one node, and of two (an
///   image is kept as two layers), keep theirs numbers  a tent over the nodes less than f away, (f - |k|) / f^2 an axis; near a face, as
///   wide as the face is away. A place counts
///            only together with the one opposite, where both have values, so that a linear field stays what it is beside holes, too
///   vectors, and numbers of which the nearest counts (labels): the node's own value, so that axes without a sign and labels stay theirs
/// A node without a value stays without one. Off the tick, any thread.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

inline constexpr int kMaxLevels = 3;

/// `level` 1 to kMaxLevels of a grid that is read linearly or by the nearest; read by cubic cells where that is wanted. Its notes get a
/// sentence: how many voxels are left, and what it differs from the data by. `path` begins the errors: an axis is too short, nothing is
/// left, the memory does not suffice.
Result<AnyField> downsample_to_level(const std::string& path, AnyField field, int level, bool cubic = false);

/// How far one grid is off another at the voxels of `fine` at which both have values, every one of small grids, a lattice of large ones.
struct GridDifference {
  double rms = 0, max = 0;
};
GridDifference compute_difference(const ScalarGrid& fine, const ScalarGrid& coarse);
GridDifference compute_difference(const VectorGrid& fine, const VectorGrid& coarse);

}  // namespace catena::field
