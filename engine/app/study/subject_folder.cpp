#include "engine/app/study/subject_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/base/append_file.h"
#include "engine/base/json_text.h"
#include "engine/base/output_file.h"

namespace catena::app {

namespace {

constexpr std::string_view kAnswersHeader = "question,answer\n";

Error cannot(const std::string& path, const char* what) { return Error{path + ": cannot " + what + ": " + std::strerror(errno)}; }

/// A cell of a table by RFC 4180, without line ends.
std::string cell(std::string text) {
  text = one_line(std::move(text));
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// The name of a folder is on the disk when the folder is.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace

// ---- the lock ----

Result<FolderLock> FolderLock::take(const std::string& folder) {
  const std::string path = folder + "/.lock";
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return cannot(path, "write");
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return FolderLock(descriptor);
  ::close(descriptor);
  return Error{folder + ": another session writes to it; its end was expected, or another folder"};
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

// ---- the folder ----

Result<SubjectFolder> SubjectFolder::open(const std::string& path, const study::Study& study, int subject) {
  CATENA_TRY(study::DataFolder folder, study::DataFolder::open(path, study));
  CATENA_TRY(FolderLock lock, FolderLock::take(path));
  SubjectFolder result(study, subject, std::move(folder), std::move(lock));
  CATENA_CHECK(study::make_folder(study::recordings_folder(path)));
  CATENA_CHECK(study::make_folder(std::filesystem::path(result.answers_file()).parent_path()));
  result.trials_ = study::session_of(study, subject);
  CATENA_CHECK(result.look_for_trials());
  CATENA_CHECK(result.look_for_answers());
  return result;
}

std::string SubjectFolder::answers_file() const { return fmt::format("{}/questionnaire/{:03}.csv", folder_.path(), subject_); }

std::string SubjectFolder::recording(const study::Trial& trial) const {
  return study::recordings_folder(folder_.path()) + "/" + study::recording_name(trial);
}

std::string SubjectFolder::unfinished_recording(const study::Trial& trial) const {
  const std::string place = recording(trial);
  remove_stale_parts(place);
  return part_name(place);
}

Outcome SubjectFolder::look_for_trials() {
  CATENA_TRY(const std::vector<study::Row> rows, folder_.rows(subject_));
  const std::string path = study::subject_file(folder_.path(), subject_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const study::Row& row = rows[i];
    const bool same = i < trials_.size() && row.index == trials_[i].index && row.stimulus == trials_[i].stimulus &&
                      row.task == study_->tasks[static_cast<std::size_t>(trials_[i].task)].name &&
                      row.condition == study_->conditions[static_cast<std::size_t>(trials_[i].condition)].name;
    if (!same) return Error{fmt::format("{}:{}: this is not trial {} of the subject's session", path, i + 2, i)};
  }
  finished_ = rows.size();
  // what was being recorded when a session was cut off
  if (finished_ < trials_.size()) remove_stale_parts(recording(trials_[finished_]));
  return Done{};
}

Outcome SubjectFolder::look_for_answers() {
  const std::string path = answers_file();
  std::error_code code;
  if (!std::filesystem::exists(path, code)) return Done{};
  CATENA_TRY(const std::string text, read_text(path, "a table of answers"));
  const auto end = text.rfind('\n');
  const std::string_view whole = std::string_view(text).substr(0, end == std::string::npos ? 0 : end + 1);
  if (whole.size() != text.size() && ::truncate(path.c_str(), static_cast<off_t>(whole.size())) != 0) return cannot(path, "write");
  if (whole.empty()) return Done{};
  if (!whole.starts_with(kAnswersHeader)) return Error{path + ":1: \"question,answer\" was expected"};
  std::string_view rest = whole.substr(kAnswersHeader.size());
  for (; !rest.empty(); rest.remove_prefix(rest.find('\n') + 1)) {
    if (answered_ == study_->questions.size() || !rest.starts_with(cell(study_->questions[answered_].name) + ","))
      return Error{fmt::format("{}:{}: this is not the answer to question {} of the study", path, answered_ + 2, answered_ + 1)};
    ++answered_;
  }
  return Done{};
}

Outcome SubjectFolder::keep(const study::Trial& trial, const study::Measured& measured, const std::string& unfinished) const {
  const std::string place = recording(trial);
  if (std::rename(unfinished.c_str(), place.c_str()) != 0) return cannot(place, "write");
  sync_folder(study::recordings_folder(folder_.path()));
  return folder_.append(study::row_of(*study_, trial, measured));
}

Outcome SubjectFolder::keep_answer(const std::string& question, const std::string& answer) const {
  return append_whole(answers_file(), kAnswersHeader, cell(question) + "," + cell(answer) + "\n");
}

std::string about_trial(const study::Study& study, const study::Trial& trial) {
  return fmt::format(
      R"({{"study": {}, "subject": {}, "trial": {}, "task": {}, "condition": {}, "stimulus": {}, "seed": {}, "training": {}}})",
      json_string(study.name), trial.subject, trial.index, json_string(study.tasks[static_cast<std::size_t>(trial.task)].name),
      json_string(study.conditions[static_cast<std::size_t>(trial.condition)].name), trial.stimulus, trial.seed, trial.training);
}

}  // namespace catena::app
