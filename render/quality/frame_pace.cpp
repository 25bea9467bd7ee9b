#include "render/quality/frame_pace.h"

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

FramePace::FramePace(const LadderKind& kind) : kind_(kind), refinement_(1, kind), room_(kRoom), regain_(kRegain), late_room_(kRoom) {}

void FramePace::follow(const LadderKind& kind) {
  if (kind == kind_) return;
  kind_ = kind;
  refinement_ = Refinement(1, kind);
  plan_.scale = 1;
  drawn_ = too_slow_ = quick_ = 0;
  asked_ = false;
}

void FramePace::count(double period_ms, std::int64_t shown_ns) {
  ++frames_;
  if (half_) ++at_half_rate_;
  if (shown_ns_ != 0) {
    const double periods = 1e-6 * (static_cast<double>(shown_ns) - static_cast<double>(shown_ns_)) / period_ms;
    const bool late = periods > plan_.periods + 0.5;
    make_room(late);
    if (late) {
      ++late_;
      if (frames_ > kLearning) ++late_after_;
    }
  }
  shown_ns_ = shown_ns;
}

/// A stall says nothing of the room that a picture can have, and what comes late while the room grows does: of several late frames in a row
/// the first one counts.
void FramePace::make_room(bool late) {
  if (late && !was_late_) {
    late_room_ = std::max(room_, kForgotten * late_room_);
    regain_ = rested_ >= kRecovery ? kRegain : std::max(kLeastRegain, regain_ / 2);
  }
  was_late_ = late;
  beyond_ = late || room_ <= late_room_ ? 1 : kBeyond * beyond_;
  regain_ = beyond_ * regain_ < kRegain ? regain_ : kRegain;
  room_ = late ? std::max(kLeastRoom, kAfterLate * room_) : std::min(kRoom, room_ + beyond_ * regain_);
  rested_ = late || room_ < kRoom ? 0 : rested_ + 1;
}

void FramePace::choose_rate(double coarsest_ms) {
  const bool fits = coarsest_ms <= budget_ms_;
  too_slow_ = fits || drawn_ < kUntilHalf ? 0 : too_slow_ + 1;
  quick_ = coarsest_ms <= kFullBelow * budget_ms_ ? quick_ + 1 : 0;
  if (!half_ && too_slow_ >= kUntilHalf) {
    half_ = true;
    if (!std::exchange(told_, true))
      news_ = fmt::format("the coarsest picture takes {:.1f} ms of the {:.1f} ms that the headset leaves it: every 2nd frame is drawn",
                          coarsest_ms, budget_ms_);
  } else if (half_ && quick_ >= kUntilFull) {
    half_ = false;
  }
}

FramePlan FramePace::next(double period_ms, std::int64_t shown_ns) {
  CATENA_ASSERT(period_ms > 0);
  count(period_ms, shown_ns);
  budget_ms_ = room_ * period_ms;
  refinement_.set_budget(budget_ms_);
  const RefinementStep step = *refinement_.next(true);
  plan_.settings = step.settings;
  plan_.scale = kind_.fast ? 1 : coarser_pixels(step.expected_ms, plan_.scale, budget_ms_);
  const double scale = kind_.fast ? 1 : kMaxScale;
  choose_rate(refinement_.expected_coarsest_ms() / (scale * scale));
  plan_.periods = half_ ? 2 : 1;
  asked_ = true;
  return plan_;
}

void FramePace::drawn(double ms) {
  CATENA_ASSERT(asked_);
  asked_ = false;
  ++drawn_;
  refinement_.drawn(ms * plan_.scale * plan_.scale);
}

std::string FramePace::news() { return std::exchange(news_, {}); }

}  // namespace catena::render
