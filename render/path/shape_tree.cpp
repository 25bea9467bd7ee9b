// SPDX-License-Identifier: MIT
#include "render/path/shape_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace catena::render {
namespace {

constexpr std::uint32_t kLeafShapes = 4;
constexpr int kMaxDepth = 60;
constexpr double kStartShare = 1e-6, kStartRadius = 1e-4;  // distance of new rays: of the shape's coordinates, of its radius

struct Box {
  glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};
  void extend(const glm::vec3& p, float radius = 0) {
    lo = glm::min(lo, p - radius);
    hi = glm::max(hi, p + radius);
  }
};

Box box_of(const PathShape& shape) {
  Box box;
  box.extend(shape.a, shape.radius);
  box.extend(shape.b, shape.radius);
  if (shape.kind == PathShape::Kind::triangle) box.extend(shape.c);
  return box;
}

glm::vec3 middle_of(const PathShape& shape) {
  const Box box = box_of(shape);
  return 0.5f * box.lo + 0.5f * box.hi;
}

Color mix(const Color& a, const Color& b, double t) {
  const auto f = float(t);
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b)};
}

/// Distances at which a ray meets a shape, at most four, with normals.
struct Roots {
  std::array<double, 4> t{};
  std::array<Vec3, 4> normal{};
  std::array<double, 4> along{};  ///< 0 at a, 1 at b
  int count = 0;
  void add(double at, const Vec3& n, double f) {
    t[std::size_t(count)] = at, normal[std::size_t(count)] = n, along[std::size_t(count)] = f;
    ++count;
  }
};

void add_sphere(Roots& roots, const Vec3& center, double radius, const Vec3& o, const Vec3& d, double along, const auto& keeps) {
  const Vec3 off = o - center, across = off - dot(off, d) * d;
  const double root = radius * radius - dot(across, across);
  if (root < 0) return;
  for (const double side : {-1.0, 1.0}) {
    const double t = -dot(off, d) + side * std::sqrt(root);
    const Vec3 p = o + t * d;
    if (keeps(p)) roots.add(t, p - center, along);
  }
}

/// Round segment: the cylinder between its ends and the outer halves of the spheres around them.
Roots meet_segment(const PathShape& shape, const Vec3& o, const Vec3& d) {
  Roots roots;
  const Vec3 a(shape.a), axis = Vec3(shape.b) - a;
  const double length2 = dot(axis, axis), r = double(shape.radius);
  if (!(length2 > 0)) {
    add_sphere(roots, a, r, o, d, 0, [](const Vec3&) { return true; });
    return roots;
  }
  const Vec3 off = o - a;
  const double d_along = dot(d, axis) / length2, o_along = dot(off, axis) / length2;
  const Vec3 dp = d - d_along * axis, op = off - o_along * axis;
  const double dd = dot(dp, dp), nearest = dd > 0 ? -dot(dp, op) / dd : 0;
  const Vec3 gap = op + nearest * dp;
  if (const double root = r * r - dot(gap, gap); dd > 0 && root >= 0)
    for (const double side : {-1.0, 1.0}) {
      const double t = nearest + side * std::sqrt(root / dd), f = o_along + t * d_along;
      if (f >= 0 && f <= 1) roots.add(t, op + t * dp, f);
    }
  add_sphere(roots, a, r, o, d, 0, [&](const Vec3& p) { return roots.count < 4 && dot(p - a, axis) < 0; });
  const Vec3 b(shape.b);
  add_sphere(roots, b, r, o, d, 1, [&](const Vec3& p) { return roots.count < 4 && dot(p - b, axis) > 0; });
  return roots;
}

/// Cone with the disc of its base.
Roots meet_cone(const PathShape& shape, const Vec3& o, const Vec3& d) {
  Roots roots;
  const Vec3 base(shape.a), axis = Vec3(shape.b) - base;
  const double length2 = dot(axis, axis), r = double(shape.radius);
  if (!(length2 > 0)) return roots;
  const Vec3 off = o - base;
  const double df = dot(d, axis) / length2, of = dot(off, axis) / length2;
  const Vec3 dp = d - df * axis, op = off - of * axis;
  // |op + t dp| = r (1 - of - t df)
  const double qa = dot(dp, dp) - r * r * df * df, qb = dot(op, dp) + r * r * (1 - of) * df, qc = dot(op, op) - r * r * (1 - of) * (1 - of),
               root = qb * qb - qa * qc;
  if (qa != 0 && root >= 0)
    for (const double side : {-1.0, 1.0}) {
      const double t = (-qb + side * std::sqrt(root)) / qa, f = of + t * df;
      const Vec3 radial = op + t * dp;
      if (f >= 0 && f <= 1) roots.add(t, radial + r * norm(radial) / length2 * axis, f);
    }
  if (df != 0) {
    const double t = -of / df;
    const Vec3 p = op + t * dp;
    if (dot(p, p) <= r * r) roots.add(t, -axis, 0);
  }
  return roots;
}

}  // namespace

void ShapeTree::build() {
  nodes_.clear();
  if (shapes.empty()) return;
  nodes_.reserve(2 * shapes.size() / kLeafShapes + 2);
  nodes_.push_back({{}, {}, 0, std::uint32_t(shapes.size())});
  split(0, 0);
}

