// SPDX-License-Identifier: MIT
#include "engine/app/study/subject_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/base/durable_append.h"
#include "engine/base/json_text.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/study/protocol_deviations.h"
#include "engine/study/questionnaire_answers.h"

namespace catena::app {

namespace {

Error cannot(const std::string& path, const char* what) { return system_error(path + ": cannot " + what, errno); }

}  // namespace

Result<SubjectFolder> SubjectFolder::open(const std::string& path, const study::Study& study, int subject) {
  CATENA_TRY(study::DataFolder folder, study::DataFolder::open(path, study, study::ParticipantKind::people));
  SubjectFolder result(study, subject, std::move(folder));
  CATENA_CHECK(study::make_folder(study::recordings_folder(path)));
  CATENA_CHECK(study::make_folder(std::filesystem::path(study::answers_file(path, subject)).parent_path()));
  result.trials_ = study::make_session(study, subject);
  CATENA_CHECK(result.find_finished_trials());
  CATENA_CHECK(result.find_answered_questions());
  return result;
}

Outcome SubjectFolder::find_finished_trials() {
  CATENA_TRY(const std::vector<study::TrialRow> rows, folder_.rows(subject_));
  const std::string path = study::subject_file(folder_.path(), subject_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool same = i < trials_.size() && study::find_protocol_deviation(*study_, rows[i], trials_[i]).empty();
    if (!same) return Error{fmt::format("{}:{}: the row is not trial {} of the subject's session", path, i + 2, i)};
  }
  finished_trials_ = rows.size();
  // remove the incomplete recording of an interrupted session
  if (finished_trials_ < trials_.size()) remove_stale_temporaries(study::recording_file(folder_.path(), trials_[finished_trials_]));
  return Done{};
}

Outcome SubjectFolder::find_answered_questions() {
  const std::string path = study::answers_file(folder_.path(), subject_);
  CATENA_TRY(const study::Answers answers, study::read_answers(path, *study_));
  if (answers.has_partial_line && ::truncate(path.c_str(), static_cast<off_t>(answers.complete_bytes)) != 0) return cannot(path, "write");
  answered_questions_ = answers.texts.size();
  return Done{};
}

Outcome SubjectFolder::save_trial(const study::Trial& trial, const study::TrialResult& measured, const std::string& unfinished) const {
  CATENA_CHECK(folder_.commit_recording(trial, unfinished));
  return folder_.append(study::make_row(*study_, trial, measured));
}

Outcome SubjectFolder::save_answer(const std::string& question, const std::string& answer) const {
  return append_durably(study::answers_file(folder_.path(), subject_), study::answers_header(), study::answer_row(question, answer));
}

std::string trial_metadata_json(const study::Study& study, const study::Trial& trial) {
  return fmt::format(
      R"({{"study": {}, "subject": {}, "trial": {}, "task": {}, "condition": {}, "stimulus": {}, "seed": {}, "training": {}}})",
      json_string(study.name), trial.subject, trial.index, json_string(study.tasks[static_cast<std::size_t>(trial.task)].name),
      json_string(study.conditions[static_cast<std::size_t>(trial.condition)].name), trial.stimulus, trial.seed, trial.training);
}

}  // namespace catena::app
