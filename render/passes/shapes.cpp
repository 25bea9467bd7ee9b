// SPDX-License-Identifier: MIT
#include "render/passes/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/result.h"
#include "render/passes/cursor_parts.h"
#include "shaders/shared/frame.h"

namespace catena::render {

Vec3 any_perpendicular(const Vec3& t) {
  const Vec3 axis = std::fabs(t.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  return direction(cross(t, axis));
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMaxJointTurn = 0.35;  // radians; a corner with a larger turn gets several rings

std::uint32_t add_vertex(ShapeMesh& shape, const Vec3& position, const Vec3& normal, const Color& color) {
  shape.vertices.push_back({position, normal, color, 0});
  return static_cast<std::uint32_t>(shape.vertices.size() - 1);
}

void add_triangle(ShapeMesh& shape, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  shape.triangles.insert(shape.triangles.end(), {a, b, c});
}

/// Applies the smallest rotation from unit `from` to unit `to` (not opposite) to a vector v perpendicular to `from`.
Vec3 transport(const Vec3& v, const Vec3& from, const Vec3& to) {
  const Vec3 sum = from + to;
  const Vec3 w = v - (dot(v, to) / (1 + dot(from, to))) * sum;
  return direction(w - dot(w, to) * to);
}

Vec3 rotate_about(const Vec3& v, const Vec3& axis, double angle) {  // v perpendicular to axis
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v);
}

using Ring = TubeRing;

/// Adds `sides` vertices of a circle of `radius` about center + height * tangent, with normals across * radial + along * tangent.
std::uint32_t add_ring(ShapeMesh& shape, const Ring& ring, double radius, double height, double across, double along, int sides,
                       const Color& color) {
  const Vec3 binormal = cross(ring.tangent, ring.normal);
  const std::uint32_t first = static_cast<std::uint32_t>(shape.vertices.size());
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * kPi * k / sides;
    const Vec3 out = std::cos(angle) * ring.normal + std::sin(angle) * binormal;
    add_vertex(shape, ring.center + height * ring.tangent + radius * out, across * out + along * ring.tangent, color);
  }
  return first;
}

/// Adds the wall between two rings; `b` lies further along the tangent, `shift` offsets its vertex numbers.
void add_wall(ShapeMesh& shape, std::uint32_t a, std::uint32_t b, int sides, int shift = 0) {
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t l = (k + 1) % n, kb = (k + static_cast<std::uint32_t>(shift)) % n, lb = (kb + 1) % n;
    add_triangle(shape, a + k, a + l, b + lb);
    add_triangle(shape, a + k, b + lb, b + kb);
  }
}

/// Adds the triangles from a ring to an apex, which lies ahead of it along the tangent or behind it.
void add_fan(ShapeMesh& shape, std::uint32_t ring, std::uint32_t apex, int sides, bool ahead) {
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t a = ring + k, b = ring + (k + 1) % n;
    ahead ? add_triangle(shape, a, b, apex) : add_triangle(shape, b, a, apex);
  }
}

int cap_steps(int sides) { return std::max(2, sides / 4); }

/// Adds a half sphere onto an existing ring.
void add_round_cap(ShapeMesh& shape, const Ring& ring, std::uint32_t equator, double radius, int sides, const Color& color, bool ahead) {
  const int steps = cap_steps(sides);
  const double sign = ahead ? 1 : -1;
  std::uint32_t last = equator;
  for (int i = 1; i < steps; ++i) {
    const double latitude = 0.5 * kPi * i / steps, c = std::cos(latitude), s = sign * std::sin(latitude);
    const std::uint32_t next = add_ring(shape, ring, radius * c, radius * s, c, s, sides, color);
    ahead ? add_wall(shape, last, next, sides) : add_wall(shape, next, last, sides);
    last = next;
  }
  add_fan(shape, last, add_vertex(shape, ring.center + sign * radius * ring.tangent, sign * ring.tangent, color), sides, ahead);
}

