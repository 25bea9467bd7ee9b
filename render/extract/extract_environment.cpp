// SPDX-License-Identifier: MIT
#include "render/extract/extract_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "render/extract/axis_edges.h"

namespace catena::render {
namespace {

constexpr double kLineShare = 0.0012;                                                // line radius / diagonal of the drawn bounds
constexpr double kTickShare = 0.015;                                                 // tick length / diagonal
constexpr double kNumberDistance = 2.6, kNameDistance = 5.5, kWideNameDistance = 9;  // of numbers and names from the axis, in tick lengths
constexpr double kNumberPt = 10, kNamePt = 13;
constexpr double kGroundShare = 1.6;  // edge of the ground / diagonal
constexpr double kGroundGap = 0.02;   // gap between the drawn bounds and the ground / diagonal
constexpr int kTilesAcross = 16;

/// Corners of a box, possibly oblique; corner i + 2 j + 4 k, i, j, k in {0, 1}.
using Corners = std::array<Vec3, 8>;

Corners corners_of(const scene::Scene& scene, scene::Entity named, const Bounds& drawn) {
  Corners corners;
  if (!named) {
    Bounds bounds = drawn;
    if (bounds.empty()) {
      bounds.extend(Vec3(-1.0));
      bounds.extend(Vec3(1.0));
    }
    for (int i = 0; i < 8; ++i) corners[i] = bounds.corner(i);
    return corners;
  }
  const field::Field* field = scene::rendered_field(scene, named).get();
  for (int i = 0; i < 8; ++i) corners[i] = scene.stretch * field->corner(i);
  return corners;
}

double diagonal_of(const Corners& corners) { return norm(corners[7] - corners[0]); }

TubeItem line(const Vec3& a, const Vec3& b, double radius, const Color& color, std::uint32_t id) {
  TubeItem tube;
  tube.points = {a, b};
  tube.radius = radius;
  tube.color = color;
  tube.id = id;
  tube.is_clipped = false;
  return tube;
}

LabelItem label(const Vec3& at, const std::string& text, double size_pt, const Color& color) {
  LabelItem item;
  item.position = at;
  item.text = text;
  item.anchor = Anchor::center;
  item.offset_pt = Vec2(0.0);
  item.size_pt = size_pt;
  item.color = color;
  return item;
}

Bounds box_of_axes(const scene::Scene& scene, const Bounds& drawn) {
  const Corners corners = corners_of(scene, scene.axes->field, drawn);
  Bounds box;
  for (const Vec3& p : corners) box.extend(p);
  return box;
}

/// Returns the object id of a kind that a packet has once; adds the object at the first call.
std::uint32_t only_object(FramePacket& packet, const std::string& kind) {
  for (const ObjectName& object : packet.objects)
    if (object.kind == kind) return object.id;
  return packet.add_object(kind, "");
}

void add_bounding_box(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  const scene::BoundingBox& box = *scene.bounding_box;
  const Corners corners = corners_of(scene, box.field, drawn);
  const double radius = box.radius > 0 ? box.radius : kLineShare * diagonal_of(corners);
  const std::uint32_t id = only_object(packet, "bounding box");
  // edges drawn by the axes are left out: two tubes at one position would fight for each pixel
  std::vector<AxisEdge> axes;
  if (scene.axes)
    for (const AxisEdge& edge : find_axis_edges(box_of_axes(scene, drawn), packet.view)) axes.push_back(edge);
  const auto is_axis = [&](const Vec3& a, const Vec3& b) {
    return std::ranges::any_of(axes, [&](const AxisEdge& e) { return (e.from == a && e.to == b) || (e.from == b && e.to == a); });
  };
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 1; axis < 8; axis *= 2)
      if ((i & axis) == 0 && !is_axis(corners[i], corners[i | axis]))
        packet.environment.tubes.push_back(line(corners[i], corners[i | axis], radius, box.color, id));
}

/// Adds the three axis edges with ticks that point away from the box, numbers and names.
void add_axes(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  const scene::Axes& axes = *scene.axes;
  const Bounds box = box_of_axes(scene, drawn);
  const double radius = axes.radius > 0 ? axes.radius : kLineShare * box.diagonal(), tick = kTickShare * box.diagonal();
  const Color color = axes.color;
  const std::uint32_t id = only_object(packet, "axes");
  const auto edges = find_axis_edges(box, packet.view);
  for (int axis = 0; axis < 3; ++axis) {
    const AxisEdge& edge = edges[std::size_t(axis)];
    const Vec3 out = tick * edge.outward;
    packet.environment.tubes.push_back(line(edge.from, edge.to, radius, color, id));
    const double stretch = scene.stretch[axis];
    for (const AxisTick& t : nice_ticks(box.lo[axis] / stretch, box.hi[axis] / stretch, axes.ticks)) {
      Vec3 at = edge.from;
      at[axis] = stretch * t.value;
      packet.environment.tubes.push_back(line(at, at + out, radius, color, id));
      packet.overlay.axis_labels.push_back(label(at + kNumberDistance * out, t.label, kNumberPt, color));
    }
    std::string name = axes.names[std::size_t(axis)];
    if (stretch != 1) name += fmt::format(" (\u00d7 {:.3g})", stretch);
    const double distance = stretch == 1 ? kNameDistance : kWideNameDistance;
    const Vec3 middle = 0.5 * edge.from + 0.5 * edge.to + distance * out;
    packet.overlay.axis_labels.push_back(label(middle, name, kNamePt, color));
  }
}

/// Adds the ground as two meshes, one for each color of the checkerboard.
void add_ground(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  const scene::Ground& ground = *scene.ground;
  Bounds bounds = drawn;
  if (bounds.empty()) {
    bounds.extend(Vec3(-1.0));
    bounds.extend(Vec3(1.0));
  }
  const double diagonal = bounds.diagonal();
  const double size = ground.size > 0 ? ground.size : ground.tile_size > 0 ? kTilesAcross * ground.tile_size : kGroundShare * diagonal;
  const int tiles = std::clamp(static_cast<int>(std::lround(ground.tile_size > 0 ? size / ground.tile_size : kTilesAcross)), 1, 1000);
  const double edge = size / tiles, z = ground_height(scene, bounds);
  const std::uint32_t id = packet.add_object("ground", "");
  for (int shade = 0; shade < 2; ++shade) {
    auto geometry = std::make_shared<MeshGeometry>();
    for (int j = 0; j < tiles; ++j)
      for (int i = (j + shade) % 2; i < tiles; i += 2) {
        const double x = bounds.center().x + edge * (i - 0.5 * tiles), y = bounds.center().y + edge * (j - 0.5 * tiles);
        const auto first = static_cast<std::uint32_t>(geometry->vertices.size());
        for (const Vec3& p : {Vec3(x, y, z), Vec3(x + edge, y, z), Vec3(x + edge, y + edge, z), Vec3(x, y + edge, z)})
          geometry->vertices.push_back(p);
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) geometry->triangles.push_back(first + k);
      }
    if (!geometry->triangles.empty())
      packet.environment.meshes.push_back({std::move(geometry), ground.colors[std::size_t(shade)], id, false});
  }
}

