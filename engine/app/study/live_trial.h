// SPDX-License-Identifier: MIT
/// LiveTrial runs one trial with a subject and a real device: its scene, the haptics before and during the trial, its recording, and its
/// scorer, which gets every tick of the servo at any frame rate.
///   open()    opens the scene with a ball at the start, and without the links that not all conditions share: before the trial begins,
///             nothing reveals the condition
///   begin()   starts the recording of every tick, then adds the condition's own links; the scorer starts with the first tick that runs
///             them. The clock starts when the cursor leaves the start (engine/study/trial_scorer.h)
///   update()  scores the ticks that the servo has run since the last call
///   end()     removes the condition's own links and ends the recording
/// Frame thread; the haptic thread never waits (tick_observer.h).
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
  /// `study` must outlive this object.
  explicit LiveTrial(const study::Study& study) : study_(study), stimulus_maker_(study) {}

  /// Opens the scene of a trial: parsed, data not loaded. `adjust`: as for SceneModel::open. Error: the stimulus or the scene is not valid.
  Result<SceneModel> open(const study::Trial& trial, const std::function<Outcome(scene::Scene&)>& adjust);
  const study::Trial& trial() const { return trial_; }
  const Vec3& start_position() const { return stimulus_.start; }
  /// Whether the cursor is inside the start ball of the trial.
  bool is_at_start(const Vec3& cursor) const;

  /// Begins the trial. `scene`: the result of open(), loaded and used by `hand`; `recording`: path of the file for every tick.
  Outcome begin(SceneModel& scene, HapticSession& hand, const std::string& recording);
  /// Whether begin() was called without end().
  bool is_running() const { return scorer_.has_value(); }

  /// State of the trial.
  enum class State : std::uint8_t {
    running,
    return_to_start,  ///< The cursor left the start before the first tick; it has to return
    ended,            ///< The trial has ended; end() returns the result
    device_lost,
    /// The program stalled for so long that ticks were dropped
    tick_lost
  };
  /// Scores the ticks since the last call. Error (system failure): the recording cannot be written.
  Result<State> update(const HapticSession& hand);
  /// Ends the trial and returns what was measured; meaningful only for State::ended.
  Result<study::TrialResult> end(SceneModel& scene, HapticSession& hand);

 private:
  const study::Study& study_;
  study::StimulusGenerator stimulus_maker_;
  study::Trial trial_;
  study::Stimulus stimulus_;
  TickObserver tick_observer_;
  std::optional<study::TrialScorer> scorer_;
  std::uint64_t epoch_ = 0;  ///< Epoch of the trial's program
};

}  // namespace catena::app
