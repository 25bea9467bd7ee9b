/// These functions do what a hand does to the points of a transfer function: find, add, move, remove. Values rise strictly after every
/// step, whatever is asked: a point stays between its neighbours, the outermost within the plot. Pure, any thread.
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

inline constexpr double kMaxAlpha = scene::TransferFunction::OpacityPoint::kMaxAlpha;

/// The nearest handle within `reach` pixels; of those at one place the last.
std::optional<std::size_t> find_point(const OpacityPoints& points, const PlotTransform& frame, double x, double y, double reach);
/// Colours by x alone.
std::optional<std::size_t> find_point(const ColorPoints& points, const PlotTransform& frame, double x, double reach);

/// The index of the new point; none where there is no room between its neighbours, or the value is no number.
std::optional<std::size_t> add_point(OpacityPoints& points, const PlotTransform& frame, double value, double alpha);
/// It has the colour that was shown there.
std::optional<std::size_t> add_point(ColorPoints& points, const PlotTransform& frame, double value);

/// As near to the place as the neighbours allow. A point beyond the plot stays beyond it until it is moved.
void move_point(OpacityPoints& points, const PlotTransform& frame, std::size_t index, double value, double alpha);
void move_point(ColorPoints& points, const PlotTransform& frame, std::size_t index, double value);

/// False: the last one stays.
bool remove_point(OpacityPoints& points, std::size_t index);
bool remove_point(ColorPoints& points, std::size_t index);

/// What is drawn at a value: sigma linear between the points on their scale, constant beyond them. Of no points 0, or grey.
double evaluate_alpha(const OpacityPoints& points, double value, double linear_below = 0);
Color evaluate_color(const ColorPoints& points, double value, double linear_below = 0);

/// Lays the points anew on their scale, from where they reach to lo..hi. False (and nothing is changed) where they would fall together.
bool fit_to_range(ColorPoints& colors, OpacityPoints& opacities, double lo, double hi, double linear_below = 0);
/// From the least to the greatest value of both; none of no points.
std::optional<std::array<double, 2>> value_range(const ColorPoints& colors, const OpacityPoints& opacities);

/// This file leads from a volume as it is drawn to one whose transfer function stands in the scene as points and looks the same, and has
/// the edits of the scene's text that make it what the hand wants. Where the points came from a file, extinctions or the histogram, the
/// first edit states them all.
///   alpha = 1 - exp(-sigma u), u the opacity unit; a volume without opacities gets that at which the thickest point has alpha 0.6
/// Pure, any thread.

/// What the editor holds of a volume while it edits.
struct TransferEdit {
  ColorPoints colors;
  OpacityPoints opacities;
  double opacity_unit = 0;      ///< world length, > 0
  std::string color_map;        ///< the colours' name, if they have one; `colors` are its points
  bool has_range = false;       ///< the named map's range is stated
  scene::ValueMapping mapping;  ///< as stated
  double linear_below = 0;      ///< and what it comes to
};

/// `volume.transfer` as drawn: complete_transfer has filled it in. Empty where it has not.
std::optional<TransferEdit> make_transfer_edit(const scene::Volume& volume, double smallest_edge);

/// Where values from lo to hi can be plotted: a logarithm has no place for what is not above 0.
std::array<double, 2> plottable_range(const TransferEdit& edit, double lo, double hi);

/// What makes the text's volume look like the edit.
TextEdits make_opacity_edits(const scene::Volume& volume, TransferEdit edit);
TextEdits make_unit_edits(const scene::Volume& volume, const TransferEdit& edit);
/// Stated points; a name is given up.
TextEdits make_color_edits(const scene::Volume& volume, TransferEdit edit);
/// Another name over the range that the colours have.
TextEdits make_color_map_edits(const scene::Volume& volume, TransferEdit edit, const std::string& map);
/// Another scale between the same points; empty where they cannot lie on it.
TextEdits make_mapping_edits(const scene::Volume& volume, TransferEdit edit, const scene::ValueMapping& mapping);
/// All points over another range; empty where they cannot lie in it.
TextEdits make_range_edits(const scene::Volume& volume, TransferEdit edit, double lo, double hi);

}  // namespace catena::app
