// SPDX-License-Identifier: MIT
/// Labels, and an isosurface with its connected parts.
#include <fmt/format.h>

#include <algorithm>

#include "engine/app/cli/command.h"
#include "engine/app/cli/measure_data.h"
#include "engine/app/cli/measure_field.h"
#include "engine/field/measure/labels.h"
#include "engine/field/measure/parts.h"
#include "engine/geometry/mesh/measure.h"
#include "engine/scene/label_table.h"

namespace catena::app {

namespace {

/// Loads the field of --values, at its own step if it has several; null without the option.
Result<std::optional<MeasuredField>> load_values(const MeasureRequest& request) {
  if (request.values.empty()) return std::optional<MeasuredField>{};
  CATENA_TRY(MeasuredField first, load_scalar(request.values, request.values_grid, 0));
  if (request.step == 0 || first.steps == 1) return std::optional{std::move(first)};
  CATENA_TRY(MeasuredField loaded, load_scalar(request.values, request.values_grid, request.step));
  return std::optional{std::move(loaded)};
}

void add_value_columns(MeasureReport& report, const std::string& unit) {
  report.add_column("valued_voxels");
  for (const char* name : {"mean", "deviation", "min", "max"}) report.add_column(name, unit);
}

void append_values(std::vector<MeasureCell>& row, const field::Moments& values) {
  row.emplace_back(values.count());
  for (const double v : {values.mean(), values.deviation(), values.min(), values.max()}) row.emplace_back(v);
}

/// A note when the second field has other voxels than the first.
void add_lattice_note(MeasureReport& report, const MeasuredField& measured, const std::optional<MeasuredField>& values) {
  if (values && !field::is_same_lattice(*measured.field.get(), *values->field.get()))
    report.notes.push_back("the values are interpolated at the voxel centers of " + report.file);
}

const field::ScalarField* second_field(const std::optional<MeasuredField>& values) { return values ? values->field.scalar.get() : nullptr; }

}  // namespace

Result<MeasureReport> measure_label_map(const MeasureRequest& request) {
  CATENA_TRY(const MeasuredField map, load_scalar(request.source, request.grid, request.step));
  CATENA_TRY(const std::optional<MeasuredField> values, load_values(request));
  const field::ScalarGrid& grid = *map.field.scalar->grid();
  auto measured = field::measure_labels(grid, second_field(values));
  if (!measured) return Error{request.source + ": " + measured.error().message + "; --level measures other fields"};
  if (const Outcome done = field::add_label_surfaces(grid, mesh::label_cell_areas(grid.mapping()), *measured); !done)
    return in_file(request.source, done.error());
  scene::LabelTable names;
  if (const std::string path = scene::find_label_table(request.source); !path.empty()) {
    CATENA_TRY(names, scene::read_label_table(path));
  }
  MeasureReport report{"labels", request.source, {}, {}, {}, {}};
  const double volume = field::voxel_volume(grid.mapping());
  report.add("voxel_volume", volume, map.volume_unit);
  std::uint64_t unlabeled = 0;
  report.add_column("label");
  report.add_column("name");
  report.add_column("voxels");
  report.add_column("volume", map.volume_unit);
  report.add_column("surface", map.area_unit);
  if (values) add_value_columns(report, values->units.value);
  add_position_columns(report, map.units.length);
  for (const field::MeasuredLabel& label : measured->labels) {
    if (label.label == 0) {
      unlabeled = label.voxels;
      continue;
    }
    const auto name = std::ranges::find(names, static_cast<double>(label.label), &scene::LabelRow::value);
    std::vector<MeasureCell> row{static_cast<double>(label.label), name == names.end() ? MeasureCell() : MeasureCell(name->name),
                                 label.voxels, volume * static_cast<double>(label.voxels), label.surface};
    if (values) append_values(row, label.values);
    append_position(row, label.centroid(grid.mapping()));
    report.rows.push_back(std::move(row));
  }
  report.add("labels", std::uint64_t{report.rows.size()});
  report.add("unlabeled_voxels", unlabeled);
  add_left_out(report, measured->left_out);
  report.notes.push_back(
      "the surface is that of the voxels, triangulated at 0.5 without smoothing; of a smooth body it is 5 to 10 % too large");
  add_lattice_note(report, map, values);
  return report;
}

Result<MeasureReport> measure_level(const MeasureRequest& request) {
  CATENA_TRY(const MeasuredField loaded, load_scalar(request.source, request.grid, request.step));
  CATENA_TRY(const std::optional<MeasuredField> values, load_values(request));
  const field::ScalarGrid& grid = *loaded.field.scalar->grid();
  const auto measured = field::measure_parts(grid, *request.level, request.neighbors == 6 ? field::Neighbors::faces : field::Neighbors::all,
                                             static_cast<std::size_t>(request.parts), second_field(values));
  if (!measured) return in_file(request.source, measured.error());
  MeasureReport report{"level", request.source, {}, {}, {}, {}};
  std::optional<mesh::SurfaceMeasure> whole;
  {
    ProgressLine progress("measure", 1);
    auto surface = mesh::measure_isosurface(grid, *request.level, *measured, "the isosurface", [&](double done) { progress.update(done); });
    if (surface) {
      whole = std::move(*surface);
    } else if (surface.error().system_failure) {
      return surface.error();
    } else {
      report.notes.push_back(surface.error().message);
    }
  }
  const double volume = field::voxel_volume(grid.mapping());
  std::uint64_t voxels = measured->others.voxels;
  for (const field::RegionStats& part : measured->parts) voxels += part.voxels;
  report.add("level", *request.level, loaded.units.value);
  report.add("voxels_above", voxels);
  report.add("volume_above", volume * static_cast<double>(voxels), loaded.volume_unit);
  report.add("isosurface_area", whole ? MeasureCell(whole->area) : MeasureCell(), loaded.area_unit);
  report.add("closed", whole ? MeasureCell(whole->volume.has_value()) : MeasureCell());
  report.add("open_edges", whole ? MeasureCell(whole->open_edges) : MeasureCell());
  report.add("enclosed_volume", whole && whole->volume ? MeasureCell(*whole->volume) : MeasureCell(), loaded.volume_unit);
  report.add("neighbors", static_cast<std::uint64_t>(request.neighbors));
  report.add("parts", measured->count);
  add_left_out(report, measured->left_out);
  report.add_column("part");
  report.add_column("voxels");
  report.add_column("volume", loaded.volume_unit);
  report.add_column("surface", loaded.area_unit);
  report.add_column("closed");
  add_value_columns(report, values ? values->units.value : loaded.units.value);
  add_position_columns(report, loaded.units.length);
  const auto add_part = [&](MeasureCell name, const field::RegionStats& part, std::size_t n) {
    std::vector<MeasureCell> row{std::move(name), part.voxels, volume * static_cast<double>(part.voxels)};
    row.push_back(whole ? MeasureCell(whole->parts[n].area) : MeasureCell());
    row.push_back(whole && whole->parts[n].triangles > 0 ? MeasureCell(whole->parts[n].is_closed) : MeasureCell());
    append_values(row, part.values);
    append_position(row, part.centroid(grid.mapping()));
    report.rows.push_back(std::move(row));
  };
  for (std::size_t n = 0; n < measured->parts.size(); ++n) add_part(std::uint64_t{n + 1}, measured->parts[n], n);
  if (measured->others.voxels > 0) add_part(std::string("others"), measured->others, measured->parts.size());
  if (whole && !whole->volume)
    report.notes.push_back(
        "the surface ends at the border of the grid or at missing values and encloses no volume; volume_above counts voxels");
  if (whole && whole->volume && whole->encloses_lower) report.notes.push_back("the surface encloses values below the level");
  add_lattice_note(report, loaded, values);
  return report;
}

}  // namespace catena::app
