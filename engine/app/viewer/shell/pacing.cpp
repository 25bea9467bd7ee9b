#include "engine/app/viewer/shell/pacing.h"

#include <fmt/format.h>

#include <utility>

namespace catena::app {
namespace {

constexpr double kKeptBudgets = 3;       // that a picture may take whose rays are kept, as good as it is
constexpr double kStandingBudgets = 20;  // the same of exact rays, that is to be better than the last one
constexpr double kFinerBelow = 0.7;      // of the budget: more pixels again only with some room, or their number would come and go

bool is_goal(const Quality& quality) { return quality.goal.has_value(); }

double budget_of(const Quality& quality) {
  if (quality.moving_ms) return *quality.moving_ms;
  return is_goal(quality) && quality.goal->kind == render::QualityGoal::Kind::time ? quality.goal->value : kBudgetMs;
}

render::LadderKind ladder_of(const SceneKind& kind) { return {kind.fast, kind.shaded}; }

}  // namespace

Pacing::Pacing(const Quality& quality) : quality_(quality), budget_ms_(budget_of(quality)), refinement_(budget_ms_, ladder_of(kind_)) {}

/// Another kind of scene begins with another ladder.
void Pacing::follow(const SceneKind& kind) {
  if (kind == kind_) return;
  kind_ = kind;
  refinement_ = render::Refinement(budget_ms_, ladder_of(kind));
  asked_ = false;
}

NextPicture Pacing::ask(const render::RefinementStep& step, std::uint32_t scale) {
  asked_ = true;
  rmse_.reset();
  current_ = {step.settings, scale};
  return current_;
}

NextPicture Pacing::moving(const SceneKind& kind) {
  follow(kind);
  const render::RefinementStep step = *refinement_.next(true);
  // the fast raycast saves pixels by itself
  const std::uint32_t scale = kind.fast ? 1 : render::coarser_pixels(step.expected_ms, current_.scale, budget_ms_);
  by_moving_ = true;
  finished_ = false;
  return ask(step, scale);
}

std::optional<NextPicture> Pacing::still(const SceneKind& kind) {
  follow(kind);
  kept_late_ = false;
  if (finished_) return std::nullopt;
  const std::uint32_t scale = current_.scale;
  if (!is_goal(quality_) || !kind.rays) {
    finished_ = true;
    const bool shown = by_moving_ && scale == 1 && !kind.rays;
    by_moving_ = asked_ = false;
    rmse_.reset();
    if (shown) return std::nullopt;
    current_ = {quality_.settings, 1};
    return current_;
  }
  by_moving_ = false;
  if (const auto step = refinement_.next(false)) {
    finished_ = step->finished;
    return ask(*step, 1);
  }
  finished_ = true;
  if (scale == 1) return std::nullopt;
  current_.scale = 1;
  return current_;
}

NextPicture Pacing::kept() {
  // what it takes says nothing of its setting
  asked_ = false;
  is_kept_ = true;
  NextPicture next = current_;
  next.settings.keep = true;
  return next;
}

bool Pacing::may_improve() const { return kind_.fast || refinement_.expected_better_ms().value_or(0) <= kStandingBudgets * budget_ms_; }

NextPicture Pacing::best(const SceneKind& kind) {
  while (still(kind)) {
  }
  by_moving_ = false;
  return current_;
}

void Pacing::drawn(double ms) {
  shown_ms_ = ms;
  if (std::exchange(is_kept_, false) && ms > kKeptBudgets * budget_ms_) kept_late_ = true;
  if (asked_) refinement_.drawn(ms * current_.scale * current_.scale);
  asked_ = false;
}

void Pacing::estimated(double rmse) {
  rmse_ = rmse;
  if (quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && rmse <= quality_.goal->value) finished_ = true;
}

std::string Pacing::words() const {
  std::string text = kind_.rays ? render::describe(current_.settings) + ", " : "";
  if (current_.scale > 1) text += fmt::format("1/{} of the size, ", current_.scale);
  if (rmse_) text += fmt::format("error {:.2f}, ", *rmse_);
  return text + fmt::format("{:.0f} ms", shown_ms_);
}

namespace {

constexpr std::int64_t kPauseNs = 1'000'000'000;

std::string figures_json(const haptics::HistogramFigures& f) {
  std::string bins;
  for (const auto& bin : f.bins) bins += fmt::format("{}[{:.6g}, {}]", bins.empty() ? "" : ", ", bin.from_us, bin.count);
  return fmt::format(R"({{"p50": {:.6g}, "p99": {:.6g}, "p999": {:.6g}, "max": {:.6g}, "count": {}, "bins": [{}]}})", f.p50_us, f.p99_us,
                     f.p999_us, f.max_us, f.count, bins);
}

}  // namespace

void FrameTimes::add(double ms, std::int64_t now_ns) {
  draw_.add(static_cast<std::int64_t>(1e6 * ms));
  if (last_ns_ != 0 && now_ns - last_ns_ < kPauseNs) period_.add(now_ns - last_ns_);
  last_ns_ = now_ns;
  recent_[recent_first()] = static_cast<float>(ms);
  ++count_;
}

std::string FrameTimes::json() const {
  return fmt::format("{{\"frames\": {},\n \"draw_us\": {},\n \"period_us\": {},\n \"interface_us\": {}}}\n", count_, figures_json(draw()),
                     figures_json(period()), figures_json(interface()));
}

}  // namespace catena::app
