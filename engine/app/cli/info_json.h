/// `catena info --json`: what `info` tells, as one JSON object on one line of stdout. docs/command-line.md has its members.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena::app {

Outcome print_json_info(const std::string& path, const std::string& grid, int step);

}  // namespace catena::app
