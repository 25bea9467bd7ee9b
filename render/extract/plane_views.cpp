// SPDX-License-Identifier: MIT
#include "render/extract/plane_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/io/volume/units.h"
#include "engine/scene/labels.h"
#include "engine/scene/units.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/extract/stretch.h"
#include "render/extract/widget_shapes.h"

namespace catena::render {

namespace {

constexpr double kMargin = 1.06, kOverlayOpacity = 0.5;
constexpr Color kPlaneColors[] = {{1.0f, 0.5f, 0.45f}, {0.35f, 0.8f, 0.3f}, {0.95f, 0.85f, 0.25f}};  // of the planes' lines in the others
constexpr double kLetterPt = 16, kNamePt = 12;
constexpr double kTextScale = 1.6;  // a plane is half as high as the page, which is read as one image

/// Scalar fields that the scene shows, in the order of preference for the base.
std::vector<scene::Entity> shown_fields(const scene::Scene& scene) {
  std::vector<scene::Entity> fields;
  const auto add = [&](scene::Entity field) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(field);
    if (source.label) field = scene::find_field(scene, source.label->label_map);
    if (field && std::ranges::find(fields, field) == fields.end()) fields.push_back(field);
  };
  for (const scene::Entity e : scene::visible_entities<scene::Slice>(scene.entities))
    add(scene.entities.get<scene::Slice>(e).color_by.field);
  for (const scene::Entity e : scene::visible_entities<scene::Volume>(scene.entities)) add(scene.entities.get<scene::Volume>(e).field);
  for (const scene::Entity e : scene::visible_entities<scene::Isosurface>(scene.entities))
    add(scene.entities.get<scene::Isosurface>(e).field);
  return fields;
}

/// Assigns each world axis the grid axis that is nearest to it; every grid axis is used once.
std::array<Vec3, 3> axes_near_world(const Mat3& linear) {
  std::array<Vec3, 3> axes;
  std::array<bool, 3> used{};
  for (int world = 2; world >= 0; --world) {  // the vertical axis first
    int best = -1;
    double most = -1;
    for (int column = 0; column < 3; ++column) {
      const double along = std::fabs(direction(linear[column])[world]);
      if (!used[static_cast<std::size_t>(column)] && along > most) best = column, most = along;
    }
    used[static_cast<std::size_t>(best)] = true;
    const Vec3 axis = direction(linear[best]);
    axes[static_cast<std::size_t>(world)] = axis[world] < 0 ? -1.0 * axis : axis;
  }
  return axes;
}

/// The frame whose image has these axes; sheared grids are made orthogonal.
PlaneFrame make_plane_frame(const Vec3& right, const Vec3& up, std::string name, std::array<std::string, 4> letters) {
  PlaneFrame frame;
  frame.back = direction(cross(right, up));
  frame.right = direction(right);
  frame.up = cross(frame.back, frame.right);
  frame.name = std::move(name);
  frame.letters = std::move(letters);
  return frame;
}

std::array<PlaneFrame, 3> make_plane_frames(const Mat3& linear, bool is_patient_space) {
  const auto [x, y, z] = axes_near_world(linear);
  if (!is_patient_space)
    return {make_plane_frame(x, y, "x y", {"", "x", "y", ""}), make_plane_frame(x, z, "x z", {"", "x", "z", ""}),
            make_plane_frame(y, z, "y z", {"", "y", "z", ""})};
  return {make_plane_frame(-1.0 * x, y, "axial", {"R", "L", "A", "P"}), make_plane_frame(-1.0 * x, z, "coronal", {"R", "L", "S", "I"}),
          make_plane_frame(-1.0 * y, z, "sagittal", {"A", "P", "S", "I"})};
}

/// Slice of the scene that shows the field; nullptr: none.
const scene::Slice* slice_of(const scene::Scene& scene, scene::Entity field) {
  for (const scene::Entity e : scene::visible_entities<scene::Slice>(scene.entities))
    if (scene.entities.get<scene::Slice>(e).color_by.field == field) return &scene.entities.get<scene::Slice>(e);
  return nullptr;
}

/// Volume of the scene that shows the field; nullptr: none.
const scene::Volume* volume_of(const scene::Scene& scene, scene::Entity field) {
  for (const scene::Entity e : scene::visible_entities<scene::Volume>(scene.entities))
    if (scene.entities.get<scene::Volume>(e).field == field) return &scene.entities.get<scene::Volume>(e);
  return nullptr;
}

/// Returns whether a volume shows a channel: in one color, whatever the value (engine/scene/default_channels.h).
bool shows_channel(const scene::Volume* volume) {
  return volume != nullptr && volume->transfer.colors.size() > 1 && std::ranges::all_of(volume->transfer.colors, [&](const auto& point) {
           return point.color == volume->transfer.colors.front().color;
         });
}

/// The field in the plane: a channel from black to its color; others with the colors of its slice in the scene, else of its labels, else
/// gray over the window; over the base also with the colors and the threshold of its volume.
SliceItem make_plane_slice(const scene::Scene& scene, scene::Entity field, bool is_base,
                           const std::optional<std::array<double, 2>>& window) {
  const field::AnyField& any = scene::rendered_field(scene, field);
  SliceItem item;
  item.grid = {any.scalar, any.scalar->grid()};
  item.paged = any.paged;
  const bool labels = scene::find_label_map(scene, field) != nullptr;
  const DisplayRange& range = field::display_range(*item.grid);
  const scene::Slice* own = slice_of(scene, field);
  scene::ColorBy colors = own != nullptr ? own->color_by : scene::ColorBy{};
  if (own == nullptr && !labels) colors.named.map = "grey";
  const scene::Volume* volume = volume_of(scene, field);
  if (volume != nullptr && own == nullptr && !is_base && !labels) {
    colors.colors = volume->transfer.colors;
    colors.named = volume->transfer.named;
  }
  if (is_base && window) colors.named.range = *window;
  if (own == nullptr && !labels && shows_channel(volume)) {
    const auto& points = volume->transfer.colors;
    const auto [lo, hi] = window.value_or(std::array{points.front().value, points.back().value});
    const Color& color = points.front().color;
    item.colors = {{lo, 0, 0, 0}, {hi, color.r, color.g, color.b}};
  } else {
    for (const auto& row : scene::make_display_color_table(scene, field, colors.colors, colors.named, range.lo, range.hi))
      item.colors.push_back({row.value, row.color.r, row.color.g, row.color.b});
  }
  if (labels) item.hidden_label = 0;
  item.threshold = colors.named.threshold;
  item.opacity = is_base ? 1.0f : own != nullptr ? static_cast<float>(own->opacity) : static_cast<float>(kOverlayOpacity);
  item.is_clipped = false;
  item.stack_order = is_base ? 0 : 1;
  return item;
}

/// Height of the image that shows the whole box in every plane, so that all planes have one scale.
double common_height(const OrthoPlanes& planes, const Vec3& stretch, double aspect) {
  double height = 0;
  for (const PlaneFrame& frame : planes.frames) {
    double half_width = 0, half_height = 0;
    for (const Vec3& corner : planes.corners) {
      const Vec3 arm = stretch * (corner - planes.center);
      half_width = std::max(half_width, std::fabs(dot(arm, frame.right)));
      half_height = std::max(half_height, std::fabs(dot(arm, frame.up)));
    }
    height = std::max({height, 2 * half_height, 2 * half_width / aspect});
  }
  return kMargin * height;
}

/// Moves the widgets in front of the plane, so that they are seen like a drawing on it.
void project_widgets(FramePacket& packet, const Vec3& on_plane, const Vec3& back) {
  const double above = 0.1 * packet.view.height;
  const auto project = [&](Vec3& p) { p += (above - dot(p - on_plane, back)) * back; };
  for (TubeItem& tube : packet.widgets.tubes) {
    std::vector<Vec3> points = tube.points.list();
    for (Vec3& p : points) project(p);
    tube.points = std::move(points);
  }
  for (ArrowItem& arrow : packet.widgets.arrows) project(arrow.base), project(arrow.tip);
  packet.widgets.meshes.clear();
}

/// Writes the values that are shown as black and white in the first plane.
void add_window_text(FramePacket& plane) {
  const SliceItem& base = plane.slices.front();
  if (base.hidden_label || base.colors.empty()) return;
  plane.overlay.texts.push_back(
      {fmt::format("{:.4g} .. {:.4g}", base.colors.front()[0], base.colors.back()[0]), Anchor::bottom_left, {8, -6}, kNamePt, false, {}});
}

/// Lines of the two other planes, and of the texts.
void add_marks(const OrthoPlanes& planes, std::size_t plane, const Vec3& focus, const std::string& unit, FramePacket& packet) {
  const PlaneFrame& frame = planes.frames[plane];
  WidgetShapes shapes(packet);
  shapes.begin_object(0, 0);
  const double reach = packet.view.height * std::max(1.0, double(packet.width) / packet.height);
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == plane) continue;
    const Vec3 along = direction(cross(frame.back, planes.frames[other].back)) / packet.view.stretch;
    shapes.tube({focus - reach * along, focus + reach * along}, 0.7, kPlaneColors[other]);
  }
  const std::pair<Anchor, Vec2> edges[] = {
      {Anchor::left, {6, 0}}, {Anchor::right, {-6, 0}}, {Anchor::top, {0, 4}}, {Anchor::bottom, {0, -4}}};
  for (std::size_t k = 0; k < 4; ++k)
    packet.overlay.texts.push_back({frame.letters[k], edges[k].first, edges[k].second, kLetterPt, true, {}});
  // along the axis of the world that is nearest to the normal
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(frame.back[i]) > std::fabs(frame.back[axis])) axis = i;
  const double position = (frame.back[axis] < 0 ? -1 : 1) * dot(focus, frame.back) + 0.0;  // no -0
  packet.overlay.texts.push_back({fmt::format("{} {:.4g}{}", frame.name, position, scene::unit_suffix(unit)),
                                  Anchor::top_left,
                                  {8, 6},
                                  kNamePt,
                                  false,
                                  kPlaneColors[plane]});
}

