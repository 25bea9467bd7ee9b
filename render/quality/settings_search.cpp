// SPDX-License-Identifier: MIT
#include "render/quality/settings_search.h"

#include <algorithm>

#include "render/quality/fast_settings_search.h"
#include "render/quality/refinement.h"
#include "render/quality/single_image_search.h"

namespace catena::render {
namespace {

constexpr double kAbout = 1.6;  // of a time that is wanted, and by it

/// Where things are thin, refinement costs more than every pixel's rays do, and the ladder has a gap: its best takes less than this of the
/// time.
constexpr double kUnused = 0.6;
constexpr double kEveryPixel[] = {2, 1.4, 1, 0.7, 0.5};

/// The quicker of two, where it is about the time that is wanted; else one says enough.
Result<double> time_of(const ErrorEstimator& lattice, const RenderSettings& settings, double wanted_ms) {
  CATENA_TRY(const double first, measure_render_ms(lattice.renderer(), lattice.packet(), settings));
  if (first < wanted_ms / kAbout || first > wanted_ms * kAbout) return first;
  CATENA_TRY(const double second, measure_render_ms(lattice.renderer(), lattice.packet(), settings));
  return std::min(first, second);
}

/// The nearest to what cannot be reached.
QualityChoice finest(const ErrorEstimator& lattice, double e) {
  RenderSettings settings = reference_settings();
  settings.step_voxels = std::min(lattice.reference_step(), settings.step_voxels);
  return make_choice(lattice, settings, lattice.reference_error(), lattice.reference_error() <= e);
}

}  // namespace

void set_termination_for(double error, RenderSettings& settings) {
  // most of what a ray leaves out at its end is told from what it has met
  constexpr double kEndShare = 2, kSoonestEnd = 1.0 / 32;
  settings.fast->termination = std::min(kSoonestEnd, kEndShare * error / 255);
}

QualityChoice make_choice(const ErrorEstimator& lattice, const RenderSettings& settings, double error, bool reached) {
  return {settings, error, 0, reached, lattice.images_rendered()};
}

Result<QualityChoice> find_settings_for_single_image(ErrorEstimator& lattice, double e) {
  CATENA_TRY(const std::optional<QualityChoice> chosen, SingleImageSearch(lattice, e).find());
  return chosen ? *chosen : finest(lattice, e);
}

Result<QualityChoice> find_settings_for_error(ErrorEstimator& lattice, double e, const SearchProgress& progress) {
  if (lattice.uses_fast_raycast()) {
    CATENA_TRY(const std::optional<QualityChoice> chosen, FastSettingsSearch(lattice, e, progress).find());
    if (chosen) return *chosen;
  }
  std::optional<QualityChoice> good;
  for (const double step : kExactSteps) {
    // they are judged by what is finer than they are
    if (step < 2 * lattice.reference_step()) break;
    CATENA_TRY(const ErrorEstimate rays, lattice.estimate_rays(exact_level(step)));
    if (rays.meets(e)) good = make_choice(lattice, exact_level(step), rays.upper_bound, true);
    if (good && rays.upper_bound <= (lattice.is_shaded() ? kBandingShare : 1) * e) break;
  }
  return good ? *good : finest(lattice, e);
}

Result<QualityChoice> find_settings_for_time(ErrorEstimator& lattice, double ms, const SearchProgress& progress,
                                             const RenderTimeFn& timer) {
  const bool shaded = lattice.is_shaded();
  std::vector<RenderSettings> settings;
  std::vector<SettingsTrial> tried;
  const auto fits = [&](const RenderSettings& next) -> Result<bool> {
    // the first picture pays for pipelines and mirrors
    CATENA_TRY(const ErrorEstimate error, lattice.estimate_image(next));
    CATENA_TRY(const double took, timer ? timer(next) : time_of(lattice, next, ms));
    settings.push_back(next);
    tried.push_back({took, error.upper_bound});
    return took <= ms;
  };
  const std::vector<RenderSettings> ladder = quality_levels({lattice.uses_fast_raycast(), shaded});
  for (const RenderSettings& next : ladder) {
    progress(double(tried.size()) / double(ladder.size()));
    CATENA_TRY(const bool goes_on, fits(next));
    if (!goes_on) break;
  }
  if (lattice.uses_fast_raycast() && tried.back().ms > ms && tried[best_within(tried, ms)].ms < kUnused * ms)
    for (const double step : kEveryPixel) {
      CATENA_TRY(const bool goes_on, fits(fast_level(step, 1, 0, -1, shaded)));
      if (!goes_on) break;
    }
  const std::size_t best = best_within(tried, ms);
  QualityChoice chosen = make_choice(lattice, settings[best], tried[best].rmse, tried[best].ms <= ms);
  chosen.expected_ms = tried[best].ms;
  return chosen;
}

}  // namespace catena::render
