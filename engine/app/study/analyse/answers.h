// SPDX-License-Identifier: MIT
/// The subjects' answers to the study's questions: choices are counted, free text is listed.
#pragma once
#include <string>
#include <vector>

#include "engine/study/study.h"

namespace catena::app::analysis {

/// The answers of one subject.
struct SubjectAnswers {
  int subject = 1;
  std::vector<std::string> answers;  ///< To the study's first questions; an interrupted session has not answered the rest
};

/// Reads the answers of these subjects from a data folder; subjects without answers are omitted.
Result<std::vector<SubjectAnswers>> read_questionnaires(const study::Study& study, const std::string& folder,
                                                        const std::vector<int>& subjects);

/// CSV table "subject,question,answer".
std::string answers_csv(const study::Study& study, const std::vector<SubjectAnswers>& answers);
/// JSON list of objects with the same members.
std::string answers_json(const study::Study& study, const std::vector<SubjectAnswers>& answers);
/// HTML section; empty if nobody answered.
std::string answers_html(const study::Study& study, const std::vector<SubjectAnswers>& answers);

}  // namespace catena::app::analysis
