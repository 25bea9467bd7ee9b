/// Places to start streamlines from, the same at every call. World coordinates. Off the tick, any thread.
#pragma once
#include <vector>

#include "engine/base/result.h"
#include "engine/field/field.h"

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

}  // namespace catena::flow
