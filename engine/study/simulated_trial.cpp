#include "engine/study/simulated_trial.h"

#include <algorithm>
#include <set>

#include "engine/scene/document.h"
#include "engine/study/operator.h"
#include "engine/study/trial_scene.h"
#include "haptics/device/settings.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/limits_for.h"
#include "haptics/servo/step.h"

namespace catena::study {
namespace {

constexpr double kRampS = 0.02;    ///< of switches, as with every device
constexpr double kPatienceS = 30;  ///< beyond the limit of the clock: for a hand that never leaves the start
constexpr std::uint64_t kTrialSeeds = 0x0be7a7047a1a1001u;

std::uint64_t operator_seed(const Study& study, const Trial& trial) {
  std::uint64_t seed = kTrialSeeds;
  for (const int part : {study.seed, trial.subject, trial.index}) seed = mixed_bits(seed ^ static_cast<std::uint64_t>(part));
  return seed;
}

}  // namespace

TrialSimulator::TrialSimulator(const Study& study, Recorder recorder) : study_(study), recorder_(std::move(recorder)), maker_(study) {}

Result<const Stimulus*> TrialSimulator::stimulus_of(const Trial& trial) {
  if (!kept_.empty() && kept_.front().task != trial.task) kept_.clear();
  const auto found = std::ranges::find(kept_, trial.seed, &Kept::seed);
  if (found != kept_.end()) return &found->stimulus;
  CATENA_TRY(Stimulus made, maker_.make(trial.task, trial.seed));
  return &kept_.emplace_back(trial.task, trial.seed, std::move(made)).stimulus;
}

Result<TrialSimulator::Stage> TrialSimulator::stage_of(const Trial& trial) {
  const Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  Stage stage;
  CATENA_TRY(stage.stimulus, stimulus_of(trial));
  stage.text = trial_scene(study_, trial, *stage.stimulus);
  CATENA_TRY(scene::Scene scene, scene::parse_scene(stage.text, study_.path));
  if (last_) scene::carry_over(*last_, scene);
  if (!scene.coupling.ramp_s) scene.coupling.ramp_s = kRampS;
  CATENA_TRY(stage.field, scene::use_field(scene, task.field, task.where));
  haptics::DeviceSettings settings;
  settings.rate_hz = kSimulatedRateHz;
  const haptics::SimulatedHand device({{}}, hand_of(study_.model, 1 / kSimulatedRateHz));
  CATENA_TRY(stage.program, haptics::extract_program(scene, haptics::limits_for(device.capabilities(), settings)));
  last_.emplace(std::move(scene));
  return stage;
}

Outcome TrialSimulator::check() {
  std::set<std::pair<int, int>> checked;
  for (const Trial& trial : session_of(study_, 1))
    if (checked.emplace(trial.task, trial.condition).second) CATENA_CHECK(stage_of(trial));
  return Done{};
}

Result<Measured> TrialSimulator::run(const Trial& trial) {
  const Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  CATENA_TRY(const Stage stage, stage_of(trial));
  haptics::TickSink* sink = nullptr;
  if (recorder_) {
    CATENA_TRY(sink, recorder_(trial, stage.text, *stage.program));
  }
  const haptics::HandParameters parameters = hand_of(study_.model, 1 / kSimulatedRateHz);
  haptics::SimulatedHand hand({{.position_m = haptics::device_from_world(*stage.program, stage.stimulus->start)}}, parameters);
  Operator subject(study_, task, *stage.stimulus, *stage.field.vector, subject_model(study_, trial.subject), operator_seed(study_, trial),
                   parameters.period_s);
  haptics::Stepper stepper(hand, *stage.program, kSimulatedRateHz, sink);
  Judge judge(task, *stage.stimulus);
  while (stepper.t_s() < task.limits.ends_s + kPatienceS) {
    const double t_s = stepper.t_s();
    const exchange::HapticState& state = stepper.step();
    if (judge.tick(t_s, state.probe, norm(state.force_n)) == Judge::Phase::ended) return judge.measured();
    hand.want(haptics::device_from_world(*stage.program, subject.next(state.probe)));
  }
  return judge.given_up();
}

}  // namespace catena::study
