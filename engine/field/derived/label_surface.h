// SPDX-License-Identifier: MIT
/// Label maps (segmentations: scalar grids whose voxels hold integer labels) and the surface of one or several labels. Not for the haptic
/// tick; any thread. Results do not depend on the number of threads.
///
/// The surface of a set of labels is the isosurface at level 0.5 of a separate grid chi, used for rendering and haptics alike:
///   chi(v) = 1 in a voxel whose label is in the set, 0 elsewhere           trilinear between voxel centers
///   smooth s > 0:  chi_s = chi * g_s, a separable Gaussian with sigma s voxels, truncated at 3 s and normalized, then clamped:
///                  at least 0.52 in a voxel of the set, at most 0.48 in any other
/// Without smoothing the surface crosses the line between two voxel centers in its middle. With any smoothing every voxel center stays on
/// its own side, so the set of voxel centers inside is exactly that of the labels. The smoothed surface is never farther than one voxel
/// from the unsmoothed one, and no part of a label disappears or is joined to another across a face between two voxels. The grid uses the
/// mapping of the label map and covers the box of the set and a margin of 2 + 3 s voxels, in which labels outside of the map count as 0, so
/// the surface is closed at the border of the map. Blocks of a single value take no memory.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Smoothing of label surfaces, sigma of the Gaussian in voxels: default and maximum. kLabelLevel: level of the surface.
inline constexpr double kDefaultLabelSmoothing = 1.2;
inline constexpr double kMaxLabelSmoothing = 4;
inline constexpr double kLabelLevel = 0.5;

/// One label of a map with its number of voxels.
struct LabelCount {
  double value = 0;
  std::uint64_t voxels = 0;
  Index3 lo, hi;  ///< bounding box of the label in index space, both ends included
};

/// Returns all labels in the box of the grid in ascending order. nullopt when a voxel is not an integer, there are more than 65536 labels,
/// or the box has more than 2^30 voxels.
std::optional<std::vector<LabelCount>> count_labels(const ScalarGrid& map);

/// Makes the grid chi for the set `labels`, each of which must be in `counts`, the labels of the map. `smooth`: sigma in voxels, 0 to
/// kMaxLabelSmoothing. Error (a message fragment): there is not enough memory.
Result<std::shared_ptr<const ScalarGrid>> make_label_surface(const ScalarGrid& map, const std::vector<LabelCount>& counts,
                                                             const std::vector<double>& labels, double smooth, const std::string& name);

/// Returns the label at a position: that of the nearest voxel center or, when it is 0, that of the nearest corner of the cell with another
/// label; 0 when all are 0 or the position is not inside.
double label_at(const ScalarGrid& map, const Vec3& world);

}  // namespace catena::field
