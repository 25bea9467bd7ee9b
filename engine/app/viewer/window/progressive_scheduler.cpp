// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/progressive_scheduler.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace catena::app {
namespace {

constexpr double kKeptBudgets = 3;                       // frame budgets allowed for a frame that reuses rays, at its best quality
constexpr double kStandingBudgets = 20;                  // frame budgets allowed for a refined frame of exact rays
constexpr double kSmoothBelow = 0.2, kPlainAbove = 0.6;  // fractions of the budget: frames in motion get, and lose, antialiased contours
constexpr double kFinerBelow = 0.7;  // fraction of the budget: hysteresis for increasing the pixel count, which would otherwise oscillate

bool is_goal(const Quality& quality) { return quality.goal.has_value(); }

bool has_time_goal(const Quality& quality) { return is_goal(quality) && quality.goal->kind == render::QualityGoal::Kind::time; }

double budget_of(const Quality& quality) {
  if (quality.interactive_ms) return *quality.interactive_ms;
  return has_time_goal(quality) ? quality.goal->value : kFrameBudgetMs;
}

render::QualityLevelOptions ladder_of(const RayWorkload& kind) { return {kind.supports_fast, kind.is_shaded}; }

}  // namespace

ProgressiveScheduler::ProgressiveScheduler(const Quality& quality)
    : quality_(quality), budget_ms_(budget_of(quality)), refinement_(budget_ms_, ladder_of(workload_)) {}

/// Sets the kind of workload; a different kind starts with its own quality levels.
void ProgressiveScheduler::set_workload(const RayWorkload& kind) {
  if (kind == workload_) return;
  workload_ = kind;
  refinement_ = render::Refinement(budget_ms_, ladder_of(kind));
  awaits_time_ = false;
}

FrameRequest ProgressiveScheduler::request(const render::RefinementStep& step, std::uint32_t scale) {
  awaits_time_ = true;
  rmse_.reset();
  current_ = {step.settings, scale};
  current_.settings.smooth_edges = !is_interactive_ || smooths_in_motion_;
  return current_;
}

FrameRequest ProgressiveScheduler::interactive_frame(const RayWorkload& kind) {
  set_workload(kind);
  const render::RefinementStep step = *refinement_.next(true);
  // the fast ray casting marches fewer rays first; fewer pixels follow if its coarsest level exceeds the budget
  const std::uint32_t scale = render::choose_pixel_scale(step.expected_ms, current_.pixel_stride, budget_ms_);
  is_interactive_ = true;
  is_finished_ = false;
  return request(step, scale);
}

std::optional<FrameRequest> ProgressiveScheduler::refined_frame(const RayWorkload& kind) {
  set_workload(kind);
  reuse_too_slow_ = false;
  if (is_finished_ && current_.settings.smooth_edges) return std::nullopt;
  if (is_finished_) {  // frames after it reused its rays without antialiased contours
    current_.settings.smooth_edges = true;
    FrameRequest next = current_;
    next.settings.reuse_rays = true;
    return next;
  }
  const std::uint32_t scale = current_.pixel_stride;
  if (!is_goal(quality_) || !kind.uses_rays) {
    is_finished_ = true;
    const bool shown = is_interactive_ && scale == 1 && !kind.uses_rays && current_.settings.smooth_edges;
    is_interactive_ = awaits_time_ = false;
    rmse_.reset();
    if (shown) return std::nullopt;
    current_ = {quality_.settings, 1};
    current_.settings.smooth_edges = true;
    return current_;
  }
  is_interactive_ = false;
  if (const auto step = refinement_.next(false)) {
    is_finished_ = step->is_final;
    return request(*step, 1);
  }
  is_finished_ = true;
  if (scale == 1 && current_.settings.smooth_edges) return std::nullopt;
  current_.pixel_stride = 1;
  current_.settings.smooth_edges = true;
  return current_;
}

FrameRequest ProgressiveScheduler::reused_frame() {
  // the time of this frame does not represent its setting
  awaits_time_ = false;
  is_reused_ = true;
  current_.settings.smooth_edges = smooths_in_motion_;
  FrameRequest next = current_;
  next.settings.reuse_rays = true;
  return next;
}

bool ProgressiveScheduler::may_refine() const {
  return workload_.supports_fast || refinement_.expected_next_ms().value_or(0) <= kStandingBudgets * budget_ms_;
}

FrameRequest ProgressiveScheduler::final_frame(const RayWorkload& kind) {
  while (refined_frame(kind)) {
  }
  is_interactive_ = false;
  return current_;
}

void ProgressiveScheduler::on_interface_drawn(double ms) {
  constexpr double kNew = 0.1, kSlack = 0.95;  // weight of a new time; share of the period that is planned
  if (quality_.interactive_ms || has_time_goal(quality_)) return;
  interface_ms_ += kNew * (ms - interface_ms_);
  budget_ms_ = std::clamp(kSlack * kFramePeriodMs - interface_ms_, kMinFrameBudgetMs, kFrameBudgetMs);
  refinement_.set_budget(budget_ms_);
}

void ProgressiveScheduler::on_rendered(double ms) {
  last_image_ms_ = ms;
  if (is_interactive_ || is_reused_) {
    if (ms < kSmoothBelow * budget_ms_) smooths_in_motion_ = true;
    if (current_.settings.smooth_edges && ms > kPlainAbove * budget_ms_) smooths_in_motion_ = false;
  }
  if (std::exchange(is_reused_, false) && ms > kKeptBudgets * budget_ms_) reuse_too_slow_ = true;
  if (awaits_time_) refinement_.record_render_ms(ms * current_.pixel_stride * current_.pixel_stride);
  awaits_time_ = false;
}

void ProgressiveScheduler::set_estimate(double rmse) {
  rmse_ = rmse;
  if (quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && rmse <= quality_.goal->value) is_finished_ = true;
}

std::string ProgressiveScheduler::status_text() const {
  std::string text = workload_.uses_rays ? render::describe(current_.settings) + ", " : "";
  if (current_.pixel_stride > 1) text += fmt::format("1/{} of the size, ", current_.pixel_stride);
  if (rmse_) text += fmt::format("error {:.2f}, ", *rmse_);
  return text + fmt::format("{:.0f} ms", last_image_ms_);
}

namespace {

constexpr std::int64_t kPauseNs = 1'000'000'000;

std::string figures_json(const haptics::HistogramSummary& f) {
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
  recent_[recent_begin()] = static_cast<float>(ms);
  ++count_;
}

std::string FrameTimes::to_json() const {
  return fmt::format("{{\"frames\": {},\n \"draw_us\": {},\n \"period_us\": {},\n \"interface_us\": {}}}\n", count_,
                     figures_json(draw_times()), figures_json(periods()), figures_json(interface_times()));
}

}  // namespace catena::app
