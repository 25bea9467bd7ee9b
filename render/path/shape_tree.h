// SPDX-License-Identifier: MIT
/// Intersection of rays with triangles, round line segments (spheres, if both ends are equal) and cones, by a tree of boxes. Positions are
/// single precision relative to an origin, intersections double precision. Immutable after build(): any thread.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/base/plane.h"
#include "render/path/path_ray.h"

namespace catena::render {

/// Appearance that shapes share. Colors are linear.
struct ShapeItem {
  Color color{};
  float opacity = 1;
  bool is_clipped = true;
};

/// Triangle a b c; segment a b with a radius; or cone from base a to apex b with the radius of its base.
struct PathShape {
  enum class Kind : std::uint8_t { triangle, segment, cone };
  glm::vec3 a{0.0f}, b{0.0f}, c{0.0f};
  float radius = 0;
  std::uint32_t item = 0;
  std::uint32_t colors = kNone;   ///< first of its colors: 3 of a triangle, 2 of a segment, 1 of a cone; kNone: the item's
  std::uint32_t normals = kNone;  ///< first of 3 normals of a triangle; kNone: flat
  Kind kind = Kind::triangle;
  static constexpr std::uint32_t kNone = ~0u;
};

/// Shapes of a scene.
class ShapeTree {
 public:
  Vec3 origin{0.0};  ///< of the shapes' positions
  std::vector<ShapeItem> items;
  std::vector<PathShape> shapes;
  std::vector<Color> colors;
  std::vector<glm::vec3> normals;

  /// Sorts the shapes into the tree.
  void build();
  /// Returns the first intersection between two distances that the clip planes keep.
  SurfaceHit intersect(const PathRay& ray, double from, double to, const std::vector<Plane>& planes) const;

 private:
  struct Node {
    glm::vec3 lo, hi;
    std::uint32_t first = 0;  ///< first shape of a leaf; left child of an inner node, which is followed by the right one
    std::uint32_t count = 0;  ///< number of shapes; 0: inner node
  };
  void split(std::uint32_t node, int depth);
  void test(const PathShape& shape, const PathRay& ray, double from, SurfaceHit& hit, const std::vector<Plane>& planes) const;

  std::vector<Node> nodes_;
};

}  // namespace catena::render
