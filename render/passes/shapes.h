// SPDX-License-Identifier: MIT
/// Triangle meshes of the packet's shapes: tubes around polylines and the haptic cursor. CPU code, frame thread.
///   tube: rings of `tube_sides` vertices around the points, in a parallel-transport frame (without twist; on a closed line the frame's
///         holonomy is distributed over the length), mitered at the corners so that the walls keep the radius, with round caps (half
///         spheres) at open ends
///   sphere, cylinder, cone: for the probe, the proxies, the links between them, the force
/// All are closed surfaces with outward normals, counter-clockwise seen from outside. World units.
#pragma once
#include <cstdint>
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

/// Vertex of a shape mesh.
struct MeshVertex {
  Vec3 position{0.0};
  Vec3 normal{0.0};  ///< unit vector, outward
  Color color;
  /// Object id, combined with flags: UNCLIPPED (not cut by clip planes) and the corner number in a triangle with visible edges.
  std::uint32_t id = 0;
};

/// Indexed triangles in double precision; converted to floats relative to an origin on upload.
struct ShapeMesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices per triangle
};

/// Returns a unit vector perpendicular to a unit vector.
Vec3 any_perpendicular(const Vec3& t);

/// Assigns the vertices from index `first` on to an object.
void assign_object(ShapeMesh& shape, std::size_t first, std::uint32_t id, bool clipped);

/// Returns the number of sides of a tube at a pixel size of `pixel` world units (0: unknown): 12 or 16; 0 if the tube is so thin that it is
/// rendered as a ribbon.
int tube_sides(double radius, double pixel);

/// Cross section of a tube's surface: its vertices lie at center + radius out, with the normals sqrt(1 - normal_tilt^2) out + normal_tilt
/// tangent, where `out` is a unit vector perpendicular to the tangent.
struct TubeRing {
  Vec3 center{0.0}, tangent{0.0}, normal{0.0};  ///< unit vectors; normal: direction to the first vertex
  Color color{};
  double radius = 0, normal_tilt = 0;
};
/// Returns the rings of a tube; the walls between consecutive rings are its surface. For an open tube the first and the last ring have
/// radius 0 (tips of the caps); a closed one ends with its first ring. Same requirements on the points as add_tube().
std::vector<TubeRing> tube_rings(const TubeItem& tube, bool& closed);

/// Appends a tube. Points not further apart than 1e-9 of the radius are merged; a single point gives a sphere, no point gives nothing.
/// Colors are interpolated linearly between points. Closed: the last point repeats the first. Points must be finite.
void add_tube(ShapeMesh& shape, const TubeItem& tube, int sides);

/// Appends a mesh: three vertices per triangle, with the triangle's normal or vertex normals, and corner numbers if edges are shown.
/// Triangles without area are left out.
void add_mesh(ShapeMesh& shape, const MeshItem& mesh);

/// Appends a sphere.
void add_sphere(ShapeMesh& shape, const Vec3& centre, double radius, const Color& color, int sides = 20);
/// Appends a cylinder with flat ends; nothing if a and b coincide.
void add_cylinder(ShapeMesh& shape, const Vec3& a, const Vec3& b, double radius, const Color& color, int sides = 12);
/// Appends a cone with a closed base.
void add_cone(ShapeMesh& shape, const Vec3& base, const Vec3& tip, double radius, const Color& color, int sides = 16);

/// Appends the parts of the cursor (cursor_parts.h).
void add_cursor(ShapeMesh& shape, const CursorItem& cursor);

}  // namespace catena::render
