#include "engine/app/render/quality_words.h"

#include <cmath>

#include "engine/base/numbers.h"

namespace catena::app {

Result<Quality> parse_quality(const std::string& words) {
  using Kind = render::QualityGoal::Kind;
  if (words == "draft") return Quality{render::draft_settings(), {}};
  if (words == "balanced") return Quality{render::balanced_settings(), {}};
  if (words == "reference") return Quality{render::reference_settings(), {}};
  for (const auto& [prefix, kind] : {std::pair{"error=", Kind::error}, std::pair{"time=", Kind::time}}) {
    if (!words.starts_with(prefix)) continue;
    const auto value = parse_double(words.substr(std::string_view(prefix).size()));
    if (value && std::isfinite(*value) && *value > 0) return Quality{render::balanced_settings(), render::QualityGoal{kind, *value}};
    return Error{"--quality " + words + ": expected a positive number of " + (kind == Kind::error ? "1/255" : "milliseconds")};
  }
  if (words.starts_with("step=")) {
    const auto step = parse_double(words.substr(5));
    if (step && std::isfinite(*step) && *step >= 0.01 && *step <= 100) {
      render::RenderSettings settings;
      settings.step_voxels = *step;
      return Quality{settings, {}};
    }
    return Error{"--quality " + words + ": expected a step of 0.01 to 100 voxels"};
  }
  return Error{"--quality " + words + ": expected draft, balanced, reference, time=MS, error=E or step=VOXELS"};
}

}  // namespace catena::app
