/// The core lines of the vortices of a steady flow, traced once for the hand and the eye. With J = grad v:
///   sujudi-haimes     v - (v.e) e = 0, e the real unit eigenvector of J where the two others are a complex pair (Sujudi and Haimes, 1995);
///                     the same set as v || J v there (Roth and Peikert, 1998). First order: exact where the core is straight
///   parallel-vectors  v || D^2 v / Dt^2 where J has a complex pair (Roth and Peikert, 1998): second order, for bent cores
///   vorticity         v || curl v where the flow turns in the plane across curl v. Not a definition of a core: helicity at its extreme
/// Where more than half of the places at which the flow turns are on a core by the criterion (v || curl v everywhere: a Beltrami flow), it
/// tells none from another, and none is traced.
/// How: at the middle of every cell (of a formula: of 48 an axis of its domain) one Newton step; where it is shorter than 1.5 cells the
/// core is sought, and followed both ways in steps of half a voxel (of a formula: L / 2000), each corrected by Newton's method across the
/// line to 1e-13 L, or 1e-3 voxels where grad v has a kink. Lines whose ends meet are joined. Of a grid
/// each knot is then moved onto the parabola that fits its neighbours within three voxels best, fewer near an open end, which stays: noise
/// and the kinks of cells count less, and a line that is straight or bends evenly stays where it is. Through the knots goes a cubic spline,
/// so that tangent and curvature are continuous. Off the tick; any thread; the same lines for the same field.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/flow/curve.h"

namespace catena::flow {

/// By what a core is told.
enum class CoreCriterion { sujudi_haimes, parallel_vectors, vorticity };
/// The words of scenes, in the order of the enumeration.
inline constexpr std::array<std::string_view, 3> kCoreCriterionNames{"sujudi-haimes", "parallel-vectors", "vorticity"};

/// What is asked for.
struct CoreOptions {
  CoreCriterion criterion = CoreCriterion::sujudi_haimes;  ///< by what a core is told
  double min_length = 0;                                   ///< of a line, world units; 0: of grids 6 voxels, of others 0.02 L
  double min_swirl = 0.05;                                 ///< mean swirl of a line, of the strongest one's
  auto operator<=>(const CoreOptions&) const = default;
};

/// All core lines of a field, longest first. Immutable; any thread.
struct VortexCores {
  std::vector<CurvePtr> lines;             ///< may be empty
  std::vector<std::vector<float>> swirls;  ///< at the knots of each line: imaginary part of the complex pair, by the greatest of all
  bool holds_everywhere = false;           ///< every place satisfies the criterion: none is traced
  double spacing = 0;                      ///< of the knots, world units
};
/// Cores are shared and never change.
using VortexCoresPtr = std::shared_ptr<const VortexCores>;

/// The cores of a field; those that something holds are not traced again. The error: no memory, or more lines than can be kept.
Result<VortexCoresPtr> find_vortex_cores(const field::VectorFieldPtr& field, const CoreOptions& options);

/// Private to this room: each place on the parabola of the `reach` places before and after it.
std::vector<Vec3> fair_points(const std::vector<Vec3>& places, bool closed, int reach);
/// Private to this room: a line through these places (core_lines.cpp); `closed`: the last one leads to the first.
CurvePtr spline_through(const std::vector<Vec3>& places, bool closed, const LineEnd& first, const LineEnd& last, double domain_length);

}  // namespace catena::flow
