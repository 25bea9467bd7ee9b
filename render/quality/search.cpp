#include "render/quality/search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kStepShare = 0.93;  // of the error that ray steps may take
constexpr int kMaxPictures = 16;
constexpr std::size_t kGoodSteps = 5;  // of those that are good enough, the longest
constexpr double kStill = 0.95;        // of the error of a longer step: hardly less
// of the error, that a ray may leave out at its end: most of that is told from what it has met
constexpr double kEndShare = 2, kSoonestEnd = 1.0 / 32;

/// How rays become a picture. Refinement thresholds in shares of the error; then the rays of every 2nd pixel and of every pixel that are
/// refined, by all such that show something: guesses, until one was drawn.
struct Plan {
  std::uint32_t spacing;
  double refine_half, refine_full;
  std::array<double, 2> refined;
};
constexpr Plan kPlan[] = {{4, -1, -1, {0, 0}},  {4, 1.3, -1, {0.4, 0}}, {2, 0, -1, {0, 0}},     {4, 1, 3, {0.45, 0.1}},
                          {2, 0, 2, {0, 0.15}}, {2, 0, 1.5, {0, 0.22}}, {2, 0, 0.8, {0, 0.37}}, {1, 0, -1, {0, 0}}};
constexpr int kPlans = int(std::size(kPlan));
/// Of every pixel's rays by those of the first lattice, and of a refined share: a ray costs the more the farther its neighbours are. As a
/// CPU driver has it: it only decides between settings that are good enough.
double cost_of(const Plan& plan, const std::array<double, 2>& refined, const FastSettings& f) {
  const double first = plan.spacing == 1 ? 1 : plan.spacing == 2 ? 0.325 : 0.137;
  const double marks = plan.refine_full >= 0 ? 0.02 : 0;
  const double a_ray = (f.smooth_gradients ? kSmoothCost : 1) * (kStepless + (1 - kStepless) / f.step_voxels);
  return (first + marks + 0.29 * refined[0] + refined[1]) * a_ray;
}
constexpr double kFastSteps[] = {8, 6, 4, 3, 2, 1.5, 1.2, 1, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.25, 0.18, 0.125};
constexpr double kExactSteps[] = {4, 2.8, 2, 1.4, 1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.06, 0.04, 0.03};

struct Candidate {
  RenderSettings settings;
  double rays, above;  ///< of the rays alone: LatticeError
  int plan;
};

/// What a plan's picture refined; stricter plans refine no less.
void learn(int plan, const std::array<double, 2>& found, std::array<double, 2> (&refined)[kPlans]) {
  refined[plan] = found;
  const Plan& p = kPlan[plan];
  for (int other = 0; other < kPlans; ++other) {
    const Plan& o = kPlan[other];
    if (o.refine_half > 0 && o.refine_half < p.refine_half) refined[other][0] = std::max(refined[other][0], found[0]);
    if (o.refine_full > 0 && o.refine_full < p.refine_full) refined[other][1] = std::max(refined[other][1], found[1]);
  }
}

/// Rays of a step with a plan, which end when they may leave out no more than the error says.
RenderSettings planned(const Plan& plan, double step, double e, bool smooth) {
  RenderSettings s = fast_rung(step, plan.spacing, plan.refine_half * e, plan.refine_full * e, smooth);
  s.fast->termination = std::min(kSoonestEnd, kEndShare * e / 255);
  return s;
}

/// The longest steps whose rays alone are good enough, and steady, with every plan of interpolation. Light by the gradient of the cell
/// has an error that no step mends: steps that make it hardly less are the last.
Outcome add_candidates(Lattice& lattice, double e, bool smooth, std::vector<Candidate>& all) {
  const bool floor = !smooth && lattice.packet().volumes.front().shade;
  const std::size_t most = all.size() + kGoodSteps * std::size(kPlan);
  double before = std::numeric_limits<double>::infinity();
  for (const double step : kFastSteps) {
    if (all.size() == most) break;
    const RenderSettings every_ray = planned(kPlan[kPlans - 1], step, e, smooth);
    CATENA_TRY(const LatticeError error, lattice.of_rays(every_ray));
    if (floor && error.rmse > kStill * before) break;
    before = error.rmse;
    if (error.rmse > kStepShare * e || error.p999 > kFarthest * e) continue;
    CATENA_TRY(const bool steady, lattice.rays_are_steady(every_ray));
    if (!steady) continue;
    for (int plan = 0; plan < kPlans; ++plan) {
      all.push_back({planned(kPlan[plan], step, e, smooth), error.rmse, error.above, plan});
    }
  }
  return Done{};
}

Result<std::vector<Candidate>> fast_candidates(Lattice& lattice, double e) {
  std::vector<Candidate> all;
  CATENA_CHECK(add_candidates(lattice, e, false, all));
  if (lattice.packet().volumes.front().shade) CATENA_CHECK(add_candidates(lattice, e, true, all));
  return all;
}

QualityChoice choice(const Lattice& lattice, const RenderSettings& settings, double error, bool reached) {
  return {settings, error, 0, reached, lattice.pictures()};
}

