// SPDX-License-Identifier: MIT
/// Loading of data and common columns for `catena measure`.
#pragma once
#include <string>
#include <vector>

#include "engine/app/cli/measure_report.h"
#include "engine/field/measure/voxels.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::app {

/// A loaded field with the units that its file states.
struct MeasuredField {
  field::AnyField field;
  field::Units units;
  std::string area_unit, volume_unit;
  int steps = 1;
};

/// Loads a field and prints its notes. Error: no field, or no such step.
Result<MeasuredField> load_measured(const std::string& source, const std::string& grid, int step);
/// Loads a scalar field on a grid.
Result<MeasuredField> load_scalar(const std::string& source, const std::string& grid, int step);

/// Puts the file before a message fragment.
Error in_file(const std::string& source, Error error);

void add_left_out(MeasureReport& report, const field::LeftOut& left_out);
/// Columns "x", "y", "z" and their cells.
void add_position_columns(MeasureReport& report, const std::string& unit);
void append_position(std::vector<MeasureCell>& row, const Vec3& position);

}  // namespace catena::app
