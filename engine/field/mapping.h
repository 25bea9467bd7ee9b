/// The linear map between the index space of a grid and the world: world = J index + origin. Anisotropic voxels, rotations,
/// shears and negative origins are all just J. Analytic fields have J = 1, origin = 0.
#pragma once
#include "engine/base/bounds.h"
#include "engine/base/vec.h"

namespace catena::field {

/// World from index and back, worked out once.
struct Mapping {
  Mat3 world_from_index_linear{1.0};  ///< J, world units a voxel
  Mat3 index_from_world_linear{1.0};  ///< J^-1
  Vec3 origin{0.0};                   ///< world position of index (0, 0, 0)

  /// The map of J and the origin. A J that cannot be inverted gives one that is not is_invertible().
  static Mapping from_linear(const Mat3& world_from_index, const Vec3& origin);

  /// The world place of an index place.
  Vec3 world_from_index(const Vec3& index) const { return world_from_index_linear * index + origin; }
  /// The index place of a world place.
  Vec3 index_from_world(const Vec3& world) const { return index_from_world_linear * (world - origin); }
  /// A covector: gradient_world = J^-T gradient_index.
  Vec3 world_from_index_gradient(const Vec3& g) const { return g * index_from_world_linear; }
  double min_voxel_edge() const;  ///< of a voxel, world units
  bool is_invertible() const;     ///< finite, and can be inverted
};

/// A box in index space (grids: voxel centres lo..hi, both included; analytic fields: world coordinates).
struct Box {
  Vec3 lo{0.0}, hi{0.0};  ///< least and greatest corner
  /// Whether p lies within it, or at most `slack` outside along any axis.
  bool contains(const Vec3& p, double slack = 0) const {
    return p.x >= lo.x - slack && p.y >= lo.y - slack && p.z >= lo.z - slack && p.x <= hi.x + slack && p.y <= hi.y + slack &&
           p.z <= hi.z + slack;
  }
  bool operator==(const Box&) const = default;
};

/// Of a box that may lie obliquely in the world: corner i + 2 j + 4 k by index, and what encloses all eight.
Vec3 world_corner(const Mapping& mapping, const Box& box, int i);
/// The box along the world's axes that encloses all eight corners, world units.
Bounds world_bounds(const Mapping& mapping, const Box& box);

}  // namespace catena::field
