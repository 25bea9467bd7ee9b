/// Where a report comes from.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace catena::app {

/// Version, build, processor, cores, and the UTC date; the rest is added by who knows it.
std::vector<std::pair<std::string, std::string>> system_info();

}  // namespace catena::app
