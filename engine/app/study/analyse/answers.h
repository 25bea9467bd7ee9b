/// What the subjects answered to the study's questions: counted where answers were offered, listed where any text was.
#pragma once
#include <string>
#include <vector>

#include "engine/study/study.h"

namespace catena::app::analysis {

struct SubjectAnswers {
  int subject = 1;
  std::vector<std::string> answers;  ///< to the study's first questions: who was cut off has not answered the rest
};

/// Of these subjects of a data folder; whoever answered nothing is not there.
Result<std::vector<SubjectAnswers>> read_questionnaires(const study::Study& study, const std::string& folder,
                                                        const std::vector<int>& subjects);

std::string answers_csv(const study::Study& study, const std::vector<SubjectAnswers>& answers);  ///< "subject,question,answer"
std::string answers_json(const study::Study& study,
                         const std::vector<SubjectAnswers>& answers);  ///< a list of objects with the same members
std::string answers_html(const study::Study& study, const std::vector<SubjectAnswers>& answers);  ///< a section; "" where nobody answered

}  // namespace catena::app::analysis
