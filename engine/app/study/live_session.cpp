#include "engine/app/study/live_session.h"

#include <unistd.h>

#include <utility>

namespace catena::app {

LiveSession::~LiveSession() {
  if (!recording_.empty()) ::unlink(recording_.c_str());
}

Result<std::optional<SceneHost>> LiveSession::next_scene() {
  const std::vector<study::Trial>& trials = procedure_.trials();
  std::optional<std::size_t> ahead = procedure_.trial_ahead();
  // behind the questions stands what was there last
  if (!ahead && !opened_ && !trials.empty()) ahead = trials.size() - 1;
  if (!ahead || ahead == opened_) return std::optional<SceneHost>();
  CATENA_TRY(SceneHost host, live_.open(trials[*ahead], adjust_));
  opened_ = ahead;
  return std::optional<SceneHost>(std::move(host));
}

bool LiveSession::is_at_start(const HandHost& hand) const {
  return procedure_.stage() == Procedure::Stage::ready && opened_ == procedure_.trial() && hand.felt().tick > 0 &&
         live_.is_at_start(hand.felt().probe);
}

Outcome LiveSession::take(const Stroke& stroke, SceneHost& scene, HandHost& hand) {
  procedure_.take(stroke, is_at_start(hand));
  if (const auto answer = procedure_.take_answer()) CATENA_CHECK(folder_.keep_answer(answer->question, answer->answer));
  if (procedure_.stage() != Procedure::Stage::running || live_.runs()) return Done{};
  recording_ = folder_.unfinished_recording(live_.trial());
  to_start_ = false;
  return live_.begin(scene, hand, recording_);
}

Outcome LiveSession::follow(SceneHost& scene, HandHost& hand) {
  if (!live_.runs()) return Done{};
  CATENA_TRY(const LiveTrial::State state, live_.follow(hand));
  to_start_ = state == LiveTrial::State::to_start;
  if (state == LiveTrial::State::goes_on || to_start_) return Done{};
  CATENA_TRY(const study::Measured measured, live_.end(scene, hand));
  const std::string recording = std::exchange(recording_, {});
  if (state == LiveTrial::State::ended) {
    CATENA_CHECK(folder_.keep(live_.trial(), measured, recording));
    procedure_.ended();
    return Done{};
  }
  ::unlink(recording.c_str());
  procedure_.cut_off(state == LiveTrial::State::device_lost ? "The device was away for a moment."
                                                            : "The program stood still for too long.");
  return Done{};
}

}  // namespace catena::app
