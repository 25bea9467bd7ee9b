// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::mesh {

namespace {

std::atomic<std::uint64_t> next_version{1};

constexpr double kSmallest = 1e-100, kLargest = 1e100;

/// Merges vertices with equal coordinates (-0 equals 0).
void weld(TriangleSoup& soup) {
  for (Vec3& v : soup.vertices) v = v + Vec3(0.0);
  std::vector<std::uint32_t> order(soup.vertices.size()), renamed(soup.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto is_less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &u = soup.vertices[a], &v = soup.vertices[b];
    return u.x != v.x ? u.x < v.x : u.y != v.y ? u.y < v.y : u.z != v.z ? u.z < v.z : a < b;
  };
  std::sort(order.begin(), order.end(), is_less);
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || soup.vertices[order[i]] != soup.vertices[first]) first = order[i];
    renamed[order[i]] = first;
  }
  for (Triangle& t : soup.triangles)
    for (std::uint32_t& v : t) v = renamed[v];
}

/// Returns the triangle's smallest height: twice the area divided by the longest edge.
double height_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = c - b;
  const double longest = std::sqrt(std::max({dot(u, u), dot(v, v), dot(w, w)}));
  return longest > 0 ? norm(cross(u, v)) / longest : 0;
}

/// Removes vertices that no triangle uses; the others keep their order.
void compact(std::vector<Vec3>& vertices, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> renamed(vertices.size(), 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) renamed[v] = 1;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (renamed[i] == 0) continue;
    vertices[count] = vertices[i];
    renamed[i] = count++;
  }
  vertices.resize(count);
  vertices.shrink_to_fit();
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v = renamed[v];
}

double bytes_of_soup(const TriangleSoup& soup) {
  return static_cast<double>(soup.vertices.capacity() * sizeof(Vec3) + soup.triangles.capacity() * sizeof(Triangle));
}

/// Returns the bytes that welding needs besides the soup: two lists of vertices, then the remaining triangles.
double bytes_to_weld(const TriangleSoup& soup) {
  return static_cast<double>(2 * soup.vertices.size() * sizeof(std::uint32_t) + soup.triangles.size() * sizeof(Triangle));
}

/// Returns the bytes that a mesh needs besides the soup and the memory for welding: the vertices in the local frame, their normals, faces
/// and boundary flags; the faces with their neighbors; the hierarchy (a node for every two faces); and the larger of the temporary memory
/// for building it (boxes, centers, orders) and for finding edges.
double bytes_to_build(std::size_t vertices, std::size_t triangles) {
  constexpr double kVertex = 2 * sizeof(Vec3) + 2 * sizeof(std::uint32_t) + 1;
  constexpr double kHierarchy = sizeof(BvhNode) / 2.0, kBoxes = sizeof(FaceBox) + sizeof(Vec3) + 2 * sizeof(std::uint32_t), kEdges = 3 * 20;
  constexpr double kTriangle = 2 * sizeof(Triangle) + sizeof(Face) + 3 * sizeof(std::uint32_t) + kHierarchy + kBoxes + kEdges;
  return static_cast<double>(vertices) * kVertex + static_cast<double>(triangles) * kTriangle;
}

/// A mesh and its reserved bytes.
struct HeldMesh {
  TriangleMesh mesh;
  MemoryReservation memory;
};

}  // namespace

