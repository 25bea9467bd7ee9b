// SPDX-License-Identifier: MIT
/// Module-internal: helpers shared by all parts of the extraction. Frame thread unless stated otherwise.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/scene.h"
#include "engine/scene/stereo.h"
#include "engine/scene/visibility.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"
#include "render/frame/overlay_items.h"

namespace catena::render {

/// Returns the entity's name, "?" if it has none.
inline std::string entity_name(const scene::Scene& scene, scene::Entity entity) {
  return scene.entities.has<scene::Name>(entity) ? scene.entities.get<scene::Name>(entity).value : std::string("?");
}

/// Returns the entities that have the component, in order of insertion; a copy, so that components may be added meanwhile.
template <class T>
std::vector<scene::Entity> entities_with(const scene::EntityStore& world) {
  std::vector<scene::Entity> owners;
  world.each<T>([&](scene::Entity e, const T&) { owners.push_back(e); });
  return owners;
}

/// Returns the bounds of the drawn data: without cursors, indicators, the environment and widgets.
Bounds drawn_bounds(const FramePacket& packet);

using ColorTable = std::vector<scene::TransferFunction::ColorPoint>;

/// Returns the color table of the data cached beside an entity (scene.cache); null if there is none or it is empty.
template <class Cached>
const ColorTable* cached_colors(const scene::EntityStore& made, scene::Entity e) {
  return made.has<Cached>(e) && !made.get<Cached>(e).colors.empty() ? &made.get<Cached>(e).colors : nullptr;
}

/// Rebuilds the cached data beside visible curves or points unless it was made from the source loaded at present (`of`).
template <class Cached, class Drawable, class Make>
Outcome prepare_cached(scene::Scene& scene, const Make& make) {
  for (const scene::Entity e : entities_with<Drawable>(scene.entities)) {
    if (is_hidden(scene.entities, e)) continue;
    if (!scene.cache.has<Cached>(e)) scene.cache.emplace<Cached>(e);
    if (scene.cache.get<Cached>(e).of == scene.entities.get<Drawable>(e).loaded) continue;
    const Drawable drawn = scene.entities.get<Drawable>(e);
    CATENA_TRY(Cached made, make(scene, drawn, entity_name(scene, e)));
    scene.cache.get<Cached>(e) = std::move(made);
  }
  return Done{};
}

/// Bounding box, axes, ground, fog and lights. Frame thread.
///   bounding box   the twelve edges of a field's domain, also for rotated and sheared grids; else of the bounds of all rendered items
///   axes           three edges of that box with ticks at round numbers (along the world's axes), on its outline in the image
///   ground         a checkerboard perpendicular to z, just below all rendered items
///   fog            from the nearest to the farthest view depth of all rendered items

/// Returns the height of the scene's ground in display units: as specified, or slightly below `drawn`.
double ground_height(const scene::Scene& scene, const Bounds& drawn);

/// Adds the environment; to be called after all other items and the view are in the packet. `drawn`: bounds of these items.
void extract_environment(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// Updates only the bounding box and the axes, whose edges depend on the packet's view.
void update_box_lines(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// Updates only the fog, whose range depends on the packet's view.
void update_fog(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

/// Adds the local flow indicators, to be called after the cursors: the exact tracer's line through the probe, half the length to either
/// side; none if the flow has no line there. Frame thread.
Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet);

/// Radius and length of an arrowhead, relative to the radius of its tube.
inline constexpr double kArrowRadius = 2.4, kArrowLength = 6;

/// Curves from files as tubes, with each line's points unchanged, colored by values, by a single color or by the line's direction. Of more
/// than kMaxCurvePoints points an even selection of the lines is rendered, as reported in packet.omitted. An Error for values that the file
/// does not have, or if more memory is needed than permitted.
inline constexpr std::size_t kMaxCurvePoints = 2'000'000;

/// Points from tables as spheres: colored by a column, by a field's values or by a single color; gray for NaN. Of more than kMaxSpheres an
/// even selection is rendered, as reported in packet.omitted. An Error for a column that the table does not have, or if more memory is
/// needed than permitted.
inline constexpr std::size_t kMaxSpheres = 4'000'000;

/// Returns the color of a value by a table with rising values; the end colors beyond them; gray for NaN.
Color sample_color_table(const ColorTable& table, double value);

/// Adds the scene's annotations to the packet's overlay. To be called after everything else: scalar bars show the final colors of volumes
/// and streamlines. Frame thread.
void extract_overlay(const scene::Scene& scene, FramePacket& packet);

/// Returns the packing for the scene's stereo mode. Called by extract_frame(), and by callers that change the packet's view afterwards.
Packing stereo_packing(const scene::Stereo& stereo);
/// Returns the number of packed views; 1 if a single eye or the view itself is shown.
std::size_t stereo_view_count(const scene::Stereo& stereo);
/// Returns a one-line Error if the eyes are too far apart to see a common scene.
Outcome check_eye_separation(const FramePacket& packet, const scene::Stereo& stereo);
/// Returns the view from the same position through the display screen of the image; unchanged if there is no screen or the position is not
/// in front of it.
View make_screen_window_view(const View& view, const scene::Stereo& stereo);
/// Sets `eyes` and `packing` from the packet's view, width and height. With a display screen, the eyes are placed side by side along it and
/// share its frame.
void update_eyes(FramePacket& packet, const scene::Stereo& stereo);

/// Meshes and slices as plain data. A vector field is shown by its magnitude: on slices by a grid of the magnitudes at the voxels, built
/// once and interpolated; on meshes at each vertex.

/// Returns the contour levels within lo..hi: those listed, or `count` of them at equal distances excluding the ends, or all multiples of
/// `spacing`.
Result<std::vector<double>> contour_levels(const scene::Slice::Contours& contours, double lo, double hi);

/// Widgets (engine/widget/widget.h; paper, Figure 6a) as tubes and arrows. Frame thread.
///   cutting plane  outline of the plane in the bounds of the data (a square of edge L if they do not intersect); the sphere as three great
///                  circles, each perpendicular to one axis and in its color: x red, y green, z blue; an arrow along the normal
///                    explore     the border of the plane is thick and bright
///                    translate   a double arrow along every free axis, a square perpendicular to every locked axis
///                    rotate      the circles are thick; turn: even thicker. The locked circle is bright
///   seed           a sphere in a ring that faces the camera
///   rake, ruler    a tube with spheres at its ends and its center; the ruler's length is written beside it, and the path that it measures
///                  along a curve or a surface is shown beside its straight line
///   isolevel       a sphere, and an arrow along the field's gradient
///   box            twelve edges, a sphere on every face and one in the center
/// A hovered handle is larger and brighter, a dragged one brighter still; the axes along which it can move are shown as double arrows. No
/// tube is thinner than about a pixel of the packet's view, no sphere smaller than a few. Clip planes do not cut widgets, and the camera is
/// not fitted to them.

/// Computes the ruler measurements (engine/scene/ruler.h). To be called after scene::propagate_widgets().
Outcome prepare_widgets(scene::Scene& scene);
/// Adds the widgets; to be called when the view is known. `drawn`: bounds of the data, which limit a cutting plane's outline.
void extract_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// Rebuilds the parts that depend on the view.
void update_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

/// Ticks of a scalar bar: round values and their texts. Pure functions, any thread.
///   values   of engine/base/numbers.h, about `count` of them; on a symlog scale 0 and powers of ten, with their multiples by two and five
///            if there are few
///   texts    with the decimals that the step requires; very large or small numbers get a common factor "x 10^n". A user-defined format
///            ("%.2f") is used as it is, without a factor.
struct ScalarBarTicks {
  std::vector<BarTick> ticks;
  std::string factor;
};
/// Returns about `count` ticks for the values lo..hi. `format`: printf format of the user, empty: automatic; `linear_below`: threshold of
/// the symlog scale, 0: linear.
ScalarBarTicks make_scalar_bar_ticks(double lo, double hi, int count, const std::string& format, double linear_below = 0);

}  // namespace catena::render