FogItem fog_of(const scene::Fog& fog, const Bounds& drawn, const FramePacket& packet) {
  FogItem item;
  item.color = fog.color ? *fog.color : Color{packet.background[0], packet.background[1], packet.background[2]};
  item.max_opacity = fog.max_opacity;
  const Vec3 forward = direction(packet.view.target - packet.view.position);
  double nearest = 0, farthest = 1;
  for (int i = 0; i < 8 && !drawn.empty(); ++i) {
    const double depth = dot(drawn.corner(i) - packet.view.position, forward);
    nearest = i == 0 ? depth : std::min(nearest, depth);
    farthest = i == 0 ? depth : std::max(farthest, depth);
  }
  item.near = fog.near.value_or(std::max(0.0, nearest));
  const double min_range =
      1e-9 * (drawn.empty() ? 1 : drawn.diagonal()) + 1e-12 * std::fabs(item.near);  // the fog's ratio divides by far - near
  item.far = std::max(fog.far.value_or(farthest), item.near + min_range);
  return item;
}

/// The light of the look `lit` of a scene that states none: a soft key light from above, a weaker one at the camera, which leaves nothing
/// black, and light from all sides, with occlusion.
scene::Illumination default_light() {
  scene::Illumination setup;
  setup.look = scene::Look::lit;
  constexpr float kSides = 0.35f;
  constexpr double kKey = 0.6, kFill = 0.2, kKeySize_deg = 8;
  setup.lights = {{Vec3(1.2, -0.4, 1.2), {1, 1, 1}, kKey, false, kKeySize_deg}, {Vec3(0, 0, 1), {1, 1, 1}, kFill, true, 0}};
  setup.environment_light = scene::EnvironmentLight{{kSides, kSides, kSides}, {kSides, kSides, kSides}};
  setup.ambient_occlusion = scene::AmbientOcclusion{};
  setup.shadows = true;
  setup.line_halos = true;
  return setup;
}

