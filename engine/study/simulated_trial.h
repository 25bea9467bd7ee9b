/// A trial done by the model of a subject: its scene, the real tick, the simulated device, and the judge. Off the tick; any thread, each
/// with an object of its own. The same bits for the same trial, whatever was done before, on one type of machine.
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

inline constexpr double kSimulatedRateHz = 1000;

class TrialSimulator {
 public:
  /// Who records a trial, if anybody: asked once its program stands, with the scene's text; may answer with nothing.
  using Recorder = std::function<Result<haptics::TickSink*>(const Trial&, const std::string& scene_text, const haptics::HapticProgram&)>;

  /// `study` outlives it.
  explicit TrialSimulator(const Study& study, Recorder recorder = {});

  /// An error where the trial's scene, field or chain cannot be read.
  Result<TrialResult> run(const Trial& trial);
  /// Whether every task can be done in every condition: of the first trials of a session everything is made, and nothing is done.
  Outcome check();

 private:
  /// All that the hand of a trial meets.
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
  std::optional<scene::Scene> last_scene_;  ///< what it has loaded goes over to the next
  struct CachedStimulus {
    int task = -1, seed = 0;
    Stimulus stimulus;
  };
  std::vector<CachedStimulus> stimulus_cache_;  ///< of the block at hand: conditions share stimuli
};

}  // namespace catena::study
