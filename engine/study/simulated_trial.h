// SPDX-License-Identifier: MIT
/// Runs a trial with the human model instead of a subject: the trial's scene, the real haptic tick, the simulated device and the trial
/// scorer. Not for the haptic thread; otherwise any thread, with one object per thread. A trial gives bit-identical results whichever
/// trials were run before it, on one type of machine.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/scene/scene.h"
#include "engine/study/session.h"
#include "engine/study/stimulus.h"
#include "engine/study/trial_scorer.h"
#include "haptics/servo/servo.h"

namespace catena::study {

/// Tick rate of a simulated trial, Hz.
inline constexpr double kSimulatedRateHz = 1000;

/// Simulates trials of one study. It caches the stimuli of the current task and the data of the last scene.
class TrialSimulator {
 public:
  /// Called when a trial's program is built, with the trial and the scene's JSON text. Returns the sink that receives every tick, or null
  /// to record nothing. An Error ends run().
  using Recorder = std::function<Result<haptics::TickSink*>(const Trial&, const std::string& scene_text, const haptics::HapticProgram&)>;

  /// `study` must outlive this object. `recorder`: empty: nothing is recorded.
  explicit TrialSimulator(const Study& study, Recorder recorder = {});

  /// Runs one trial to its end and returns what was measured; a trial whose clock never starts is aborted 30 s after the task's timeout.
  /// Error: the trial's scene, field or chain cannot be read.
  Result<TrialResult> run(const Trial& trial);
  /// Checks that every task can be run in every condition: builds the scene and the program of the first trial of each pair in the session
  /// of subject 1, without simulating it. Error: as run().
  Outcome check();

 private:
  /// Data of one simulated trial.
  struct TrialSetup {
    const Stimulus* stimulus;
    std::string text;
    field::AnyField field;
    std::shared_ptr<const haptics::HapticProgram> program;
  };
  Result<TrialSetup> make_setup(const Trial& trial);
  Result<const Stimulus*> cached_stimulus(const Trial& trial);

  const Study& study_;
  Recorder recorder_;
  StimulusGenerator generator_;
  std::optional<scene::Scene> last_scene_;  ///< The last trial's scene; its loaded data are reused by the next one
  struct CachedStimulus {
    int task = -1, seed = 0;
    Stimulus stimulus;
  };
  std::vector<CachedStimulus> stimulus_cache_;  ///< Stimuli of the current task; conditions share them
};

}  // namespace catena::study
