// SPDX-License-Identifier: MIT
/// Measurements of catena.measure_labels, measure_parts, histogram and profile: the numbers of `catena measure` as dicts of arrays.
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "engine/field/measure/histogram.h"
#include "engine/field/measure/labels.h"
#include "engine/field/measure/profile.h"
#include "engine/geometry/mesh/measure.h"
#include "engine/python/module.h"
#include "engine/scene/label_table.h"

namespace catena::python {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

const field::ScalarGrid& grid_of(const Field& field, const std::string& what) {
  const field::ScalarGrid* grid = field.any.scalar ? field.any.scalar->grid() : nullptr;
  if (grid == nullptr)
    throw Failure(Error{what + " is " + (field.any.scalar ? "a formula" : "a vector field") + "; a grid of scalars was expected"});
  return *grid;
}

/// Returns the second field of a measurement; null for None.
const field::ScalarField* values_of(const std::optional<Field>& values) {
  if (!values) return nullptr;
  if (!values->any.scalar) throw Failure(Error{"values is a vector field; a scalar field was expected"});
  return values->any.scalar.get();
}

/// Returns the value; throws Failure with `what` before the message.
template <class T>
T unwrap_named(Result<T> result, const std::string& what) {
  if (!result) throw Failure(Error{what + ": " + result.error().message, result.error().system_failure});
  return std::move(*result);
}

/// Array of a number of each row.
template <class T, class Rows, class Get>
py::array_t<T> column_of(const Rows& rows, Get get) {
  py::array_t<T> column(static_cast<py::ssize_t>(rows.size()));
  std::transform(rows.begin(), rows.end(), column.mutable_data(), get);
  return column;
}

void add_left_out(py::dict& out, const field::LeftOut& left_out) {
  out["masked_voxels"] = left_out.masked;
  out["not_finite_voxels"] = left_out.not_finite;
}

/// Adds the columns of regions: voxels, volume, statistics and centers.
template <class Regions>
void add_regions(py::dict& out, const Regions& regions, const field::Mapping& mapping, bool has_values) {
  const double volume = field::voxel_volume(mapping);
  using field::RegionStats;
  out["voxels"] = column_of<std::uint64_t>(regions, [](const RegionStats& r) { return r.voxels; });
  out["volume"] = column_of<double>(regions, [&](const RegionStats& r) { return volume * static_cast<double>(r.voxels); });
  if (has_values) {
    const auto of_valued = [](const RegionStats& r, double value) { return r.values.count() > 0 ? value : kNoValue; };
    out["valued_voxels"] = column_of<std::uint64_t>(regions, [](const RegionStats& r) { return r.values.count(); });
    out["mean"] = column_of<double>(regions, [](const RegionStats& r) { return r.values.mean(); });
    out["deviation"] = column_of<double>(regions, [](const RegionStats& r) { return r.values.deviation(); });
    out["min"] = column_of<double>(regions, [&](const RegionStats& r) { return of_valued(r, r.values.min()); });
    out["max"] = column_of<double>(regions, [&](const RegionStats& r) { return of_valued(r, r.values.max()); });
  }
  std::vector<Vec3> centers;
  for (const RegionStats& region : regions) centers.push_back(region.centroid(mapping));
  out["center"] = to_array(centers);
}

/// `path`: file of the labels, whose table of names is read; empty: none.
py::dict measure_labels(const Field& labels, const std::optional<Field>& values, const std::string& path) {
  const field::ScalarGrid& grid = grid_of(labels, "labels");
  const field::ScalarField* second = values_of(values);
  field::MeasuredLabels measured;
  scene::LabelTable names;
  {
    const py::gil_scoped_release unlocked;
    measured = unwrap_named(field::measure_labels(grid, second), "labels");
    unwrap(field::add_label_surfaces(grid, mesh::label_cell_areas(grid.mapping()), measured));
    if (const std::string table = path.empty() ? "" : scene::find_label_table(path); !table.empty())
      names = unwrap(scene::read_label_table(table));
  }
  std::vector<field::MeasuredLabel>& rows = measured.labels;
  const auto none = std::ranges::find(rows, 0.0f, &field::MeasuredLabel::label);
  const std::uint64_t unlabeled = none == rows.end() ? 0 : none->voxels;
  if (none != rows.end()) rows.erase(none);
  py::list words;
  for (const field::MeasuredLabel& row : rows) {
    const auto name = std::ranges::find(names, static_cast<double>(row.label), &scene::LabelRow::value);
    words.append(name == names.end() ? std::string() : name->name);
  }
  py::dict out;
  out["label"] = column_of<std::int64_t>(rows, [](const field::MeasuredLabel& row) { return static_cast<std::int64_t>(row.label); });
  out["name"] = py::module_::import("numpy").attr("array")(words, py::arg("dtype") = "str");
  add_regions(out, rows, grid.mapping(), second != nullptr);
  out["surface"] = column_of<double>(rows, [](const field::MeasuredLabel& row) { return row.surface; });
  out["voxel_volume"] = field::voxel_volume(grid.mapping());
  out["unlabeled_voxels"] = unlabeled;
  add_left_out(out, measured.left_out);
  return out;
}

py::dict measure_parts(const Field& field, double level, const std::optional<Field>& values, int neighbors, int parts) {
  const field::ScalarGrid& grid = grid_of(field, "data");
  const field::ScalarField* second = values_of(values);
  if (!std::isfinite(level)) throw Failure(Error{"level: a finite number was expected"});
  if (neighbors != 6 && neighbors != 26) throw Failure(Error{"neighbors is " + std::to_string(neighbors) + "; 6 or 26 was expected"});
  if (parts < 1 || parts > 10'000) throw Failure(Error{"parts is " + std::to_string(parts) + "; from 1 to 10000 were expected"});
  field::MeasuredParts measured;
  std::optional<mesh::SurfaceMeasure> surface;
  {
    const py::gil_scoped_release unlocked;
    measured = unwrap_named(
        field::measure_parts(grid, level, static_cast<field::Neighbors>(neighbors), static_cast<std::size_t>(parts), second), "data");
    auto made = mesh::measure_isosurface(grid, level, measured, "the isosurface");
    if (made)
      surface = std::move(*made);
    else if (made.error().system_failure)
      throw Failure(made.error());
  }
  std::vector<field::RegionStats> rows = measured.parts;
  if (measured.others.voxels > 0) rows.push_back(measured.others);
  std::uint64_t voxels = 0;
  for (const field::RegionStats& row : rows) voxels += row.voxels;
  py::dict out;
  py::array_t<std::int64_t> numbers(static_cast<py::ssize_t>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n)
    numbers.mutable_data()[n] = n < measured.parts.size() ? static_cast<std::int64_t>(n + 1) : 0;
  out["part"] = numbers;
  add_regions(out, rows, grid.mapping(), true);
  std::vector<mesh::PartSurface> surfaces(rows.size(), {kNoValue, 0, false});
  if (surface) std::copy_n(surface->parts.begin(), rows.size(), surfaces.begin());
  out["surface"] = column_of<double>(surfaces, [](const mesh::PartSurface& part) { return part.area; });
  out["closed"] = column_of<bool>(surfaces, [](const mesh::PartSurface& part) { return part.triangles > 0 && part.is_closed; });
  out["parts"] = measured.count;
  out["voxels_above"] = voxels;
  out["volume_above"] = field::voxel_volume(grid.mapping()) * static_cast<double>(voxels);
  out["isosurface_area"] = surface ? surface->area : kNoValue;
  out["enclosed_volume"] = surface ? surface->volume.value_or(kNoValue) : kNoValue;
  out["open_edges"] = surface ? surface->open_edges : 0;
  add_left_out(out, measured.left_out);
  return out;
}

py::dict histogram(const Field& field, int bins, const std::optional<std::pair<double, double>>& range) {
  const field::ScalarGrid& grid = grid_of(field, "data");
  if (bins < 1 || bins > field::kMaxHistogramBins)
    throw Failure(Error{"bins is " + std::to_string(bins) + "; from 1 to " + std::to_string(field::kMaxHistogramBins) + " were expected"});
  if (range && !(range->first < range->second && std::isfinite(range->second - range->first)))
    throw Failure(Error{"range: LO < HI was expected, finite numbers"});
  field::Histogram made;
  {
    const py::gil_scoped_release unlocked;
    made = unwrap_named(field::make_histogram(grid, bins, range), "data");
  }
  py::dict out;
  out["counts"] = column_of<std::uint64_t>(made.counts, [](std::uint64_t count) { return count; });
  out["edges"] = column_of<double>(made.edges, [](double edge) { return edge; });
  out["below"] = made.below;
  out["above"] = made.above;
  out["voxels"] = made.values.count();
  out["mean"] = made.values.mean();
  out["deviation"] = made.values.deviation();
  out["min"] = made.values.min();
  out["max"] = made.values.max();
  add_left_out(out, made.left_out);
  return out;
}

/// Values of points: shape (N,), or (N, 3) of a vector field; NaN where there is none.
py::array_t<double> to_values(const std::vector<field::PointValue>& points, bool vectors) {
  const auto count = static_cast<py::ssize_t>(points.size());
  py::array_t<double> values = vectors ? py::array_t<double>({count, py::ssize_t(3)}) : py::array_t<double>(count);
  double* to = values.mutable_data();
  for (const field::PointValue& point : points)
    for (int a = 0; a < (vectors ? 3 : 1); ++a) *to++ = point.value ? (*point.value)[a] : kNoValue;
  return values;
}

py::dict profile(const Field& field, const Points& start, const Points& end, int samples) {
  const Vec3 from = to_vec3(start, "start"), to = to_vec3(end, "end");
  if (!std::isfinite(norm(to - from))) throw Failure(Error{"the distance from start to end is no finite number"});
  if (samples < 2 || samples > 10'000'000)
    throw Failure(Error{"samples is " + std::to_string(samples) + "; from 2 to 10000000 were expected"});
  std::vector<field::PointValue> points;
  {
    const py::gil_scoped_release unlocked;
    points = field::sample_line(field.any, from, to, static_cast<std::size_t>(samples));
  }
  std::vector<Vec3> positions;
  for (const field::PointValue& point : points) positions.push_back(point.position);
  py::dict out;
  out["length"] = column_of<double>(points, [](const field::PointValue& point) { return point.length; });
  out["points"] = to_array(positions);
  out["values"] = to_values(points, field.any.vector != nullptr);
  return out;
}

py::array_t<double> values_at(const Field& field, const Points& points) {
  const std::vector<Vec3> places = to_points(points, "points");
  std::vector<field::PointValue> values;
  {
    const py::gil_scoped_release unlocked;
    field::Cursor cursor;
    for (const Vec3& place : places) values.push_back(field::sample_point(field.any, place, cursor));
  }
  return to_values(values, field.any.vector != nullptr);
}

}  // namespace

void add_measurements(py::module_& m) {
  m.def("_measure_labels", measure_labels, py::arg("labels"), py::arg("values"), py::arg("path"));
  m.def("_measure_parts", measure_parts, py::arg("field"), py::arg("level"), py::arg("values"), py::arg("neighbors"), py::arg("parts"));
  m.def("_histogram", histogram, py::arg("field"), py::arg("bins"), py::arg("range"));
  m.def("_profile", profile, py::arg("field"), py::arg("start"), py::arg("end"), py::arg("samples"));
  m.def("_values_at", values_at, py::arg("field"), py::arg("points"));
}

}  // namespace catena::python
