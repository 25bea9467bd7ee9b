// SPDX-License-Identifier: MIT
/// `catena info --json`: the contents of `catena info` as one JSON object on one line of stdout. docs/reference/columns.md lists its
/// members.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena::app {

/// Prints the information on a scene or data file. `grid`: name or number of one grid, or empty. `step`: time step.
Outcome print_json_info(const std::string& path, const std::string& grid, int step);

}  // namespace catena::app
