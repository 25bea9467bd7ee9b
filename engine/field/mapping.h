// SPDX-License-Identifier: MIT
/// Affine map between the index space of a grid and the world: world = J index + origin. J represents anisotropic voxels, rotations and
/// shears. Analytic fields have J = 1, origin = 0.
#pragma once
#include "engine/base/bounds.h"
#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::field {

/// Map from index space to the world and its inverse, computed once.
struct CATENA_EXPORT Mapping {
  Mat3 world_from_index_linear{1.0};  ///< J, world units per voxel
  Mat3 index_from_world_linear{1.0};  ///< J^-1
  Vec3 origin{0.0};                   ///< world position of index (0, 0, 0)

  /// Makes the map from J and the origin. When J cannot be inverted, is_invertible() of the result is false.
  static Mapping from_linear(const Mat3& world_from_index, const Vec3& origin);

  /// Converts a position from index space to the world.
  Vec3 world_from_index(const Vec3& index) const { return world_from_index_linear * index + origin; }
  /// Converts a position from the world to index space.
  Vec3 index_from_world(const Vec3& world) const { return index_from_world_linear * (world - origin); }
  /// Converts a gradient (covector) from index space to the world: gradient_world = J^-T gradient_index.
  Vec3 world_from_index_gradient(const Vec3& g) const { return g * index_from_world_linear; }
  double min_voxel_edge() const;  ///< shortest edge of a voxel, world units
  bool is_invertible() const;     ///< whether all numbers are finite and J can be inverted
};

/// Box in index space (grids: voxel centers lo..hi, both included; analytic fields: world coordinates).
struct Box {
  Vec3 lo{0.0}, hi{0.0};  ///< lowest and highest corner
  /// Returns true when p is inside the box or at most `slack` outside of it along any axis.
  bool contains(const Vec3& p, double slack = 0) const {
    return p.x >= lo.x - slack && p.y >= lo.y - slack && p.z >= lo.z - slack && p.x <= hi.x + slack && p.y <= hi.y + slack &&
           p.z <= hi.z + slack;
  }
  bool operator==(const Box&) const = default;
};

/// Returns the world position of corner number i + 2 j + 4 k of an index box, which may be oblique in the world.
CATENA_EXPORT Vec3 world_corner(const Mapping& mapping, const Box& box, int i);
/// Returns the world-axis-aligned box that encloses all eight corners, world units.
CATENA_EXPORT Bounds world_bounds(const Mapping& mapping, const Box& box);

}  // namespace catena::field
