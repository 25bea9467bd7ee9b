// SPDX-License-Identifier: MIT
/// The table of finished trials, and the data folder that holds it:
///   DIR/study.json        the study file, verbatim; opening the folder with a different study is an error
///   DIR/subjects/007.csv  a subject's rows in the order of the session, after a header; each row is appended atomically and synced, and a
///                         partial last line is dropped on reading, so that a crash at any moment loses only the current trial
///   DIR/recordings/       recordings of every tick of a trial, if requested
///   DIR/trials.csv        the rows of all subjects, ordered by subject, as of the end of the last command; its rows are used only if
///                         subjects/ has none
///   DIR/questionnaire/    answers (questionnaire_answers.h)
///   DIR/simulated.json    exists if the human model did trials of this folder, so that every reader can tell
/// Doubles are written with the fewest digits that read back exactly.
#pragma once
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/folder_lock.h"
#include "engine/study/session.h"
#include "engine/study/trial_scorer.h"

namespace catena::study {

/// One finished trial, as a row of the table.
struct TrialRow {
  int subject = 1, index = 0, block = 0;  ///< As in Trial
  std::string task;                       ///< Name of the task
  std::string kind;                       ///< "advection" or "tracing"
  int dimensions = 2;                     ///< 2 or 3
  std::string condition;                  ///< Name of the condition
  int stimulus = 0, seed = 0;             ///< As in Trial
  bool training = false;                  ///< Excluded from the analysis
  bool reached_target = true;             ///< False: ended by the timeout
  double time_s = 0;                      ///< TrialResult::time_s. This and the next three are measured on the cursor, not on a proxy
  double error_mm = 0;                    ///< TrialResult::error_mm
  double traveled_mm = 0;                 ///< TrialResult::traveled_mm
  double peak_force_n = 0;                ///< TrialResult::peak_force_n
  Vec3 end_mm{0.0};                       ///< End position, world axes, device millimeters
  bool operator==(const TrialRow&) const = default;
};

/// Makes the row of a trial of this study's design (make_session()); the study gives the names of task and condition. Any thread.
CATENA_EXPORT TrialRow make_row(const Study& study, const Trial& trial, const TrialResult& measured);

/// The header row, with its line break: "subject,index,block,task,kind,dimensions,condition,stimulus,seed,training,ended,time_s,..."
CATENA_EXPORT std::string table_header();
CATENA_EXPORT std::string format_row(const TrialRow& row);  ///< One row, with its line break
/// The header, then all rows.
CATENA_EXPORT std::string format_table(const std::vector<TrialRow>& rows);
/// Parses a table with its header. `file`: name in error messages. `allow_partial_line`: a partial last line is ignored instead of an
/// error, and an empty text gives no rows. `complete_bytes`: receives the number of bytes of the complete lines. Error, "FILE:LINE: ...":
/// another header, or a bad value.
CATENA_EXPORT Result<std::vector<TrialRow>> parse_rows(std::string_view text, const std::string& file, bool allow_partial_line = false,
                                                       std::size_t* complete_bytes = nullptr);

/// Path of a subject's rows: "DIR/subjects/007.csv".
CATENA_EXPORT std::string subject_file(const std::string& folder, int subject);

/// Path of the recordings: "DIR/recordings".
CATENA_EXPORT std::string recordings_folder(const std::string& folder);
/// Creates the folder with its parent folders.
CATENA_EXPORT Outcome make_folder(const std::string& path);
/// Path of a trial's recording: "DIR/recordings/007-012.catlog", with the numbers of subject and trial index.
CATENA_EXPORT std::string recording_file(const std::string& folder, const Trial& trial);

/// Returns the numbers of the subjects that have a file in a data folder, ascending. `notes`: if not null, receives a line for every other
/// file in its subfolder "subjects".
CATENA_EXPORT Result<std::vector<int>> list_subjects(const std::string& folder, std::vector<std::string>* notes = nullptr);
/// Reads the finished trials of a subject, in the order of the session; none if the subject has no file. A partial last line is ignored and
/// reported in `notes`, if that is not null. Writes nothing. Error: names file and line.
CATENA_EXPORT Result<std::vector<TrialRow>> read_rows(const std::string& folder, int subject, std::vector<std::string>* notes = nullptr);

/// Participants of the trials of a data folder: people or the human model. A folder never holds trials of both.
enum class ParticipantKind { people, model };

/// A data folder opened for writing. It is locked for other programs during the lifetime of this object. One thread.
class CATENA_EXPORT DataFolder {
 public:
  /// Opens the folder, and creates it if it does not exist. Error: it holds another study, another program writes to it, or it holds trials
  /// of the human model while `participant_kind` is people, or the reverse.
  static Result<DataFolder> open(const std::string& path, const Study& study, ParticipantKind participant_kind);

  /// Path of the folder, as given to open().
  const std::string& path() const { return path_; }
  /// Reads a subject's rows as read_rows() does, and removes a partial last line from the file, so that rows can be appended.
  Result<std::vector<TrialRow>> rows(int subject) const;
  /// Appends a row to its subject's file and returns when it is synced to disk.
  Outcome append(const TrialRow& row) const;
  /// Replaces all rows of a subject, atomically.
  Outcome write_subject(int subject, const std::vector<TrialRow>& rows) const;
  /// Path of a temporary file for a trial's recording; commit_recording() renames it. Removes temporary files that ended programs left for
  /// this trial.
  std::string partial_recording_path(const Trial& trial) const;
  /// Renames the complete recording at `unfinished` to recordings/007-012.catlog and syncs the folder.
  Outcome commit_recording(const Trial& trial, const std::string& unfinished) const;
  /// Writes trials.csv with the rows of all subjects.
  Outcome write_table() const;

 private:
  DataFolder(std::string path, FolderLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}
  std::string path_;
  FolderLock lock_;
};

/// All rows of a data folder: those of DIR/subjects/*.csv, or of DIR/trials.csv if there are none.
struct TrialTable {
  std::vector<TrialRow> rows;  ///< Ordered by subject, then trial
  /// One line each: files that were not read, partial lines, and whether trials.csv differs from the rows
  std::vector<std::string> notes;
};
/// Reads all rows of a data folder. Error: names file and line; or the folder has neither trials.csv nor rows in subjects/.
CATENA_EXPORT Result<TrialTable> read_trial_table(const std::string& folder);

/// Returns whether the human model did the trials of this data folder.
CATENA_EXPORT bool is_simulated(const std::string& folder);

}  // namespace catena::study
