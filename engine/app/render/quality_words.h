/// "--quality Q" and the scene's "quality": draft, balanced, reference, time=MS, error=E or step=VOXELS.
#pragma once
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "render/quality/quality.h"

namespace catena::app {

/// Settings, or a goal that they have yet to be measured for.
struct Quality {
  render::RenderSettings settings;
  std::optional<render::QualityGoal> goal;
};

Result<Quality> parse_quality(const std::string& words);

}  // namespace catena::app
