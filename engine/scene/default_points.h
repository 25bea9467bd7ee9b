/// How a table of points is shown of which nobody says how. Inside this room only.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Members of a scene's object: balls, coloured by the first column of values that differ, from its 1 to its 99 percentile where the rest
/// would take most of the colours. `file`: as JSON. `note`: what is shown, one sentence. Error: colours are stated and there is no such
/// column.
Result<std::string> default_points_members(const curves::PointSet& set, const std::string& file, const NamedColors& colors,
                                           std::string& note);

}  // namespace catena::scene
