// SPDX-License-Identifier: MIT
/// LiveSession runs a Procedure with a haptic device: it opens the scene of each trial, begins and ends the trial, and saves finished
/// trials and answers to disk. It has no window: the caller passes key presses and shows the scenes that next_scene() returns. Frame
/// thread.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/app/study/live_trial.h"
#include "engine/app/study/procedure.h"
#include "engine/app/study/subject_folder.h"

namespace catena::app {

/// One session of one subject.
class LiveSession {
 public:
  /// All arguments must outlive this object. `adjust`: as for SceneModel::open.
  LiveSession(const study::Study& study, SubjectFolder& folder, Procedure& procedure, std::function<Outcome(scene::Scene&)> adjust)
      : folder_(folder), procedure_(procedure), adjust_scene_(std::move(adjust)), live_trial_(study) {}
  ~LiveSession();  ///< Deletes the unfinished recording; stop the haptics first
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  const Procedure& procedure() const { return procedure_; }
  /// Returns the scene of the current or next trial if it is not yet open, parsed but with its data not loaded: the caller shows it, or
  /// prepares it behind a page. Empty: the scene that was returned last stays. The first call returns a scene if the study has trials.
  Result<std::optional<SceneModel>> next_scene();
  const LiveTrial& trial() const { return live_trial_; }
  /// Whether the cursor is at the start of the trial that is ready.
  bool is_at_start(const HapticSession& hand) const;
  /// Whether the trial is running but the cursor has to return to its start.
  bool is_returning_to_start() const { return procedure_.stage() == Procedure::Stage::running && returning_to_start_; }

  /// Handles a key press: begins a trial at once, and saves an answer to disk. Error: a file cannot be written.
  Outcome handle_key(const KeyPress& stroke, SceneModel& scene, HapticSession& hand);
  /// Processes the ticks since the last call; saves a trial that has ended to disk, or aborts one whose device was lost or ticks were
  /// dropped.
  Outcome update(SceneModel& scene, HapticSession& hand);

 private:
  SubjectFolder& folder_;
  Procedure& procedure_;
  std::function<Outcome(scene::Scene&)> adjust_scene_;
  LiveTrial live_trial_;
  std::optional<std::size_t> opened_trial_;  ///< Index of the trial whose scene is open
  std::string recording_path_;               ///< Path of the unfinished recording; empty: none
  bool returning_to_start_ = false;
};

}  // namespace catena::app
