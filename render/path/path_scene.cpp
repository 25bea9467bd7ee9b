// SPDX-License-Identifier: MIT
#include "render/path/path_scene.h"

#include <algorithm>
#include <cmath>

#include "render/frame/linear_color.h"

namespace catena::render {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFaceSlack = 1e-3;  // voxels; a slice in a face of the domain is drawn

Color to_color(const float* rgb) { return {rgb[0], rgb[1], rgb[2]}; }

template <std::size_t Columns>
PiecewiseCurve curve_of(const std::vector<std::array<double, Columns + 1>>& points) {
  return PiecewiseCurve(points, std::integral_constant<std::size_t, Columns>());
}

}  // namespace

Color PathScene::OtherColors::at(const Vec3& position, const Color& own) const {
  const glm::vec3 p(grid->to_index(position));
  for (int a = 0; a < 3; ++a)
    if (p[a] < 0 || p[a] > float(grid->size()[std::size_t(a)] - 1)) return own;
  float value = 0, rgb[3] = {};
  if (!grid->sample(p, value)) return own;
  if (source->is_categorical && (value == 0 || (!source->labels.empty() && !std::ranges::binary_search(source->labels, double(value)))))
    return own;
  colors.at(value, rgb);
  return to_color(rgb);
}

Result<std::shared_ptr<const DenseGrid>> PathScene::dense(const field::ScalarGrid& grid) {
  if (grid.interpolation() == field::Interpolation::cubic)
    return Error{"path tracing interpolates linearly; " + grid.name() + " is cubic, \"interpolation\": \"linear\" was expected"};
  auto& made = grids_[&grid];
  if (!made) made = DenseGrid::make(grid);
  return made;
}

Result<std::optional<PathScene::OtherColors>> PathScene::other_colors(const std::optional<ColorSource>& source) {
  std::optional<OtherColors> colors;
  if (!source) return colors;
  CATENA_TRY(auto grid, dense(*source->grid));
  colors.emplace(OtherColors{std::move(grid), curve_of<3>(source->colors), &*source});
  return colors;
}

Outcome PathScene::add_slice(const SliceItem& slice) {
  CATENA_TRY(auto grid, dense(*slice.grid));
  slices_.push_back({&slice, std::move(grid), curve_of<3>(slice.colors)});
  if (!slice.contour_levels.empty()) notes_.emplace_back("path tracing does not draw the contour lines of slices");
  return Done{};
}

void PathScene::add(const MeshItem& item) {
  if (!item.geometry) return;
  const MeshGeometry& mesh = *item.geometry;
  const auto owner = std::uint32_t(shapes_.items.size() - 1);
  const bool is_smooth = item.smooth && mesh.normals.size() == mesh.vertices.size();
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    PathShape shape;
    shape.item = owner;
    glm::vec3* corners[3] = {&shape.a, &shape.b, &shape.c};
    if (is_smooth) shape.normals = std::uint32_t(shapes_.normals.size());
    if (!mesh.colors.empty()) shape.colors = std::uint32_t(shapes_.colors.size());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i + k];
      *corners[k] = glm::vec3(mesh.vertices[vertex] - shapes_.origin);
      if (is_smooth) shapes_.normals.emplace_back(mesh.normals[vertex]);
      if (!mesh.colors.empty()) shapes_.colors.push_back(to_linear(mesh.colors[vertex]));
    }
    shapes_.shapes.push_back(shape);
  }
}

void PathScene::add(const TubeItem& item) {
  const std::vector<Vec3>& points = item.points.list();
  const std::vector<Color>& colors = item.colors.list();
  PathShape shape;
  shape.kind = PathShape::Kind::segment;
  shape.item = std::uint32_t(shapes_.items.size() - 1);
  shape.radius = float(item.radius);
  const bool has_colors = colors.size() == points.size();
  for (std::size_t i = 0; i < points.size() && (i + 1 < points.size() || i == 0); ++i) {
    const std::size_t next = std::min(i + 1, points.size() - 1);
    shape.a = glm::vec3(points[i] - shapes_.origin);
    shape.b = glm::vec3(points[next] - shapes_.origin);
    if (has_colors) {
      shape.colors = std::uint32_t(shapes_.colors.size());
      shapes_.colors.insert(shapes_.colors.end(), {to_linear(colors[i]), to_linear(colors[next])});
    }
    shapes_.shapes.push_back(shape);
  }
}