/// Splits a node at the middle of the longest edge around its shapes' centers, or in half.
void ShapeTree::split(std::uint32_t node, int depth) {
  const std::uint32_t first = nodes_[node].first, count = nodes_[node].count;
  Box box, middles;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Box one = box_of(shapes[i]);
    box.lo = glm::min(box.lo, one.lo);
    box.hi = glm::max(box.hi, one.hi);
    middles.extend(0.5f * one.lo + 0.5f * one.hi);
  }
  nodes_[node].lo = box.lo;
  nodes_[node].hi = box.hi;
  if (count <= kLeafShapes || depth >= kMaxDepth) return;
  const glm::vec3 size = middles.hi - middles.lo;
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const float cut = 0.5f * middles.lo[axis] + 0.5f * middles.hi[axis];
  const auto begin = shapes.begin() + first, end = begin + count;
  auto middle = std::partition(begin, end, [&](const PathShape& shape) { return middle_of(shape)[axis] < cut; });
  if (middle == begin || middle == end) middle = begin + count / 2;
  const auto left_count = std::uint32_t(middle - begin), left = std::uint32_t(nodes_.size());
  nodes_.push_back({{}, {}, first, left_count});
  nodes_.push_back({{}, {}, first + left_count, count - left_count});
  nodes_[node].first = left;
  nodes_[node].count = 0;
  split(left, depth + 1);
  split(left + 1, depth + 1);
}

SurfaceHit ShapeTree::intersect(const PathRay& ray, double from, double to, const std::vector<Plane>& planes) const {
  SurfaceHit hit;
  if (nodes_.empty()) return hit;
  PathRay local{ray.origin - origin, ray.direction};
  const Vec3 inverse = 1.0 / ray.direction;
  const auto enter = [&](const Node& node) {
    double near = from, far = std::min(to, hit.t);
    for (int a = 0; a < 3; ++a) {
      if (local.direction[a] == 0) {
        if (local.origin[a] < double(node.lo[a]) || local.origin[a] > double(node.hi[a])) return std::numeric_limits<double>::infinity();
        continue;
      }
      const double x = (double(node.lo[a]) - local.origin[a]) * inverse[a], y = (double(node.hi[a]) - local.origin[a]) * inverse[a];
      near = std::max(near, std::min(x, y));
      far = std::min(far, std::max(x, y));
    }
    return near <= far * (1 + 1e-12) ? near : std::numeric_limits<double>::infinity();
  };
  std::array<std::uint32_t, 2 * kMaxDepth + 2> stack{};
  int top = 0;
  stack[std::size_t(top++)] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[std::size_t(--top)]];
    if (!(enter(node) < std::numeric_limits<double>::infinity())) continue;
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) test(shapes[i], local, from, hit, planes);
      if (hit.t >= to) hit.t = std::numeric_limits<double>::infinity();
      continue;
    }
    const double left = enter(nodes_[node.first]), right = enter(nodes_[node.first + 1]);
    const std::uint32_t farther = left <= right ? node.first + 1 : node.first;
    stack[std::size_t(top++)] = farther;
    stack[std::size_t(top++)] = farther == node.first ? node.first + 1 : node.first;
  }
  return hit;
}

void ShapeTree::test(const PathShape& shape, const PathRay& ray, double from, SurfaceHit& hit, const std::vector<Plane>& planes) const {
  const ShapeItem& item = items[shape.item];
  const auto accepts = [&](double t) {
    if (!(t > from && t < hit.t)) return false;
    const Vec3 p = origin + ray.at(t);
    return !item.is_clipped || std::ranges::none_of(planes, [&](const Plane& plane) { return dot(p - plane.point, plane.normal) < 0; });
  };
  const auto take = [&](double t, const Vec3& normal, const Vec3& shading, const Color& color) {
    hit = {t, normal, shading, color, item.opacity, 0, false};
    hit.epsilon = kStartShare * (max_abs(Vec3(shape.a)) + max_abs(Vec3(shape.b))) + kStartRadius * double(shape.radius);
  };
  if (shape.kind == PathShape::Kind::triangle) {
    const Vec3 a(shape.a), e1 = Vec3(shape.b) - a, e2 = Vec3(shape.c) - a, p = cross(ray.direction, e2);
    const double determinant = dot(e1, p);
    if (determinant == 0) return;
    const Vec3 s = ray.origin - a, q = cross(s, e1);
    const double u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return;
    const double t = dot(e2, q) / determinant;
    if (!accepts(t)) return;
    const Vec3 flat = cross(e1, e2);
    Vec3 shading = flat;
    if (shape.normals != PathShape::kNone) {
      const glm::vec3* n = &normals[shape.normals];
      shading = (1 - u - v) * Vec3(n[0]) + u * Vec3(n[1]) + v * Vec3(n[2]);
    }
    Color color = item.color;
    if (shape.colors != PathShape::kNone) {
      const Color* c = &colors[shape.colors];
      const auto sum = [&](float x, float y, float z) { return float((1 - u - v) * double(x) + u * double(y) + v * double(z)); };
      color = {sum(c[0].r, c[1].r, c[2].r), sum(c[0].g, c[1].g, c[2].g), sum(c[0].b, c[1].b, c[2].b)};
    }
    return take(t, flat, shading, color);
  }
  const bool is_segment = shape.kind == PathShape::Kind::segment;
  const Roots roots = is_segment ? meet_segment(shape, ray.origin, ray.direction) : meet_cone(shape, ray.origin, ray.direction);
  for (std::size_t i = 0; i < std::size_t(roots.count); ++i) {
    if (!accepts(roots.t[i])) continue;
    Color color = item.color;
    if (shape.colors != PathShape::kNone)
      color = is_segment ? mix(colors[shape.colors], colors[shape.colors + 1], roots.along[i]) : colors[shape.colors];
    take(roots.t[i], roots.normal[i], roots.normal[i], color);
  }
}

}  // namespace catena::render
