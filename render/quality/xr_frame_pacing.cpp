// SPDX-License-Identifier: MIT
#include "render/quality/xr_frame_pacing.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/base/result.h"

namespace catena::render {
namespace {

constexpr double kRoom = 0.8, kLeastRoom = 0.25, kAfterLate = 0.9;
constexpr int kRecovery = 90;                                                              // frames
constexpr double kRegain = (kRoom - kLeastRoom) / kRecovery, kLeastRegain = kRegain / 22;  // a frame
constexpr double kForgotten = 0.97;                                                        // of the room where frames came late
constexpr double kBeyond = 1.035;                                                          // twice in 20 frames
constexpr int kUntilHalf = 8, kUntilFull = 30;                                             // frames
constexpr double kFullBelow = 0.7;                                                         // of the budget

}  // namespace

XrFramePacing::XrFramePacing(const QualityLevelOptions& kind)
    : level_options_(kind), refinement_(1, kind), headroom_(kRoom), headroom_gain_(kRegain), late_headroom_(kRoom) {}

void XrFramePacing::set_level_options(const QualityLevelOptions& kind) {
  if (kind == level_options_) return;
  level_options_ = kind;
  refinement_ = Refinement(1, kind);
  plan_.pixel_scale = 1;
  rendered_frames_ = slow_in_a_row_ = fast_in_a_row_ = 0;
  is_pending_ = false;
}

void XrFramePacing::count_frame(double period_ms, std::int64_t shown_ns) {
  ++frame_count_;
  if (is_half_rate_) ++half_rate_frames_;
  if (last_shown_ns_ != 0) {
    const double periods = 1e-6 * (static_cast<double>(shown_ns) - static_cast<double>(last_shown_ns_)) / period_ms;
    const bool late = periods > plan_.display_periods + 0.5;
    update_headroom(late);
    if (late) {
      ++late_frames_;
      if (frame_count_ > kWarmupFrames) ++late_after_warmup_;
    }
  }
  last_shown_ns_ = shown_ns;
}

/// A stall says nothing of the room that a picture can have, and what comes late while the room grows does: of several late frames in a row
/// the first one counts.
void XrFramePacing::update_headroom(bool late) {
  if (late && !was_late_) {
    late_headroom_ = std::max(headroom_, kForgotten * late_headroom_);
    headroom_gain_ = on_time_frames_ >= kRecovery ? kRegain : std::max(kLeastRegain, headroom_gain_ / 2);
  }
  was_late_ = late;
  gain_multiplier_ = late || headroom_ <= late_headroom_ ? 1 : kBeyond * gain_multiplier_;
  headroom_gain_ = gain_multiplier_ * headroom_gain_ < kRegain ? headroom_gain_ : kRegain;
  headroom_ = late ? std::max(kLeastRoom, kAfterLate * headroom_) : std::min(kRoom, headroom_ + gain_multiplier_ * headroom_gain_);
  on_time_frames_ = late || headroom_ < kRoom ? 0 : on_time_frames_ + 1;
}

void XrFramePacing::choose_rate(double coarsest_ms) {
  const bool fits = coarsest_ms <= budget_ms_;
  slow_in_a_row_ = fits || rendered_frames_ < kUntilHalf ? 0 : slow_in_a_row_ + 1;
  fast_in_a_row_ = coarsest_ms <= kFullBelow * budget_ms_ ? fast_in_a_row_ + 1 : 0;
  if (!is_half_rate_ && slow_in_a_row_ >= kUntilHalf) {
    is_half_rate_ = true;
    if (!std::exchange(has_reported_, true))
      message_ = fmt::format("the coarsest picture takes {:.1f} ms of the {:.1f} ms that the headset leaves it: every 2nd frame is drawn",
                             coarsest_ms, budget_ms_);
  } else if (is_half_rate_ && fast_in_a_row_ >= kUntilFull) {
    is_half_rate_ = false;
  }
}

FramePlan XrFramePacing::next(double period_ms, std::int64_t shown_ns) {
  CATENA_ASSERT(period_ms > 0);
  count_frame(period_ms, shown_ns);
  budget_ms_ = headroom_ * period_ms;
  refinement_.set_budget(budget_ms_);
  const RefinementStep step = *refinement_.next(true);
  plan_.settings = step.settings;
  plan_.pixel_scale = level_options_.can_draw_fast ? 1 : choose_pixel_scale(step.expected_ms, plan_.pixel_scale, budget_ms_);
  const double scale = level_options_.can_draw_fast ? 1 : kMaxPixelScale;
  choose_rate(refinement_.expected_coarsest_ms() / (scale * scale));
  plan_.display_periods = is_half_rate_ ? 2 : 1;
  is_pending_ = true;
  return plan_;
}

void XrFramePacing::record_render_ms(double ms) {
  CATENA_ASSERT(is_pending_);
  is_pending_ = false;
  ++rendered_frames_;
  refinement_.record_render_ms(ms * plan_.pixel_scale * plan_.pixel_scale);
}

std::string XrFramePacing::take_message() { return std::exchange(message_, {}); }

}  // namespace catena::render