void PathScene::add(const ArrowItem& item) {
  PathShape shape;
  shape.kind = PathShape::Kind::cone;
  shape.item = std::uint32_t(shapes_.items.size() - 1);
  shape.a = glm::vec3(item.base - shapes_.origin);
  shape.b = glm::vec3(item.tip - shapes_.origin);
  shape.radius = float(item.radius);
  shapes_.shapes.push_back(shape);
}

void PathScene::add(const GlyphItem& item) {
  for (const Glyph& glyph : item.glyphs) {
    const Vec3 whole = glyph.tip - glyph.tail, neck = glyph.tip - item.head_length * whole;
    const double length = norm(whole);
    PathShape shape;
    shape.item = std::uint32_t(shapes_.items.size() - 1);
    shape.colors = std::uint32_t(shapes_.colors.size());
    shapes_.colors.insert(shapes_.colors.end(), {to_linear(glyph.color), to_linear(glyph.color)});
    shape.kind = PathShape::Kind::segment;
    shape.a = glm::vec3(glyph.tail - shapes_.origin);
    shape.b = glm::vec3(neck - shapes_.origin);
    shape.radius = float(item.shaft_radius * length);
    shapes_.shapes.push_back(shape);
    if (!(item.head_length > 0)) continue;
    shape.kind = PathShape::Kind::cone;
    shape.a = shape.b;
    shape.b = glm::vec3(glyph.tip - shapes_.origin);
    shape.radius = float(item.head_radius * length);
    shapes_.shapes.push_back(shape);
  }
}

void PathScene::add(const SpheresItem& item) {
  const SphereSet& set = *item.spheres;
  for (std::size_t i = 0; i < set.offsets.size(); ++i) {
    PathShape shape;
    shape.kind = PathShape::Kind::segment;
    shape.item = std::uint32_t(shapes_.items.size() - 1);
    shape.a = shape.b = glm::vec3(set.position(i) - shapes_.origin);
    shape.radius = set.radii[i];
    shape.colors = std::uint32_t(shapes_.colors.size());
    shapes_.colors.insert(shapes_.colors.end(), {to_linear(set.colors[i]), to_linear(set.colors[i])});
    shapes_.shapes.push_back(shape);
  }
}

void PathScene::add_shapes() {
  const Bounds& bounds = packet_->illumination.bounds;
  shapes_.origin = bounds.empty() ? Vec3(0.0) : bounds.center();
  const auto each = [&](const auto& items) {
    for (const auto& item : items) {
      ShapeItem look;
      look.is_clipped = item.is_clipped;
      if constexpr (requires { item.color; }) look.color = to_linear(item.color);
      if constexpr (requires { item.opacity; }) look.opacity = item.opacity;
      shapes_.items.push_back(look);
      add(item);
    }
  };
  each(packet_->meshes), each(packet_->tubes), each(packet_->arrows), each(packet_->glyphs), each(packet_->spheres);
  each(packet_->environment.tubes), each(packet_->environment.meshes);
  each(packet_->widgets.tubes), each(packet_->widgets.arrows), each(packet_->widgets.meshes);
  shapes_.build();
}

Result<PathScene> PathScene::make(const FramePacket& packet) {
  PathScene scene(packet);
  if (packet.fog) return Error{"path tracing has no \"fog\""};
  for (const VolumeItem& item : packet.volumes) {
    if (item.projection != Projection::composite) return Error{"path tracing has no projections; \"composite\" was expected"};
    if (item.paged) scene.notes_.emplace_back("path tracing shows the level of the data that is in memory");
    CATENA_TRY(auto grid, scene.dense(*item.grid));
    CATENA_TRY(auto colors, scene.other_colors(item.color_by));
    scene.volumes_.emplace_back(item, std::move(grid));
    scene.volume_colors_.push_back(std::move(colors));
  }
  for (const IsosurfaceItem& item : packet.isosurfaces) {
    if (!(item.opacity > 0)) continue;
    CATENA_TRY(auto grid, scene.dense(*item.grid));
    CATENA_TRY(auto colors, scene.other_colors(item.color_by));
    scene.surfaces_.emplace_back(item, std::move(grid));
    scene.surface_colors_.push_back(std::move(colors));
  }
  for (const SliceItem& slice : packet.slices) CATENA_CHECK(scene.add_slice(slice));
  if (!packet.cursors.empty() || !packet.indicators.empty()) scene.notes_.emplace_back("path tracing does not draw the haptic cursor");
  scene.add_shapes();
  return scene;
}

