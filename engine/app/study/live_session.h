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
  /// All of it outlives the session. `adjust`: as SceneHost::open.
  LiveSession(const study::Study& study, SubjectFolder& folder, Procedure& procedure, std::function<Outcome(scene::Scene&)> adjust)
      : folder_(folder), procedure_(procedure), adjust_(std::move(adjust)), live_(study) {}
  ~LiveSession();  ///< what is being recorded goes; the hand is to be stopped before
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  const Procedure& procedure() const { return procedure_; }
  /// The trial's scene that is to be shown from now on, or got ready behind a page: read and not loaded yet. Nothing where the one that was
  /// given last stays. The first call gives one.
  Result<std::optional<SceneHost>> next_scene();
  const LiveTrial& trial() const { return live_; }
  /// The cursor is where the trial begins that is ready.
  bool is_at_start(const HandHost& hand) const;
  /// The trial runs, and the cursor has to come back to its start.
  bool wants_start() const { return procedure_.stage() == Procedure::Stage::running && to_start_; }

  /// A key. What it begins, begins at once; what it answers is on the disk.
  Outcome take(const Stroke& stroke, SceneHost& scene, HandHost& hand);
  /// What the hand has done since: a trial that is over is on the disk.
  Outcome follow(SceneHost& scene, HandHost& hand);

 private:
  SubjectFolder& folder_;
  Procedure& procedure_;
  std::function<Outcome(scene::Scene&)> adjust_;
  LiveTrial live_;
  std::optional<std::size_t> opened_;  ///< the trial whose scene there is
  std::string recording_;              ///< unfinished; empty: none
  bool to_start_ = false;
};

}  // namespace catena::app