void add_note(scene::Scene& scene, std::string note) {
  if (std::ranges::find(scene.notes, note) == scene.notes.end()) scene.notes.push_back(std::move(note));
}

}  // namespace

Result<OrthoPlanes> find_ortho_planes(scene::Scene& scene) {
  OrthoPlanes planes;
  std::vector<scene::Entity> fields;
  for (const scene::Entity field : shown_fields(scene)) {
    const json::Node where = scene.entities.get<scene::FieldSource>(field).where;
    CATENA_TRY(const field::AnyField any, scene::resolve_rendered_field(scene, field, where));
    if (any.scalar) fields.push_back(field);
  }
  if (fields.empty()) return Error{"orthogonal views show a scalar field in three planes, but the scene shows none"};
  const auto is_map = [&](scene::Entity field) { return scene::find_label_map(scene, field) != nullptr; };
  // labels, and values of which a threshold shows a part, lie over an image
  const auto lies_over = [&](scene::Entity field) {
    const scene::Slice* slice = slice_of(scene, field);
    const scene::Volume* volume = volume_of(scene, field);
    return is_map(field) || (slice != nullptr && !slice->color_by.named.threshold.empty()) ||
           (volume != nullptr && !volume->transfer.named.threshold.empty());
  };
  const auto first = std::ranges::find_if_not(fields, lies_over);
  planes.base = first != fields.end() ? *first : fields.front();
  const bool has_channels = shows_channel(volume_of(scene, planes.base));
  bool leaves_out = false;
  for (const scene::Entity field : fields) {
    const bool is_other_channel =
        has_channels && field != planes.base && slice_of(scene, field) == nullptr && shows_channel(volume_of(scene, field));
    leaves_out = leaves_out || is_other_channel;
    if (is_other_channel) continue;
    if (field != planes.base && (is_map(field) || slice_of(scene, field) != nullptr || volume_of(scene, field) != nullptr))
      planes.overlays.push_back(field);
  }
  if (leaves_out)
    add_note(scene, fmt::format("the orthogonal views show the channel {} only (--grid NAME shows another)",
                                in_quotes(scene.entities.get<scene::Name>(planes.base).value)));
  const field::Field& field = *scene::rendered_field(scene, planes.base).get();
  Bounds box;
  box.extend(field.index_box().lo);
  box.extend(field.index_box().hi);
  for (int i = 0; i < 8; ++i) planes.corners[static_cast<std::size_t>(i)] = field.mapping().world_from_index(box.corner(i));
  planes.center = field.mapping().world_from_index(box.center());
  const auto& file = scene.entities.get<scene::FieldSource>(planes.base).file;
  const bool is_patient_space = file && field::read_units(file->path, file->grid).is_patient_space;
  planes.frames = make_plane_frames(field.mapping().world_from_index_linear, is_patient_space);
  return planes;
}

