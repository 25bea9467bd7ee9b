// SPDX-License-Identifier: MIT
/// SubjectFolder stores what a session of one subject writes to disk, and reads what an earlier session, interrupted at any moment, has
/// left:
///   DIR/subjects/007.csv               the finished trials (engine/study/trial_table.h)
///   DIR/recordings/007-012.catlog      every tick of trial 12; complete or absent
///   DIR/questionnaire/007.csv          the answers (engine/study/questionnaire_answers.h)
/// A recording gets its final name before its trial's row is written, so that every row has its recording. Subjects are identified by
/// numbers, never by names. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/study/trial_table.h"

namespace catena::app {

/// The data of one subject, in a locked data folder.
class SubjectFolder {
 public:
  /// Opens the folder and creates what is missing. Error: the folder holds another study, is used by another process, or holds rows or
  /// answers that are not those of this subject's session.
  static Result<SubjectFolder> open(const std::string& path, const study::Study& study, int subject);

  /// The subject's session.
  const std::vector<study::Trial>& trials() const { return trials_; }
  std::size_t finished_trials() const { return finished_trials_; }        ///< Number of finished trials when the folder was opened
  std::size_t answered_questions() const { return answered_questions_; }  ///< Number of answered questions when the folder was opened

  /// Path of a temporary file for the recording of a trial; save_trial() renames it.
  std::string unfinished_recording(const study::Trial& trial) const { return folder_.partial_recording_path(trial); }
  /// Saves a finished trial: renames the recording at `unfinished` and appends the row, synced to disk.
  Outcome save_trial(const study::Trial& trial, const study::TrialResult& measured, const std::string& unfinished) const;
  /// Appends an answer, synced to disk.
  Outcome save_answer(const std::string& question, const std::string& answer) const;
  /// Writes trials.csv with all rows of the folder, including this session's.
  Outcome write_table() const { return folder_.write_table(); }

 private:
  SubjectFolder(const study::Study& study, int subject, study::DataFolder folder)
      : study_(&study), subject_(subject), folder_(std::move(folder)) {}
  Outcome find_finished_trials();
  Outcome find_answered_questions();

  const study::Study* study_;
  int subject_;
  study::DataFolder folder_;
  std::vector<study::Trial> trials_;
  std::size_t finished_trials_ = 0, answered_questions_ = 0;
};

/// Metadata of a recording as JSON on one line: {"study": "...", "subject": 7, "trial": 12, "task": "...", "condition": "...", "stimulus":
/// 4, "seed": 99, "training": false}.
std::string trial_metadata_json(const study::Study& study, const study::Trial& trial);

}  // namespace catena::app
