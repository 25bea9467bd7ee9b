/// Triangle meshes of the packet's shapes: tubes around polylines and the cursor's glyph. Plain CPU code, frame thread.
///   tube: rings of `tube_sides` vertices around the points, in a parallel-transport frame (no twist of its own; on a closed
///         line the frame's holonomy is spread over the length), mitred at the corners so that the walls keep the radius,
///         with round caps (half spheres) at open ends
///   ball, cylinder, cone: for the probe, the proxies, the links between them, the force
/// All are closed surfaces with outward normals, counter-clockwise seen from outside. World units.
#pragma once
#include <cstdint>
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

struct MeshVertex {
  Vec3 position{0.0};
  Vec3 normal{0.0};  ///< unit, outward
  Color color;
  std::uint32_t id = 0;  ///< of the object; UNCLIPPED in it: the clip planes do not touch it; its corner of a triangle with edges
};

/// Indexed triangles in double precision; the uploader makes floats of them, relative to an origin of its choice.
struct ShapeMesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each
};

/// Gives the vertices from `first` on to an object.
void assign_object(ShapeMesh& shape, std::size_t first, std::uint32_t id, bool clipped);

/// Of a tube where a pixel has that size in the world (0: unknown): 12 or 16; 0 of one so thin that a ribbon shows it.
int tube_sides(double radius, double pixel);

/// A circle of a tube's surface: its vertices at centre + radius out, with the normals sqrt(1 - lean^2) out + lean tangent.
struct TubeRing {
  Vec3 center{0.0}, tangent{0.0}, normal{0.0};  ///< normal: to the first vertex
  Color color{};
  double radius = 0, normal_tilt = 0;
};
/// A tube as rings: walls from each to the next are its surface. Of an open one the first and the last have no radius: they are the tips of
/// the caps; a closed one ends with its first ring. Points as add_tube takes them.
std::vector<TubeRing> tube_rings(const TubeItem& tube, bool& closed);

/// Appends a tube. Points that are not further apart than 1e-9 of the radius are one; a single point gives a ball, none nothing.
/// Colours by point run linearly between them. Closed: the last point repeats the first. Non-finite points are a bug of the caller.
void add_tube(ShapeMesh& shape, const TubeItem& tube, int sides);

/// Appends a mesh: three vertices a triangle, with its normal or their own, and marked. Triangles without an area are left out.
void add_mesh(ShapeMesh& shape, const MeshItem& mesh);

void add_sphere(ShapeMesh& shape, const Vec3& centre, double radius, const Color& color, int sides = 20);
/// With flat ends. Nothing if a and b coincide.
void add_cylinder(ShapeMesh& shape, const Vec3& a, const Vec3& b, double radius, const Color& color, int sides = 12);
void add_cone(ShapeMesh& shape, const Vec3& base, const Vec3& tip, double radius, const Color& color, int sides = 16);

/// The colour of link i's proxy: a colour-blind-safe sequence (Okabe and Ito); dim while the link is not active.
Color link_color(std::size_t i, bool active);

/// The link between a proxy and its probe: grey on the feature, over amber to red where the hand is about to leave it (Okabe
/// and Ito's, told apart by the colour-blind).
Color release_color(double leaving);

/// Probe ball, a ball a proxy (larger than a tube of the fitted radius: it covers the line it sits on), cylinders
/// probe -> p1 -> p2 .., and an arrow for the force: cursor_arrow_length, along F, from the probe, or
/// from where the hand is held where the picture stands for a device (CursorItem::strain).
/// A link that the hand is leaving: its cylinder takes release_color and gets thicker; one that has let go: three rings of
/// release_color(1) around the place where it would hold. With a foot: a grey line of 0.15 size from the probe to there, and a cross of
/// 1.5 size to each side, in the plane across the line. A crosshair is three rods and nothing else.
void add_cursor(ShapeMesh& shape, const CursorItem& cursor);
/// 2.5 glyph radii a newton, between 2 (anything felt can be seen) and 16 radii; 0 without a force.
double cursor_arrow_length(double force_n, double size);

}  // namespace catena::render
