/// Labels of a scalar grid whose voxels hold whole numbers that are names, and the surface of one or several of them. Off the tick, any
/// thread; the same grid gives the same answer, whatever the number of threads.
///
/// The surface of a set of labels is the level 0.5 of a grid of its own, which eye and hand share:
///   chi(v) = 1 in a voxel whose label is of the set, 0 elsewhere           trilinear between voxel centres
///   smooth s > 0:  chi_s = chi * g_s, a separable Gaussian of s voxels, cut at 3 s and normalised, and then held to its side:
///                  at least 0.52 in a voxel of the set, at most 0.48 in any other
/// So with smooth 0 the surface crosses a line of two voxel centres in its middle, and with any smooth every voxel centre stays on the side
/// that its label says: the number of voxel centres inside, and which of them are, is that of the labels. The surface is never farther than
/// a voxel from that without smoothing, and no part of a label is lost or joined to another along a face of two voxels.
/// The grid lies in the map's own transform, over the box of the set and a margin of 2 + 3 s voxels beyond it, in which chi is 0: the
/// surface is closed where the map ends. Blocks of one value cost nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Voxels along each axis by which a surface is smoothed unless something else is said.
inline constexpr double kDefaultLabelSmoothing = 1.2;
inline constexpr double kMaxLabelSmoothing = 4;
inline constexpr double kLabelLevel = 0.5;

struct LabelCount {
  double value = 0;
  std::uint64_t voxels = 0;
  Index3 lo, hi;  ///< its box, index space, both ends included
};

/// All values of the grid's box, rising. None where a voxel holds no whole number, there are more than 65536 different ones, or the box has
/// more than 2^30 voxels.
std::optional<std::vector<LabelCount>> count_labels(const ScalarGrid& map);

/// `labels`: values, each of which must be among `counts`, those of the map. An error is one phrase on memory.
Result<std::shared_ptr<const ScalarGrid>> make_label_surface(const ScalarGrid& map, const std::vector<LabelCount>& counts,
                                                             const std::vector<double>& labels, double smooth, const std::string& name);

/// The label that a place belongs to: that of the nearest voxel centre, or where that is 0, of the nearest one of the cell's eight that is
/// not; 0 where all are, or the place is not inside.
double label_at(const ScalarGrid& map, const Vec3& world);

}  // namespace catena::field
