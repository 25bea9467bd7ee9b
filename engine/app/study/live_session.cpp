// SPDX-License-Identifier: MIT
#include "engine/app/study/live_session.h"

#include <unistd.h>

#include <utility>

namespace catena::app {

LiveSession::~LiveSession() {
  if (!recording_path_.empty()) ::unlink(recording_path_.c_str());
}

Result<std::optional<SceneModel>> LiveSession::next_scene() {
  const std::vector<study::Trial>& trials = procedure_.trials();
  std::optional<std::size_t> ahead = procedure_.next_trial();
  // questions are shown over the last scene
  if (!ahead && !opened_trial_ && !trials.empty()) ahead = trials.size() - 1;
  if (!ahead || ahead == opened_trial_) return std::optional<SceneModel>();
  CATENA_TRY(SceneModel host, live_trial_.open(trials[*ahead], adjust_scene_));
  opened_trial_ = ahead;
  return std::optional<SceneModel>(std::move(host));
}

bool LiveSession::is_at_start(const HapticSession& hand) const {
  return procedure_.stage() == Procedure::Stage::ready && opened_trial_ == procedure_.trial() && hand.latest_state().tick > 0 &&
         live_trial_.is_at_start(hand.latest_state().probe);
}

Outcome LiveSession::handle_key(const KeyPress& stroke, SceneModel& scene, HapticSession& hand) {
  procedure_.handle_key(stroke, is_at_start(hand));
  if (const auto answer = procedure_.take_answer()) CATENA_CHECK(folder_.save_answer(answer->question, answer->answer));
  if (procedure_.stage() != Procedure::Stage::running || live_trial_.is_running()) return Done{};
  recording_path_ = folder_.unfinished_recording(live_trial_.trial());
  returning_to_start_ = false;
  return live_trial_.begin(scene, hand, recording_path_);
}

Outcome LiveSession::update(SceneModel& scene, HapticSession& hand) {
  if (!live_trial_.is_running()) return Done{};
  CATENA_TRY(const LiveTrial::State state, live_trial_.update(hand));
  returning_to_start_ = state == LiveTrial::State::return_to_start;
  if (state == LiveTrial::State::running || returning_to_start_) return Done{};
  CATENA_TRY(const study::TrialResult measured, live_trial_.end(scene, hand));
  const std::string recording = std::exchange(recording_path_, {});
  if (state == LiveTrial::State::ended) {
    CATENA_CHECK(folder_.save_trial(live_trial_.trial(), measured, recording));
    procedure_.complete_trial();
    return Done{};
  }
  ::unlink(recording.c_str());
  procedure_.abort_trial(state == LiveTrial::State::device_lost ? "The connection to the device was interrupted."
                                                                : "The program was interrupted for too long.");
  return Done{};
}

}  // namespace catena::app