Result<MeshPtr> make_mesh(TriangleSoup soup, const std::string& name) {
  const auto failed = [&](const std::string& what) { return Error{one_line(name + ": " + what)}; };
  for (const Triangle& t : soup.triangles)
    for (const std::uint32_t v : t)
      if (v >= soup.vertices.size()) return failed("a triangle refers to a vertex that does not exist; a complete mesh was expected");
  for (const Vec3& v : soup.vertices)
    if (!is_finite(v)) return failed("a vertex is not finite; finite numbers were expected");
  const auto owner = std::make_shared<HeldMesh>();
  TriangleMesh* const self = &owner->mesh;
  self->name_ = name;
  self->version_ = next_version.fetch_add(1);

  // bounding box of the used vertices, and the exact scale
  Vec3 lo(INFINITY), hi(-INFINITY);
  for (const Triangle& t : soup.triangles)
    for (const std::uint32_t i : t) {
      const Vec3& v = soup.vertices[i];
      lo = {std::min(lo.x, v.x), std::min(lo.y, v.y), std::min(lo.z, v.z)};
      hi = {std::max(hi.x, v.x), std::max(hi.y, v.y), std::max(hi.z, v.z)};
    }
  if (soup.triangles.empty()) return failed("contains no triangles; at least one was expected");
  const double length = max_abs(hi * 0.5 - lo * 0.5) * 2;
  if (length <= kLargest && !(max_abs(hi) <= kLargest && max_abs(lo) <= kLargest))
    return failed("has a coordinate of magnitude " + to_text(std::max(max_abs(hi), max_abs(lo))) + "; at most 1e100 was expected");
  if (!(length >= kSmallest && length <= kLargest))
    return failed("has the size " + to_text(length) + "; a size from 1e-100 to 1e100 was expected");
  int exponent = 0;
  const double part = std::frexp(length, &exponent);
  self->scale_ = std::ldexp(1.0, part == 0.5 ? exponent - 1 : exponent);
  self->inverse_scale_ = 1 / self->scale_;
  // center rounded to few digits, so that differences with float coordinates are exact
  for (int i = 0; i < 3; ++i) {
    const double step = self->scale_ / 64;
    self->center_[i] = std::round((0.5 * (lo[i] + hi[i])) / step) * step;
  }

  // weld vertices, drop degenerate triangles
  const std::string what = one_line(name + ": a mesh of " + std::to_string(soup.triangles.size()) + " triangles");
  CATENA_CHECK(check_text_memory_available(what, bytes_of_soup(soup) + bytes_to_weld(soup)));
  weld(soup);
  std::vector<Triangle> triangles;
  triangles.reserve(soup.triangles.size());
  for (const Triangle& t : soup.triangles) {
    const bool distinct = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    const double height = height_of(self->local_from_world(soup.vertices[t[0]]), self->local_from_world(soup.vertices[t[1]]),
                                    self->local_from_world(soup.vertices[t[2]]));
    if (distinct && height > kMinTriangleHeight) triangles.push_back(t);
  }
  self->dropped_triangles_ = soup.triangles.size() - triangles.size();
  if (triangles.empty())
    return failed("all " + std::to_string(self->dropped_triangles_) + " triangles have zero area; a surface was expected");
  compact(soup.vertices, triangles);
  soup.triangles = {};
  CATENA_CHECK(check_text_memory_available(what, bytes_of_soup(soup) + static_cast<double>(triangles.capacity() * sizeof(Triangle)) +
                                                     bytes_to_build(soup.vertices.size(), triangles.size())));
  self->vertices_ = std::move(soup.vertices);
  self->min_corner_ = Vec3(INFINITY);
  self->max_corner_ = Vec3(-INFINITY);
  self->local_vertices_.reserve(self->vertices_.size());
  for (const Vec3& v : self->vertices_) {
    self->min_corner_ = {std::min(self->min_corner_.x, v.x), std::min(self->min_corner_.y, v.y), std::min(self->min_corner_.z, v.z)};
    self->max_corner_ = {std::max(self->max_corner_.x, v.x), std::max(self->max_corner_.y, v.y), std::max(self->max_corner_.z, v.z)};
    self->local_vertices_.push_back(self->local_from_world(v));
  }
  self->domain_length_ = max_abs(self->max_corner_ - self->min_corner_);

  // build the hierarchy, which determines the order of the faces
  std::vector<FaceBox> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Vec3 &a = self->local_vertices_[t[0]], &b = self->local_vertices_[t[1]], &c = self->local_vertices_[t[2]];
    boxes.push_back({{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
                     {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}});
  }
  std::vector<std::uint32_t> order;
  self->bvh_.build(boxes, order);
  self->triangles_.reserve(triangles.size());
  for (const std::uint32_t f : order) self->triangles_.push_back(triangles[f]);
  self->compute_faces();
  self->build_adjacency();
  owner->memory = MemoryReservation(self->bytes());
  return MeshPtr(owner, self);
}

void TriangleMesh::compute_faces() {
  faces_.resize(triangles_.size());
  vertex_normals_.assign(vertices_.size(), Vec3(0.0));
  for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
    Face& face = faces_[f];
    const std::array<Vec3, 3> v{corner(f, 0), corner(f, 1), corner(f, 2)};
    face.normal = direction(cross(v[1] - v[0], v[2] - v[0]));
    face.offset = (dot(face.normal, v[0]) + dot(face.normal, v[1]) + dot(face.normal, v[2])) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = v[k], &b = v[(k + 1) % 3], &c = v[(k + 2) % 3];
      face.edge_normal[k] = direction(cross(face.normal, b - a));
      face.edge_offset[k] = 0.5 * (dot(face.edge_normal[k], a) + dot(face.edge_normal[k], b));
      const Vec3 u = direction(b - a), w = direction(c - a);
      vertex_normals_[triangles_[f][k]] += std::atan2(norm(cross(u, w)), dot(u, w)) * face.normal;
    }
  }
  for (Vec3& n : vertex_normals_) n = direction(n);
}