Outcome add_plane_views(const scene::Scene& scene, const OrthoPlanes& planes, const scene::OrthogonalViews& state, FramePacket& packet) {
  if (!packet.eyes.empty()) return Error{"orthogonal views are not shown in stereo; --stereo mono was expected"};
  const Vec3 focus = state.focus.value_or(planes.center), at = scene.stretch * focus;
  const Vec3 center = scene.stretch * state.center.value_or(planes.center);
  const double height = common_height(planes, scene.stretch, double(packet.width) / packet.height) / state.zoom;
  packet.planes.clear();
  for (std::size_t k = 0; k < planes.frames.size(); ++k) {
    const PlaneFrame& frame = planes.frames[k];
    auto plane = std::make_shared<FramePacket>();
    plane->width = packet.width;
    plane->height = packet.height;
    plane->background = packet.background;
    plane->objects = packet.objects;
    plane->cursors = packet.cursors;
    plane->view.target = center + dot(at - center, frame.back) * frame.back;
    plane->view.position = plane->view.target + 2 * norm(scene.stretch * (planes.corners[7] - planes.corners[0])) * frame.back;
    plane->view.up = frame.up;
    plane->view.orthographic = true;
    plane->view.height = height;
    plane->slices.push_back(make_plane_slice(scene, planes.base, true, state.window));
    for (const scene::Entity field : planes.overlays) plane->slices.push_back(make_plane_slice(scene, field, false, {}));
    plane->view.stretch = scene.stretch;
    plane->size_scale = packet.size_scale;
    for (SliceItem& slice : plane->slices) slice.point = focus, slice.normal = scene.stretch * frame.back;
    stretch_slices(scene, *plane);
    plane->overlay.font = packet.overlay.font;
    plane->overlay.scale = kTextScale * packet.overlay.scale;
    update_widgets(scene, data_bounds(packet), *plane);
    project_widgets(*plane, at, frame.back);
    if (k == 0) add_window_text(*plane);
    add_marks(planes, k, focus, scene::length_unit(scene), *plane);
    packet.planes.push_back(std::move(plane));
  }
  packet.packing = Packing::grid;
  return Done{};
}

}  // namespace catena::render
