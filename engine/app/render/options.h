/// What `catena render` was asked for, as it came from the command line.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

struct RenderOptions {
  std::string source, output, size = "1024x768", quality, stats, probe;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  int frames = 1;
  double orbit_deg = 0, phase = 0;
  bool validation = false;
};

/// All of the work. An Error: bad input; throws MachineFailure for the rest.
Outcome render_pictures(const RenderOptions& options);

}  // namespace catena::app