struct ColoredPoint {
  Vec3 p;
  Color color;
};

/// Returns the points of a polyline without repeated points, and of a closed one without its repeated end.
std::vector<ColoredPoint> distinct_points(const TubeItem& tube, bool& closed) {
  CATENA_ASSERT(tube.colors.empty() || tube.colors.size() == tube.points.size());
  std::vector<ColoredPoint> points;
  points.reserve(tube.points.size());
  const double min_radius = 1e-9 * tube.radius;
  for (std::size_t i = 0; i < tube.points.size(); ++i) {
    const Vec3& p = tube.points[i];
    CATENA_ASSERT(is_finite(p));
    if (points.empty() || norm(p - points.back().p) > min_radius) points.push_back({p, tube.colors.empty() ? tube.color : tube.colors[i]});
  }
  closed = points.size() > 3 && norm(points.front().p - points.back().p) <= 1e-6 * tube.radius;
  if (closed) points.pop_back();
  return points;
}

/// Returns one ring per point, perpendicular to the mean of its two segments; a sharp corner gets several, from one direction to the other.
std::vector<Ring> rings_of(const std::vector<ColoredPoint>& points, bool closed) {
  const std::size_t n = points.size();
  std::vector<Ring> rings;
  rings.reserve(n);
  const auto segment = [&](std::size_t i) { return direction(points[(i + 1) % n].p - points[i % n].p); };
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [p, color] = points[i];
    const bool first = !closed && i == 0, last = !closed && i + 1 == n;
    const Vec3 before = first ? segment(0) : segment(i + n - 1), after = last ? before : segment(i);
    const double turn = std::atan2(norm(cross(before, after)), dot(before, after));
    if (turn <= kMaxJointTurn) {
      rings.push_back({p, direction(before + after), Vec3(0.0), color, 0, 0});
      continue;
    }
    Vec3 axis = direction(cross(before, after));
    if (max_abs(axis) == 0) axis = any_perpendicular(before);
    const int steps = static_cast<int>(std::ceil(turn / kMaxJointTurn));
    for (int k = 0; k <= steps; ++k) rings.push_back({p, direction(rotate_about(before, axis, turn * k / steps)), Vec3(0.0), color, 0, 0});
  }
  return rings;
}

/// Returns rings with normals, by parallel transport from ring to ring.
std::vector<Ring> framed_rings(const std::vector<ColoredPoint>& points, bool closed) {
  std::vector<Ring> rings = rings_of(points, closed);
  rings.front().normal = any_perpendicular(rings.front().tangent);
  for (std::size_t i = 1; i < rings.size(); ++i) rings[i].normal = transport(rings[i - 1].normal, rings[i - 1].tangent, rings[i].tangent);
  if (!closed) return rings;
  // parallel transport around a closed line rotates the normal; the difference is distributed over the rings
  const Ring &a = rings.front(), &b = rings.back();
  const Vec3 back = transport(b.normal, b.tangent, a.tangent);
  const double angle = std::atan2(dot(cross(back, a.normal), a.tangent), dot(back, a.normal));
  const double count = static_cast<double>(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i)
    rings[i].normal = rotate_about(rings[i].normal, rings[i].tangent, angle * static_cast<double>(i) / count);
  return rings;
}

}  // namespace

void assign_object(ShapeMesh& shape, std::size_t first, std::uint32_t id, bool clipped) {
  for (std::size_t i = first; i < shape.vertices.size(); ++i) shape.vertices[i].id = id | (clipped ? 0u : UNCLIPPED);
}

int tube_sides(double radius, double pixel) {
  if (!(radius > 0) || !(pixel > 0)) return 16;
  const double pixels = radius / pixel;
  return pixels < 3 ? 0 : pixels < 6 ? 12 : 16;
}

