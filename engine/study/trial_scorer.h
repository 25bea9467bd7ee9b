// SPDX-License-Identifier: MIT
/// Detects the start and end of a trial and measures its result. `study simulate` and `study run` give it the probe of every tick, which is
/// the rendered cursor. It is never given a proxy: a proxy that a link holds on the path would have zero error by construction.
///   start    the clock starts when the cursor leaves the ball of radius `start_radius_mm` about the start; it must have been inside it
///   end      circle or plane: where the cursor crosses it, interpolated linearly between two ticks; end: within `target_radius_mm` of the
///            path's end; in any case `timeout_s` after the clock has started
///   error    advection: distance from the path's end to the crossing (at the timeout: to the cursor); tracing: mean over all ticks while
///            the clock runs of the distance from the cursor to the closest point of the path
/// In 2D tasks everything is measured in the image plane. Positions are in world units. tick() allocates nothing and may run on the haptic
/// thread.
#pragma once
#include <string>

#include "engine/base/export.h"
#include "engine/study/stimulus.h"

namespace catena::study {

/// The measured result of one trial.
struct TrialResult {
  bool reached_target = false;  ///< False: ended by the timeout, or aborted
  double time_s = 0;            ///< Time that the clock ran
  double error_mm = 0;          ///< Error as the task's kind defines it, see above
  double traveled_mm = 0;       ///< Distance that the cursor traveled while the clock ran
  double peak_force_n = 0;      ///< Largest force magnitude while the clock ran
  Vec3 end_mm{0.0};             ///< The crossing, or the last cursor; world axes, device millimeters
};

/// Scores one trial. One thread.
class CATENA_EXPORT TrialScorer {
 public:
  /// Phase of the trial. waiting: the cursor has not been at the start. ready: the cursor is at the start. running: the clock runs. ended:
  /// the result is complete.
  enum class Phase { waiting, ready, running, ended };

  /// `task` must outlive this object; `stimulus` is copied.
  TrialScorer(const Task& task, const Stimulus& stimulus);

  /// Takes one tick and returns the phase after it. `t_s`: time, s, increasing; `cursor`: world units; `force_n`: force magnitude, N.
  /// Ignores a cursor that is not finite, and every tick after the end.
  Phase tick(double t_s, const Vec3& cursor, double force_n) noexcept;
  /// Current phase.
  Phase phase() const { return phase_; }
  /// Seconds since the clock started; 0 unless the phase is running.
  double running_s() const { return phase_ == Phase::running ? last_s_ - start_s_ : 0; }
  /// The result; complete when the phase is ended.
  const TrialResult& result() const { return result_; }
  /// Result of a trial that is aborted before its clock reaches the timeout: its time is `timeout_s`, its error is that of the last cursor:
  /// the distance from the path's end (advection) or from the path (tracing).
  TrialResult aborted_result() const noexcept;
  /// Distance from `cursor` to the path, world units; in 2D tasks within the image plane.
  double distance_to_path(const Vec3& cursor) const noexcept;

 private:
  /// In 2D tasks the projection of `p` onto the image plane; in 3D tasks `p`.
  Vec3 project_to_image(const Vec3& p) const noexcept;
  /// Fraction, 0 to 1, of the segment `from`-`to` at which it crosses the target; negative: no crossing.
  double find_crossing(const Vec3& from, const Vec3& to) const noexcept;
  void end_trial(double t_s, const Vec3& at, bool by_target) noexcept;

  const Task& task_;
  std::vector<Vec3> path_;
  Vec3 start_, end_;
  double circle_radius_ = 0, start_radius_ = 0, target_radius_ = 0;
  Phase phase_ = Phase::waiting;
  double start_s_ = 0, last_s_ = 0, distance_sum_ = 0;
  std::uint64_t ticks_ = 0;
  Vec3 last_{0.0};
  TrialResult result_;
};

}  // namespace catena::study
