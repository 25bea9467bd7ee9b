/// The labels of a label map: the numbers that its voxels hold, with their names and colours. A field is one where its nearest voxel counts
/// and all voxels hold whole numbers; 0 is no label. Frame thread, off the tick.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/field/derived/label_surface.h"
#include "engine/scene/components.h"
#include "engine/scene/scene.h"

namespace catena::scene {

struct LabelEntry {
  double value = 0;
  std::string name;  ///< empty: the table does not say
  Color color;  ///< the table's; else of the palette (label_palette.h): by its row of the table, then by its place among the map's others
  std::uint64_t voxel_count = 0;
};

struct LabelMap {
  std::vector<field::LabelCount> counts;  ///< of all values, 0 included
  std::vector<LabelEntry> labels;         ///< values rising, without 0
  const LabelEntry* find(double value) const;
};

/// None where a voxel holds no whole number.
std::shared_ptr<const LabelMap> make_label_map(const field::ScalarGrid& grid, const LabelTable& table);

/// Sets `labels` of a source that is loaded, if it is a label map.
void load_label_map(FieldSource& source);
/// The labels of a field that is loaded; nullptr where it is no label map.
const LabelMap* find_label_map(const Scene& scene, Entity field);

/// "Precentral_L (1)", "17"; "no label" for 0.
std::string describe_label(const LabelMap& map, double value);
/// What a field is of: the name of a single label's surface, "Precentral_L"; empty: of nothing that has one.
std::string surface_label_name(const Scene& scene, std::string_view field);

/// Rows of a colour table, constant from half a label before each to half a one behind it.
std::vector<TransferFunction::ColorPoint> make_label_colors(const LabelMap& map);
/// Whether what shows the field shows its labels: nothing else is said of the colours.
bool shows_labels(const Scene& scene, Entity field, const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named);

/// What shows values of a field: its labels, or as make_color_table (color_maps.h).
std::vector<TransferFunction::ColorPoint> make_display_color_table(const Scene& scene, Entity field,
                                                                   const std::vector<TransferFunction::ColorPoint>& colors,
                                                                   const NamedColors& named, double lo, double hi);

/// The surface that a field of labels describes. Errors carry `where`.
Result<field::AnyField> resolve_label_surface(Scene& scene, Entity field);

}  // namespace catena::scene
