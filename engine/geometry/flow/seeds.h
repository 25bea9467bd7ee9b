// SPDX-License-Identifier: MIT
/// Seed points for streamlines, and evenly spaced streamlines. Deterministic. World coordinates. Off the haptic thread; any thread.
#pragma once
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/field.h"
#include "engine/geometry/flow/batch_tracer.h"

namespace catena::flow {

/// Returns `count` points from one end to the other, both included; for one point: the middle.
CATENA_EXPORT std::vector<Vec3> seeds_on_line(const Vec3& from, const Vec3& to, int count);

/// Returns a regular grid of points over the parallelogram origin + a u + b v, 0 <= a, b <= 1, borders included; u runs fastest.
CATENA_EXPORT std::vector<Vec3> seeds_on_plane(const Vec3& origin, const Vec3& u, const Vec3& v, int count_u, int count_v);

/// Returns points on the sphere, or with `inside` in the ball, uniformly by area or volume (a Fibonacci spiral; radii by the cube root).
CATENA_EXPORT std::vector<Vec3> seeds_on_sphere(const Vec3& centre, double radius, int count, bool inside);

/// Returns points on the level set s = level inside the field's domain, uniformly by area: the intersections with isotropic lines (through
/// pairs of points of a low-discrepancy sequence on the sphere around the domain). By the Cauchy-Crofton formula every piece of the surface
/// is hit in proportion to its area. Lines are searched in steps of half a voxel (analytic fields: L / 128); roots by the Illinois method.
/// Returns fewer than `count` points, or none, when 64 lines per seed (at least 4096) do not cross the level often enough.
CATENA_EXPORT std::vector<Vec3> seeds_on_isosurface(const field::ScalarField& field, double level, int count);

/// Options of evenly spaced streamlines, after Jobard and Lefer (1997), in 3D.
///   seeds   at `distance` from an existing line, on four sides of its tangent, every `distance` along it; used only where no line is
///           nearer than `distance`
///   lines   grow in both directions and end where they come nearer than `termination_ratio * distance` to another line or to
///           themselves; lines shorter than `distance` are dropped
/// The lines come from the batch tracer (batch_tracer.h), so that the set does not depend on the number of threads. Off the haptic thread.
struct EvenSpacingOptions {
  double distance = 0;             ///< Separation distance, world units, > 0.
  double termination_ratio = 0.5;  ///< Minimum distance of a growing line, as a fraction of `distance`; in (0, 1].
  std::vector<Vec3> start_points;  ///< Seeds of the first lines, world units; empty: the center of the domain.
  std::size_t max_lines = 20000;   ///< Maximum number of lines.
};

/// Traces evenly spaced lines. Returns them in order of acceptance, first the line of the first usable start point; empty when no start
/// point yields a line.
CATENA_EXPORT std::vector<CurvePtr> trace_evenly_spaced(const Flow& flow, const EvenSpacingOptions& spacing,
                                                        const BatchOptions& options = {});

/// Returns the part s0..s1 of an open curve, or of one lap of a closed one; an end inside the curve has the termination LENGTH.
CATENA_EXPORT CurvePtr extract_subcurve(const Curve& curve, double s0, double s1);

}  // namespace catena::flow
