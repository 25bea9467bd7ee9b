#include "engine/app/study/live_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/app/run_files.h"
#include "engine/app/study/subject_folder.h"
#include "engine/base/json_text.h"
#include "engine/base/numbers.h"
#include "engine/scene/write_values.h"
#include "engine/study/trial_scene.h"

namespace catena::app {

namespace {

/// The places in a trial's chain of what not every condition feels, the last first.
std::vector<std::size_t> own_links(const study::Study& study, const study::Trial& trial) {
  const auto task = static_cast<std::size_t>(trial.task);
  const auto& links = study.conditions[static_cast<std::size_t>(trial.condition)].chains[task].items;
  std::vector<std::size_t> own;
  for (std::size_t i = links.size(); i-- > 0;) {
    const auto feels = [&](const study::Condition& condition) {
      return std::ranges::any_of(condition.chains[task].items, [&](const json::Node& link) { return json::same_value(link, links[i]); });
    };
    if (!std::ranges::all_of(study.conditions, feels)) own.push_back(i);
  }
  return own;
}

/// A line so short that it is a ball, in the middle of where the trial starts.
std::string start_ball(const study::Task& task, const study::Stimulus& stimulus) {
  constexpr double kShare = 0.35;
  const double radius = kShare * task.world(task.start_mm);
  return fmt::format(R"({{"field": {}, "seeds": [{}], "length": {}, "radius": {}, "color": [0.05, 0.5, 0.2]}})", json_string(task.field),
                     scene::text_of(stimulus.start), to_text(1e-3 * radius), to_text(radius));
}

}  // namespace

Result<SceneHost> LiveTrial::open(const study::Trial& trial, const std::function<Outcome(scene::Scene&)>& adjust) {
  CATENA_ASSERT(!runs());
  const study::Task& task = study_.tasks[static_cast<std::size_t>(trial.task)];
  CATENA_TRY(study::Stimulus stimulus, maker_.make(trial.task, trial.seed));
  CATENA_TRY(scene::Document document, scene::Document::make(study::trial_scene(study_, trial, stimulus), study_.path));
  CATENA_TRY(SceneHost host, SceneHost::open(std::move(document), adjust));
  // one step of undo
  std::vector<scene::Document::Edit> before{{"/streamlines/-", start_ball(task, stimulus)}};
  for (const std::size_t i : own_links(study_, trial)) before.push_back({fmt::format("/chain/{}", i), std::nullopt});
  CATENA_CHECK(host.apply(before, "before the trial"));
  host.take_changed();
  trial_ = trial;
  stimulus_ = std::move(stimulus);
  return host;
}

bool LiveTrial::is_at_start(const Vec3& cursor) const {
  study::Judge judge(study_.tasks[static_cast<std::size_t>(trial_.task)], stimulus_);
  return judge.tick(0, cursor, 0) == study::Judge::Phase::ready;
}

Outcome LiveTrial::begin(SceneHost& scene, HandHost& hand, const std::string& recording) {
  RecordedScene recorded{study_.path, scene.document().text(), {}, inputs_of(scene.scene()), about_trial(study_, trial_)};
  recorded.inputs.push_back(study_.path);
  const auto through_tap = [&](haptics::TickSink* sink) {
    tap_.begin(sink);
    return &tap_;
  };
  CATENA_CHECK(hand.record(recording, std::move(recorded), through_tap));
  CATENA_CHECK(scene.undo());
  scene.take_changed();
  CATENA_CHECK(hand.publish(scene.scene(), scene.document().text()));
  epoch_ = hand.program()->epoch;
  judge_.emplace(study_.tasks[static_cast<std::size_t>(trial_.task)], stimulus_);
  return Done{};
}

Result<LiveTrial::State> LiveTrial::follow(const HandHost& hand) {
  if (hand.recording().failed()) return Error{hand.recording().path() + ": the recording cannot be written any more", true};
  // after a hole nothing counts
  if (tap_.has_lost()) return State::tick_lost;
  while (const auto tick = tap_.take()) {
    if (tick->epoch != epoch_) continue;
    if (!tick->good) return State::device_lost;
    if (judge_->tick(tick->t_s, tick->probe, norm(tick->force_n)) == study::Judge::Phase::ended) return State::ended;
  }
  return judge_->phase() == study::Judge::Phase::waiting ? State::to_start : State::goes_on;
}

Result<study::Measured> LiveTrial::end(SceneHost& scene, HandHost& hand) {
  const study::Measured measured = judge_->measured();
  judge_.reset();
  CATENA_CHECK(scene.redo());
  scene.take_changed();
  CATENA_CHECK(hand.publish(scene.scene(), scene.document().text()));
  CATENA_CHECK(hand.stop_recording());
  return measured;
}

}  // namespace catena::app
