// SPDX-License-Identifier: MIT
#include "render/quality/refinement.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/result.h"

namespace catena::render {
namespace {

constexpr double kFirstGuessMs = 400;  // initial guess of the time per unit of cost, at one megapixel on two CPU cores
constexpr double kFinerBelow = 0.7;    // share of the budget below which the pixels get finer
constexpr double kUpBelow =
    0.85;  // share of the budget that a better level may take; the rest is a reserve, so that levels do not alternate

/// The share of pixels with marched rays, and the relative cost of interpolation.
struct Share {
  double rays, overhead;
};
Share share_of(const FastSettings& f) {
  if (f.spacing == 1) return {1, 0.03};
  // a threshold of 3/255 refines about a third
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

/// Quality levels of the fast raycast. Chosen on a head, a heart, vessels and noise, as the levels on the front of error against time for
/// most of them. The share that a threshold refines depends on the data; levels that refine no more than others take no longer.
struct FastLevel {
  double step;
  std::uint32_t spacing;
  double half, full;
  bool smooth = true;  // smooth gradients, if shaded
};
constexpr FastLevel kPlain[] = {{8, 4, -1, -1},  {6, 4, -1, -1},  {4, 4, -1, -1},   {3, 4, -1, -1},  {2, 4, -1, -1},  {1.5, 4, -1, -1},
                                {1, 4, -1, -1},  {1, 4, 24, -1},  {1, 4, 6, -1},    {2, 2, 0, -1},   {1, 2, 0, -1},   {1, 2, 0, 24},
                                {1, 2, 0, 12},   {1, 2, 0, 4},    {1, 2, 0, 1.5},   {1, 2, 0, 0.6},  {1.5, 1, 0, -1}, {1, 1, 0, -1},
                                {0.7, 1, 0, -1}, {0.5, 1, 0, -1}, {0.35, 1, 0, -1}, {0.25, 1, 0, -1}};
// Shading needs short steps more than full resolution. With long steps, cell gradients are as good as central differences, in half the
// time.
constexpr FastLevel kShaded[] = {{8, 4, -1, -1, false}, {4, 4, -1, -1, false}, {2, 4, -1, -1, false}, {4, 4, -1, -1},   {3, 4, -1, -1},
                                 {2, 4, -1, -1},        {1.5, 4, -1, -1},      {1, 4, -1, -1},        {1, 4, 24, -1},   {2, 2, 0, -1},
                                 {1.5, 2, 0, -1},       {1, 2, 0, -1},         {0.7, 2, 0, -1},       {0.5, 2, 0, -1},  {0.5, 2, 0, 24},
                                 {0.5, 2, 0, 12},       {0.5, 2, 0, 4},        {0.5, 2, 0, 1.5},      {0.7, 1, 0, -1},  {0.5, 1, 0, -1},
                                 {0.35, 1, 0, -1},      {0.25, 1, 0, -1},      {0.18, 1, 0, -1},      {0.125, 1, 0, -1}};
constexpr double kExactLevelSteps[] = {4, 3, 2, 1.5, 1, 0.7, 0.5, 0.35, 0.25};
// steps of the exact levels after the fast ones; shaded ones need a fourth of the fast raycast's step to be as good
constexpr double kLastSteps[] = {0.25, 0.1, 0.05}, kLastShadedSteps[] = {0.0625, 0.03};

}  // namespace

std::vector<RenderSettings> quality_levels(const QualityLevelOptions& kind) {
  std::vector<RenderSettings> all;
  if (kind.can_draw_fast) {
    for (const FastLevel& r : kind.is_shaded ? std::span<const FastLevel>(kShaded) : kPlain)
      all.push_back(fast_level(r.step, r.spacing, r.half, r.full, kind.is_shaded && r.smooth));
    for (const double step : kind.is_shaded ? std::span<const double>(kLastShadedSteps) : kLastSteps) all.push_back(exact_level(step));
  } else {
    for (const double step : kExactLevelSteps) all.push_back(exact_level(step));
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

double TimeModel::correction_factor(std::size_t level) const {
  for (std::size_t away = 0; away < levels_.size(); ++away) {
    double factor = 0;
    if (away <= level && levels_[level - away].is_measured) factor = levels_[level - away].factor;
    if (level + away < levels_.size() && levels_[level + away].is_measured) factor = std::max(factor, levels_[level + away].factor);
    if (factor > 0) return factor;
  }
  return 1;
}

void TimeModel::add_measurement(std::size_t level, double ms) {
  Level& r = levels_[level];
  const double ratio = std::clamp(ms / expected_ms(level), 0.01, 100.0);
  const bool counts = r.is_measured || ratio < 1;
  r.factor = correction_factor(level);
  r.is_measured = true;
  if (!counts) return;
  unit_ms_ *= std::sqrt(ratio);
  r.factor *= std::sqrt(ratio);
}

Refinement::Refinement(double budget_ms, const QualityLevelOptions& kind) : budget_ms_(budget_ms), times_({}, 0) {
  std::vector<double> costs;
  for (const RenderSettings& settings : quality_levels(kind)) {
    // finer levels are for image files, not for a window
    if (kind.can_draw_fast ? !settings.fast || settings.fast->step_voxels < 0.5 : settings.step_voxels < 0.5) continue;
    levels_.push_back(settings);
    costs.push_back(relative_cost(settings, kind.is_shaded));
  }
  times_ = TimeModel(std::move(costs), kFirstGuessMs);
  // stops: the last level of each spacing; without the fast raycast, levels whose step is half of the previous stop's
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

std::size_t Refinement::next_stop(std::size_t level) const {
  const auto next = std::upper_bound(stops_.begin(), stops_.end(), level);
  return next == stops_.end() ? levels_.size() - 1 : *next;
}

RefinementStep Refinement::make_step(std::size_t level) {
  last_level_ = level;
  is_pending_ = true;
  return {levels_[level], times_.expected_ms(level), level + 1 == levels_.size()};
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
