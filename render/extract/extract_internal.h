/// Private to this room: what every part of the extraction asks of the scene.
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

/// "?" where it has none.
inline std::string entity_name(const scene::Scene& scene, scene::Entity entity) {
  return scene.entities.has<scene::Name>(entity) ? scene.entities.get<scene::Name>(entity).value : std::string("?");
}

/// In order of insertion; a copy, so that components may be added meanwhile.
template <class T>
std::vector<scene::Entity> entities_with(const scene::EntityStore& world) {
  std::vector<scene::Entity> owners;
  world.each<T>([&](scene::Entity e, const T&) { owners.push_back(e); });
  return owners;
}

using ColorTable = std::vector<scene::TransferFunction::ColorPoint>;

/// Of scene.made: the table `colors` of what this room keeps beside an entity; none where that is empty.
template <class Kept>
const ColorTable* cached_colors(const scene::EntityStore& made, scene::Entity e) {
  return made.has<Kept>(e) && !made.get<Kept>(e).colors.empty() ? &made.get<Kept>(e).colors : nullptr;
}

/// Makes what this room keeps beside visible curves or points, where it was not made of what is loaded now (`of`).
template <class Kept, class Drawn, class Make>
Outcome prepare_cached(scene::Scene& scene, const Make& make) {
  for (const scene::Entity e : entities_with<Drawn>(scene.entities)) {
    if (is_hidden(scene.entities, e)) continue;
    if (!scene.cache.has<Kept>(e)) scene.cache.emplace<Kept>(e);
    if (scene.cache.get<Kept>(e).of == scene.entities.get<Drawn>(e).loaded) continue;
    const Drawn drawn = scene.entities.get<Drawn>(e);
    CATENA_TRY(Kept made, make(scene, drawn, entity_name(scene, e)));
    scene.cache.get<Kept>(e) = std::move(made);
  }
  return Done{};
}

/// Private to this room: bounding box, axes, ground, fog and lights into the packet. Frame thread.
///   bounding box   the twelve edges of a field's domain, true to rotated and sheared grids; else of the box of all that is drawn
///   axes           three edges of that box with ticks at round numbers (along the world's axes), on its outline in the picture
///   ground         a checkerboard across z, just below all that is drawn
///   fog            from the nearest to the farthest view depth of all that is drawn

/// The height of the ground below what is drawn: stated, or a little lower than all of it.
double ground_height(const scene::Ground& ground, const Bounds& drawn);

