// SPDX-License-Identifier: MIT
#include "render/extract/slice_texture.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"

namespace catena::render {
namespace {

constexpr double kStreakTexels = 2 * flow::kLicHalfLength;
constexpr double kStreaksAlongPlane = 25;  // number of default streak lengths along the longer edge

/// Cached texture of a slice.
struct SliceTexture {
  std::uint64_t field_version = 0;
  std::shared_ptr<const flow::LicTexture> texture;
  bool is_animated = false;
};

}  // namespace

std::optional<flow::LicPlane> lic_plane(const field::Field& domain, const Vec3& point, const Vec3& normal, double length) {
  flow::LicPlane plane;
  const Vec3 n = direction(normal), size = glm::abs(n);
  const Vec3 axis = size.x <= size.y && size.x <= size.z ? Vec3(1, 0, 0) : size.y <= size.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  plane.u = direction(axis - dot(axis, n) * n);
  plane.v = cross(n, plane.u);
  // the plane's polygon: intersections with the edges of the domain
  glm::dvec2 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (int a = 0; a < 8; ++a)
    for (int bit = 1; bit < 8; bit *= 2) {
      const int b = a | bit;
      if (a == b) continue;
      const Vec3 from = domain.corner(a), to = domain.corner(b);
      const double before = dot(n, from - point), after = dot(n, to - point);
      if ((before > 0) == (after > 0) && before != 0 && after != 0) continue;
      const Vec3 at = before == after ? from : from + (before / (before - after)) * (to - from);
      const glm::dvec2 place(dot(at, plane.u), dot(at, plane.v));
      lo = glm::min(lo, place);
      hi = glm::max(hi, place);
    }
  const double longer = std::max(hi.x - lo.x, hi.y - lo.y);
  if (!(longer > 0) || !std::isfinite(longer)) return std::nullopt;
  const double streak = length > 0 ? length : longer / kStreaksAlongPlane;
  plane.texel_size = std::clamp(streak / kStreakTexels, longer / (kMaxLicTexels - 2), longer);
  // texel k of the plane is at k texel sizes from the world's origin
  const auto first = [&](double at) { return static_cast<std::int64_t>(std::floor(at / plane.texel_size)); };
  const auto count = [&](double at, std::int64_t from) {
    return std::max(2, static_cast<int>(std::ceil(at / plane.texel_size - static_cast<double>(from))) + 1);
  };
  plane.first_u = first(lo.x);
  plane.first_v = first(lo.y);
  plane.width = count(hi.x, plane.first_u);
  plane.height = count(hi.y, plane.first_v);
  plane.origin = dot(point, n) * n + (plane.texel_size * static_cast<double>(plane.first_u)) * plane.u +
                 (plane.texel_size * static_cast<double>(plane.first_v)) * plane.v;
  return plane;
}

Outcome prepare_slice_texture(scene::Scene& scene, scene::Entity e, const field::Field& domain) {
  const scene::Slice slice = scene.entities.get<scene::Slice>(e);
  if (!slice.flow_texture) return Done{};
  const json::Node& where = json::member_or_parent(slice.flow_texture->where, "field");
  CATENA_TRY(const field::AnyField any, scene::resolve_field(scene, slice.flow_texture->field, where));
  if (!any.vector)
    return json::error_at(where, in_quotes(scene.entities.get<scene::Name>(slice.flow_texture->field).value) +
                                     " is a scalar field; a vector field was expected for line integral convolution");
  if (!scene.cache.has<SliceTexture>(e)) scene.cache.emplace<SliceTexture>(e);
  SliceTexture& made = scene.cache.get<SliceTexture>(e);
  const auto plane = lic_plane(domain, slice.point, slice.normal, slice.flow_texture->length);
  if (!plane) {
    made = {};
    return Done{};
  }
  const bool same = made.texture && made.field_version == any.vector->version() && made.texture->plane == *plane;
  if (same && made.is_animated == slice.flow_texture->is_animated) return Done{};
  made = {any.vector->version(), flow::compute_lic(*any.vector, *plane, slice.flow_texture->is_animated), slice.flow_texture->is_animated};
  return Done{};
}

std::shared_ptr<const flow::LicTexture> slice_texture(const scene::Scene& scene, scene::Entity e) {
  return scene.cache.has<SliceTexture>(e) ? scene.cache.get<SliceTexture>(e).texture : nullptr;
}

}  // namespace catena::render
