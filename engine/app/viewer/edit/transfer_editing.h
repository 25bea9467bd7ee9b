// SPDX-License-Identifier: MIT
/// Operations of the transfer function editor on control points: find, add, move, remove. The values are strictly increasing after every
/// operation: a point stays between its neighbors, the outermost ones within the plot. Pure, any thread.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/scene/components.h"

namespace catena::app {

using OpacityPoints = std::vector<scene::TransferFunction::OpacityPoint>;
using ColorPoints = std::vector<scene::TransferFunction::ColorPoint>;

/// Maximum opacity of a point.
inline constexpr double kMaxAlpha = scene::TransferFunction::OpacityPoint::kMaxAlpha;

/// Returns the index of the nearest opacity point within `max_distance_px` pixels; the last one if several have this position.
std::optional<std::size_t> find_point(const OpacityPoints& points, const PlotTransform& frame, double x, double y, double max_distance_px);
/// Returns the index of the color point with the nearest x within `max_distance_px` pixels.
std::optional<std::size_t> find_point(const ColorPoints& points, const PlotTransform& frame, double x, double max_distance_px);

/// Adds a point and returns its index; nothing if there is no space between its neighbors, or the value is not finite.
std::optional<std::size_t> add_point(OpacityPoints& points, const PlotTransform& frame, double value, double alpha);
/// Adds a color point with the color shown at that value, and returns its index; nothing if there is no space between its neighbors, or the
/// value is not finite.
std::optional<std::size_t> add_point(ColorPoints& points, const PlotTransform& frame, double value);

/// Moves a point as close to the position as its neighbors allow. A point outside the plot stays outside until it is moved.
void move_point(OpacityPoints& points, const PlotTransform& frame, std::size_t index, double value, double alpha);
void move_point(ColorPoints& points, const PlotTransform& frame, std::size_t index, double value);

/// Removes a point; returns false for the last one, which stays.
bool remove_point(OpacityPoints& points, std::size_t index);
bool remove_point(ColorPoints& points, std::size_t index);

/// Return the opacity and the color rendered at a value: extinction linear between the points on their scale, constant beyond them. Without
/// points 0, or gray.
double evaluate_alpha(const OpacityPoints& points, double value, double linear_below = 0);
Color evaluate_color(const ColorPoints& points, double value, double linear_below = 0);

/// Rescales the points from their own range to lo..hi on their scale. Returns false, and changes nothing, if points would coincide.
bool fit_to_range(ColorPoints& colors, OpacityPoints& opacities, double lo, double hi, double linear_below = 0);
/// Returns smallest and largest value of all points; nothing without points.
std::optional<std::array<double, 2>> value_range(const ColorPoints& colors, const OpacityPoints& opacities);

/// Conversion of a volume's transfer function, as rendered, to control points stated in the scene that look the same, and the edits of the
/// scene's text for each operation. If the points came from a file, from extinctions or from the histogram, the first edit states all of
/// them.
///   alpha = 1 - exp(-sigma u), u the opacity unit; a volume without opacities gets the unit at which the thickest point has alpha 0.6
/// Pure, any thread.

/// The transfer function of a volume while it is edited.
struct TransferEdit {
  ColorPoints colors;
  OpacityPoints opacities;
  double opacity_unit = 0;      ///< World length, above 0.
  std::string color_map;        ///< Name of the color map, empty if there is none; `colors` are its points.
  bool has_range = false;       ///< The scene states the range of the named map.
  scene::ValueMapping mapping;  ///< Mapping stated by the scene.
  double linear_below = 0;      ///< The value that `mapping` resolves to.
};

/// Returns the state for the editor from `volume.transfer` as rendered, that is, completed by complete_transfer; nothing if it is not.
/// `smallest_edge`: edge of the smallest voxel, world units.
std::optional<TransferEdit> make_transfer_edit(const scene::Volume& volume, double smallest_edge);

/// Returns the part of lo..hi that can be plotted: on a logarithmic scale only values above 0.
std::array<double, 2> plottable_range(const TransferEdit& edit, double lo, double hi);

/// Return the edits that make the volume in the text match the opacities, and the opacity unit.
TextEdits make_opacity_edits(const scene::Volume& volume, TransferEdit edit);
TextEdits make_unit_edits(const scene::Volume& volume, const TransferEdit& edit);
/// Edits for stated color points; a color map name is removed.
TextEdits make_color_edits(const scene::Volume& volume, TransferEdit edit);
/// Edits for another color map over the current range of the colors.
TextEdits make_color_map_edits(const scene::Volume& volume, TransferEdit edit, const std::string& map);
/// Edits for another scale between the same points; empty if the points cannot lie on it.
TextEdits make_mapping_edits(const scene::Volume& volume, TransferEdit edit, const scene::ValueMapping& mapping);
/// Edits that move all points to another range; empty if they cannot lie in it.
TextEdits make_range_edits(const scene::Volume& volume, TransferEdit edit, double lo, double hi);

}  // namespace catena::app
