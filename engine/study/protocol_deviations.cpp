// SPDX-License-Identifier: MIT
#include "engine/study/protocol_deviations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/base/text.h"

namespace catena::study {
namespace {

constexpr std::size_t kMaxListed = 3;  ///< maximum number of rows listed per subject

}  // namespace

std::string find_protocol_deviation(const Study& study, const TrialRow& row, const Trial& trial) {
  const std::string& task = study.tasks[static_cast<std::size_t>(trial.task)].name;
  const std::string& condition = study.conditions[static_cast<std::size_t>(trial.condition)].name;
  const auto differs = [](const char* what, const auto& is, const auto& designed) {
    return fmt::format("{} is {}, but {} by design", what, is, designed);
  };
  if (row.index != trial.index) return differs("index", row.index, trial.index);
  if (row.task != task) return differs("task", row.task, task);
  if (row.condition != condition) return differs("condition", row.condition, condition);
  if (row.stimulus != trial.stimulus) return differs("stimulus", row.stimulus, trial.stimulus);
  if (row.seed != trial.seed) return differs("seed", row.seed, trial.seed);
  if (row.block != trial.block) return differs("block", row.block, trial.block);
  if (row.training != trial.training) return differs("training", row.training ? 1 : 0, trial.training ? 1 : 0);
  return {};
}

std::vector<std::string> find_protocol_deviations(const Study& study, const std::vector<TrialRow>& rows) {
  std::map<int, std::vector<const TrialRow*>> subjects;
  for (const TrialRow& row : rows) subjects[row.subject].push_back(&row);
  std::vector<std::string> lines;
  for (const auto& [subject, subject_rows] : subjects) {
    if (subject < 1 || subject > kMaxSubject) {
      lines.push_back(fmt::format("subject {}: the subject number is invalid; 1 to {} was expected", subject, kMaxSubject));
      continue;
    }
    const std::vector<Trial> session = make_session(study, subject);
    const bool has_training = std::ranges::any_of(subject_rows, [](const TrialRow* row) { return row->training; });
    const auto counts = [&](const Trial& trial) { return has_training || !trial.training; };
    const auto designed = static_cast<std::size_t>(std::ranges::count_if(session, counts));
    if (subject_rows.size() != designed)
      lines.push_back(fmt::format("subject {}: {} of {} trials", subject, subject_rows.size(), designed));
    std::size_t others = 0;
    for (const TrialRow* row : subject_rows) {
      const bool exists = row->index >= 0 && row->index < static_cast<int>(session.size());
      const std::string what = exists ? find_protocol_deviation(study, *row, session[static_cast<std::size_t>(row->index)])
                                      : fmt::format("the trial does not exist in a session of {} trials", session.size());
      if (!what.empty() && ++others <= kMaxListed)
        lines.push_back(one_line(fmt::format("subject {}, trial {}: {}", subject, row->index, what)));
    }
    if (others > kMaxListed) lines.push_back(fmt::format("subject {}: {} more trials deviate", subject, others - kMaxListed));
  }
  return lines;
}

}  // namespace catena::study
