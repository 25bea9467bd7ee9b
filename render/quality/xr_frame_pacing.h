// SPDX-License-Identifier: MIT
/// Frame pacing of a headset: chooses the settings of the next frame so that it is on schedule, for a display that shows a frame every
/// period, whether a new one is ready or not. Pure logic, no device and no clock; uses the quality levels and times of refinement.h.
///   budget   headroom times the period. The headroom is 0.8 and falls by a tenth with every missed frame (to 0.25 at least), since the
///            needs of the compositor and the machine are unknown. After a stall it recovers within 90 frames; if frames are missed during
///            the recovery, it rises half as fast after each of these (a 22nd at least) up to the value where they were missed; beyond,
///            while no frame is missed, the rate doubles every 20 frames
///   level    the best one whose expected time, of both eyes together, fits the budget; where the fast raycast is not possible and none
///            fits, fewer pixels (choose_pixel_scale)
///   rate     where even the lowest level does not fit for 8 frames in a row: that one, at half rate (two periods per frame), reported the
///            first time. Back to full rate when it would fit with headroom (0.7 of the budget) for 30 frames
///   late     a missed frame: displayed later after the one before than its rate implies; late_after_warmup() leaves out the first 30, in
///            which times are learned
#pragma once
#include <cstdint>
#include <string>

#include "render/quality/refinement.h"

namespace catena::render {

/// Settings of the next frame.
struct FramePlan {
  RenderSettings settings;
  std::uint32_t pixel_scale = 1;  ///< every n-th pixel in each direction
  int display_periods = 1;        ///< display periods per frame: 2 at half rate
};

/// Frame pacing of one headset session. Frame thread.
class XrFramePacing {
 public:
  static constexpr int kWarmupFrames = 30;

  explicit XrFramePacing(const QualityLevelOptions& kind = {});
  /// Changes the quality levels for another scene.
  void set_level_options(const QualityLevelOptions& kind);

  /// Returns the plan of the next frame; to be called after the frame's wait. `period_ms`: display period; `shown_ns`: predicted display
  /// time of this frame, as reported by the runtime.
  FramePlan next(double period_ms, std::int64_t shown_ns);
  /// Reports the render time of that frame, both eyes. Not to be called if nothing was rendered.
  void record_render_ms(double ms);
  /// To be called while the session is not running: the next frame does not count as missed, however late it is.
  void pause() { last_shown_ns_ = 0; }
  /// Returns a one-line message for the user when the rate is halved for the first time, and clears it; empty: none.
  std::string take_message();

  int frame_count() const { return frame_count_; }              ///< number of frames so far
  int late_frames() const { return late_frames_; }              ///< number of missed frames
  int late_after_warmup() const { return late_after_warmup_; }  ///< number of missed frames after the first kWarmupFrames
  int half_rate_frames() const { return half_rate_frames_; }    ///< number of frames at half rate
  double budget_ms() const { return budget_ms_; }               ///< budget of the last planned frame, milliseconds

 private:
  void count_frame(double period_ms, std::int64_t shown_ns);
  void update_headroom(bool late);
  void choose_rate(double coarsest_ms);

  QualityLevelOptions level_options_;
  Refinement refinement_;
  FramePlan plan_;
  double headroom_, budget_ms_ = 0;
  double headroom_gain_;        ///< rise of the headroom with every frame on schedule
  double gain_multiplier_ = 1;  ///< factor on that while no frame is missed beyond late_headroom_
  double late_headroom_;        ///< headroom at which frames were missed; falls by 3 % with each of them
  int on_time_frames_ = 0;      ///< frames on schedule since the headroom was fully recovered
  bool was_late_ = false;
  std::int64_t last_shown_ns_ = 0;  ///< display time of the last frame; 0: none
  bool is_pending_ = false;
  int frame_count_ = 0, rendered_frames_ = 0, late_frames_ = 0, late_after_warmup_ = 0, half_rate_frames_ = 0;
  int slow_in_a_row_ = 0, fast_in_a_row_ = 0;  ///< numbers of consecutive frames
  bool is_half_rate_ = false, has_reported_ = false;
  std::string message_;
};

}  // namespace catena::render
