/// LiveSession carries a procedure out with a hand: it opens the scene of each trial, begins and ends it, and keeps on the disk what is
/// finished. It knows no window: strokes go in, and whoever shows the scene asks for the next one. Frame thread.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/app/study/live_trial.h"
#include "engine/app/study/procedure.h"
#include "engine/app/study/subject_folder.h"

namespace catena::app {

class LiveSession {
 public:
  /// All of it outlives the session. `adjust`: as SceneModel::open.
  LiveSession(const study::Study& study, SubjectFolder& folder, Procedure& procedure, std::function<Outcome(scene::Scene&)> adjust)
      : folder_(folder), procedure_(procedure), adjust_scene_(std::move(adjust)), live_trial_(study) {}
  ~LiveSession();  ///< what is being recorded goes; the hand is to be stopped before
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  const Procedure& procedure() const { return procedure_; }
  /// The trial's scene that is to be shown from now on, or got ready behind a page: read and not loaded yet. Nothing where the one that was
  /// given last stays. The first call gives one.
  Result<std::optional<SceneModel>> next_scene();
  const LiveTrial& trial() const { return live_trial_; }
  /// The cursor is where the trial begins that is ready.
  bool is_at_start(const HapticSession& hand) const;
  /// The trial runs, and the cursor has to come back to its start.
  bool is_returning_to_start() const { return procedure_.stage() == Procedure::Stage::running && returning_to_start_; }

  /// A key. What it begins, begins at once; what it answers is on the disk.
  Outcome handle_key(const KeyPress& stroke, SceneModel& scene, HapticSession& hand);
  /// What the hand has done since: a trial that is over is on the disk.
  Outcome update(SceneModel& scene, HapticSession& hand);

 private:
  SubjectFolder& folder_;
  Procedure& procedure_;
  std::function<Outcome(scene::Scene&)> adjust_scene_;
  LiveTrial live_trial_;
  std::optional<std::size_t> opened_trial_;  ///< the trial whose scene there is
  std::string recording_path_;               ///< unfinished; empty: none
  bool returning_to_start_ = false;
};

}  // namespace catena::app
