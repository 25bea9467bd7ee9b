/// Places to start streamlines from, and lines that keep a distance from each other: the same at every call. World coordinates. Off the
/// tick, any thread.
#pragma once
#include <vector>

#include "engine/base/result.h"
#include "engine/field/field.h"
#include "engine/geometry/flow/batch_tracer.h"

namespace catena::flow {

/// From one end to the other, both included; one: the middle.
std::vector<Vec3> seeds_on_line(const Vec3& from, const Vec3& to, int count);

/// A lattice over the parallelogram origin + a u + b v, 0 <= a, b <= 1, borders included; u runs fastest.
std::vector<Vec3> seeds_on_plane(const Vec3& origin, const Vec3& u, const Vec3& v, int count_u, int count_v);

/// On the sphere, or within the ball, evenly by area or volume (a Fibonacci spiral; radii by the cube root).
std::vector<Vec3> seeds_on_sphere(const Vec3& centre, double radius, int count, bool inside);

/// On the level set s = level within the field's domain, evenly by area: where isotropic lines (through pairs of places of a
/// low-discrepancy sequence on the domain's enclosing sphere) cross it; by the Cauchy-Crofton formula every piece of surface
/// is met in proportion to its area. Lines are searched at half a voxel (analytic: L / 128), roots by Illinois.
/// Fewer than `count`, or none, where 64 lines a seed (at least 4096) do not meet the level often enough.
std::vector<Vec3> seeds_on_isosurface(const field::ScalarField& field, double level, int count);

/// StreamlineTracing that keep a distance from each other, after Jobard and Lefer (1997), in space.
///   seeds   at `distance` from a line that is there, to four sides of its tangent, every `distance` along it, and kept only where
///           no line is nearer than `distance`
///   lines   grow both ways and end where they come nearer than `test * distance` to another line, or to themselves; lines
///           shorter than `distance` are dropped
/// Lines of the batch tracer (batch.h), which are the same whatever the number of threads: so is the set. Off the tick.
struct EvenSpacingOptions {
  double distance = 0;             ///< world units, > 0
  double termination_ratio = 0.5;  ///< times the distance, 0 < test <= 1
  std::vector<Vec3> start_points;  ///< where the first lines begin, world; empty: the middle of the domain
  std::size_t max_lines = 20000;   ///< no more are made
};

/// In order of acceptance; the first start that begins a line is the first line. Empty where none does.
std::vector<CurvePtr> trace_evenly_spaced(const Flow& flow, const EvenSpacingOptions& spacing, const BatchOptions& options = {});

/// The part s0..s1 of a curve that is not closed, or of one lap of a closed one; its ends inside the curve are LENGTH.
CurvePtr extract_subcurve(const Curve& curve, double s0, double s1);

}  // namespace catena::flow
