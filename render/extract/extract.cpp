// SPDX-License-Identifier: MIT
#include "render/extract/extract.h"

#include <algorithm>
#include <cmath>

#include "engine/base/result.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/prepare.h"
#include "engine/scene/visibility.h"
#include "render/extract/auto_camera.h"
#include "render/extract/drawable.h"
#include "render/extract/extract_internal.h"
#include "render/extract/linear_colors.h"
#include "render/extract/stretch.h"
#include "render/frame/linear_color.h"

namespace catena::render {

namespace {

constexpr double kCursorShare = 0.008;  // fitted cursor radius / diagonal of the drawn bounds
constexpr double kCursorOverTube = 2;

/// Returns |F| / maximum force, 0..1; 0 without a maximum force or with a force that is not finite.
double strain_of(const scene::Scene& scene, const scene::Cursor& cursor) {
  const double max_force = scene.coupling.max_force_n;
  return max_force > 0 && is_finite(cursor.force_n) ? std::clamp(norm(cursor.force_n) / max_force, 0.0, 1.0) : 0;
}

/// Calls work(cursor) for each visible cursor with a finite probe, in the order of the entities.
template <class Work>
void each_cursor(const scene::Scene& scene, const Work& work) {
  scene.entities.each<scene::Cursor>([&](scene::Entity, const scene::Cursor& cursor) {
    if (cursor.visible && is_finite(cursor.probe)) work(cursor);
  });
}

/// Returns the cursor item's state of the hand, without its appearance.
CursorItem hand_of(const scene::Scene& scene, const scene::Cursor& cursor) {
  CursorItem item{cursor.probe, cursor.proxies, cursor.active, cursor.force_n, 0, cursor.release_ratios, 0};
  if (cursor.pseudo_haptic) item.force_ratio = strain_of(scene, cursor);
  item.link_active.resize(item.proxies.size(), true);
  item.release_ratios.resize(item.proxies.size(), 0.0);
  return item;
}

void extract_cursors(const scene::Scene& scene, FramePacket& packet) {
  Bounds drawn = packet_bounds(packet);
  if (drawn.empty()) {
    // only the cursor is drawn: its size follows the bounds of the loaded fields, curves, points and meshes
    scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
      if (const field::Field* field = source.loaded.get()) drawn.extend(field->world_bounds());
    });
    const auto add_box = [&](scene::Entity, const auto& source) {
      if (!source.loaded) return;
      drawn.extend(source.loaded->min_corner);
      drawn.extend(source.loaded->max_corner);
    };
    scene.entities.each<scene::CurvesSource>(add_box);
    scene.entities.each<scene::PointsSource>(add_box);
    scene.entities.each<scene::MeshSource>([&](scene::Entity, const scene::MeshSource& source) {
      if (!source.loaded) return;
      drawn.extend(source.loaded->min_corner());
      drawn.extend(source.loaded->max_corner());
    });
  }
  double widest_tube = 0;
  for (const TubeItem& tube : packet.tubes) widest_tube = std::max(widest_tube, tube.radius);
  each_cursor(scene, [&](const scene::Cursor& cursor) {
    CursorItem item = hand_of(scene, cursor);
    item.radius = cursor.size;
    item.id = packet.add_object("cursor", "");
    item.show_occluded = cursor.show_occluded;
    item.is_crosshair = cursor.crosshair;
    if (cursor.drop_line) item.foot_point = item.probe;  // extract_feet projects it to the floor
    if (!(item.radius > 0)) item.radius = std::max(kCursorShare * (drawn.empty() ? 4.0 : drawn.diagonal()), kCursorOverTube * widest_tube);
    packet.cursors.push_back(std::move(item));
  });
}

/// Projects the feet of drop lines to the floor: the ground, if the scene has one, else the lowest face of the drawn bounds, along the
/// world axis nearest to the view's up direction. Removes a foot if the probe is not above the floor or nothing is drawn.
void extract_feet(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  const Vec3 up = scene.ground ? Vec3(0, 0, 1) : packet.view.up;
  int axis = 2;
  for (const int other : {1, 0})
    if (std::fabs(up[other]) > std::fabs(up[axis])) axis = other;
  const double sign = up[axis] < 0 ? -1 : 1;
  for (CursorItem& cursor : packet.cursors) {
    if (!cursor.foot_point) continue;
    const double floor = scene.ground ? ground_height(scene, drawn) : (sign > 0 ? drawn.lo : drawn.hi)[axis];
    (*cursor.foot_point)[axis] = floor;
    if (drawn.empty() || !(sign * (cursor.probe[axis] - floor) > 0)) cursor.foot_point.reset();
  }
}

View view_of(const scene::Scene& scene, const FramePacket& packet) {
  const scene::Camera& camera = scene.camera;
  View view{camera.position, camera.target, camera.up, camera.fovy_deg, camera.orthographic, camera.ortho_height};
  if (!camera.is_explicit) view = make_auto_view(scene, packet);
  view.stretch = scene.stretch;
  return view;
}

}  // namespace

