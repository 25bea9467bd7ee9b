// SPDX-License-Identifier: MIT
#include "render/extract/clipped_away.h"

#include <glm/matrix.hpp>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::render {

// A bounded intersection of half spaces is empty exactly if none of the points in which three of the boundaries meet lies in all of them.
// With at most 6 + kMaxClipPlanes boundaries there are 364 such points.
bool has_common_point(const Bounds& box, std::span<const Plane> planes) {
  if (box.empty()) return false;
  std::vector<Plane> sides;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 inward(0.0);
    inward[axis] = 1;
    sides.push_back({box.lo, inward});
    sides.push_back({box.hi, -inward});
  }
  for (const Plane& plane : planes) sides.push_back({plane.point, direction(plane.normal)});
  const double slack = 1e-9 * box.diagonal();
  const auto is_inside = [&](const Vec3& p) {
    return std::ranges::all_of(sides, [&](const Plane& side) { return dot(p - side.point, side.normal) >= -slack; });
  };
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = i + 1; j < sides.size(); ++j)
      for (std::size_t k = j + 1; k < sides.size(); ++k) {
        const Plane &a = sides[i], &b = sides[j], &c = sides[k];
        const Mat3 normals = glm::transpose(Mat3(a.normal, b.normal, c.normal));
        if (std::fabs(glm::determinant(normals)) < 1e-12) continue;
        const Vec3 at = glm::inverse(normals) * Vec3(dot(a.point, a.normal), dot(b.point, b.normal), dot(c.point, c.normal));
        if (is_inside(at)) return true;
      }
  return false;
}

bool is_clipped_away(const FramePacket& packet) {
  if (packet.clip_planes.empty()) return false;
  bool has_data = false, is_visible = false;
  const auto add = [&](bool is_clipped, const Bounds& bounds) {
    if (bounds.empty() || is_visible) return;
    has_data = true;
    is_visible = !is_clipped || has_common_point(bounds, packet.clip_planes);
  };
  const auto points = [&](bool is_clipped, const auto& positions) {
    Bounds bounds;
    for (const Vec3& p : positions) bounds.extend(p);
    add(is_clipped, bounds);
  };
  for (const VolumeItem& item : packet.volumes) add(item.is_clipped, item.grid->world_bounds());
  for (const IsosurfaceItem& item : packet.isosurfaces) add(item.is_clipped, item.grid->world_bounds());
  for (const SliceItem& item : packet.slices) add(item.is_clipped, item.grid->world_bounds());
  for (const MeshItem& item : packet.meshes) points(item.is_clipped, item.geometry->vertices);
  for (const TubeItem& item : packet.tubes) points(item.is_clipped, item.points);
  for (const GlyphItem& item : packet.glyphs) {
    Bounds bounds;
    for (const Glyph& glyph : item.glyphs) bounds.extend(glyph.tail);
    add(item.is_clipped, bounds);
  }
  for (const SpheresItem& item : packet.spheres) {
    Bounds bounds;
    for (std::size_t i = 0; i < item.spheres->offsets.size(); ++i) bounds.extend(item.spheres->position(i));
    add(item.is_clipped, bounds);
  }
  return has_data && !is_visible;
}

}  // namespace catena::render
