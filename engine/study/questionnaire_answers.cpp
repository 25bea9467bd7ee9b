// SPDX-License-Identifier: MIT
#include "engine/study/questionnaire_answers.h"

#include <fmt/format.h>

#include <filesystem>

#include "engine/base/csv.h"
#include "engine/base/text.h"

namespace catena::study {
namespace {

/// Returns the text of a CSV cell, without quotes if it is quoted.
std::string words_of_cell(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && i + 2 < cell.size() && cell[i + 1] == '"') ++i;
  }
  return text;
}

}  // namespace

std::string answers_file(const std::string& folder, int subject) {
  return (std::filesystem::path(folder) / "questionnaire" / fmt::format("{:03}.csv", subject)).string();
}

std::string_view answers_header() { return "question,answer\n"; }

std::string answer_row(const std::string& question, const std::string& answer) {
  return quoted_csv_cell(one_line(question)) + "," + quoted_csv_cell(one_line(answer)) + "\n";
}

Result<Answers> read_answers(const std::string& path, const Study& study) {
  Answers answers;
  std::error_code code;
  if (!std::filesystem::exists(path, code)) return answers;
  CATENA_TRY(const std::string text, read_text_file(path, "a table of answers"));
  const auto end = text.rfind('\n');
  answers.complete_bytes = end == std::string::npos ? 0 : end + 1;
  answers.has_partial_line = answers.complete_bytes != text.size();
  std::string_view remaining = std::string_view(text).substr(0, answers.complete_bytes);
  if (remaining.empty()) return answers;
  if (!remaining.starts_with(answers_header())) return Error{path + ":1: the header is missing; \"question,answer\" was expected"};
  for (remaining.remove_prefix(answers_header().size()); !remaining.empty(); remaining.remove_prefix(remaining.find('\n') + 1)) {
    const std::size_t number = answers.texts.size();
    const std::string question =
        number < study.questions.size() ? quoted_csv_cell(one_line(study.questions[number].name)) + "," : std::string();
    if (question.empty() || !remaining.starts_with(question))
      return Error{fmt::format("{}:{}: the row is not an answer to question {} of the study", path, number + 2, number + 1)};
    answers.texts.push_back(words_of_cell(remaining.substr(question.size(), remaining.find('\n') - question.size())));
  }
  return answers;
}

}  // namespace catena::study
