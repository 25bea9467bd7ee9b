// SPDX-License-Identifier: MIT
/// Description of the system and the build that a report was made with.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace catena::app {

/// Returns name and value of: version, build, processor, cores, UTC date. The caller appends what else it knows.
std::vector<std::pair<std::string, std::string>> system_info();

}  // namespace catena::app
