/// SubjectFolder is what a session of one subject leaves on the disk, and what an earlier one that was cut off at any moment has left:
///   DIR/subjects/007.csv               the finished trials (engine/study/trial_table.h)
///   DIR/recordings/007-012.catlog      every tick of trial 12: whole, or not there
///   DIR/questionnaire/007.csv          the answers (engine/study/questionnaire_answers.h)
/// A recording gets its name before its trial's row is written, so that every row has its recording. NumberArray stand for subjects, never
/// names. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/study/trial_table.h"

namespace catena::app {

class SubjectFolder {
 public:
  /// Makes what is missing. An error where another study is in the folder, another process, or another session of this subject.
  static Result<SubjectFolder> open(const std::string& path, const study::Study& study, int subject);

  const std::vector<study::Trial>& trials() const { return trials_; }
  std::size_t finished_trials() const { return finished_trials_; }        ///< of the trials, when it was opened
  std::size_t answered_questions() const { return answered_questions_; }  ///< of the questions

  /// Where the recording of a trial is written until it is whole.
  std::string unfinished_recording(const study::Trial& trial) const { return folder_.partial_recording_path(trial); }
  /// The trial is finished: the recording at `unfinished` gets its name, and the row is on the disk.
  Outcome save_trial(const study::Trial& trial, const study::TrialResult& measured, const std::string& unfinished) const;
  /// One more answer is on the disk.
  Outcome save_answer(const std::string& question, const std::string& answer) const;
  /// trials.csv has the folder's rows, those of this session too.
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

/// One line that says what is recorded, as JSON: {"study": "...", "subject": 7, "trial": 12, "task": "...", "condition": "...", "stimulus":
/// 4, "seed": 99, "training": false}
std::string trial_metadata_json(const study::Study& study, const study::Trial& trial);

}  // namespace catena::app
