// SPDX-License-Identifier: MIT
/// The measurements of `catena measure`: loads the data, calls engine/field/measure and engine/geometry/mesh/measure.h, and makes a report.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/cli/measure_report.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::app {

/// What to measure, and of which data.
struct MeasureRequest {
  std::string source, grid, values, values_grid;  ///< data file or pattern; `values`: a second one for the statistics
  int step = 0;                                   ///< time step
  std::optional<double> level;
  int neighbors = 26, parts = 20, bins = 0, samples = 256;
  std::optional<std::pair<double, double>> range;  ///< of the histogram
  std::vector<Vec3> points;                        ///< points, or the ends of a line
};

/// Labels of a label map. Errors name the file.
Result<MeasureReport> measure_label_map(const MeasureRequest& request);
/// Isosurface at a level, and the connected parts at or above it.
Result<MeasureReport> measure_level(const MeasureRequest& request);
/// Values along the line between the first two points.
Result<MeasureReport> measure_profile(const MeasureRequest& request);
/// Values at points, at every time step.
Result<MeasureReport> measure_at_points(const MeasureRequest& request);
Result<MeasureReport> measure_histogram(const MeasureRequest& request);
/// Distance of two points, or angle at the second of three points; the file only provides the unit of length and may be empty.
Result<MeasureReport> measure_geometry(const MeasureRequest& request);

}  // namespace catena::app