std::vector<TubeRing> tube_rings(const TubeItem& tube, bool& closed) {
  closed = false;
  if (!(tube.radius > 0) || !std::isfinite(tube.radius)) return {};
  const std::vector<ColoredPoint> points = distinct_points(tube, closed);
  if (points.empty()) return {};
  std::vector<TubeRing> wall;
  if (points.size() == 1)
    wall = {{points.front().p, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, points.front().color, 0, 0}};
  else
    wall = framed_rings(points, closed);
  for (TubeRing& ring : wall) ring.radius = tube.radius;
  if (closed) {
    wall.push_back(wall.front());
    return wall;
  }
  // rings of a half sphere, from its equator or to it
  constexpr int steps = 3;
  const auto latitude = [&](TubeRing ring, int i, double sign) {
    const double angle = 0.5 * kPi * i / steps;
    ring.center += sign * tube.radius * std::sin(angle) * ring.tangent;
    ring.radius = i == steps ? 0 : tube.radius * std::cos(angle);
    ring.normal_tilt = i == steps ? sign : sign * std::sin(angle);
    return ring;
  };
  std::vector<TubeRing> rings;
  rings.reserve(wall.size() + 2 * static_cast<std::size_t>(steps));
  for (int i = steps; i > 0; --i) rings.push_back(latitude(wall.front(), i, -1));
  rings.insert(rings.end(), wall.begin(), wall.end());
  for (int i = 1; i <= steps; ++i) rings.push_back(latitude(wall.back(), i, 1));
  return rings;
}

void add_tube(ShapeMesh& shape, const TubeItem& tube, int sides) {
  CATENA_ASSERT(sides >= 3);
  if (!(tube.radius > 0) || !std::isfinite(tube.radius)) return;
  bool closed = false;
  const std::vector<ColoredPoint> points = distinct_points(tube, closed);
  if (points.empty()) return;
  if (points.size() == 1) return add_sphere(shape, points.front().p, tube.radius, points.front().color, std::max(8, sides));
  const std::vector<Ring> rings = framed_rings(points, closed);

  std::uint32_t first = 0, last = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const std::uint32_t ring = add_ring(shape, rings[i], tube.radius, 0, 1, 0, sides, rings[i].color);
    if (i == 0) first = ring;
    if (i > 0) add_wall(shape, last, ring, sides);
    last = ring;
  }
  if (closed) return add_wall(shape, last, first, sides);
  add_round_cap(shape, rings.front(), first, tube.radius, sides, rings.front().color, false);
  add_round_cap(shape, rings.back(), last, tube.radius, sides, rings.back().color, true);
}

void add_mesh(ShapeMesh& shape, const MeshItem& mesh) {
  CATENA_ASSERT(mesh.geometry != nullptr && mesh.geometry->triangles.size() % 3 == 0);
  const MeshGeometry& geometry = *mesh.geometry;
  const std::vector<std::uint32_t>& triangles = geometry.triangles;
  CATENA_ASSERT(!mesh.smooth || geometry.normals.size() == geometry.vertices.size());
  CATENA_ASSERT(geometry.colors.empty() || geometry.colors.size() == geometry.vertices.size());
  shape.vertices.reserve(shape.vertices.size() + triangles.size());
  shape.triangles.reserve(shape.triangles.size() + triangles.size());
  const std::size_t start = shape.vertices.size();
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) -> const Vec3& { return geometry.vertices[triangles[i + k]]; };
    const Vec3 normal = direction(cross(direction(corner(1) - corner(0)), direction(corner(2) - corner(0))));
    if (max_abs(normal) == 0) continue;
    const auto first = static_cast<std::uint32_t>(shape.vertices.size());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangles[i + k];
      add_vertex(shape, corner(k), mesh.smooth ? geometry.normals[v] : normal, geometry.colors.empty() ? mesh.color : geometry.colors[v]);
    }
    add_triangle(shape, first, first + 1, first + 2);
  }
  assign_object(shape, start, mesh.id, mesh.is_clipped);
  if (!mesh.show_edges) return;
  for (std::size_t i = start; i < shape.vertices.size(); ++i)
    shape.vertices[i].id |= static_cast<std::uint32_t>(1 + (i - start) % 3) << CORNER_SHIFT;
}

