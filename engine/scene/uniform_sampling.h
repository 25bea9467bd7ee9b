// SPDX-License-Identifier: MIT
/// Evenly spaced points on a plane, in a box, or on a surface. World coordinates. Deterministic. Off the tick, any thread.
///   plane     triangular grid with the spacing between neighbors; one point is the domain's center projected onto the plane, and one
///             row is along the world axis most nearly parallel to the plane (of several, the first)
///   box       cubic grid along the domain's edges, centered in it
///   surfaces  from candidate points closer than a quarter of the spacing: those at least the spacing from all points chosen before, in an
///             order given by a hash of their cell or triangle, so that the points of a level stay while it moves a little. As measured,
///             each has a neighbor within 1.5 spacings, and no point of the surface is farther than 1.1 spacings from a chosen one.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/field/field.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::scene {

/// A box that may be rotated and sheared in the world.
struct Domain {
  field::Mapping mapping;  ///< From index to world space
  field::Box box;          ///< In index space
};

/// Result of the sampling.
struct UniformSamples {
  std::vector<Vec3> positions;  ///< World; empty also if there are more than `max_count`
  /// Approximate number of points; if it exceeds the maximum allowed, `positions` is empty.
  double expected_count = 0;
};

/// Points on the part of a plane, or in the volume, of a domain. `spacing`: world units; `max_count`: maximum number of points.
UniformSamples sample_plane(const Domain& domain, const Vec3& point, const Vec3& normal, double spacing, std::size_t max_count);
UniformSamples sample_box(const Domain& domain, double spacing, std::size_t max_count);

/// Points on a level set in the field's domain. The level is searched on a grid of the field's voxels, at most 128 cells per axis: in
/// larger grids a sheet or bubble thinner than a 128th of the domain may be missed. Only points with valid values.
UniformSamples sample_isosurface(const field::ScalarField& field, double level, double spacing, std::size_t max_count);
/// Points on the triangles of a mesh.
UniformSamples sample_mesh(const mesh::TriangleMesh& mesh, double spacing, std::size_t max_count);

}  // namespace catena::scene
