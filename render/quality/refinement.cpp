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

RenderSettings fast_rung(double step_voxels, std::uint32_t spacing, double half, double full, bool smooth) {
  RenderSettings s;
  s.fast = FastSettings{step_voxels, spacing, half, full};
  s.fast->smooth_gradients = smooth;
  if (spacing > 1) s.fast->termination = spacing / 256.0;
  return s;
}

RenderSettings exact_rung(double step_voxels) {
  RenderSettings s;
  s.step_voxels = step_voxels;
  if (step_voxels < 1) s.termination = 1e-3;
  return s;
}

RenderSettings converged_rung(double step_voxels) {
  RenderSettings s = exact_rung(step_voxels);
  s.termination = 1e-4;
  return s;
}

double relative_cost(const RenderSettings& settings, bool shaded) {
  if (!settings.fast) return (shaded ? 3.5 : 1.1) / settings.step_voxels + 0.05;
  const FastSettings& f = *settings.fast;
  const Share share = share_of(f);
  const double a_ray = shaded ? 1.1 * (f.smooth_gradients ? kSmoothCost : 1) : 1.0;
  return share.overhead + share.rays * a_ray * (kStepless + (1 - kStepless) / f.step_voxels);
}

namespace {

/// The fast raycast's rungs: step, spacing, thresholds. Measured on a head, a heart, vessels, and noise: what lies on the front of error
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

std::vector<RenderSettings> quality_ladder(const LadderKind& kind) {
  std::vector<RenderSettings> all;
  if (kind.fast) {
    for (const FastRung& r : kind.shaded ? std::span<const FastRung>(kShaded) : kPlain)
      all.push_back(fast_rung(r.step, r.spacing, r.half, r.full, kind.shaded && r.smooth));
    for (const double step : kind.shaded ? std::span<const double>(kLastShadedSteps) : kLastSteps) all.push_back(exact_rung(step));
  } else {
    for (const double step : kExactLadder) all.push_back(exact_rung(step));
  }
  std::stable_sort(all.begin(), all.end(), [&](const RenderSettings& a, const RenderSettings& b) {
    return relative_cost(a, kind.shaded) < relative_cost(b, kind.shaded);
  });
  return all;
}

std::uint32_t coarser_pixels(double expected_ms, std::uint32_t before, double budget_ms) {
  const auto fits = [&](std::uint32_t scale) {
    const double room = scale < before ? kFinerBelow : 1;
    return expected_ms / (scale * scale) <= room * budget_ms;
  };
  std::uint32_t scale = 1;
  while (scale < kMaxScale && !fits(scale)) scale *= 2;
  return scale;
}

TimeModel::TimeModel(std::vector<double> costs, double first_guess_ms) : unit_ms_(first_guess_ms) {
  for (const double cost : costs) rungs_.push_back({cost});
}

double TimeModel::factor_of(std::size_t rung) const {
  for (std::size_t away = 0; away < rungs_.size(); ++away) {
    double factor = 0;
    if (away <= rung && rungs_[rung - away].drawn) factor = rungs_[rung - away].factor;
    if (rung + away < rungs_.size() && rungs_[rung + away].drawn) factor = std::max(factor, rungs_[rung + away].factor);
    if (factor > 0) return factor;
  }
  return 1;
}

void TimeModel::measured(std::size_t rung, double ms) {
  Rung& r = rungs_[rung];
  const double ratio = std::clamp(ms / expected_ms(rung), 0.01, 100.0);
  const bool counts = r.drawn || ratio < 1;
  r.factor = factor_of(rung);
  r.drawn = true;
  if (!counts) return;
  unit_ms_ *= std::sqrt(ratio);
  r.factor *= std::sqrt(ratio);
}

Refinement::Refinement(double budget_ms, const LadderKind& kind) : budget_ms_(budget_ms), times_({}, 0) {
  std::vector<double> costs;
  for (const RenderSettings& settings : quality_ladder(kind)) {
    // finer rays are for files: a window's picture ends before
    if (kind.fast ? !settings.fast || settings.fast->step_voxels < 0.5 : settings.step_voxels < 0.5) continue;
    rungs_.push_back(settings);
    costs.push_back(relative_cost(settings, kind.shaded));
  }
  times_ = TimeModel(std::move(costs), kFirstGuessMs);
  // the last rung of every spacing; without the fast raycast, where the step is half of that of the stop before
  double step = 1e9;
  for (std::size_t i = 0; i < rungs_.size(); ++i) {
    const bool last = i + 1 == rungs_.size();
    const bool stop = rungs_[i].fast ? !last && rungs_[i].fast->spacing > rungs_[i + 1].fast->spacing : rungs_[i].step_voxels <= 0.5 * step;
    if (!last && !stop) continue;
    stops_.push_back(i);
    step = rungs_[i].step_voxels;
  }
}

std::size_t Refinement::best_within_budget() const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < rungs_.size(); ++i)
    if (times_.expected_ms(i) <= (i > moving_ ? kUpBelow : 1.0) * budget_ms_) best = i;
  return best;
}

std::size_t Refinement::stop_after(std::size_t rung) const {
  const auto next = std::upper_bound(stops_.begin(), stops_.end(), rung);
  return next == stops_.end() ? rungs_.size() - 1 : *next;
}

RefinementStep Refinement::step(std::size_t rung) {
  shown_ = rung;
  asked_ = true;
  return {rungs_[rung], times_.expected_ms(rung), rung + 1 == rungs_.size()};
}

std::optional<RefinementStep> Refinement::next(bool changed) {
  if (changed || !shown_) {
    moving_ = best_within_budget();
    return step(moving_);
  }
  if (*shown_ + 1 == rungs_.size()) return std::nullopt;
  return step(stop_after(*shown_));
}

std::optional<double> Refinement::expected_better_ms() const {
  if (!shown_ || *shown_ + 1 == rungs_.size()) return std::nullopt;
  return times_.expected_ms(stop_after(*shown_));
}

void Refinement::drawn(double ms) {
  CATENA_ASSERT(asked_);
  asked_ = false;
  times_.measured(*shown_, ms);
}

}  // namespace catena::render
