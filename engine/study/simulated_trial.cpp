// SPDX-License-Identifier: MIT
#include "engine/study/simulated_trial.h"

#include <algorithm>
#include <set>

#include "engine/scene/document.h"
#include "engine/study/human_model.h"
#include "engine/study/trial_scene.h"
#include "haptics/build/build_program.h"
#include "haptics/device/device_settings.h"
#include "haptics/servo/device_limits.h"
#include "haptics/servo/servo_tick.h"

namespace catena::study {
namespace {

constexpr double kRampS = 0.02;    ///< duration of force ramps after switching, as for every device
constexpr double kPatienceS = 30;  ///< time after the timeout at which a trial is aborted: the simulated user may never leave the start
constexpr std::uint64_t kTrialSeeds = 0x0be7a7047a1a1001u;

std::uint64_t operator_seed(const Study& study, const Trial& trial) {
  std::uint64_t seed = kTrialSeeds;
  for (const int part : {study.seed, trial.subject, trial.index}) seed = mix_bits(seed ^ static_cast<std::uint64_t>(part));
  return seed;
}

}  // namespace

TrialSimulator::TrialSimulator(const Study& study, Recorder recorder) : study_(study), recorder_(std::move(recorder)), generator_(study) {}

Result<const Stimulus*> TrialSimulator::cached_stimulus(const Trial& trial) {
  if (!stimulus_cache_.empty() && stimulus_cache_.front().task != trial.task) stimulus_cache_.clear();
  const auto found = std::ranges::find(stimulus_cache_, trial.seed, &CachedStimulus::seed);
  if (found != stimulus_cache_.end()) return &found->stimulus;
  CATENA_TRY(Stimulus stimulus, generator_.generate(trial.task, trial.seed));
  return &stimulus_cache_.emplace_back(trial.task, trial.seed, std::move(stimulus)).stimulus;
}

Result<TrialSimulator::TrialSetup> TrialSimulator::make_setup(const Trial& trial) {
  const Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  TrialSetup setup;
  CATENA_TRY(setup.stimulus, cached_stimulus(trial));
  setup.text = make_trial_scene(study_, trial, *setup.stimulus);
  CATENA_TRY(scene::Scene scene, scene::parse_scene(setup.text, study_.path));
  if (last_scene_) scene::transfer_state(*last_scene_, scene);
  if (!scene.coupling.ramp_s) scene.coupling.ramp_s = kRampS;
  CATENA_TRY(setup.field, scene::resolve_field(scene, task.field, task.where));
  haptics::DeviceSettings settings;
  settings.rate_hz = kSimulatedRateHz;
  const haptics::SimulatedDevice device({{}}, make_hand_parameters(study_.human_model, 1 / kSimulatedRateHz));
  CATENA_TRY(setup.program, haptics::build_program(scene, haptics::compute_device_limits(device.capabilities(), settings)));
  last_scene_.emplace(std::move(scene));
  return setup;
}

Outcome TrialSimulator::check() {
  std::set<std::pair<int, int>> checked;
  for (const Trial& trial : make_session(study_, 1))
    if (checked.emplace(trial.task, trial.condition).second) CATENA_CHECK(make_setup(trial));
  return Done{};
}

Result<TrialResult> TrialSimulator::run(const Trial& trial) {
  const Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  CATENA_TRY(const TrialSetup setup, make_setup(trial));
  haptics::TickSink* sink = nullptr;
  if (recorder_) {
    CATENA_TRY(sink, recorder_(trial, setup.text, *setup.program));
  }
  const haptics::SimulatedDeviceParameters parameters = make_hand_parameters(study_.human_model, 1 / kSimulatedRateHz);
  haptics::SimulatedDevice hand({{.position_m = haptics::device_from_world(*setup.program, setup.stimulus->start)}}, parameters);
  HumanModel subject(study_, task, *setup.stimulus, *setup.field.vector, draw_subject_traits(study_, trial.subject),
                     operator_seed(study_, trial), parameters.period_s);
  haptics::ServoStepper stepper(hand, *setup.program, kSimulatedRateHz, sink);
  TrialScorer scorer(task, *setup.stimulus);
  while (stepper.t_s() < task.limits.timeout_s + kPatienceS) {
    const double t_s = stepper.t_s();
    const HapticState& state = stepper.step();
    if (scorer.tick(t_s, state.probe, norm(state.force_n)) == TrialScorer::Phase::ended) return scorer.result();
    hand.set_target(haptics::device_from_world(*setup.program, subject.next_target(state.probe)));
  }
  return scorer.aborted_result();
}

}  // namespace catena::study
