/// LiveTrial is one trial with a person's hand: its scene, what is felt before and while it runs, its recording, and its judge, who gets
/// every tick of the servo however slow the pictures are.
///   open()    the scene with a ball at its start, and without what one condition feels and another does not: before it begins nothing
///             tells the condition
///   begin()   every tick from here on is recorded, and then the condition's own links begin; the judge follows from the first tick that
///             they run. His clock starts when the cursor leaves the start (engine/study/trial_scorer.h)
///   follow()  takes what the servo has done since
///   end()     the condition's own links end, and so does the recording
/// Frame thread; the haptic thread never waits (tick_tap.h).
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/app/study/tick_observer.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/study/session.h"
#include "engine/study/trial_scorer.h"

namespace catena::app {

class LiveTrial {
 public:
  /// `study` outlives it.
  explicit LiveTrial(const study::Study& study) : study_(study), stimulus_maker_(study) {}

  /// The scene of a trial, read and not loaded yet. `adjust`: as SceneModel::open.
  Result<SceneModel> open(const study::Trial& trial, const std::function<Outcome(scene::Scene&)>& adjust);
  const study::Trial& trial() const { return trial_; }
  const Vec3& start_position() const { return stimulus_.start; }
  /// The cursor is where the trial begins.
  bool is_at_start(const Vec3& cursor) const;

  /// `scene`: what open() gave, loaded, and in the hand. `recording`: where every tick goes.
  Outcome begin(SceneModel& scene, HapticSession& hand, const std::string& recording);
  bool is_running() const { return scorer_.has_value(); }

  /// What became of it. An error: it cannot be recorded any more.
  enum class State : std::uint8_t {
    running,
    return_to_start,  ///< it was left before the first tick: the cursor has to come back to the start
    ended,            ///< end() says how
    device_lost,
    tick_lost  ///< the program stood still for so long that ticks were lost
  };
  Result<State> update(const HapticSession& hand);
  /// What was measured, if it has ended.
  Result<study::TrialResult> end(SceneModel& scene, HapticSession& hand);

 private:
  const study::Study& study_;
  study::StimulusGenerator stimulus_maker_;
  study::Trial trial_;
  study::Stimulus stimulus_;
  TickObserver tick_observer_;
  std::optional<study::TrialScorer> scorer_;
  std::uint64_t epoch_ = 0;  ///< of the trial's program
};

}  // namespace catena::app