void TriangleMesh::build_adjacency() {
  struct Edge {
    std::uint32_t a, b, face;
    std::uint8_t k;
    bool forward;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles_.size());
  for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles_[f][k], b = triangles_[f][(k + 1u) % 3u];
      edges.push_back({std::min(a, b), std::max(a, b), f, k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return x.a != y.a ? x.a < y.a : x.b != y.b ? x.b < y.b : x.face != y.face ? x.face < y.face : x.k < y.k;
  });
  adjacent_faces_.resize(triangles_.size());
  is_boundary_.assign(vertices_.size(), 0);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b) ++end;
    for (std::size_t j = i; j < end; ++j) adjacent_faces_[edges[j].face][edges[j].k] = edges[j + 1 < end ? j + 1 : i].face;
    if (end - i == 1) is_boundary_[edges[i].a] = is_boundary_[edges[i].b] = 1;
    open_edges_ += end - i == 1 ? 1 : 0;
    non_manifold_edges_ += end - i > 2 ? 1 : 0;
    misoriented_edges_ += end - i == 2 && edges[i].forward == edges[i + 1].forward ? 1 : 0;
    i = end;
  }

  // faces around each vertex
  vertex_face_offsets_.assign(vertices_.size() + 1, 0);
  for (const Triangle& t : triangles_)
    for (const std::uint32_t v : t) ++vertex_face_offsets_[v + 1];
  std::partial_sum(vertex_face_offsets_.begin(), vertex_face_offsets_.end(), vertex_face_offsets_.begin());
  vertex_faces_.resize(3 * triangles_.size());
  std::vector<std::uint32_t> next(vertex_face_offsets_.begin(), vertex_face_offsets_.end() - 1);
  for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    for (const std::uint32_t v : triangles_[f]) vertex_faces_[next[v]++] = f;
}

std::size_t TriangleMesh::bytes() const {
  const auto of = [](const auto& list) { return list.size() * sizeof(list[0]); };
  return of(vertices_) + of(local_vertices_) + of(vertex_normals_) + of(triangles_) + of(adjacent_faces_) + of(faces_) + of(vertex_faces_) +
         of(vertex_face_offsets_) + of(is_boundary_) + bvh_.bytes();
}

ClosestPoint closest_point_on_face(const TriangleMesh& mesh, std::uint32_t f, const Vec3& p) noexcept {
  const Face& face = mesh.face(f);
  ClosestPoint best;
  best.face = f;
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (dot(face.edge_normal[at], p) - face.edge_offset[at] >= 0) continue;
    const Vec3 &a = mesh.corner(f, k), &b = mesh.corner(f, (k + 1) % 3);
    const Vec3 edge = b - a;
    const double part = dot(p - a, edge) / dot(edge, edge);
    ClosestPoint c;
    c.face = f;
    c.edge = static_cast<std::int8_t>(k);
    if (part <= 0) {
      c.point = a;
      c.corner = c.edge;
    } else if (part >= 1) {
      c.point = b;
      c.corner = static_cast<std::int8_t>((k + 1) % 3);
    } else {
      c.point = part < 0.5 ? a + part * edge : b - (1 - part) * edge;
    }
    c.distance2 = dot(p - c.point, p - c.point);
    if (inside || c.distance2 < best.distance2) best = c;
    inside = false;
  }
  if (!inside) return best;
  best.point = p - face.normal * face.signed_distance(p);
  best.point -= face.normal * face.signed_distance(best.point);
  best.distance2 = dot(p - best.point, p - best.point);
  return best;
}

NearestResult nearest_point(const TriangleMesh& mesh, const Vec3& p, double radius, int& budget, std::uint32_t hint) noexcept {
  NearestResult out;
  double bound2 = radius * radius;
  const auto update_closest = [&](std::uint32_t f) {
    const ClosestPoint c = closest_point_on_face(mesh, f, p);
    if (c.distance2 < bound2 || (!out.found && c.distance2 <= bound2)) {
      bound2 = c.distance2;
      out.closest = c;
      out.found = true;
    }
  };
  update_closest(hint);
  out.is_complete = mesh.bvh().visit_nearest(p, bound2, budget, update_closest);
  return out;
}

Vec3 normal_at(const TriangleMesh& mesh, const ClosestPoint& at) noexcept {
  if (at.corner >= 0) return mesh.vertex_normal(mesh.triangles()[at.face][static_cast<std::size_t>(at.corner)]);
  Vec3 sum = mesh.face(at.face).normal;
  if (at.edge < 0) return sum;
  for_each_adjacent_face(mesh, at.face, at.edge, [&](std::uint32_t f) { sum += mesh.face(f).normal; });
  return sum;
}

bool is_on_boundary(const TriangleMesh& mesh, const ClosestPoint& at) noexcept {
  if (at.corner >= 0) return mesh.is_boundary_vertex(mesh.triangles()[at.face][static_cast<std::size_t>(at.corner)]);
  return at.edge >= 0 && mesh.adjacent_face(at.face, at.edge) == at.face;
}

}  // namespace catena::mesh
