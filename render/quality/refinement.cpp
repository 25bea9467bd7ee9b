// SPDX-License-Identifier: MIT
#include "render/quality/refinement.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/result.h"

namespace catena::render {
namespace {

constexpr double kFirstGuessMs = 400;  // a unit of cost at a megapixel on two CPU cores
constexpr double kFinerBelow = 0.7;    // of the budget, likewise for pixels
constexpr double kUpBelow = 0.85;      // of the budget: a better rung is taken only with some room, or it would come and go

/// The share of pixels whose rays are marched, and what interpolation costs beside them.
struct Share {
  double rays, overhead;
};
Share share_of(const FastSettings& f) {
  if (f.spacing == 1) return {1, 0.03};
  // a threshold of 3/255 leaves about a third of what is finer
  const auto refined = [](double threshold_255) { return threshold_255 < 0 ? 0.0 : 1.5 / (1.5 + threshold_255); };
  const double half = f.spacing == 2 ? 1 : refined(f.refine_half_255), full = refined(f.refine_full_255);
  return {0.1 + 0.2 * half + 0.7 * full * half, 0.02 + (half > 0 ? 0.01 : 0) + (full > 0 ? 0.03 : 0)};
}

}  // namespace

RenderSettings fast_level(double step_voxels, std::uint32_t spacing, double half, double full, bool smooth) {
  RenderSettings s;
  s.fast = FastSettings{step_voxels, spacing, half, full};
  s.fast->smooth_gradients = smooth;
  if (spacing > 1) s.fast->termination = spacing / 256.0;
  return s;
}

RenderSettings exact_level(double step_voxels) {
  RenderSettings s;
  s.step_voxels = step_voxels;
  if (step_voxels < 1) s.termination = 1e-3;
  return s;
}

RenderSettings converged_level(double step_voxels) {
  RenderSettings s = exact_level(step_voxels);
  s.termination = 1e-4;
  return s;
}

double relative_cost(const RenderSettings& settings, bool shaded) {
  if (!settings.fast) return (shaded ? 3.5 : 1.1) / settings.step_voxels + 0.05;
  const FastSettings& f = *settings.fast;
  const Share share = share_of(f);
  const double a_ray = shaded ? 1.1 * (f.smooth_gradients ? kSmoothGradientCost : 1) : 1.0;
  return share.overhead + share.rays * a_ray * (kFixedRayCost + (1 - kFixedRayCost) / f.step_voxels);
}

namespace {

/// The fast raycast's rungs: step, spacing, thresholds. TrialResult on a head, a heart, vessels, and noise: what lies on the front of error
/// against time of most of them. What a threshold refines is the data's own; those that refine nothing more take no longer.
struct FastRung {
  double step;
  std::uint32_t spacing;
  double half, full;
  bool smooth = true;  // where it is lit
};
constexpr FastRung kPlain[] = {{8, 4, -1, -1},  {6, 4, -1, -1},  {4, 4, -1, -1},   {3, 4, -1, -1},  {2, 4, -1, -1},  {1.5, 4, -1, -1},
                               {1, 4, -1, -1},  {1, 4, 24, -1},  {1, 4, 6, -1},    {2, 2, 0, -1},   {1, 2, 0, -1},   {1, 2, 0, 24},
                               {1, 2, 0, 12},   {1, 2, 0, 4},    {1, 2, 0, 1.5},   {1, 2, 0, 0.6},  {1.5, 1, 0, -1}, {1, 1, 0, -1},
                               {0.7, 1, 0, -1}, {0.5, 1, 0, -1}, {0.35, 1, 0, -1}, {0.25, 1, 0, -1}};
// Light wants short steps more than it wants every pixel. With long ones the gradient of the cell is as good as central differences are,
// at half the time.
constexpr FastRung kShaded[] = {{8, 4, -1, -1, false}, {4, 4, -1, -1, false}, {2, 4, -1, -1, false}, {4, 4, -1, -1},   {3, 4, -1, -1},
                                {2, 4, -1, -1},        {1.5, 4, -1, -1},      {1, 4, -1, -1},        {1, 4, 24, -1},   {2, 2, 0, -1},
                                {1.5, 2, 0, -1},       {1, 2, 0, -1},         {0.7, 2, 0, -1},       {0.5, 2, 0, -1},  {0.5, 2, 0, 24},
                                {0.5, 2, 0, 12},       {0.5, 2, 0, 4},        {0.5, 2, 0, 1.5},      {0.7, 1, 0, -1},  {0.5, 1, 0, -1},
                                {0.35, 1, 0, -1},      {0.25, 1, 0, -1},      {0.18, 1, 0, -1},      {0.125, 1, 0, -1}};
constexpr double kExactLadder[] = {4, 3, 2, 1.5, 1, 0.7, 0.5, 0.35, 0.25};
// of exact rays that end the fast ones: lit ones have to be a fourth of the fast raycast's to be as good
constexpr double kLastSteps[] = {0.25, 0.1, 0.05}, kLastShadedSteps[] = {0.0625, 0.03};

}  // namespace

std::vector<RenderSettings> quality_levels(const QualityLevelOptions& kind) {
  std::vector<RenderSettings> all;
  if (kind.can_draw_fast) {
    for (const FastRung& r : kind.is_shaded ? std::span<const FastRung>(kShaded) : kPlain)
      all.push_back(fast_level(r.step, r.spacing, r.half, r.full, kind.is_shaded && r.smooth));
    for (const double step : kind.is_shaded ? std::span<const double>(kLastShadedSteps) : kLastSteps) all.push_back(exact_level(step));
  } else {
    for (const double step : kExactLadder) all.push_back(exact_level(step));
  }
  std::stable_sort(all.begin(), all.end(), [&](const RenderSettings& a, const RenderSettings& b) {
    return relative_cost(a, kind.is_shaded) < relative_cost(b, kind.is_shaded);
  });
  return all;
}

std::uint32_t choose_pixel_scale(double expected_ms, std::uint32_t before, double budget_ms) {
  const auto fits = [&](std::uint32_t scale) {
    const double room = scale < before ? kFinerBelow : 1;
    return expected_ms / (scale * scale) <= room * budget_ms;
  };
  std::uint32_t scale = 1;
  while (scale < kMaxPixelScale && !fits(scale)) scale *= 2;
  return scale;
}

TimeModel::TimeModel(std::vector<double> costs, double first_guess_ms) : unit_ms_(first_guess_ms) {
  for (const double cost : costs) levels_.push_back({cost});
}

double TimeModel::correction_factor(std::size_t rung) const {
  for (std::size_t away = 0; away < levels_.size(); ++away) {
    double factor = 0;
    if (away <= rung && levels_[rung - away].is_measured) factor = levels_[rung - away].factor;
    if (rung + away < levels_.size() && levels_[rung + away].is_measured) factor = std::max(factor, levels_[rung + away].factor);
    if (factor > 0) return factor;
  }
  return 1;
}

void TimeModel::add_measurement(std::size_t rung, double ms) {
  Level& r = levels_[rung];
  const double ratio = std::clamp(ms / expected_ms(rung), 0.01, 100.0);
  const bool counts = r.is_measured || ratio < 1;
  r.factor = correction_factor(rung);
  r.is_measured = true;
  if (!counts) return;
  unit_ms_ *= std::sqrt(ratio);
  r.factor *= std::sqrt(ratio);
}

Refinement::Refinement(double budget_ms, const QualityLevelOptions& kind) : budget_ms_(budget_ms), times_({}, 0) {
  std::vector<double> costs;
  for (const RenderSettings& settings : quality_levels(kind)) {
    // finer rays are for files: a window's picture ends before
    if (kind.can_draw_fast ? !settings.fast || settings.fast->step_voxels < 0.5 : settings.step_voxels < 0.5) continue;
    levels_.push_back(settings);
    costs.push_back(relative_cost(settings, kind.is_shaded));
  }
  times_ = TimeModel(std::move(costs), kFirstGuessMs);
  // the last rung of every spacing; without the fast raycast, where the step is half of that of the stop before
  double step = 1e9;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const bool last = i + 1 == levels_.size();
    const bool stop =
        levels_[i].fast ? !last && levels_[i].fast->spacing > levels_[i + 1].fast->spacing : levels_[i].step_voxels <= 0.5 * step;
    if (!last && !stop) continue;
    stops_.push_back(i);
    step = levels_[i].step_voxels;
  }
}

