// SPDX-License-Identifier: MIT
#include "engine/app/study/analyse/answers.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/tuning/report/html_page.h"
#include "engine/app/tuning/report/results_dir.h"
#include "engine/base/json_text.h"
#include "engine/study/questionnaire_answers.h"

namespace catena::app::analysis {
namespace {

/// Calls `add(subject, name of the question, answer)` for each answer that was given.
template <class Add>
void for_each_answer(const study::Study& study, const std::vector<SubjectAnswers>& answers, const Add& add) {
  for (const SubjectAnswers& a : answers)
    for (std::size_t q = 0; q < a.answers.size(); ++q) add(a.subject, study.questions[q].name, a.answers[q]);
}

std::string counts_table(const study::Question& question, std::size_t number, const std::vector<SubjectAnswers>& answers) {
  std::string text = "<div class=\"wide\"><table><tr><th>answer</th><th class=\"n\">subjects</th></tr>\n";
  for (const std::string& offered : question.answers) {
    const auto count =
        std::ranges::count_if(answers, [&](const SubjectAnswers& a) { return number < a.answers.size() && a.answers[number] == offered; });
    text += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", escape_html(offered), count);
  }
  return text + "</table></div>\n";
}

std::string texts_list(std::size_t number, const std::vector<SubjectAnswers>& answers) {
  std::string text = "<ul>\n";
  for (const SubjectAnswers& a : answers)
    if (number < a.answers.size() && !a.answers[number].empty())
      text += fmt::format("<li>subject {}: {}</li>\n", a.subject, escape_html(a.answers[number]));
  return text + "</ul>\n";
}

}  // namespace

Result<std::vector<SubjectAnswers>> read_questionnaires(const study::Study& study, const std::string& folder,
                                                        const std::vector<int>& subjects) {
  std::vector<SubjectAnswers> all;
  for (const int subject : subjects) {
    CATENA_TRY(study::Answers answers, study::read_answers(study::answers_file(folder, subject), study));
    if (!answers.texts.empty()) all.push_back({subject, std::move(answers.texts)});
  }
  return all;
}

std::string answers_csv(const study::Study& study, const std::vector<SubjectAnswers>& answers) {
  CsvTable table("subject,question,answer");
  for_each_answer(study, answers, [&](int subject, const std::string& question, const std::string& answer) {
    table.add(subject).add(csv_text(question)).add(csv_text(answer));
    table.end_row();
  });
  return table.text();
}

std::string answers_json(const study::Study& study, const std::vector<SubjectAnswers>& answers) {
  std::string list;
  for_each_answer(study, answers, [&](int subject, const std::string& question, const std::string& answer) {
    list += fmt::format("{}\n   {{\"subject\": {}, \"question\": {}, \"answer\": {}}}", list.empty() ? "" : ",", subject,
                        json_string(question), json_string(answer));
  });
  return "[" + list + "]";
}

std::string answers_html(const study::Study& study, const std::vector<SubjectAnswers>& answers) {
  if (answers.empty()) return {};
  std::string text = "<h2>Questionnaire</h2>\n";
  for (std::size_t q = 0; q < study.questions.size(); ++q) {
    const study::Question& question = study.questions[q];
    text += "<p>" + escape_html(question.question) + "</p>\n" +
            (question.answers.empty() ? texts_list(q, answers) : counts_table(question, q, answers));
  }
  return text + "<p class=\"note\">As a table: <code>answers.csv</code></p>\n";
}

}  // namespace catena::app::analysis
