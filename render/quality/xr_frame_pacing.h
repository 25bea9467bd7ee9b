/// Which picture a headset's next frame is, so that it comes in time: a display that shows a frame every period, whether it is there or
/// not. Pure logic of what it is told, no device and no clock; it shares the ladder and the times of refinement.h with the window.
///   budget   room of the period; room is 0.8 and falls by a tenth with every late frame (to 0.25 at least): what the compositor and the
///            machine need beside the picture is not known before. After a stall it is all back within 90 frames; where frames come late
///            again on the way, it rises half as fast after each of these (to a 22nd at least) up to where they did, and beyond, where
///            they do not any more, twice as fast every 20 frames
///   rung     the best one whose expected time, of both eyes together, fits the budget; where the fast raycast cannot draw it and none
///            fits, fewer pixels (choose_pixel_scale)
///   rate     where even the coarsest does not fit for 8 frames in a row: that one, at half rate (two periods a frame); said once. Back at
///            full rate when it would fit with room (0.7) for 30 frames
///   late     a frame that is shown more periods after the one before than its rate has; of the first 30 apart, while times are learnt
#pragma once
#include <cstdint>
#include <string>

#include "render/quality/refinement.h"

namespace catena::render {

struct FramePlan {
  RenderSettings settings;
  std::uint32_t pixel_scale = 1;  ///< every so many pixels, each way
  int display_periods = 1;        ///< of the display, for this frame: 2 at half rate
};

class XrFramePacing {
 public:
  static constexpr int kWarmupFrames = 30;

  explicit XrFramePacing(const QualityLevelOptions& kind = {});
  /// Another scene has another ladder.
  void set_level_options(const QualityLevelOptions& kind);

  /// After the frame's wait: the display's period and when this frame will be shown, as the runtime predicts them.
  FramePlan next(double period_ms, std::int64_t shown_ns);
  /// What that frame took, both eyes. Not called: it says nothing (nothing was to be drawn).
  void record_render_ms(double ms);
  /// The session did not run: the next frame is not late, whenever it is.
  void pause() { last_shown_ns_ = 0; }
  /// One sentence for the person when the rate changes for the first time; empty: nothing new. Once.
  std::string take_message();

  int frame_count() const { return frame_count_; }
  int late_frames() const { return late_frames_; }              ///< of all
  int late_after_warmup() const { return late_after_warmup_; }  ///< of those after the first kWarmupFrames
  int half_rate_frames() const { return half_rate_frames_; }    ///< frames
  double budget_ms() const { return budget_ms_; }

 private:
  void count_frame(double period_ms, std::int64_t shown_ns);
  void update_headroom(bool late);
  void choose_rate(double coarsest_ms);

  QualityLevelOptions level_options_;
  Refinement refinement_;
  FramePlan plan_;
  double headroom_, budget_ms_ = 0;
  double headroom_gain_;        ///< of the room, with every frame in time
  double gain_multiplier_ = 1;  ///< times that, where no frame came late
  double late_headroom_;        ///< where frames came late, 3 % less with each of them
  int on_time_frames_ = 0;      ///< frames in time since the room was all there
  bool was_late_ = false;
  std::int64_t last_shown_ns_ = 0;  ///< the last frame; 0: none
  bool is_pending_ = false;
  int frame_count_ = 0, rendered_frames_ = 0, late_frames_ = 0, late_after_warmup_ = 0, half_rate_frames_ = 0;
  int slow_in_a_row_ = 0, fast_in_a_row_ = 0;  ///< frames in a row
  bool is_half_rate_ = false, has_reported_ = false;
  std::string message_;
};

}  // namespace catena::render
