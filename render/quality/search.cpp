#include "render/quality/search.h"

#include <algorithm>

#include "render/quality/fast_search.h"
#include "render/quality/one_picture.h"
#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kAbout = 1.6;  // of a time that is wanted, and by it

/// Where things are thin, refinement costs more than every pixel's rays do, and the ladder has a gap: its best takes less than this of the
/// time.
constexpr double kUnused = 0.6;
constexpr double kEveryPixel[] = {2, 1.4, 1, 0.7, 0.5};

/// The quicker of two, where it is about the time that is wanted; else one says enough.
Result<double> time_of(const Lattice& lattice, const RenderSettings& settings, double wanted_ms) {
  CATENA_TRY(const double first, drawing_ms(lattice.renderer(), lattice.packet(), settings));
  if (first < wanted_ms / kAbout || first > wanted_ms * kAbout) return first;
  CATENA_TRY(const double second, drawing_ms(lattice.renderer(), lattice.packet(), settings));
  return std::min(first, second);
}

/// The nearest to what cannot be reached.
QualityChoice finest(const Lattice& lattice, double e) {
  RenderSettings settings = reference_settings();
  settings.step_voxels = std::min(lattice.truth_step(), settings.step_voxels);
  return choice_of(lattice, settings, lattice.truth_error(), lattice.truth_error() <= e);
}

}  // namespace

void end_rays_for(double error, RenderSettings& settings) {
  // most of what a ray leaves out at its end is told from what it has met
  constexpr double kEndShare = 2, kSoonestEnd = 1.0 / 32;
  settings.fast->termination = std::min(kSoonestEnd, kEndShare * error / 255);
}

QualityChoice choice_of(const Lattice& lattice, const RenderSettings& settings, double error, bool reached) {
  return {settings, error, 0, reached, lattice.pictures()};
}

Result<QualityChoice> settings_for_one(Lattice& lattice, double e) {
  CATENA_TRY(const std::optional<QualityChoice> chosen, OnePicture(lattice, e).find());
  return chosen ? *chosen : finest(lattice, e);
}

Result<QualityChoice> settings_for_error(Lattice& lattice, double e, const SearchProgress& progress) {
  if (lattice.fast()) {
    CATENA_TRY(const std::optional<QualityChoice> chosen, FastSearch(lattice, e, progress).find());
    if (chosen) return *chosen;
  }
  std::optional<QualityChoice> good;
  for (const double step : kExactSteps) {
    // they are judged by what is finer than they are
    if (step < 2 * lattice.truth_step()) break;
    CATENA_TRY(const LatticeError rays, lattice.of_rays(exact_rung(step)));
    if (rays.good_for(e)) good = choice_of(lattice, exact_rung(step), rays.above, true);
    if (good && rays.above <= (lattice.shaded() ? kRingShare : 1) * e) break;
  }
  return good ? *good : finest(lattice, e);
}

Result<QualityChoice> settings_for_time(Lattice& lattice, double ms, const SearchProgress& progress, const DrawTimer& timer) {
  const bool shaded = lattice.shaded();
  std::vector<RenderSettings> settings;
  std::vector<TimedPicture> tried;
  const auto fits = [&](const RenderSettings& next) -> Result<bool> {
    // the first picture pays for pipelines and mirrors
    CATENA_TRY(const LatticeError error, lattice.of_picture(next));
    CATENA_TRY(const double took, timer ? timer(next) : time_of(lattice, next, ms));
    settings.push_back(next);
    tried.push_back({took, error.above});
    return took <= ms;
  };
  const std::vector<RenderSettings> ladder = quality_ladder({lattice.fast(), shaded});
  for (const RenderSettings& next : ladder) {
    progress(double(tried.size()) / double(ladder.size()));
    CATENA_TRY(const bool goes_on, fits(next));
    if (!goes_on) break;
  }
  if (lattice.fast() && tried.back().ms > ms && tried[best_within(tried, ms)].ms < kUnused * ms)
    for (const double step : kEveryPixel) {
      CATENA_TRY(const bool goes_on, fits(fast_rung(step, 1, 0, -1, shaded)));
      if (!goes_on) break;
    }
  const std::size_t best = best_within(tried, ms);
  QualityChoice chosen = choice_of(lattice, settings[best], tried[best].rmse, tried[best].ms <= ms);
  chosen.expected_ms = tried[best].ms;
  return chosen;
}

}  // namespace catena::render
