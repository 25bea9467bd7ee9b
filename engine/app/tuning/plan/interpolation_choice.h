/// Linear or cubic cells as a plan's choice: which fields leave it open, and how one becomes cubic. Off the tick.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace catena::app::plan {

inline constexpr const char* kInterpolationKey = "interpolation";

/// A grid from one file, read linearly, for which the scene does not say how.
bool is_interpolation_unset(const scene::FieldSource& source);

/// From now on it is read so, and what was loaded is, too. What the eye had made of it is made again. Where the memory for a cubic's
/// ghosts is missing it stays as it is, and the error says so.
Outcome set_cubic_interpolation(scene::FieldSource& source);

/// "/fields/NAME" in the scene's text.
std::string field_pointer(const std::string& name);

}  // namespace catena::app::plan
