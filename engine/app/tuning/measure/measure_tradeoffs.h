// SPDX-License-Identifier: MIT
/// Command `catena tradeoff SCENE|FILE`: measures all curves of a scene and writes them as an HTML page, CSV tables and JSON.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/figures/figures.h"

namespace catena::app {

/// Options of the command line.
struct MeasureOptions {
  std::string source, output, compare, probe, grid;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  std::vector<std::string> only;    ///< Names of measurements to run; empty: all.
  std::string effort = "default";
  std::optional<std::string> shard;  ///< I/N; empty: all measurements.
};

/// Runs the command and prints the result and the files written. If the source is itself a report, nothing is measured and only its page is
/// made. An Error if the source cannot be read or measured, or the output cannot be written.
/// With a shard, only its share of the measurements is run, and written as a part (engine/app/batch/tradeoff_parts.h).
Outcome measure_tradeoffs(const MeasureOptions& options);

/// Returns the valid names for MeasureOptions::only.
std::vector<std::string> measurement_names();

}  // namespace catena::app
