// SPDX-License-Identifier: MIT
/// Default visualization of a table of points. Private to this module.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Returns members of a scene object: balls, colored by the first column whose values differ (without "radius" and row numbers). Colors
/// range from the 1 to the 99 percentile if the values outside would take most of the color range. `file`: JSON string with the file
/// name. `note` receives one sentence on the visualization. Error: `colors` are specified but there is no such column.
Result<std::string> default_points_members(const curves::PointSet& set, const std::string& file, const NamedColors& colors,
                                           std::string& note);

}  // namespace catena::scene
