#include "render/quality/fast_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "render/quality/refinement.h"
#include "render/quality/search.h"

namespace catena::render {
namespace {

constexpr int kMaxPictures = 16;
constexpr double kStepsDone = 0.3;     // of the search, when the steps are known
constexpr std::size_t kGoodSteps = 5;  // of those that are good enough, the longest

// Rays that leap go to what is seen by short steps, and begin there with shorter ones: unlit, longer ones than this gain nothing.
constexpr double kLongestLeaping = 3, kSameCost = 1e-6;

}  // namespace

FastSearch::FastSearch(Lattice& lattice, double error, const SearchProgress& progress)
    : lattice_(lattice), error_(error), progress_(progress), best_cost_(std::numeric_limits<double>::infinity()) {
  for (std::size_t plan = 0; plan < refined_.size(); ++plan) refined_[plan] = kPlans[plan].refined;
}

Result<std::optional<QualityChoice>> FastSearch::find() {
  CATENA_CHECK(add_candidates(false));
  if (lattice_.shaded()) CATENA_CHECK(add_candidates(true));
  leaps_ = lattice_.renderer().leaps() && !lattice_.shaded();
  progress_(kStepsDone);
  CATENA_CHECK(try_every_ray());
  for (int drawn = 0; !candidates_.empty() && drawn < kMaxPictures;) {
    const auto cheapest = std::ranges::min_element(candidates_, {}, [this](const Candidate& c) { return cost(c); });
    const Candidate next = *cheapest;
    candidates_.erase(cheapest);
    if (cost(next) >= best_cost_) break;
    if (is_hopeless(next)) continue;
    CATENA_CHECK(try_interpolation(next));
    progress_(kStepsDone + (1 - kStepsDone) * ++drawn / kMaxPictures);
  }
  if (best_) best_->pictures = lattice_.pictures();
  return best_;
}

/// Rays of a step with a plan, which end when they may leave out no more than the error says.
RenderSettings FastSearch::planned(const Plan& plan, double step, bool smooth) const {
  RenderSettings s = fast_rung(step, plan.spacing, plan.refine_half * error_, plan.refine_full * error_, smooth);
  end_rays_for(error_, s);
  return s;
}

/// The longest steps whose rays alone are good enough, and steady, with every plan of interpolation. Light by the gradient of the cell
/// has an error that no step mends: steps that make it hardly less are the last.
Outcome FastSearch::add_candidates(bool smooth) {
  const bool facets = !smooth && lattice_.shaded();
  const std::size_t most = candidates_.size() + kGoodSteps * std::size(kPlans);
  double before = std::numeric_limits<double>::infinity();
  for (const double step : kFastSteps) {
    if (candidates_.size() == most) break;
    const RenderSettings every_ray = planned(kPlans[std::size(kPlans) - 1], step, smooth);
    CATENA_TRY(const LatticeError error, lattice_.of_rays(every_ray));
    if (facets && error.rmse > kStill * before) break;
    before = error.rmse;
    if (error.rmse > (facets ? kFacetShare : kStepShare) * error_ || error.p999 > kFarthest * error_) continue;
    CATENA_TRY(const bool steady, lattice_.rays_are_steady(every_ray));
    if (!steady) continue;
    for (std::size_t plan = 0; plan < std::size(kPlans); ++plan)
      candidates_.push_back({planned(kPlans[plan], step, smooth), error.rmse, error.above, plan});
  }
  return Done{};
}

/// Of every pixel's rays by those of the first lattice, and of a refined share: a ray costs the more the farther its neighbours are. As a
/// CPU driver has it: it only decides between settings that are good enough.
double FastSearch::cost(const Candidate& candidate) const {
  const FastSettings& f = *candidate.settings.fast;
  const double first = f.spacing == 1 ? 1 : f.spacing == 2 ? 0.325 : 0.137;
  const double marks = kPlans[candidate.plan].refine_full >= 0 ? 0.02 : 0;
  const double step = leaps_ ? std::min(f.step_voxels, kLongestLeaping) : f.step_voxels;
  const double a_ray = (f.smooth_gradients ? kSmoothCost : 1) * (kStepless + (1 - kStepless) / step);
  const double same = kSameCost * f.step_voxels;  // of those that cost the same the shortest step
  return (first + marks + 0.29 * refined_[candidate.plan][0] + refined_[candidate.plan][1]) * a_ray + same;
}

/// What a plan's picture refined; stricter plans refine no less.
void FastSearch::learn(std::size_t plan, const std::array<double, 2>& found) {
  refined_[plan] = found;
  const Plan& p = kPlans[plan];
  for (std::size_t other = 0; other < refined_.size(); ++other) {
    const Plan& o = kPlans[other];
    if (o.refine_half > 0 && o.refine_half < p.refine_half) refined_[other][0] = std::max(refined_[other][0], found[0]);
    if (o.refine_full > 0 && o.refine_full < p.refine_full) refined_[other][1] = std::max(refined_[other][1], found[1]);
  }
}

void FastSearch::take(const Candidate& candidate, double above) {
  best_ = QualityChoice{candidate.settings, above};
  best_cost_ = cost(candidate);
}

/// Every ray, of the longest step that keeps what is thin. What is left are the plans that interpolate.
Outcome FastSearch::try_every_ray() {
  for (const Candidate& c : candidates_) {
    if (c.settings.fast->spacing > 1 || best_ || c.above > error_) continue;
    CATENA_CHECK(lattice_.of_picture(c.settings));
    CATENA_TRY(const bool keeps, lattice_.keeps_what_is_thin(error_));
    if (keeps) take(c, c.above);
  }
  std::erase_if(candidates_, [](const Candidate& c) { return c.settings.fast->spacing == 1; });
  return Done{};
}

/// What interpolation cost at another step says whether this one is worth a picture.
bool FastSearch::is_hopeless(const Candidate& candidate) {
  const Tried& before = tried(candidate);
  return before.lost > 1 || (before.interpolation && std::hypot(candidate.rays, *before.interpolation) > error_);
}

Outcome FastSearch::try_interpolation(const Candidate& candidate) {
  CATENA_TRY(const LatticeError picture, lattice_.of_picture(candidate.settings));
  CATENA_TRY(const auto rays, lattice_.refined());
  learn(candidate.plan, rays);
  if (picture.good_for(error_)) {
    if (cost(candidate) >= best_cost_) return Done{};
    CATENA_TRY(const bool keeps, lattice_.keeps_what_is_thin(error_));
    CATENA_TRY(const bool steady, keeps ? lattice_.picture_is_steady(candidate.settings) : false);
    if (steady) take(candidate, picture.above);
    if (keeps) return Done{};
  }
  // where a few pixels are far off, or what is thin is lost, a shorter step may mend it once
  Tried& now = tried(candidate);
  now.lost += picture.above <= error_;
  now.interpolation = std::sqrt(std::max(0.0, picture.above * picture.above - candidate.rays * candidate.rays));
  return Done{};
}

}  // namespace catena::render
