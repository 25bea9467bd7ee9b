/// The answers to a study's questionnaire: DIR/questionnaire/007.csv, a row `question,answer` for each question that was answered, in the
/// study's order, the question by its name. Rows are appended whole and synced, as those of trials; cells as RFC 4180 has them, with no
/// line ends within.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/study/study.h"

namespace catena::study {

std::string answers_file(const std::string& folder, int subject);
std::string_view answers_header();  ///< with its line end
std::string answer_row(const std::string& question, const std::string& answer);

struct Answers {
  std::vector<std::string> texts;  ///< to the study's first questions
  std::size_t complete_bytes = 0;  ///< of the file that hold them
  bool has_partial_line = false;   ///< a last line without its end stands behind those: no answer
};

/// None where the file is missing. Errors: "PATH:LINE: ...", where it does not answer the study's questions in their order.
Result<Answers> read_answers(const std::string& path, const Study& study);

}  // namespace catena::study