PathInterval PathScene::visible(const PathRay& ray, bool is_clipped, double to) const {
  PathInterval interval{0, to};
  if (!is_clipped) return interval;
  for (const Plane& plane : packet_->clip_planes) {
    const double at = dot(ray.origin - plane.point, plane.normal), along = dot(ray.direction, plane.normal);
    if (along > 0) interval.from = std::max(interval.from, -at / along);
    if (along < 0) interval.to = std::min(interval.to, -at / along);
    if (along == 0 && at < 0) interval.to = -kInfinity;
  }
  return interval;
}

SurfaceHit PathScene::surface(const PathRay& ray, double from, double to, bool is_primary) const {
  SurfaceHit nearest = shapes_.intersect(ray, from, to, packet_->clip_planes);
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const PathInterval part = visible(ray, surfaces_[i].item().is_clipped, std::min(to, nearest.t));
    SurfaceHit hit = surfaces_[i].intersect(ray, std::max(from, part.from), part.to);
    if (!(hit.t < nearest.t)) continue;
    if (surface_colors_[i]) hit.color = surface_colors_[i]->at(ray.at(hit.t), hit.color);
    nearest = hit;
  }
  if (!is_primary) return nearest;
  for (const Slice& slice : slices_) {
    const double along = dot(ray.direction, slice.item->normal);
    if (along == 0) continue;
    const double t = dot(slice.item->point - ray.origin, slice.item->normal) / along;
    const PathInterval part = visible(ray, slice.item->is_clipped, std::min(to, nearest.t));
    if (!(t > from && t >= part.from && t < part.to)) continue;
    const glm::vec3 p(slice.grid->to_index(ray.at(t)));
    bool is_inside = true;
    for (int a = 0; a < 3; ++a)
      is_inside = is_inside && p[a] >= -float(kFaceSlack) && p[a] <= float(slice.grid->size()[std::size_t(a)] - 1) + float(kFaceSlack);
    float value = 0, rgb[3] = {};
    if (!is_inside || !slice.grid->sample(p, value) || !is_within(slice.item->threshold, double(value))) continue;
    if (slice.item->hidden_label && std::fabs(double(value) - *slice.item->hidden_label) < 0.5) continue;
    slice.colors.at(value, rgb);
    nearest = {t, slice.item->normal, slice.item->normal, to_color(rgb), slice.item->opacity, 1e-6 * std::fabs(t), !slice.item->lit};
  }
  return nearest;
}

std::optional<VolumeCollision> PathScene::collide(const PathRay& ray, double from, double to, Random& random) const {
  std::optional<VolumeCollision> first;
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    const PathInterval part = visible(ray, volumes_[i].item().is_clipped, to);
    if (!(std::max(from, part.from) < part.to)) continue;
    if (const auto t = volumes_[i].collide(ray, std::max(from, part.from), part.to, random)) {
      first = {*t, i};
      to = *t;
    }
  }
  return first;
}

double PathScene::transmittance(const PathRay& ray, double to, Random& random) const {
  double share = 1, from = 0;
  while (share > 0) {
    const SurfaceHit hit = surface(ray, from, to, false);
    if (!hit) break;
    share *= 1 - double(hit.opacity);
    from = hit.t + hit.epsilon;
  }
  for (std::size_t i = 0; i < volumes_.size() && share > 0; ++i) {
    const PathInterval part = visible(ray, volumes_[i].item().is_clipped, to);
    if (part.from < part.to) share *= volumes_[i].transmittance(ray, part.from, part.to, random);
  }
  return share;
}

Color PathScene::volume_color(std::size_t volume, const Vec3& position) const {
  const Color own = volumes_[volume].color_at(position);
  return volume_colors_[volume] ? volume_colors_[volume]->at(position, own) : own;
}

}  // namespace catena::render
