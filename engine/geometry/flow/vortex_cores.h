// SPDX-License-Identifier: MIT
/// Vortex core lines of a steady flow, traced once for haptics and rendering. With J = grad v:
///   sujudi-haimes     v - (v.e) e = 0, e the real unit eigenvector of J where the two others are a complex pair (Sujudi and Haimes, 1995);
///                     the same set as v || J v there (Roth and Peikert, 1998). First order: exact where the core is straight
///   parallel-vectors  v || D^2 v / Dt^2 where J has a complex pair (Roth and Peikert, 1998): second order, for curved cores
///   vorticity         v || curl v where the flow rotates in the plane normal to curl v. No definition of a core: extremal helicity
/// Where more than half of the rotating positions satisfy the criterion (v || curl v everywhere: a Beltrami flow), the criterion does not
/// separate cores, and none is traced.
/// Method: one Newton step at the center of every cell (formulas: 48 cells per axis of the domain). Where the step is shorter than 1.5
/// cells the core is located and traced in both directions in steps of half a voxel (formulas: L / 2000). Each point is corrected by
/// Newton's method across the line to 1e-13 L, or 1e-3 voxels where grad v has a kink. Lines whose ends meet are joined. For grids each
/// knot is then moved onto the least-squares parabola of its neighbors within three voxels, fewer near an open end, which stays: noise and
/// kinks at cell faces are reduced, and a line that is straight or evenly curved is unchanged. A cubic spline through the knots makes
/// tangent and curvature continuous. Off the haptic thread; any thread; deterministic.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/geometry/flow/curve.h"

namespace catena::flow {

/// Definition of a core line.
enum class CoreCriterion { sujudi_haimes, parallel_vectors, vorticity };
/// Names in scene files, in the order of the enumeration.
inline constexpr std::array<std::string_view, 3> kCoreCriterionNames{"sujudi-haimes", "parallel-vectors", "vorticity"};

/// Options of find_vortex_cores().
struct CoreOptions {
  CoreCriterion criterion = CoreCriterion::sujudi_haimes;  ///< Definition of a core line.
  double min_length = 0;                                   ///< Minimum length of a line, world units; 0: grids 6 voxels, formulas 0.02 L.
  double min_swirl = 0.05;                                 ///< Minimum mean swirl of a line, as a fraction of the strongest line's.
  auto operator<=>(const CoreOptions&) const = default;
};

/// All core lines of a field, longest first. Immutable; any thread.
struct VortexCores {
  std::vector<CurvePtr> lines;  ///< Core lines; may be empty.
  /// At the knots of each line: imaginary part of the complex pair, as a fraction of the maximum over all lines.
  std::vector<std::vector<float>> swirls;
  bool holds_everywhere = false;  ///< The criterion holds at more than half of the rotating positions: no line is traced.
  double spacing = 0;             ///< Distance between knots, world units.
};
/// Shared, immutable core lines.
using VortexCoresPtr = std::shared_ptr<const VortexCores>;

/// Returns the core lines of a field; results that are still referenced elsewhere are reused. Returns an Error when the memory budget is
/// too small or there are too many lines. Calls from several threads run one after the other.
CATENA_EXPORT Result<VortexCoresPtr> find_vortex_cores(const field::VectorFieldPtr& field, const CoreOptions& options);

/// Private to this module: fits a parabola to the `half_window` points before and after each point and moves the point onto it.
CATENA_EXPORT std::vector<Vec3> fair_points(const std::vector<Vec3>& points, bool closed, int half_window);
/// Private to this module: returns a spline through these points (vortex_core_splines.cpp); `closed`: the last point is joined to the
/// first.
CATENA_EXPORT CurvePtr spline_through(const std::vector<Vec3>& points, bool closed, const LineEnd& first, const LineEnd& last,
                                      double domain_length);

}  // namespace catena::flow
