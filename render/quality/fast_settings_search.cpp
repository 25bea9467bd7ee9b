// SPDX-License-Identifier: MIT
#include "render/quality/fast_settings_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "render/quality/refinement.h"
#include "render/quality/settings_search.h"

namespace catena::render {
namespace {

constexpr int kMaxImages = 16;
constexpr double kStepsDone = 0.3;        // progress when the steps are tested
constexpr std::size_t kMaxGoodSteps = 5;  // maximum number of tested steps that meet the goal; the longest ones

// Unshaded rays that skip empty space gain nothing from longer steps than this, because they enter visible space with short steps.
constexpr double kMaxSkippingStep = 3, kTieBreakCost = 1e-6;

}  // namespace

FastSettingsSearch::FastSettingsSearch(ErrorEstimator& estimator, double error, const SearchProgress& progress)
    : estimator_(estimator), error_(error), progress_(progress), best_cost_(std::numeric_limits<double>::infinity()) {
  for (std::size_t plan = 0; plan < refined_shares_.size(); ++plan) refined_shares_[plan] = kPlans[plan].refined_shares;
}

Result<std::optional<QualityChoice>> FastSettingsSearch::find() {
  CATENA_CHECK(add_candidates(false));
  if (estimator_.is_shaded()) CATENA_CHECK(add_candidates(true));
  skips_empty_space_ = estimator_.renderer().skips_empty_space() && !estimator_.is_shaded();
  progress_(kStepsDone);
  CATENA_CHECK(try_full_resolution());
  for (int drawn = 0; !candidates_.empty() && drawn < kMaxImages;) {
    const auto cheapest = std::ranges::min_element(candidates_, {}, [this](const Candidate& c) { return cost(c); });
    const Candidate next = *cheapest;
    candidates_.erase(cheapest);
    if (cost(next) >= best_cost_) break;
    if (is_hopeless(next)) continue;
    CATENA_CHECK(try_interpolation(next));
    progress_(kStepsDone + (1 - kStepsDone) * ++drawn / kMaxImages);
  }
  if (best_) best_->images_rendered = estimator_.images_rendered();
  return best_;
}

/// Returns settings of a step and a plan; rays terminate where the rest changes the image by no more than the goal.
RenderSettings FastSettingsSearch::make_settings(const InterpolationPlan& plan, double step, bool smooth) const {
  RenderSettings s = fast_level(step, plan.spacing, plan.refine_half * error_, plan.refine_full * error_, smooth);
  set_termination_for(error_, s);
  return s;
}

/// Adds the longest steps whose rays alone meet the goal and are temporally stable, with each interpolation plan. Shading by cell gradients
/// has an error that is independent of the step: the steps end where a shorter one hardly reduces the error.
Outcome FastSettingsSearch::add_candidates(bool smooth) {
  const bool facets = !smooth && estimator_.is_shaded();
  const std::size_t max_count = candidates_.size() + kMaxGoodSteps * std::size(kPlans);
  double before = std::numeric_limits<double>::infinity();
  for (const double step : kFastSteps) {
    if (candidates_.size() == max_count) break;
    const RenderSettings every_ray = make_settings(kPlans[std::size(kPlans) - 1], step, smooth);
    CATENA_TRY(const ErrorEstimate error, estimator_.estimate_rays(every_ray));
    if (facets && error.rmse > kPlateauRatio * before) break;
    before = error.rmse;
    if (error.rmse > (facets ? kFacetShare : kStepShare) * error_ || error.p999 > kMaxP999Ratio * error_) continue;
    CATENA_TRY(const bool steady, estimator_.are_rays_stable(every_ray));
    if (!steady) continue;
    for (std::size_t plan = 0; plan < std::size(kPlans); ++plan)
      candidates_.push_back({make_settings(kPlans[plan], step, smooth), error.rmse, error.upper_bound, plan});
  }
  return Done{};
}

/// Returns the relative cost of a candidate: the rays of the first ray grid plus the refined share; a ray costs more the farther its
/// neighbors are. Measured with a CPU driver; it only decides between settings that meet the goal.
double FastSettingsSearch::cost(const Candidate& candidate) const {
  const FastSettings& f = *candidate.settings.fast;
  const double first = f.spacing == 1 ? 1 : f.spacing == 2 ? 0.325 : 0.137;
  const double marks = kPlans[candidate.plan].refine_full >= 0 ? 0.02 : 0;
  const double step = skips_empty_space_ ? std::min(f.step_voxels, kMaxSkippingStep) : f.step_voxels;
  const double a_ray = (f.smooth_gradients ? kSmoothGradientCost : 1) * (kFixedRayCost + (1 - kFixedRayCost) / step);
  const double same = kTieBreakCost * f.step_voxels;  // of equal costs, the shortest step is cheaper
  return (first + marks + 0.29 * refined_shares_[candidate.plan][0] + refined_shares_[candidate.plan][1]) * a_ray + same;
}

/// Sets the refined shares that an image of the plan had; stricter plans refine at least as much.
void FastSettingsSearch::update_refined_shares(std::size_t plan, const std::array<double, 2>& found) {
  refined_shares_[plan] = found;
  const InterpolationPlan& p = kPlans[plan];
  for (std::size_t other = 0; other < refined_shares_.size(); ++other) {
    const InterpolationPlan& o = kPlans[other];
    if (o.refine_half > 0 && o.refine_half < p.refine_half) refined_shares_[other][0] = std::max(refined_shares_[other][0], found[0]);
    if (o.refine_full > 0 && o.refine_full < p.refine_full) refined_shares_[other][1] = std::max(refined_shares_[other][1], found[1]);
  }
}

void FastSettingsSearch::accept(const Candidate& candidate, double above) {
  best_ = QualityChoice{candidate.settings, above};
  best_cost_ = cost(candidate);
}

/// Tries full resolution with the longest step that preserves thin features, then removes its candidates; only interpolating plans remain.
Outcome FastSettingsSearch::try_full_resolution() {
  for (const Candidate& c : candidates_) {
    if (c.settings.fast->spacing > 1 || best_ || c.rmse_upper_bound > error_) continue;
    CATENA_CHECK(estimator_.estimate_image(c.settings));
    CATENA_TRY(const bool keeps, estimator_.preserves_thin_features(error_));
    if (keeps) accept(c, c.rmse_upper_bound);
  }
  std::erase_if(candidates_, [](const Candidate& c) { return c.settings.fast->spacing == 1; });
  return Done{};
}

/// Returns whether results of other steps show that the candidate cannot meet the goal: interpolation error, or repeated failures.
bool FastSettingsSearch::is_hopeless(const Candidate& candidate) {
  const Attempts& before = attempts(candidate);
  return before.failures > 1 || (before.interpolation_rmse && std::hypot(candidate.ray_rmse, *before.interpolation_rmse) > error_);
}

Outcome FastSettingsSearch::try_interpolation(const Candidate& candidate) {
  CATENA_TRY(const ErrorEstimate image, estimator_.estimate_image(candidate.settings));
  CATENA_TRY(const auto rays, estimator_.refined_shares());
  update_refined_shares(candidate.plan, rays);
  if (image.meets(error_)) {
    if (cost(candidate) >= best_cost_) return Done{};
    CATENA_TRY(const bool keeps, estimator_.preserves_thin_features(error_));
    CATENA_TRY(const bool steady, keeps ? estimator_.is_image_stable(candidate.settings) : false);
    if (steady) accept(candidate, image.upper_bound);
    if (keeps) return Done{};
  }
  // outlier pixels or lost thin features may be repaired once by a shorter step
  Attempts& now = attempts(candidate);
  now.failures += image.upper_bound <= error_;
  now.interpolation_rmse = std::sqrt(std::max(0.0, image.upper_bound * image.upper_bound - candidate.ray_rmse * candidate.ray_rmse));
  return Done{};
}

}  // namespace catena::render
