// SPDX-License-Identifier: MIT
#include "engine/app/study/live_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/study/subject_folder.h"
#include "engine/base/json_text.h"
#include "engine/base/numbers.h"
#include "engine/scene/to_json.h"
#include "engine/study/trial_scene.h"

namespace catena::app {

namespace {

/// Indices in the trial's chain of links that not all conditions share, in descending order.
std::vector<std::size_t> own_links(const study::Study& study, const study::Trial& trial) {
  const auto task = static_cast<std::size_t>(trial.task);
  const auto& links = study.conditions[static_cast<std::size_t>(trial.condition)].chains[task].items;
  std::vector<std::size_t> own;
  for (std::size_t i = links.size(); i-- > 0;) {
    const auto feels = [&](const study::Condition& condition) {
      return std::ranges::any_of(condition.chains[task].items,
                                 [&](const json::Node& link) { return json::is_equal_value(link, links[i]); });
    };
    if (!std::ranges::all_of(study.conditions, feels)) own.push_back(i);
  }
  return own;
}

/// Streamline so short that it appears as a ball, at the center of the trial's start.
std::string start_ball(const study::Task& task, const study::Stimulus& stimulus) {
  constexpr double kShare = 0.35;
  const double radius = kShare * task.world_from_mm(task.start_radius_mm);
  return fmt::format(R"({{"field": {}, "seeds": [{}], "length": {}, "radius": {}, "color": [0.05, 0.5, 0.2]}})", json_string(task.field),
                     scene::to_json(stimulus.start), to_text(1e-3 * radius), to_text(radius));
}

}  // namespace

Result<SceneModel> LiveTrial::open(const study::Trial& trial, const std::function<Outcome(scene::Scene&)>& adjust) {
  CATENA_ASSERT(!is_running());
  const study::Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  CATENA_TRY(study::Stimulus stimulus, stimulus_maker_.generate(trial.task, trial.seed));
  CATENA_TRY(scene::Document document, scene::Document::create(study::make_trial_scene(study_, trial, stimulus), study_.path));
  CATENA_TRY(SceneModel host, SceneModel::open(std::move(document), adjust));
  // all edits in one undo step
  std::vector<scene::Document::Edit> before{{"/streamlines/-", start_ball(task, stimulus)}};
  for (const std::size_t i : own_links(study_, trial)) before.push_back({fmt::format("/chain/{}", i), std::nullopt});
  CATENA_CHECK(host.apply(before, "before the trial"));
  host.take_changed();
  trial_ = trial;
  stimulus_ = std::move(stimulus);
  return host;
}

bool LiveTrial::is_at_start(const Vec3& cursor) const {
  study::TrialScorer judge(study_.tasks[static_cast<std::size_t>(trial_.task)], stimulus_);
  return judge.tick(0, cursor, 0) == study::TrialScorer::Phase::ready;
}

Outcome LiveTrial::begin(SceneModel& scene, HapticSession& hand, const std::string& recording) {
  RecordedScene recorded{study_.path, scene.document().text(), {}, scene_input_files(scene.scene()), trial_metadata_json(study_, trial_)};
  recorded.input_files.push_back(study_.path);
  const auto through_tap = [&](haptics::TickSink* sink) {
    tick_observer_.begin(sink);
    return &tick_observer_;
  };
  CATENA_CHECK(hand.record(recording, std::move(recorded), through_tap));
  CATENA_CHECK(scene.undo());
  scene.take_changed();
  CATENA_CHECK(hand.publish(scene.scene(), scene.document().text()));
  epoch_ = hand.program()->epoch;
  scorer_.emplace(study_.tasks[static_cast<std::size_t>(trial_.task)], stimulus_);
  return Done{};
}

Result<LiveTrial::State> LiveTrial::update(const HapticSession& hand) {
  if (hand.recording().has_failed()) return Error{hand.recording().path() + ": the recording cannot be written", true};
  // a trial with dropped ticks is invalid
  if (tick_observer_.has_lost_ticks()) return State::tick_lost;
  while (const auto tick = tick_observer_.pop()) {
    if (tick->epoch != epoch_) continue;
    if (!tick->is_valid) return State::device_lost;
    if (scorer_->tick(tick->t_s, tick->probe, norm(tick->force_n)) == study::TrialScorer::Phase::ended) return State::ended;
  }
  return scorer_->phase() == study::TrialScorer::Phase::waiting ? State::return_to_start : State::running;
}

Result<study::TrialResult> LiveTrial::end(SceneModel& scene, HapticSession& hand) {
  const study::TrialResult measured = scorer_->result();
  scorer_.reset();
  CATENA_CHECK(scene.redo());
  scene.take_changed();
  CATENA_CHECK(hand.publish(scene.scene(), scene.document().text()));
  CATENA_CHECK(hand.stop_recording());
  return measured;
}

}  // namespace catena::app
