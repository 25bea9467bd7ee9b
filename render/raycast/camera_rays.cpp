// SPDX-License-Identifier: MIT
#include "render/raycast/camera_rays.h"

#include "render/frame/linear_color.h"

#include <glm/matrix.hpp>

namespace catena::render {
namespace {

glm::vec3 narrow(const Vec3& v) { return glm::vec3(v); }

glm::vec3 color_of(const Color& c) { return {c.r, c.g, c.b}; }

/// Returns the unit direction to a light, in world coordinates.
Vec3 towards(const Camera& c, const LightItem& light) {
  const Vec3 d = direction(light.direction);
  return light.camera_relative ? d.x * c.right + d.y * c.up + d.z * c.back : d;
}

shared::FogData fog_of(const CameraRays& rays) {
  shared::FogData fog{};
  if (!rays.fog) return fog;
  fog.color = color_of(rays.fog->color);
  fog.near = float(rays.fog->near - rays.reference_depth);
  fog.per_depth = float(1 / std::max(rays.fog->far - rays.fog->near, 1e-30));
  fog.max_opacity = float(rays.fog->max_opacity);
  return fog;
}

/// Coordinates along the rays of pixels, in a space that is an affine map of the world.
struct AlongRays {
  glm::vec3 origin{}, origin_x{}, origin_y{}, direction{}, direction_x{}, direction_y{};
};

/// `from_world`: the linear part of the map. `at_reference`: coordinates of the point of the view axis at the reference depth.
AlongRays along_rays(const CameraRays& rays, const Mat3& from_world, const Vec3& at_reference) {
  const Camera& camera = rays.camera;
  // steps of one pixel to the right and down: at depth 1 (perspective) or at any depth (orthographic)
  const Vec3 x = from_world * (camera.right * (camera.half_width / (0.5 * camera.width)));
  const Vec3 y = from_world * (camera.up * (-camera.half_height / (0.5 * camera.height)));
  AlongRays along;
  along.origin = narrow(at_reference);
  along.direction = narrow(from_world * rays.forward);
  if (camera.orthographic) {
    along.origin_x = narrow(x);
    along.origin_y = narrow(y);
  } else {
    along.origin_x = narrow(rays.reference_depth * x);
    along.origin_y = narrow(rays.reference_depth * y);
    along.direction_x = narrow(x);
    along.direction_y = narrow(y);
  }
  return along;
}

/// Returns the part of the light grid's data that rays and triangles share.
/// Display encoding: diffuse 0.7 and a highlight; a volume is shown as it is by the default lights. Linear radiance: a light's irradiance
/// is pi times its color, of which a surface reflects cos / pi and a volume scatters 1 / (4 pi).
shared::LookData look_of(const IlluminationItem& illumination) {
  if (illumination.is_linear) return {1, 0, 0.25f, 1.0f / 3, 1};
  return {0.7f, 0.2f, 0.8f, 0.5f, 0};
}

shared::LightGridData light_grid_of(const LightPlace& place) {
  shared::LightGridData data{};
  data.is_on = place.version > 0 ? 1 : 0;
  data.half_cell = float(0.5 * place.cell);
  data.half_plane = place.planes > 0 ? 0.5f / float(place.planes) : 0;
  data.from_world = glm::mat3(1.0f);
  data.version = place.version;
  return data;
}

Mat3 light_from_world(const LightPlace& place) {
  Mat3 scale(0.0);
  for (int a = 0; a < 3; ++a) scale[a][a] = 1 / place.size[a];
  return scale;
}

}  // namespace

CameraRays CameraRays::make(const FramePacket& packet, const Bounds& bounds, const Bounds& of_rays) {
  CameraRays rays;
  rays.camera = make_display_camera(packet.view, packet.width, packet.height, bounds);
  rays.forward = -rays.camera.back;
  rays.clip_planes = packet.clip_planes;
  rays.lights = packet.lights;
  rays.illumination = packet.illumination;
  rays.fog = packet.fog;
  if (bounds.empty()) return rays;
  rays.reference_depth = std::max(0.0, rays.view_depth((of_rays.empty() ? bounds : of_rays).center()));
  double farthest = 0;
  for (int i = 0; i < 8; ++i) farthest = std::max(farthest, rays.view_depth(bounds.corner(i)));
  const double scale = std::max(farthest, bounds.diagonal());
  // reversed float depth keeps its relative precision at any distance, so that near may be tiny
  rays.depth_near = rays.camera.orthographic ? 0 : std::max(1e-6 * scale, 1e-30);
  rays.depth_far = farthest + 1e-3 * scale + 1e-30;
  return rays;
}

shared::FrameData CameraRays::frame_data() const {
  shared::FrameData f{};
  f.half_size = {float(0.5 * camera.width), float(0.5 * camera.height)};
  const double slope_x = camera.half_width / (0.5 * camera.width), slope_y = camera.half_height / (0.5 * camera.height);
  if (!camera.orthographic) f.slope = {float(slope_x), float(slope_y)};
  f.axis = {float(0.5 * camera.width - camera.center_x / slope_x), float(0.5 * camera.height + camera.center_y / slope_y)};
  f.right = narrow(camera.right);
  f.up = narrow(camera.up);
  f.forward = narrow(forward);
  f.reference_depth = float(reference_depth);
  f.front_depth = float(-reference_depth);
  f.depth_near = float(depth_near);
  f.depth_far = float(depth_far);
  f.orthographic = camera.orthographic;
  f.spacing = float(spacing);
  f.first = glm::vec2(0.5f - 0.5f * float(spacing));
  f.clip_count = std::uint32_t(clip_planes.size());
  for (std::size_t i = 0; i < clip_planes.size(); ++i) f.clips[i] = clip_data(clip_planes[i]);
  f.light_count = std::uint32_t(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) f.lights[i] = {narrow(towards(camera, lights[i])), color_of(lights[i].color)};
  f.sky = color_of(illumination.sky);
  f.ground = color_of(illumination.ground);
  f.zenith = {0, 0, 1};
  f.light_grid = light_grid_of(light_place);
  if (light_place.version > 0) {
    const Mat3 scale = light_from_world(light_place);
    const AlongRays along = along_rays(*this, scale, scale * (camera.position + forward * reference_depth - light_place.lo));
    shared::LightGridData& grid = f.light_grid;
    grid.origin = along.origin, grid.origin_x = along.origin_x, grid.origin_y = along.origin_y;
    grid.direction = along.direction, grid.direction_x = along.direction_x, grid.direction_y = along.direction_y;
    grid.from_normal = glm::mat3(light_place.surface_offset * scale);
  }
  f.look = look_of(illumination);
  f.fog = fog_of(*this);
  return f;
}

shared::GridData CameraRays::grid_data(const ResidentGrid& resident, const field::Mapping& whole) const {
  const field::Mapping& mapping = resident.downsampled ? resident.downsampled->mapping() : whole;
  const Mat3& inverse = mapping.index_from_world_linear;
  const Vec3 origin(resident.origin.x, resident.origin.y, resident.origin.z);
  const AlongRays along = along_rays(*this, inverse, mapping.index_from_world(camera.position + forward * reference_depth) - origin);
  shared::GridData g{};
  g.origin = along.origin, g.origin_x = along.origin_x, g.origin_y = along.origin_y;
  g.direction = along.direction, g.direction_x = along.direction_x, g.direction_y = along.direction_y;
  g.lo = narrow(resident.box_lo);
  g.hi = narrow(resident.box_hi);
  g.domain_lo = resident.downsampled ? narrow(resident.domain_lo) : g.lo;
  g.domain_hi = resident.downsampled ? narrow(resident.domain_hi) : g.hi;
  const VkExtent3D extent = resident.values.info().extent;
  g.texel = {1.0f / float(extent.width), 1.0f / float(extent.height), 1.0f / float(extent.depth)};
  g.world_gradient = glm::mat3(glm::transpose(inverse));
  g.value_offset = resident.offset;
  g.value_scale = resident.scale;
  g.nearest = resident.nearest ? 1 : 0;
  g.surface_share = 1;
  return g;
}

shared::MeshFrameData CameraRays::mesh_frame_data(const Vec3& origin) const {
  shared::MeshFrameData m{};
  // columns of the matrix with rows right, up, forward
  for (int i = 0; i < 3; ++i) m.view_from_world[i] = {float(camera.right[i]), float(camera.up[i]), float(forward[i])};
  const Vec3 from_eye = origin - camera.position;
  m.offset = {float(dot(from_eye, camera.right)), float(dot(from_eye, camera.up)), float(dot(from_eye, forward))};
  m.offset_depth = float(dot(from_eye, forward) - reference_depth);
  m.scale = {float(1 / camera.half_width), float(1 / camera.half_height)};
  m.shift = {float(-camera.center_x / camera.half_width), float(camera.center_y / camera.half_height)};
  m.pixel = {float(2 / camera.width), float(2 / camera.height)};
  m.depth_near = float(depth_near);
  m.depth_far = float(depth_far);
  m.orthographic = camera.orthographic;
  m.light_count = std::uint32_t(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Vec3 l = towards(camera, lights[i]);
    m.lights[i] = {{float(dot(l, camera.right)), float(dot(l, camera.up)), float(dot(l, forward))}, color_of(lights[i].color)};
  }
  const glm::dmat3 world_from_view(camera.right, camera.up, forward);
  m.sky = color_of(illumination.sky);
  m.ground = color_of(illumination.ground);
  m.zenith = {float(camera.right.z), float(camera.up.z), float(forward.z)};
  m.light_grid = light_grid_of(light_place);
  if (light_place.version > 0) {
    const Mat3 scale = light_from_world(light_place);
    m.light_grid.from_view = glm::mat3(scale * world_from_view);
    m.light_grid.from_world = glm::mat3(glm::transpose(world_from_view));
    m.light_grid.origin = narrow(scale * (camera.position - light_place.lo));
    m.light_grid.from_normal = glm::mat3(light_place.surface_offset * scale * world_from_view);
  }
  m.look = look_of(illumination);
  m.fog = fog_of(*this);
  m.clip_count = std::uint32_t(clip_planes.size());
  for (std::size_t i = 0; i < clip_planes.size(); ++i) {
    const Vec3 normal = direction(clip_planes[i].normal);
    m.clips[i] = glm::vec4(narrow(normal), float(dot(normal, origin - clip_planes[i].point)));
  }
  return m;
}

shared::ClipData CameraRays::clip_data(const Plane& plane) const {
  const Camera& c = camera;
  const Vec3 normal = direction(plane.normal);
  const double x = dot(normal, c.right) * (c.half_width / (0.5 * c.width)), y = -dot(normal, c.up) * (c.half_height / (0.5 * c.height));
  shared::ClipData clip_data{};
  clip_data.at = float(dot(normal, c.position - plane.point) + reference_depth * dot(normal, forward));
  clip_data.along = float(dot(normal, forward));
  const double depth = c.orthographic ? 1 : reference_depth;
  clip_data.at_x = float(depth * x);
  clip_data.at_y = float(depth * y);
  if (!c.orthographic) {
    clip_data.along_x = float(x);
    clip_data.along_y = float(y);
  }
  return clip_data;
}

VkRect2D covered_area(std::span<const Vec3> points, const Camera& camera) {
  double x0 = camera.width, y0 = camera.height, x1 = 0, y1 = 0;
  if (points.empty()) return {};
  for (const Vec3& point : points) {
    const auto pixel = project(camera, point);
    if (!pixel) return {{0, 0}, {std::uint32_t(camera.width), std::uint32_t(camera.height)}};
    x0 = std::min(x0, pixel->x);
    y0 = std::min(y0, pixel->y);
    x1 = std::max(x1, pixel->x);
    y1 = std::max(y1, pixel->y);
  }
  x0 = std::clamp(std::floor(x0) - 1, 0.0, camera.width);
  y0 = std::clamp(std::floor(y0) - 1, 0.0, camera.height);
  x1 = std::clamp(std::ceil(x1) + 1, x0, camera.width);
  y1 = std::clamp(std::ceil(y1) + 1, y0, camera.height);
  return {{std::int32_t(x0), std::int32_t(y0)}, {std::uint32_t(x1 - x0), std::uint32_t(y1 - y0)}};
}

VkRect2D covered_area(std::span<const field::Field* const> fields, const Camera& camera) {
  std::vector<Vec3> corners;
  for (const field::Field* field : fields)
    for (int i = 0; i < 8; ++i) corners.push_back(field->corner(i));
  return covered_area(corners, camera);
}

glm::vec4 background_data(const std::array<float, 4>& background, bool is_linear) {
  glm::vec4 data(background[0], background[1], background[2], background[3]);
  if (is_linear)
    for (int c = 0; c < 3; ++c) data[c] = float(to_linear(double(data[c])));
  return data;
}

void set_scattering(const Scattering& scattering, shared::GridData& grid) {
  grid.anisotropy = float(scattering.anisotropy);
  grid.surface_share = float(scattering.surface);
}

}  // namespace catena::render