/// After everything else that is drawn, and after the view: `drawn` is its box.
void extract_environment(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// The bounding box and the axes alone: which edges the axes lie on follows the packet's view.
void update_box_lines(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// The fog alone: its range follows the packet's view.
void update_fog(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

/// Private to this room: streamline sets and the local indicator into the packet. Frame thread.
///   tubes       every line of a set is flattened once; with "color_by" each point has a colour: the value there, by the table
///   arrows      cones on the line, "arrows" apart, the seed's in the middle of the first gap
///   pulse       brightness runs along the line: a cosine of period `pulse` in arc length, moved by the scene's phase
///   indicator   the exact tracer's line through the probe, half the length to either side; nothing where the flow has no line

/// Flattens the lines.
Outcome prepare_streamlines(scene::Scene& scene);
void extract_streamlines(const scene::Scene& scene, FramePacket& packet);
/// After the cursors.
Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet);

/// An arrowhead, by the radius of what it sits on.
inline constexpr double kArrowRadius = 2.4, kArrowLength = 6;

/// Curves from files as tubes, each line's points as they are, coloured by values, by one colour or by the line's direction. Above
/// kMaxCurvePoints points an even choice of the lines, and packet.left_out says so. Errors: values that the file does not have, more
/// memory than is allowed.
inline constexpr std::size_t kMaxCurvePoints = 2'000'000;
Outcome prepare_curves(scene::Scene& scene);
void extract_curves(const scene::Scene& scene, FramePacket& packet);
const ColorTable* find_curve_colors(const scene::EntityStore& made, scene::Entity curves);

/// Points from tables as balls: coloured by a column, by a field's values or by one colour; grey for no number. Of more than kMaxSpheres an
/// even choice, and packet.left_out says so. Errors: a column that the table does not have, more memory than is allowed.
inline constexpr std::size_t kMaxSpheres = 4'000'000;
Outcome prepare_points(scene::Scene& scene);
void extract_points(const scene::Scene& scene, FramePacket& packet);
const ColorTable* find_point_colors(const scene::EntityStore& made, scene::Entity points);

/// Of scene.made: what a prepared set's "color_by" has come to: its own table, or the one over the values that are drawn. None without
/// "color_by".
const ColorTable* find_streamline_colors(const scene::EntityStore& made, scene::Entity set);

/// The colour of a value by a table with rising values; its ends beyond them; grey for no number.
Color sample_color_table(const ColorTable& table, double value);

/// Private to this room: arrows at evenly spaced places (engine/scene/uniform_sampling.h) into the packet. Frame thread.
///   length   of the longest: stated, or the spacing; of the others in proportion to their speeds, or all alike
///   none     where the field is not valid, where it is zero or not faster than "min_speed", and outside what is seen of a slice

/// Makes them, and again when the plane, the level or the data that they stand on have changed. More than scene::kMaxGlyphs of a set are an
/// error, and where they follow a widget a wider spacing.
Outcome prepare_glyphs(scene::Scene& scene);
void extract_glyphs(const scene::Scene& scene, FramePacket& packet);
/// As find_streamline_colors.
const ColorTable* find_glyph_colors(const scene::EntityStore& made, scene::Entity set);

/// Private to this room: the scene's annotations into the packet's overlay. After everything else: bars show the colours that volumes
/// and streamlines have got. Frame thread.
void extract_overlay(const scene::Scene& scene, FramePacket& packet);

/// From a scene's stereo mode to the eyes of a packet. Called by extract_frame; again by who moves the packet's view afterwards.
Packing stereo_packing(const scene::Stereo& stereo);
/// How many pictures are packed; 1 where one eye or the view itself is shown.
std::size_t stereo_view_count(const scene::Stereo& stereo);
/// Eyes that no picture has both of, for they are too far apart: one sentence.
Outcome check_eye_separation(const FramePacket& packet, const scene::Stereo& stereo);
/// The view from the same place through the screen that the picture is of; as it is where it is of none, or the place is not before it.
View make_screen_window_view(const View& view, const scene::Stereo& stereo);
/// Sets `eyes` and `packing` from the packet's view, width and height. Through a screen the eyes stand beside each other along it, and see
/// one frame there.
void update_eyes(FramePacket& packet, const scene::Stereo& stereo);

/// Meshes and slices of the scene as plain data. A vector field is shown by its magnitude: on slices by a grid of the magnitudes at the
/// voxels, made once and interpolated between them; on meshes at each vertex.

/// The drawn mesh is the felt one: the same object of the scene. Colours by a field are those of its values at the vertices;
/// grey outside its domain.
/// Makes plain triangles of the meshes.
Outcome prepare_meshes(scene::Scene& scene);
void extract_meshes(const scene::Scene& scene, FramePacket& packet);

/// Errors: a plane that misses the field, a spacing that gives more than scene::kMaxContours lines, a vector grid too large for
/// its magnitudes.
Outcome prepare_slices(scene::Scene& scene);
Outcome extract_slices(const scene::Scene& scene, FramePacket& packet);

/// ResolutionLevels within lo..hi: those listed, `count` of them at equal distances with the ends left out, or all multiples of `spacing`.
Result<std::vector<double>> contour_levels(const scene::Slice::Contours& contours, double lo, double hi);

/// Private to this room: the scene's widgets (engine/widget/widget.h; paper, Figure 6a) as tubes and arrows. Frame thread.
///   cutting plane  where its plane cuts the box of what is drawn (a square of edge L where it cuts nothing); the sphere as three great
///                  circles, each across one axis and in that axis' colour: x red, y green, z blue; an arrow along the normal
///                    explore     the plane's border is thick and bright
///                    translate   a double arrow along every axis that is free, a square across every axis that is held
///                    rotate      the circles are thick; turn: the more so. The circle that is held is bright
///   seed           a ball in a ring that faces the eye
///   rake, ruler    a tube with balls at its ends and its middle; the ruler's length is written beside it, and the way that it measures
///                  along a curve or a surface is drawn beside its straight line
///   isolevel       a ball, and an arrow along the field's gradient
///   box            twelve edges, a ball on every face and one in the middle
/// A handle that is hovered over is larger and brighter, one that is dragged brighter still; the axes along which it is free show as
/// double arrows. No tube is thinner than about a pixel of the packet's view, no ball smaller than a few. Clip planes do not touch
/// widgets, and the camera is not fitted to them.

/// Measures the rulers (engine/scene/ruler.h). After scene::propagate_widgets.
Outcome prepare_widgets(scene::Scene& scene);
/// After the view is known. `drawn` is the box of the data, which outlines a cutting plane.
void extract_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// What of it follows the view, made anew.
void update_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

/// Private to this room: nice values along a scalar bar and how they are written. Pure, any thread.
///   values   of engine/base/numbers.h, about `count` of them; on a scale that is not linear 0 and powers of ten, with their doubles and
///            fivefolds where there are few
///   texts    with the decimals that the step needs; where numbers are very large or small a common factor "x 10^n" is taken out.
///            A format of the user's ("%.2f") is taken as it is, without a factor.
struct ScalarBarTicks {
  std::vector<BarTick> ticks;
  std::string factor;
};
ScalarBarTicks make_scalar_bar_ticks(double lo, double hi, int count, const std::string& format, double linear_below = 0);

}  // namespace catena::render
