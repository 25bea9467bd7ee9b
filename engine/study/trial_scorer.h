/// Says when a trial starts and ends, and measures it. In `study simulate` and `study run` alike it is given the place of the hand in every
/// tick, which is the drawn cursor. It is never given a proxy: one that a link holds on the path would have no error by construction.
///   start    the clock starts where the cursor leaves the ball of radius `start` about the start, in which it must have been
///   end      circle or plane: where it is crossed, found between two ticks on the straight line; end: within `reach` of it; or the limit
///   error    advection: from the path's end to the place of the crossing (at the limit: to the cursor); tracing: the mean over all ticks
///            of the clock of the distance to the closest place of the path
/// In 2D tasks everything is measured in the picture plane.
/// Positions in world units. `tick` allocates nothing and may run on the haptic thread.
#pragma once
#include <string>

#include "engine/study/stimulus.h"

namespace catena::study {

/// What a trial gave.
struct TrialResult {
  bool reached_target = false;  ///< else by the limit
  double time_s = 0;            ///< of the clock
  double error_mm = 0;          ///< as the task's kind has it, see above
  double traveled_mm = 0;       ///< by the cursor
  double peak_force_n = 0;      ///< while the clock ran
  Vec3 end_mm{0.0};             ///< the crossing, or the last cursor; world axes
};

/// The judge of one trial.
class TrialScorer {
 public:
  /// Where the trial is.
  enum class Phase { waiting, ready, running, ended };  ///< for the cursor at the start; at the start; the clock runs; over

  /// `task` outlives it.
  TrialScorer(const Task& task, const Stimulus& stimulus);

  /// `t_s` rises. After the end it does nothing.
  Phase tick(double t_s, const Vec3& cursor, double force_n) noexcept;
  /// Where the trial is now.
  Phase phase() const { return phase_; }
  /// Seconds since the clock started; 0 before and after.
  double running_s() const { return phase_ == Phase::running ? last_s_ - start_s_ : 0; }
  /// Once it has ended.
  const TrialResult& result() const { return result_; }
  /// Of a trial that is given up before its clock has come to the limit: the limit's time, and the error of the cursor as it is now, from
  /// the path's end (advection) or from the path (tracing).
  TrialResult aborted_result() const noexcept;
  /// From the cursor to the path, world units.
  double distance_to_path(const Vec3& cursor) const noexcept;

 private:
  Vec3 project_to_image(const Vec3& p) const noexcept;
  /// Where the way from the last cursor to this one crosses the target: 0..1; negative: it does not.
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
