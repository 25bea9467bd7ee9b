// SPDX-License-Identifier: MIT
// Intersection of a ray with the opaque items of a packet.
#include <cmath>

#include "engine/app/viewer/input/pick.h"
#include "engine/app/viewer/input/ray_span.h"
#include "engine/field/grid/grid.h"

namespace catena::app {

namespace {

constexpr int kMaxSolidSteps = 8000, kBisections = 48;

/// The nearest hit found so far.
struct Nearest {
  const render::Ray& ray;
  double t;
  std::uint32_t id = 0;

  Vec3 at(double s) const { return ray.origin + s * ray.direction; }
  void offer(double s, std::uint32_t of) {
    if (!(s >= 0) || !(s < t)) return;
    t = s;
    id = of;
  }
};

RaySpan kept(const render::FramePacket& packet, bool clipped, const render::Ray& ray, RaySpan span) {
  if (clipped)
    for (const Plane& plane : packet.clip_planes) clip_to_plane(span, ray, plane);
  return span;
}

void meet(Nearest& nearest, const render::IsosurfaceItem& item, RaySpan span) {
  span.exit = std::min(span.exit, nearest.t);
  if (span.is_empty()) return;
  field::Cursor cursor;
  const auto over = [&](double t) {
    const field::ScalarSample s = item.grid->sample(nearest.at(t), cursor);
    return s.inside ? s.value - item.level : std::nan("");
  };
  const double step = std::max(0.5 * item.grid->mapping().min_voxel_edge(), (span.exit - span.enter) / kMaxSolidSteps);
  double before = over(span.enter);
  for (double t = span.enter; t < span.exit;) {
    const double next = std::min(t + step, span.exit), now = over(next);
    if (std::isfinite(before) && std::isfinite(now) && (before < 0) != (now < 0)) {
      double lo = t, hi = next;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (lo + hi);
        ((over(middle) < 0) == (before < 0) ? lo : hi) = middle;
      }
      return nearest.offer(hi, item.id);
    }
    before = now;
    t = next;
  }
}

void meet(Nearest& nearest, const render::SliceItem& item, const RaySpan& span) {
  const double rate = dot(item.normal, nearest.ray.direction);
  if (rate == 0) return;
  const double t = dot(item.normal, item.point - nearest.ray.origin) / rate;
  if (!(t >= span.enter && t <= span.exit)) return;
  field::Cursor cursor;
  if (item.grid->sample(nearest.at(t), cursor).inside) nearest.offer(t, item.id);
}

/// T. Moeller, B. Trumbore, "Fast, minimum storage ray-triangle intersection", J. Graphics Tools 2 (1997), both sides.
void meet(Nearest& nearest, const render::MeshItem& item, const RaySpan& span) {
  const std::vector<Vec3>& places = item.geometry->vertices;
  const std::vector<std::uint32_t>& corners = item.geometry->triangles;
  const Vec3 d = nearest.ray.direction;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3 &a = places[corners[i]], ab = places[corners[i + 1]] - a, ac = places[corners[i + 2]] - a;
    const Vec3 p = cross(d, ac);
    const double det = dot(ab, p);
    if (det == 0) continue;
    const Vec3 from = nearest.ray.origin - a;
    const double u = dot(from, p) / det;
    if (!(u >= 0 && u <= 1)) continue;
    const Vec3 q = cross(from, ab);
    const double v = dot(d, q) / det;
    if (!(v >= 0 && u + v <= 1)) continue;
    const double t = dot(ac, q) / det;
    if (t >= span.enter && t <= span.exit) nearest.offer(t, item.id);
  }
}

/// Intersects the infinite cylinder, accepted where the ray enters it between the segment's ends (or within a radius of them).
void meet_piece(Nearest& nearest, const Vec3& a, const Vec3& b, double radius, std::uint32_t id, const RaySpan& span) {
  const Vec3 d = nearest.ray.direction, along = b - a, from = nearest.ray.origin - a;
  const double length2 = dot(along, along);
  if (!(length2 > 0)) return;
  // components perpendicular to the segment
  const Vec3 across = d - dot(d, along) / length2 * along, start = from - dot(from, along) / length2 * along;
  const double aa = dot(across, across), ab = dot(across, start), c = dot(start, start) - radius * radius, root = ab * ab - aa * c;
  if (!(aa > 0) || !(root >= 0)) return;
  const double t = (-ab - std::sqrt(root)) / aa, share = dot(from + t * d, along) / length2, slack = radius / std::sqrt(length2);
  if (share >= -slack && share <= 1 + slack && t >= span.enter && t <= span.exit) nearest.offer(t, id);
}

void meet(Nearest& nearest, const render::TubeItem& item, const RaySpan& span) {
  for (std::size_t i = 0; i + 1 < item.points.size(); ++i)
    meet_piece(nearest, item.points[i], item.points[i + 1], item.radius, item.id, span);
}

/// Tests the shaft, and the head as a cylinder half as wide as its base.
void meet(Nearest& nearest, const render::GlyphItem& item, const RaySpan& span) {
  for (const render::Glyph& glyph : item.glyphs) {
    const double length = norm(glyph.tip - glyph.tail);
    const Vec3 neck = glyph.tip - item.head_length * (glyph.tip - glyph.tail);
    meet_piece(nearest, glyph.tail, neck, item.shaft_radius * length, item.id, span);
    meet_piece(nearest, neck, glyph.tip, 0.5 * item.head_radius * length, item.id, span);
  }
}

/// First intersection with each sphere, or the second where the clip planes cut the first away.
void meet(Nearest& nearest, const render::SpheresItem& item, const RaySpan& span) {
  const Vec3 d = nearest.ray.direction;
  const double dd = dot(d, d);
  for (std::size_t i = 0; i < item.spheres->offsets.size(); ++i) {
    const Vec3 from = nearest.ray.origin - Vec3(item.spheres->offsets[i]);
    const double r = item.spheres->radii[i], b = dot(d, from), root = b * b - dd * (dot(from, from) - r * r);
    if (!(root >= 0)) continue;
    for (const double t : {(-b - std::sqrt(root)) / dd, (-b + std::sqrt(root)) / dd}) {
      if (!(t >= span.enter && t <= span.exit)) continue;
      nearest.offer(t, item.id);
      break;
    }
  }
}

}  // namespace

std::optional<PickHit> pick_solid(const render::FramePacket& packet, const render::Ray& ray, double farthest) {
  Nearest nearest{ray, farthest};
  for (const render::IsosurfaceItem& item : packet.isosurfaces)
    meet(nearest, item, kept(packet, item.is_clipped, ray, domain_span(*item.grid, ray)));
  for (const render::SliceItem& item : packet.slices) meet(nearest, item, kept(packet, item.is_clipped, ray, domain_span(*item.grid, ray)));
  for (const render::MeshItem& item : packet.meshes) meet(nearest, item, kept(packet, item.is_clipped, ray, {}));
  for (const render::TubeItem& item : packet.tubes) meet(nearest, item, kept(packet, item.is_clipped, ray, {}));
  for (const render::GlyphItem& item : packet.glyphs) meet(nearest, item, kept(packet, item.is_clipped, ray, {}));
  for (const render::SpheresItem& item : packet.spheres) meet(nearest, item, kept(packet, item.is_clipped, ray, {}));
  if (nearest.id == 0) return std::nullopt;
  return PickHit{nearest.at(nearest.t), nearest.id, false};
}

}  // namespace catena::app
