// SPDX-License-Identifier: MIT
#include "render/quality/settings_search.h"

#include <algorithm>

#include "render/quality/fast_settings_search.h"
#include "render/quality/refinement.h"
#include "render/quality/single_image_search.h"

namespace catena::render {
namespace {

constexpr double kTimeRatio = 1.6;  // ratio within which a measured time is close to the wanted one

/// Share of the time below which the quality levels have a gap, because refinement of thin features costs more than full resolution; then
/// kFullResolutionSteps steps at full resolution are tried, too.
constexpr double kMinUsedShare = 0.6;
constexpr double kFullResolutionSteps[] = {2, 1.4, 1, 0.7, 0.5};

/// Measures the render time: the faster of two runs, if the first is close to the wanted time.
Result<double> measure_time(const ErrorEstimator& estimator, const RenderSettings& settings, double wanted_ms) {
  CATENA_TRY(const double first, measure_render_ms(estimator.renderer(), estimator.packet(), settings));
  if (first < wanted_ms / kTimeRatio || first > wanted_ms * kTimeRatio) return first;
  CATENA_TRY(const double second, measure_render_ms(estimator.renderer(), estimator.packet(), settings));
  return std::min(first, second);
}

/// Returns the finest settings, for a goal that no other settings meet.
QualityChoice finest(const ErrorEstimator& estimator, double e) {
  RenderSettings settings = reference_settings();
  settings.step_voxels = std::min(estimator.reference_step(), settings.step_voxels);
  return make_choice(estimator, settings, estimator.reference_error(), estimator.reference_error() <= e);
}

}  // namespace

void set_termination_for(double error, RenderSettings& settings) {
  // most of the light that a terminated ray omits is extrapolated from its accumulated color
  constexpr double kTerminationShare = 2, kMaxTermination = 1.0 / 32;
  settings.fast->termination = std::min(kMaxTermination, kTerminationShare * error / 255);
}

QualityChoice make_choice(const ErrorEstimator& estimator, const RenderSettings& settings, double error, bool reached) {
  return {settings, error, 0, reached, estimator.images_rendered()};
}

Result<QualityChoice> find_settings_for_single_image(ErrorEstimator& estimator, double e) {
  CATENA_TRY(const std::optional<QualityChoice> chosen, SingleImageSearch(estimator, e).find());
  return chosen ? *chosen : finest(estimator, e);
}

Result<QualityChoice> find_settings_for_error(ErrorEstimator& estimator, double e, const SearchProgress& progress) {
  if (estimator.uses_fast_raycast()) {
    CATENA_TRY(const std::optional<QualityChoice> chosen, FastSettingsSearch(estimator, e, progress).find());
    if (chosen) return *chosen;
  }
  std::optional<QualityChoice> good;
  for (const double step : kExactSteps) {
    // the reference must be finer than the tested step
    if (step < 2 * estimator.reference_step()) break;
    CATENA_TRY(const ErrorEstimate rays, estimator.estimate_rays(exact_level(step)));
    if (rays.meets(e)) good = make_choice(estimator, exact_level(step), rays.upper_bound, true);
    if (good && rays.upper_bound <= (estimator.is_shaded() ? kBandingShare : 1) * e) break;
  }
  return good ? *good : finest(estimator, e);
}

Result<QualityChoice> find_settings_for_time(ErrorEstimator& estimator, double ms, const SearchProgress& progress,
                                             const RenderTimeFn& timer) {
  const bool shaded = estimator.is_shaded();
  std::vector<RenderSettings> settings;
  std::vector<SettingsTrial> tried;
  const auto fits = [&](const RenderSettings& next) -> Result<bool> {
    // renders the image first, so that pipelines and resident grids do not count in the time
    CATENA_TRY(const ErrorEstimate error, estimator.estimate_image(next));
    CATENA_TRY(const double took, timer ? timer(next) : measure_time(estimator, next, ms));
    settings.push_back(next);
    tried.push_back({took, error.upper_bound});
    return took <= ms;
  };
  const std::vector<RenderSettings> ladder = quality_levels({estimator.uses_fast_raycast(), shaded});
  for (const RenderSettings& next : ladder) {
    progress(double(tried.size()) / double(ladder.size()));
    CATENA_TRY(const bool goes_on, fits(next));
    if (!goes_on) break;
  }
  if (estimator.uses_fast_raycast() && tried.back().ms > ms && tried[best_within(tried, ms)].ms < kMinUsedShare * ms)
    for (const double step : kFullResolutionSteps) {
      CATENA_TRY(const bool goes_on, fits(fast_level(step, 1, 0, -1, shaded)));
      if (!goes_on) break;
    }
  const std::size_t best = best_within(tried, ms);
  QualityChoice chosen = make_choice(estimator, settings[best], tried[best].rmse, tried[best].ms <= ms);
  chosen.expected_ms = tried[best].ms;
  return chosen;
}

}  // namespace catena::render
