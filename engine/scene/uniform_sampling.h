/// Places that are evenly spaced on a plane, in a box, or on a surface: the same at every call. World coordinates. Off the tick, any
/// thread.
///   plane     a triangular lattice, its neighbours one spacing apart, a point of it below the domain's centre and a row of it along the
///             world's axis that the plane is most nearly parallel to (of equal ones the first)
///   box       a cubic lattice along the domain's edges, in its middle
///   surfaces  of places that lie closer than a quarter of the spacing those that are no nearer than it to one chosen before, in an order
///   by
///             a hash of where they are: those of a level stay while it moves a little. No two are nearer than the spacing, a neighbour is
///             within 1.5, and no place of the surface is further from one than 1.1 spacings, as measured
#pragma once
#include <cstddef>
#include <vector>

#include "engine/field/field.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::scene {

/// A box that may lie obliquely in the world.
struct Domain {
  field::Mapping mapping;
  field::Box box;
};

struct UniformSamples {
  std::vector<Vec3> positions;
  double expected_count = 0;  ///< about so many there would be; more than the most allowed: `places` is empty
};

UniformSamples sample_plane(const Domain& domain, const Vec3& point, const Vec3& normal, double spacing, std::size_t most);
UniformSamples sample_box(const Domain& domain, double spacing, std::size_t most);

/// The level is looked for at the grid's voxels, of which it takes at most 128 an axis: a sheet or a bubble thinner than a 128th of the
/// domain may be missed in larger grids. Only valid places.
UniformSamples sample_isosurface(const field::ScalarField& field, double level, double spacing, std::size_t most);
UniformSamples sample_mesh(const mesh::TriangleMesh& mesh, double spacing, std::size_t most);

}  // namespace catena::scene
