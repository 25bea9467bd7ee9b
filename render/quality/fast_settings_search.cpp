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

constexpr int kMaxPictures = 16;
constexpr double kStepsDone = 0.3;     // of the search, when the steps are known
constexpr std::size_t kGoodSteps = 5;  // of those that are good enough, the longest

// Rays that leap go to what is seen by short steps, and begin there with shorter ones: unlit, longer ones than this gain nothing.
constexpr double kLongestLeaping = 3, kSameCost = 1e-6;

}  // namespace

FastSettingsSearch::FastSettingsSearch(ErrorEstimator& lattice, double error, const SearchProgress& progress)
    : estimator_(lattice), error_(error), progress_(progress), best_cost_(std::numeric_limits<double>::infinity()) {
  for (std::size_t plan = 0; plan < refined_shares_.size(); ++plan) refined_shares_[plan] = kPlans[plan].refined_shares;
}

Result<std::optional<QualityChoice>> FastSettingsSearch::find() {
  CATENA_CHECK(add_candidates(false));
  if (estimator_.is_shaded()) CATENA_CHECK(add_candidates(true));
  skips_empty_space_ = estimator_.renderer().skips_empty_space() && !estimator_.is_shaded();
  progress_(kStepsDone);
  CATENA_CHECK(try_full_resolution());
  for (int drawn = 0; !candidates_.empty() && drawn < kMaxPictures;) {
    const auto cheapest = std::ranges::min_element(candidates_, {}, [this](const Candidate& c) { return cost(c); });
    const Candidate next = *cheapest;
    candidates_.erase(cheapest);
    if (cost(next) >= best_cost_) break;
    if (is_hopeless(next)) continue;
    CATENA_CHECK(try_interpolation(next));
    progress_(kStepsDone + (1 - kStepsDone) * ++drawn / kMaxPictures);
  }
  if (best_) best_->images_rendered = estimator_.images_rendered();
  return best_;
}

/// Rays of a step with a plan, which end when they may leave out no more than the error says.
RenderSettings FastSettingsSearch::make_settings(const InterpolationPlan& plan, double step, bool smooth) const {
  RenderSettings s = fast_level(step, plan.spacing, plan.refine_half * error_, plan.refine_full * error_, smooth);
  set_termination_for(error_, s);
  return s;
}

/// The longest steps whose rays alone are good enough, and steady, with every plan of interpolation. Light by the gradient of the cell
/// has an error that no step mends: steps that make it hardly less are the last.
Outcome FastSettingsSearch::add_candidates(bool smooth) {
  const bool facets = !smooth && estimator_.is_shaded();
  const std::size_t most = candidates_.size() + kGoodSteps * std::size(kPlans);
  double before = std::numeric_limits<double>::infinity();
  for (const double step : kFastSteps) {
    if (candidates_.size() == most) break;
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

/// Of every pixel's rays by those of the first lattice, and of a refined share: a ray costs the more the farther its neighbours are. As a
/// CPU driver has it: it only decides between settings that are good enough.
double FastSettingsSearch::cost(const Candidate& candidate) const {
  const FastSettings& f = *candidate.settings.fast;
  const double first = f.spacing == 1 ? 1 : f.spacing == 2 ? 0.325 : 0.137;
  const double marks = kPlans[candidate.plan].refine_full >= 0 ? 0.02 : 0;
  const double step = skips_empty_space_ ? std::min(f.step_voxels, kLongestLeaping) : f.step_voxels;
  const double a_ray = (f.smooth_gradients ? kSmoothGradientCost : 1) * (kFixedRayCost + (1 - kFixedRayCost) / step);
  const double same = kSameCost * f.step_voxels;  // of those that cost the same the shortest step
  return (first + marks + 0.29 * refined_shares_[candidate.plan][0] + refined_shares_[candidate.plan][1]) * a_ray + same;
}

/// What a plan's picture refined; stricter plans refine no less.
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

/// Every ray, of the longest step that keeps what is thin. What is left are the plans that interpolate.
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

/// What interpolation cost at another step says whether this one is worth a picture.
bool FastSettingsSearch::is_hopeless(const Candidate& candidate) {
  const Attempts& before = attempts(candidate);
  return before.failures > 1 || (before.interpolation_rmse && std::hypot(candidate.ray_rmse, *before.interpolation_rmse) > error_);
}

Outcome FastSettingsSearch::try_interpolation(const Candidate& candidate) {
  CATENA_TRY(const ErrorEstimate picture, estimator_.estimate_image(candidate.settings));
  CATENA_TRY(const auto rays, estimator_.refined_shares());
  update_refined_shares(candidate.plan, rays);
  if (picture.meets(error_)) {
    if (cost(candidate) >= best_cost_) return Done{};
    CATENA_TRY(const bool keeps, estimator_.preserves_thin_features(error_));
    CATENA_TRY(const bool steady, keeps ? estimator_.is_image_stable(candidate.settings) : false);
    if (steady) accept(candidate, picture.upper_bound);
    if (keeps) return Done{};
  }
  // where a few pixels are far off, or what is thin is lost, a shorter step may mend it once
  Attempts& now = attempts(candidate);
  now.failures += picture.upper_bound <= error_;
  now.interpolation_rmse = std::sqrt(std::max(0.0, picture.upper_bound * picture.upper_bound - candidate.ray_rmse * candidate.ray_rmse));
  return Done{};
}

}  // namespace catena::render
