// SPDX-License-Identifier: MIT
#include "engine/app/cli/measure_field.h"

#include <fmt/format.h>

#include "engine/app/cli/command.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

Result<MeasuredField> load_measured(const std::string& source, const std::string& grid, int step) {
  if (is_scene_file(source)) return Error{source + ": is a scene; a data file was expected"};
  field::LoadRequest request = scene::request_at(source, step);
  if (scene::detect_file_kind(request.path) != scene::FileKind::field)
    return Error{source + ": has no field; a data file with a field was expected"};
  request.grid = grid;
  MeasuredField loaded;
  CATENA_TRY(loaded.field, field::load(request));
  loaded.steps = scene::list_time_steps(source, loaded.field).count;
  CATENA_CHECK(check_step(step, loaded.steps - 1, fmt::format("--step {}", step), source));
  print_scene_notes(source, loaded.field.notes);
  loaded.units = field::read_units(request.path, loaded.field.get()->name());
  if (!loaded.units.length.empty()) {
    loaded.area_unit = loaded.units.length + "2";
    loaded.volume_unit = loaded.units.length + "3";
  }
  return loaded;
}

Result<MeasuredField> load_scalar(const std::string& source, const std::string& grid, int step) {
  CATENA_TRY(MeasuredField loaded, load_measured(source, grid, step));
  if (!loaded.field.scalar || loaded.field.scalar->grid() == nullptr)
    return Error{source + ": is a vector field; a scalar field was expected"};
  return loaded;
}

Error in_file(const std::string& source, Error error) {
  error.message = source + ": " + error.message;
  return error;
}

void add_left_out(MeasureReport& report, const field::LeftOut& left_out) {
  report.add("masked_voxels", left_out.masked);
  report.add("not_finite_voxels", left_out.not_finite);
}

void add_position_columns(MeasureReport& report, const std::string& unit) {
  for (const char* name : {"x", "y", "z"}) report.add_column(name, unit);
}

void append_position(std::vector<MeasureCell>& row, const Vec3& position) {
  for (int a = 0; a < 3; ++a) row.emplace_back(position[a]);
}

}  // namespace catena::app
