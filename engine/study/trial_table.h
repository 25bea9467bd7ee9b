/// The rows of finished trials, and the folder that holds them:
///   DIR/study.json        the study file, verbatim: another one is refused
///   DIR/subjects/007.csv  a subject's rows in the order of the session, a header first; each is appended whole and synced, and a torn last
///                         line is dropped when the file is read, so that whatever ends the program costs the trial at hand alone
///   DIR/recordings/       every tick of a trial, where that was asked for
///   DIR/trials.csv        all subjects' rows by their numbers, as they were when a command last ended; alone it is read, too
///   DIR/questionnaire/    answers (answers.h)
///   DIR/simulated.json    there where a model of a person did trials: whoever reads them must know
/// Doubles in the fewest digits that read back.
#pragma once
#include <string>
#include <vector>

#include "engine/base/folder_lock.h"
#include "engine/study/session.h"
#include "engine/study/trial_scorer.h"

namespace catena::study {

/// One finished trial, as a row of the table.
struct TrialRow {
  int subject = 1, index = 0, block = 0;                               ///< as in Trial
  std::string task, kind;                                              ///< "advection", "tracing"
  int dimensions = 2;                                                  ///< 2 or 3
  std::string condition;                                               ///< its name
  int stimulus = 0, seed = 0;                                          ///< as in Trial
  bool training = false;                                               ///< not analysed
  bool reached_target = true;                                          ///< ended by its target; else by the limit
  double time_s = 0, error_mm = 0, traveled_mm = 0, peak_force_n = 0;  ///< as in TrialResult; of the cursor, not of a proxy
  Vec3 end_mm{0.0};                                                    ///< where it ended, world axes, millimetres of the hand
  bool operator==(const TrialRow&) const = default;
};

/// The row of a measured trial of this study's design (make_session()), which gives the names of its task and condition. Any thread.
TrialRow make_row(const Study& study, const Trial& trial, const TrialResult& measured);

/// "subject,index,block,task,kind,dimensions,condition,stimulus,seed,training,ended,time_s,..."
std::string table_header();
std::string format_row(const TrialRow& row);  ///< with its line end
/// All rows, a header first.
std::string format_table(const std::vector<TrialRow>& rows);
/// `torn_end`: a last line without its end is left out rather than an error; `whole` gets the bytes before it.
Result<std::vector<TrialRow>> parse_rows(std::string_view text, const std::string& file, bool torn_end = false,
                                         std::size_t* whole = nullptr);

/// "DIR/subjects/007.csv"
std::string subject_file(const std::string& folder, int subject);

/// "DIR/recordings".
std::string recordings_folder(const std::string& folder);
/// With those that it lies in.
Outcome make_folder(const std::string& path);
/// In it "007-012.catlog": subject and index.
std::string recording_file(const std::string& folder, const Trial& trial);

/// The numbers of the subjects that have a file in a data folder, rising; other files are told in `notes`.
Result<std::vector<int>> list_subjects(const std::string& folder, std::vector<std::string>* notes = nullptr);
/// The finished trials of a subject as they are on the disk, in the order of the session; none where the subject has no file. A torn last
/// line is left out and told in `notes`, where that is not null. Nothing is written. An error names file and line.
Result<std::vector<TrialRow>> read_rows(const std::string& folder, int subject, std::vector<std::string>* notes = nullptr);

/// Who does the trials of a data folder: people and models never share one.
enum class ParticipantKind { people, model };

/// A data folder that is written to, by one program at a time: it is locked as long as this lives.
class DataFolder {
 public:
  /// Makes it where it is missing. An error where it holds another study, another program writes to it, or it holds trials of a model
  /// where people's are to come, or people's where a model's are.
  static Result<DataFolder> open(const std::string& path, const Study& study, ParticipantKind who);

  /// The folder, as it was given.
  const std::string& path() const { return path_; }
  /// read_rows(), but a torn end is cut off the file, so that rows can be appended.
  Result<std::vector<TrialRow>> rows(int subject) const;
  /// Appends one and waits until it is on the disk.
  Outcome append(const TrialRow& row) const;
  /// All of a subject's rows at once, whole or not at all.
  Outcome write_subject(int subject, const std::vector<TrialRow>& rows) const;
  /// Where the recording of a trial is written until it is whole, under a name of its own; what ended programs left of it is gone.
  std::string partial_recording_path(const Trial& trial) const;
  /// It is whole, and gets its name: recordings/007-012.catlog, on the disk.
  Outcome commit_recording(const Trial& trial, const std::string& unfinished) const;
  /// Writes trials.csv of all of them.
  Outcome write_table() const;

 private:
  DataFolder(std::string path, FolderLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}
  std::string path_;
  FolderLock lock_;
};

/// The rows of a data folder: of DIR/subjects/*.csv, or of DIR/trials.csv where there are none of those.
struct TrialTable {
  std::vector<TrialRow> rows;      ///< in the order of subjects and trials
  std::vector<std::string> notes;  ///< lines: what of the folder was not taken, or torn, and that trials.csv differs from what was
};
/// Reads all rows of a folder. An error names file and line.
Result<TrialTable> read_trial_table(const std::string& folder);

/// Whether a model did the trials.
bool is_simulated(const std::string& folder);

}  // namespace catena::study