Bounds data_bounds(const FramePacket& packet) {
  Bounds bounds;
  for (const VolumeItem& volume : packet.volumes) bounds.extend(volume.grid->world_bounds());
  for (const IsosurfaceItem& surface : packet.isosurfaces) bounds.extend(surface.grid->world_bounds());
  for (const SliceItem& slice : packet.slices) bounds.extend(slice.grid->world_bounds());
  for (const MeshItem& mesh : packet.meshes)
    for (const Vec3& p : mesh.geometry->vertices) bounds.extend(p);
  return bounds;
}

Bounds drawn_bounds(const FramePacket& packet) {
  Bounds bounds = data_bounds(packet);
  for (const TubeItem& tube : packet.tubes)
    for (const Vec3& p : tube.points) bounds.extend(p, tube.radius);
  for (const SpheresItem& item : packet.spheres)
    for (std::size_t i = 0; i < item.spheres->offsets.size(); ++i) bounds.extend(item.spheres->position(i), double(item.spheres->radii[i]));
  for (const ArrowItem& arrow : packet.arrows) {
    bounds.extend(arrow.base, arrow.radius);
    bounds.extend(arrow.tip);
  }
  for (const GlyphItem& item : packet.glyphs)
    for (const Glyph& glyph : item.glyphs) {
      bounds.extend(glyph.tail);
      bounds.extend(glyph.tip);
    }
  return bounds;
}

Bounds packet_bounds(const FramePacket& packet) {
  Bounds bounds = drawn_bounds(packet);
  for (const IndicatorItem& indicator : packet.indicators)
    for (const Vec3& p : indicator.tube.points) bounds.extend(p, indicator.arrow.radius);
  for (const CursorItem& cursor : packet.cursors) {
    bounds.extend(cursor.probe, cursor.radius);
    for (const Vec3& p : cursor.proxies) bounds.extend(p, cursor.radius);
  }
  return bounds;
}

void set_view(const scene::Scene& scene, const View& view, FramePacket& packet) {
  packet.view = make_screen_window_view(view, scene.stereo);
  packet.view.stretch = scene.stretch;
  const Bounds drawn = drawn_bounds(packet);
  update_box_lines(scene, drawn.empty() ? packet_bounds(packet) : drawn, packet);
  update_fog(scene, packet_bounds(packet), packet);
  if (packet.fog && packet.illumination.is_linear) packet.fog->color = to_linear(packet.fog->color);
  update_widgets(scene, data_bounds(packet), packet);
  update_eyes(packet, scene.stereo);
}

void update_cursors(const scene::Scene& scene, FramePacket& packet) {
  std::vector<CursorItem> hands;
  each_cursor(scene, [&](const scene::Cursor& cursor) { hands.push_back(hand_of(scene, cursor)); });
  if (hands.size() != packet.cursors.size()) return;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    CursorItem& item = packet.cursors[k];
    stretch_cursor(scene.stretch, 1, hands[k]);
    hands[k].radius = item.radius;
    hands[k].id = item.id;
    hands[k].show_occluded = item.show_occluded;
    hands[k].is_crosshair = item.is_crosshair;
    if (item.foot_point) hands[k].foot_point = hands[k].probe;
    item = std::move(hands[k]);
  }
  const bool any_foot = std::ranges::any_of(packet.cursors, [](const CursorItem& item) { return item.foot_point.has_value(); });
  if (any_foot) extract_feet(scene, drawn_bounds(packet), packet);
}

Outcome prepare_frame(scene::Scene& scene) {
  CATENA_CHECK(scene::prepare(scene, scene::StreamlineTracing::deferred));
  for (const DrawableExtraction& kind : extractions())
    if (kind.prepare != nullptr) CATENA_CHECK(kind.prepare(scene));
  prepare_auto_camera(scene);
  prepare_stretch(scene);
  return prepare_widgets(scene);
}

Result<FramePacket> make_frame(scene::Scene& scene, std::uint32_t width, std::uint32_t height) {
  CATENA_CHECK(prepare_frame(scene));
  return extract_frame(scene, width, height);
}

Result<FramePacket> extract_frame(const scene::Scene& scene, std::uint32_t width, std::uint32_t height) {
  CATENA_ASSERT(width > 0 && height > 0);
  FramePacket packet;
  packet.width = width;
  packet.height = height;
  packet.jitter = scene.jitter;
  packet.clip_planes.assign(scene.clip_planes.begin(), scene.clip_planes.end());
  const scene::Background& background = scene.background;
  packet.background = {background.color.r, background.color.g, background.color.b, background.transparent ? 0.0f : 1.0f};
  for (const DrawableExtraction& kind : extractions()) CATENA_CHECK(kind.extract(scene, packet));
  extract_cursors(scene, packet);
  CATENA_CHECK(extract_indicators(scene, packet));
  extract_overlay(scene, packet);
  stretch_items(scene, packet);
  packet.view = make_screen_window_view(view_of(scene, packet), scene.stereo);
  // the box, axes and ground enclose the data only, so that they do not move with the hand
  const Bounds drawn = drawn_bounds(packet);
  extract_feet(scene, drawn, packet);
  extract_environment(scene, drawn.empty() ? packet_bounds(packet) : drawn, packet);
  extract_widgets(scene, data_bounds(packet), packet);
  if (packet.illumination.is_linear) make_colors_linear(packet);
  update_eyes(packet, scene.stereo);
  CATENA_CHECK(check_eye_separation(packet, scene.stereo));
  return packet;
}

}  // namespace catena::render
