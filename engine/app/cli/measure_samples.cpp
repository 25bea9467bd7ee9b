// SPDX-License-Identifier: MIT
/// Profiles, values at points, histograms, distances and angles.
#include <fmt/format.h>

#include "engine/app/cli/measure_data.h"
#include "engine/app/cli/measure_field.h"
#include "engine/field/measure/histogram.h"
#include "engine/field/measure/profile.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

namespace {

/// Columns "value", or "value_x", "value_y", "value_z".
void add_sample_columns(MeasureReport& report, const MeasuredField& measured) {
  if (measured.field.scalar) report.add_column("value", measured.units.value);
  for (const char* name : {"value_x", "value_y", "value_z"})
    if (measured.field.vector) report.add_column(name, measured.units.value);
}

void append_sample(std::vector<MeasureCell>& row, const MeasuredField& measured, const field::PointValue& sample) {
  for (int a = 0; a < (measured.field.scalar ? 1 : 3); ++a) row.push_back(sample.value ? MeasureCell((*sample.value)[a]) : MeasureCell());
}

}  // namespace

Result<MeasureReport> measure_profile(const MeasureRequest& request) {
  CATENA_TRY(const MeasuredField loaded, load_measured(request.source, request.grid, request.step));
  MeasureReport report{"line", request.source, {}, {}, {}, {}};
  report.add_column("length", loaded.units.length);
  add_position_columns(report, loaded.units.length);
  add_sample_columns(report, loaded);
  std::uint64_t outside = 0;
  for (const field::PointValue& sample :
       field::sample_line(loaded.field, request.points[0], request.points[1], static_cast<std::size_t>(request.samples))) {
    std::vector<MeasureCell> row{sample.length};
    append_position(row, sample.position);
    append_sample(row, loaded, sample);
    outside += sample.value ? 0 : 1;
    report.rows.push_back(std::move(row));
  }
  report.add("line_length", norm(request.points[1] - request.points[0]), loaded.units.length);
  report.add("samples", static_cast<std::uint64_t>(request.samples));
  report.add("samples_outside", outside);
  return report;
}

Result<MeasureReport> measure_at_points(const MeasureRequest& request) {
  MeasureReport report{"points", request.source, {}, {}, {}, {}};
  scene::TimeSteps times;
  bool is_scalar = true;
  for (int step = 0; step < std::max(1, times.count); ++step) {
    CATENA_TRY(const MeasuredField loaded, load_measured(request.source, request.grid, step));
    if (step == 0) {
      times = scene::list_time_steps(request.source, loaded.field);
      is_scalar = loaded.field.scalar != nullptr;
      report.add_column("step");
      report.add_column("time", times.time_unit);
      report.add_column("point");
      add_position_columns(report, loaded.units.length);
      add_sample_columns(report, loaded);
    } else if ((loaded.field.scalar != nullptr) != is_scalar) {
      return Error{fmt::format("{}: step {} is a {} field, unlike step 0", request.source, step, is_scalar ? "vector" : "scalar")};
    }
    field::Cursor cursor;
    for (std::size_t n = 0; n < request.points.size(); ++n) {
      const bool has_times = static_cast<int>(times.times.size()) == times.count;
      std::vector<MeasureCell> row{static_cast<std::uint64_t>(step),
                                   has_times ? MeasureCell(times.times[static_cast<std::size_t>(step)]) : MeasureCell(),
                                   std::uint64_t{n + 1}};
      append_position(row, request.points[n]);
      append_sample(row, loaded, field::sample_point(loaded.field, request.points[n], cursor));
      report.rows.push_back(std::move(row));
    }
  }
  report.add("steps", static_cast<std::uint64_t>(std::max(1, times.count)));
  return report;
}

Result<MeasureReport> measure_histogram(const MeasureRequest& request) {
  CATENA_TRY(const MeasuredField loaded, load_scalar(request.source, request.grid, request.step));
  const auto made = field::make_histogram(*loaded.field.scalar->grid(), request.bins, request.range);
  if (!made) return in_file(request.source, made.error());
  MeasureReport report{"histogram", request.source, {}, {}, {}, {}};
  report.add("voxels", made->values.count());
  report.add("mean", made->values.mean(), loaded.units.value);
  report.add("deviation", made->values.deviation(), loaded.units.value);
  report.add("min", made->values.min(), loaded.units.value);
  report.add("max", made->values.max(), loaded.units.value);
  report.add("below", made->below);
  report.add("above", made->above);
  add_left_out(report, made->left_out);
  report.add_column("lower", loaded.units.value);
  report.add_column("upper", loaded.units.value);
  report.add_column("count");
  for (std::size_t n = 0; n < made->counts.size(); ++n) report.rows.push_back({made->edges[n], made->edges[n + 1], made->counts[n]});
  return report;
}

Result<MeasureReport> measure_geometry(const MeasureRequest& request) {
  std::string unit;
  if (!request.source.empty()) {
    CATENA_TRY(const MeasuredField loaded, load_measured(request.source, request.grid, request.step));
    unit = loaded.units.length;
  }
  const std::vector<Vec3>& p = request.points;
  const bool is_angle = p.size() == 3;
  MeasureReport report{is_angle ? "angle" : "distance", request.source, {}, {}, {}, {}};
  if (is_angle) {
    const std::optional<double> angle = field::angle_deg(p[0], p[1], p[2]);
    if (!angle) return Error{"--angle: two of the points coincide; three different points were expected"};
    report.add_column("angle", "degrees");
    report.rows.push_back({*angle});
    return report;
  }
  report.add_column("distance", unit);
  for (const char* name : {"dx", "dy", "dz"}) report.add_column(name, unit);
  report.rows.push_back({norm(p[1] - p[0])});
  append_position(report.rows.back(), p[1] - p[0]);
  return report;
}

}  // namespace catena::app