/// Lights, environment, occlusion and shadows. An image without any light has a black one.
void extract_light(const scene::Scene& scene, FramePacket& packet) {
  const scene::Illumination& stated = scene.illumination;
  scene::Illumination light = stated.look == scene::Look::lit && stated.is_unstated() ? default_light() : stated;
  if (stated.line_halos) light.line_halos = stated.line_halos;
  packet.has_line_halos = light.line_halos.value_or(false);
  for (const scene::Light& one : light.lights) {
    const auto i = static_cast<float>(one.intensity);
    packet.lights.push_back({one.direction, {i * one.color.r, i * one.color.g, i * one.color.b}, one.follows_camera, one.angular_size_deg});
  }
  // those that cast shadows come first
  if (light.shadows) std::ranges::stable_partition(packet.lights, [](const LightItem& one) { return !one.camera_relative; });
  IlluminationItem& item = packet.illumination;
  item.shadows = light.shadows;
  const bool is_lit = light.environment_light || light.ambient_occlusion || light.shadows;
  item.is_linear = light.look == scene::Look::lit || (light.look == scene::Look::automatic && is_lit);
  item.bounds = drawn_bounds(packet);
  if (light.ambient_occlusion) {
    constexpr double kReachShare = 0.1;
    const double own = packet.size_scale * light.ambient_occlusion->reach;
    item.occlusion_reach = own > 0 ? own : item.bounds.empty() ? 0 : kReachShare * item.bounds.diagonal();
    item.occlusion_strength = light.ambient_occlusion->strength;
  }
  // occlusion is seen by the environment's share of the light
  constexpr float kOccludedShare = 0.5f, kHeadlightBeside = 0.6f;
  if (light.environment_light) {
    item.sky = light.environment_light->sky;
    item.ground = light.environment_light->ground;
  } else if (light.ambient_occlusion) {
    item.sky = item.ground = {kOccludedShare, kOccludedShare, kOccludedShare};
  }
  if (!light.lights.empty()) return;
  if (!light.has_headlight)
    packet.lights.push_back({{0, 0, 1}, {0, 0, 0}, true});
  else if (light.ambient_occlusion && !light.environment_light)
    packet.lights.push_back({{0, 0, 1}, {kHeadlightBeside, kHeadlightBeside, kHeadlightBeside}, true});
}

}  // namespace

void update_fog(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  if (scene.fog) packet.fog = fog_of(*scene.fog, drawn, packet);
}

double ground_height(const scene::Scene& scene, const Bounds& drawn) {
  return scene.ground->z ? scene.stretch.z * *scene.ground->z : drawn.lo.z - kGroundGap * drawn.diagonal();
}

void update_box_lines(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  packet.environment.tubes.clear();
  packet.overlay.axis_labels.clear();
  if (scene.bounding_box) add_bounding_box(scene, drawn, packet);
  if (scene.axes) add_axes(scene, drawn, packet);
}

void extract_environment(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  update_box_lines(scene, drawn, packet);
  if (scene.ground) add_ground(scene, drawn, packet);
  update_fog(scene, drawn, packet);
  extract_light(scene, packet);
}

}  // namespace catena::render
