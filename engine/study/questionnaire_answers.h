// SPDX-License-Identifier: MIT
/// The answers to a study's questionnaire: DIR/questionnaire/007.csv for subject 7, with a row `question,answer` for each answered
/// question, in the study's order; a question is identified by its name. Rows are appended atomically and synced to disk, as trial rows
/// are. Cells are in the format of RFC 4180, without line breaks in them.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/study/study.h"

namespace catena::study {

/// Path of the answers of `subject` in the data folder `folder`: "DIR/questionnaire/007.csv".
std::string answers_file(const std::string& folder, int subject);
std::string_view answers_header();  ///< The header row, with its line break
/// One row of the file, with its line break.
std::string answer_row(const std::string& question, const std::string& answer);

/// The answers in a subject's file.
struct Answers {
  std::vector<std::string> texts;  ///< Answers to the study's first questions, in order
  std::size_t complete_bytes = 0;  ///< Size of the file's part that holds complete lines
  bool has_partial_line = false;   ///< A partial last line follows them; it is not an answer
};

/// Reads the answers of a file; none if it does not exist. Error, "PATH:LINE: ...": the rows do not match the study's questions in their
/// order.
Result<Answers> read_answers(const std::string& path, const Study& study);

}  // namespace catena::study