void add_sphere(ShapeMesh& shape, const Vec3& centre, double radius, const Color& color, int sides) {
  CATENA_ASSERT(is_finite(centre) && sides >= 4);
  if (!(radius > 0) || !std::isfinite(radius)) return;
  const Ring ring{centre, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, color, radius, 0};
  const std::uint32_t equator = add_ring(shape, ring, radius, 0, 1, 0, sides, color);
  add_round_cap(shape, ring, equator, radius, sides, color, false);
  add_round_cap(shape, ring, equator, radius, sides, color, true);
}

void add_cylinder(ShapeMesh& shape, const Vec3& a, const Vec3& b, double radius, const Color& color, int sides) {
  CATENA_ASSERT(is_finite(a) && is_finite(b) && sides >= 3);
  const double length = norm(b - a);
  if (!(length > 0) || !(radius > 0)) return;
  const Vec3 t = direction(b - a);
  const Ring ring{a, t, any_perpendicular(t), color, radius, 0};
  add_wall(shape, add_ring(shape, ring, radius, 0, 1, 0, sides, color), add_ring(shape, ring, radius, length, 1, 0, sides, color), sides);
  add_fan(shape, add_ring(shape, ring, radius, 0, 0, -1, sides, color), add_vertex(shape, a, -t, color), sides, false);
  add_fan(shape, add_ring(shape, ring, radius, length, 0, 1, sides, color), add_vertex(shape, b, t, color), sides, true);
}

void add_cone(ShapeMesh& shape, const Vec3& base, const Vec3& tip, double radius, const Color& color, int sides) {
  CATENA_ASSERT(is_finite(base) && is_finite(tip) && sides >= 3);
  const double length = norm(tip - base);
  if (!(length > 0) || !(radius > 0)) return;
  const Vec3 t = direction(tip - base);
  const Ring ring{base, t, any_perpendicular(t), color, radius, 0};
  const double slant = std::sqrt(length * length + radius * radius), across = length / slant, along = radius / slant;

  // the side repeats the tip for each facet, because each facet has its own normal there
  const std::uint32_t side = add_ring(shape, ring, radius, 0, across, along, sides, color), n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t l = side + (k + 1) % n;
    const Vec3 normal = direction(shape.vertices[side + k].normal + shape.vertices[l].normal);
    add_triangle(shape, side + k, l, add_vertex(shape, tip, normal, color));
  }
  add_fan(shape, add_ring(shape, ring, radius, 0, 0, -1, sides, color), add_vertex(shape, base, -t, color), sides, false);
}

namespace {
/// Adds three perpendicular rings, visible from any side.
void add_rings(ShapeMesh& shape, const CursorPart& rings) {
  constexpr int steps = 32;
  for (int axis = 0; axis < 3; ++axis) {
    TubeItem ring{{}, rings.thickness, rings.color, {}};
    for (int k = 0; k <= steps; ++k) {
      const double angle = 2 * kPi * (k % steps) / steps;
      Vec3 p(0.0);
      p[(axis + 1) % 3] = rings.radius * std::cos(angle);
      p[(axis + 2) % 3] = rings.radius * std::sin(angle);
      ring.points.push_back(rings.from + p);
    }
    add_tube(shape, ring, 8);
  }
}

}  // namespace

void add_cursor(ShapeMesh& shape, const CursorItem& cursor) {
  for (const CursorPart& part : cursor_parts(cursor)) switch (part.kind) {
      case CursorPart::Kind::sphere:
        add_sphere(shape, part.from, part.radius, part.color);
        break;
      case CursorPart::Kind::cylinder:
        add_cylinder(shape, part.from, part.to, part.radius, part.color);
        break;
      case CursorPart::Kind::cone:
        add_cone(shape, part.from, part.to, part.radius, part.color);
        break;
      case CursorPart::Kind::rings:
        add_rings(shape, part);
        break;
    }
}

}  // namespace catena::render
