/// `catena tradeoff SCENE|FILE`: all curves of a scene, as a page, tables and JSON.
#pragma once
#include <string>
#include <vector>

#include "engine/app/tuning/tradeoff/figures.h"

namespace catena::app {

struct MeasureOptions {
  std::string source, output, compare, probe, grid;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  std::vector<std::string> only;    ///< names of measurements; empty: all
  bool quick = false, thorough = false;
};

/// A source that is a report is not measured again: its page is made. Prints what was written.
Outcome measure_tradeoffs(const MeasureOptions& options);

/// The names that `only` may have.
std::vector<std::string> measurement_names();

}  // namespace catena::app
