// SPDX-License-Identifier: MIT
/// Labels of a label map: the numbers that its voxels hold, with names and colors. A field is a label map if it uses nearest-voxel
/// interpolation and all voxels hold integers; 0 means no label. Frame thread, off the tick.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/field/derived/label_surface.h"
#include "engine/scene/components.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// One label of a map.
struct LabelEntry {
  double value = 0;  ///< Number of the label
  std::string name;  ///< Name from the table; empty: none
  /// Color from the table, else from the palette (label_palette.h): index of its row in the table; labels without a row have the indices
  /// after the table's.
  Color color;
  std::uint64_t voxel_count = 0;  ///< Voxels that hold the label
};

/// All labels of a map.
struct LabelMap {
  std::vector<field::LabelCount> counts;  ///< All values of the map with their voxel counts, including 0
  std::vector<LabelEntry> labels;         ///< Labels, values rising, without 0
  /// Returns the label with that value; nullptr: none.
  const LabelEntry* find(double value) const;
};

/// Returns the labels of a grid; null if a voxel does not hold an integer, or there are too many (field::count_labels).
std::shared_ptr<const LabelMap> make_label_map(const field::ScalarGrid& grid, const LabelTable& table);

/// Sets `labels` of a loaded source if it is a label map and `labels` is null.
void load_label_map(FieldSource& source);
/// Returns the labels of a loaded field; nullptr if it is no label map.
const LabelMap* find_label_map(const Scene& scene, Entity field);

/// Returns the labels of the map that are inside the surface, rising. Names that the map does not have are left out.
std::vector<double> labels_inside(const LabelSource& surface, const LabelMap& map);

/// Returns "Precentral_L (1)", or "17" for a label without a name, or "no label" for 0.
std::string describe_label(const LabelMap& map, double value);
/// Returns the label's name if the field is the surface of exactly one named label ("Precentral_L"); else empty.
std::string surface_label_name(const Scene& scene, std::string_view field);

/// Returns a color table that is constant from value - 0.5 to value + 0.5 for each label.
std::vector<TransferFunction::ColorPoint> make_label_colors(const LabelMap& map);
/// Returns whether the colors are those of the labels: the field is a label map, and neither color table, map nor range is specified.
bool shows_labels(const Scene& scene, Entity field, const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named);

/// Returns the color table for values of a field: its label colors if shows_labels, else that of make_color_table (color_maps.h).
std::vector<TransferFunction::ColorPoint> make_display_color_table(const Scene& scene, Entity field,
                                                                   const std::vector<TransferFunction::ColorPoint>& colors,
                                                                   const NamedColors& named, double lo, double hi);

/// Computes the label surface that a field with `FieldSource::label` describes. The Error has the position of the source's `where`.
Result<field::AnyField> resolve_label_surface(Scene& scene, Entity field);

}  // namespace catena::scene