/// The cheapest of the fast settings that are good enough; nothing where none is.
Result<std::optional<QualityChoice>> fast_for_error(Lattice& lattice, double e) {
  CATENA_TRY(std::vector<Candidate> candidates, fast_candidates(lattice, e));
  std::array<double, 2> refined[kPlans];
  for (int plan = 0; plan < kPlans; ++plan) refined[plan] = kPlan[plan].refined;
  // of a plan, by the gradient of the cell and by central differences
  std::optional<double> failed[2][kPlans];  // what interpolation cost the latest
  int blurs[2][kPlans] = {};                // what is thin, at so many steps
  std::optional<QualityChoice> best;
  double best_cost = std::numeric_limits<double>::infinity();
  const auto cost = [&](const Candidate& c) { return cost_of(kPlan[c.plan], refined[c.plan], *c.settings.fast); };
  // every ray, of the longest step that keeps what is thin
  for (const Candidate& c : candidates) {
    if (c.settings.fast->spacing > 1 || best || c.above > e) continue;
    CATENA_CHECK(lattice.of_picture(c.settings));
    CATENA_TRY(const bool keeps, lattice.keeps_what_is_thin(e));
    if (keeps) best = choice(lattice, c.settings, c.above, true), best_cost = cost(c);
  }
  std::erase_if(candidates, [](const Candidate& c) { return c.settings.fast->spacing == 1; });
  for (int drawn = 0; !candidates.empty() && drawn < kMaxPictures;) {
    const auto cheapest = std::ranges::min_element(candidates, {}, cost);
    const Candidate next = *cheapest;
    candidates.erase(cheapest);
    if (cost(next) >= best_cost) break;
    // what interpolation cost at another step says whether this one is worth a picture
    const bool smooth = next.settings.fast->smooth_gradients;
    std::optional<double>& before = failed[smooth][next.plan];
    if (blurs[smooth][next.plan] > 1 || (before && std::hypot(next.rays, *before) > e)) continue;
    CATENA_TRY(const LatticeError picture, lattice.of_picture(next.settings));
    ++drawn;
    CATENA_TRY(const auto rays, lattice.refined());
    learn(next.plan, rays, refined);
    if (picture.good_for(e)) {
      if (cost(next) >= best_cost) continue;
      CATENA_TRY(const bool keeps, lattice.keeps_what_is_thin(e));
      CATENA_TRY(const bool steady, keeps ? lattice.picture_is_steady(next.settings) : false);
      if (steady) best = choice(lattice, next.settings, picture.above, true), best_cost = cost(next);
      if (keeps) continue;
    }
    // where a few pixels are far off, or what is thin is lost, a shorter step may mend it once
    blurs[smooth][next.plan] += picture.above <= e;
    before = std::sqrt(std::max(0.0, picture.above * picture.above - next.rays * next.rays));
  }
  if (best) best->pictures = lattice.pictures();
  return best;
}

Result<double> quicker_of_two(const Lattice& lattice, const RenderSettings& settings) {
  CATENA_TRY(const double first, drawing_ms(lattice.renderer(), lattice.packet(), settings));
  CATENA_TRY(const double second, drawing_ms(lattice.renderer(), lattice.packet(), settings));
  return std::min(first, second);
}

}  // namespace

Result<QualityChoice> settings_for_error(Lattice& lattice, double e) {
  if (lattice.fast()) {
    CATENA_TRY(const std::optional<QualityChoice> chosen, fast_for_error(lattice, e));
    if (chosen) return *chosen;
  }
  for (const double step : kExactSteps) {
    // they are judged by what is finer than they are
    if (step < 2 * lattice.truth_step()) break;
    CATENA_TRY(const LatticeError rays, lattice.of_rays(exact_rung(step)));
    if (rays.good_for(e)) return choice(lattice, exact_rung(step), rays.above, true);
  }
  RenderSettings finest = reference_settings();
  finest.step_voxels = std::min(lattice.truth_step(), finest.step_voxels);
  return choice(lattice, finest, lattice.truth_error(), lattice.truth_error() <= e);
}

Result<QualityChoice> settings_for_time(Lattice& lattice, double ms, const DrawTimer& timer) {
  const std::vector<VolumeItem>& volumes = lattice.packet().volumes;
  const bool shaded = std::any_of(volumes.begin(), volumes.end(), [](const VolumeItem& item) { return item.shade; });
  std::vector<RenderSettings> settings;
  std::vector<TimedPicture> tried;
  for (const RenderSettings& next : quality_ladder({lattice.fast(), shaded})) {
    // the first picture pays for pipelines and mirrors
    CATENA_TRY(const LatticeError error, lattice.of_picture(next));
    CATENA_TRY(const double took, timer ? timer(next) : quicker_of_two(lattice, next));
    settings.push_back(next);
    tried.push_back({took, error.above});
    if (took > ms) break;
  }
  const std::size_t best = best_within(tried, ms);
  QualityChoice chosen = choice(lattice, settings[best], tried[best].rmse, tried[best].ms <= ms);
  chosen.expected_ms = tried[best].ms;
  return chosen;
}

}  // namespace catena::render
