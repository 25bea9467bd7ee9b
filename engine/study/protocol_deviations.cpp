// SPDX-License-Identifier: MIT
#include "engine/study/protocol_deviations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/base/text.h"

namespace catena::study {
namespace {

constexpr std::size_t kMostTold = 3;  ///< maximum number of rows listed per subject

}  // namespace

std::string find_protocol_deviation(const Study& study, const TrialRow& row, const Trial& trial) {
  const std::string& task = study.tasks[static_cast<std::size_t>(trial.task)].name;
  const std::string& condition = study.conditions[static_cast<std::size_t>(trial.condition)].name;
  const auto differs = [](const char* what, const auto& is, const auto& designed) {
    return fmt::format("{} is {}, by the design {}", what, is, designed);
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
  for (const auto& [subject, own] : subjects) {
    if (subject < 1 || subject > kMaxSubject) {
      lines.push_back(fmt::format("subject {}: no number of a subject; 1 to {} are", subject, kMaxSubject));
      continue;
    }
    const std::vector<Trial> session = make_session(study, subject);
    const bool trained = std::ranges::any_of(own, [](const TrialRow* row) { return row->training; });
    const auto counts = [&](const Trial& trial) { return trained || !trial.training; };
    const auto designed = static_cast<std::size_t>(std::ranges::count_if(session, counts));
    if (own.size() != designed) lines.push_back(fmt::format("subject {}: {} of {} trials", subject, own.size(), designed));
    std::size_t others = 0;
    for (const TrialRow* row : own) {
      const bool there = row->index >= 0 && row->index < static_cast<int>(session.size());
      const std::string what = there ? find_protocol_deviation(study, *row, session[static_cast<std::size_t>(row->index)])
                                     : fmt::format("there is no such trial in a session of {}", session.size());
      if (!what.empty() && ++others <= kMostTold)
        lines.push_back(one_line(fmt::format("subject {}, trial {}: {}", subject, row->index, what)));
    }
    if (others > kMostTold) lines.push_back(fmt::format("subject {}: so {} more trials", subject, others - kMostTold));
  }
  return lines;
}

}  // namespace catena::study