std::size_t Refinement::best_within_budget() const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < levels_.size(); ++i)
    if (times_.expected_ms(i) <= (i > moving_level_ ? kUpBelow : 1.0) * budget_ms_) best = i;
  return best;
}

std::size_t Refinement::next_stop(std::size_t rung) const {
  const auto next = std::upper_bound(stops_.begin(), stops_.end(), rung);
  return next == stops_.end() ? levels_.size() - 1 : *next;
}

RefinementStep Refinement::make_step(std::size_t rung) {
  last_level_ = rung;
  is_pending_ = true;
  return {levels_[rung], times_.expected_ms(rung), rung + 1 == levels_.size()};
}

std::optional<RefinementStep> Refinement::next(bool changed) {
  if (changed || !last_level_) {
    moving_level_ = best_within_budget();
    return make_step(moving_level_);
  }
  if (*last_level_ + 1 == levels_.size()) return std::nullopt;
  return make_step(next_stop(*last_level_));
}

std::optional<double> Refinement::expected_next_ms() const {
  if (!last_level_ || *last_level_ + 1 == levels_.size()) return std::nullopt;
  return times_.expected_ms(next_stop(*last_level_));
}

void Refinement::record_render_ms(double ms) {
  CATENA_ASSERT(is_pending_);
  is_pending_ = false;
  times_.add_measurement(*last_level_, ms);
}

}  // namespace catena::render
