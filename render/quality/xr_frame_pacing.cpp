// SPDX-License-Identifier: MIT
#include "render/quality/xr_frame_pacing.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/base/result.h"

namespace catena::render {
namespace {

constexpr double kMaxHeadroom = 0.8, kMinHeadroom = 0.25, kLateFactor = 0.9;
constexpr int kRecoveryFrames = 90;  // on-time frames at the maximum headroom before the full gain returns
constexpr double kMaxGain = (kMaxHeadroom - kMinHeadroom) / kRecoveryFrames, kMinGain = kMaxGain / 22;  // gain of the headroom per frame
constexpr double kLateHeadroomDecay = 0.97;       // decay of late_headroom_, per late frame
constexpr double kGainGrowth = 1.035;             // factor of the gain per frame above late_headroom_; doubles in 20 frames
constexpr int kSlowFrames = 8, kFastFrames = 30;  // frames until the rate changes
constexpr double kFullRateShare = 0.7;            // share of the budget

}  // namespace

XrFramePacing::XrFramePacing(const QualityLevelOptions& kind)
    : level_options_(kind), refinement_(1, kind), headroom_(kMaxHeadroom), headroom_gain_(kMaxGain), late_headroom_(kMaxHeadroom) {}

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

/// Updates the headroom. Of several late frames in a row only the first changes late_headroom_ and the gain: a stall tells nothing about
/// the headroom, a late frame during its growth does.
void XrFramePacing::update_headroom(bool late) {
  if (late && !was_late_) {
    late_headroom_ = std::max(headroom_, kLateHeadroomDecay * late_headroom_);
    headroom_gain_ = on_time_frames_ >= kRecoveryFrames ? kMaxGain : std::max(kMinGain, headroom_gain_ / 2);
  }
  was_late_ = late;
  gain_multiplier_ = late || headroom_ <= late_headroom_ ? 1 : kGainGrowth * gain_multiplier_;
  headroom_gain_ = gain_multiplier_ * headroom_gain_ < kMaxGain ? headroom_gain_ : kMaxGain;
  headroom_ =
      late ? std::max(kMinHeadroom, kLateFactor * headroom_) : std::min(kMaxHeadroom, headroom_ + gain_multiplier_ * headroom_gain_);
  on_time_frames_ = late || headroom_ < kMaxHeadroom ? 0 : on_time_frames_ + 1;
}

void XrFramePacing::choose_rate(double coarsest_ms) {
  const bool fits = coarsest_ms <= budget_ms_;
  slow_in_a_row_ = fits || rendered_frames_ < kSlowFrames ? 0 : slow_in_a_row_ + 1;
  fast_in_a_row_ = coarsest_ms <= kFullRateShare * budget_ms_ ? fast_in_a_row_ + 1 : 0;
  if (!is_half_rate_ && slow_in_a_row_ >= kSlowFrames) {
    is_half_rate_ = true;
    if (!std::exchange(has_reported_, true))
      message_ =
          fmt::format("the coarsest image takes {:.1f} ms, more than the {:.1f} ms available per frame: the headset runs at half rate",
                      coarsest_ms, budget_ms_);
  } else if (is_half_rate_ && fast_in_a_row_ >= kFastFrames) {
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
