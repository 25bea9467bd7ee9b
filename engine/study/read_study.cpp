// SPDX-License-Identifier: MIT
#include "engine/study/study_tables.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/base/text.h"
#include "engine/schema/renames.h"
#include "engine/schema/struct_schema.h"
#include "engine/study/analysis_plan.h"
#include "engine/study/study.h"
#include "engine/study/trial_scene.h"

namespace catena::study {

const char* to_string(TaskKind kind) { return kind == TaskKind::advection ? "advection" : "tracing"; }

namespace {

using schema::integer;

/// Reads "chain": one array for all tasks, or an object with one array for each task.
Outcome read_chains(const json::Node& object, const std::vector<Task>& tasks, Condition& condition) {
  const json::Node* chain = object.find("chain");
  if (chain == nullptr) return json::error_at(object, "key \"chain\" is missing; the links that are felt were expected, [] for none");
  std::vector<std::string_view> names;
  for (const Task& task : tasks) names.push_back(task.name);
  if (chain->kind == json::Kind::object) CATENA_CHECK(json::check_known_keys(*chain, names));
  for (const Task& task : tasks) {
    const json::Node* one = chain->kind == json::Kind::object ? chain->find(task.name) : chain;
    if (one == nullptr) return json::error_at(*chain, "\"chain\" has none for the task " + in_quotes(task.name) + "; one was expected");
    if (one->kind != json::Kind::array) return json::error_at(*one, "the chain is no array; an array of links was expected");
    CATENA_CHECK(check_placeholders(*one));
    condition.chains.push_back(*one);
  }
  return Done{};
}

schema::Keys condition_keys() {
  return {schema::identifier("name", "Name of the condition, in the tables.").required(),
          array_or_object("chain",
                          "Links that the subject feels (scene.md, `chain`): one array for all tasks, or an object with an array per task.")
              .required()};
}

schema::Keys question_keys() {
  return {schema::identifier("name", "Name of the question, in the table of answers.").required(),
          schema::text("question", "Text of the question.").required(),
          schema::texts("answers", "Choices, 2 to 9; the keys 1 to 9 select them.").with_default("any text")};
}

Outcome read_question(const json::Node& node, Question& question) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(question_keys())));
  CATENA_CHECK(schema::read_value(question_keys()[0], node, question.name));
  CATENA_CHECK(schema::read_value(question_keys()[1], node, question.question));
  const json::Node* answers = node.find("answers");
  if (answers == nullptr) return Done{};
  if (answers->kind != json::Kind::array || answers->items.size() < 2 || answers->items.size() > kMaxAnswers)
    return json::error_at(*answers, "\"answers\" is no list of 2 to " + std::to_string(kMaxAnswers) +
                                        "; so many strings to choose from were expected, a key each");
  for (const json::Node& answer : answers->items) {
    CATENA_TRY(std::string text, json::as_string(answer, "answers"));
    question.answers.push_back(std::move(text));
  }
  return Done{};
}

/// Checks a name: names appear in tables and in file names of plots.
Outcome check_name(const json::Node& item, const std::string& name) {
  constexpr std::size_t kMaxNameLength = 64;
  const auto is_forbidden = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == ',' || c == '"'; };
  if (!name.empty() && name.size() <= kMaxNameLength && std::ranges::none_of(name, is_forbidden)) return Done{};
  return json::error_at(json::member_or_parent(item, "name"),
                        "\"name\" is empty, longer than " + std::to_string(kMaxNameLength) +
                            " bytes, or has commas, quotes or line ends; a short name without them was expected");
}

/// Reads the objects of an array of at least `min_items` items; each has a unique name.
template <class T, class Read>
Outcome read_items(const json::Node& root, const char* key, std::size_t min_items, std::vector<T>& out, Read&& read) {
  const json::Node* list = root.find(key);
  if (list == nullptr && min_items == 0) return Done{};
  if (list == nullptr || list->kind != json::Kind::array || list->items.size() < min_items)
    return json::error_at(json::member_or_parent(root, key),
                          in_quotes(key) + " has fewer than " + std::to_string(min_items) + " items; an array of objects was expected");
  std::set<std::string> names;
  for (const json::Node& item : list->items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item, out.emplace_back()));
    CATENA_CHECK(check_name(item, out.back().name));
    if (!names.insert(out.back().name).second)
      return json::error_at(*item.find("name"),
                            "there are two of the name " + in_quotes(out.back().name) + "; different names were expected");
  }
  return Done{};
}

const StudyTable<Study>& study_table() {
  using T = Study;
  static const auto table = [] {
    StudyTable<T> t;
    t.bind(schema::text("name", "Name of the study, for titles.").required(), &T::name);
    t.bind(integer("seed", "", "Seed of all random choices.", 0, 1'000'000'000), &T::seed);
    t.bind(integer("subjects", "", "Number of subjects that the design is made for.", 1, 9999), &T::subjects);
    t.bind(integer("trials", "", "Number of stimuli per task; each is done once in every condition.", 1, 1000), &T::trials);
    t.bind(
        integer("training", "",
                "Number of training stimuli per task, each done once in every condition before the trials; they are not analysed.", 0, 100),
        &T::training);
    t.custom(schema::file("instructions", "Text file with the pages of instructions, relative to the study file.").with_default("none"),
             [](const NoContext&, const json::Node& root, T& study) -> Outcome {
               CATENA_TRY(study.instructions, json::get_string(root, "instructions", {}));
               if (study.instructions.empty() || std::filesystem::path(study.instructions).is_absolute()) return Done{};
               study.instructions = (std::filesystem::path(study.path).parent_path() / study.instructions).string();
               return Done{};
             });
    return t;
  }();
  return table;
}

}  // namespace

std::vector<schema::Section> study_components() {
  using Shape = schema::Section::Layout;
  std::vector<schema::Section> all{
      {"study", "Keys at the top of the file.", Shape::object, study_table().keys()},
      {"tasks", "Tasks: what is visible, and what the subject does.", Shape::list, task_table().keys()},
      {"conditions", "Haptic conditions. The first is the baseline of the comparisons.", Shape::list, condition_keys()},
      {"operator", "Model of a subject for `study simulate`.", Shape::object, human_model_table().keys()},
      {"questionnaire", "Questions at the end of a session.", Shape::list, question_keys()}};
  for (schema::Section& component : analysis_plan_components()) all.push_back(std::move(component));
  return all;
}

Result<Study> parse_study(std::string_view text, const std::string& path) {
  Study study;
  study.path = path;
  study.text = std::string(text);
  CATENA_TRY(study.document, json::parse(text, path));
  const json::Node& root = study.document;
  CATENA_CHECK(json::expect_object(root, "the study"));
  CATENA_CHECK(schema::check_names(root, schema::FileKind::study));
  std::vector<std::string_view> keys = schema::key_names(study_table().keys());
  for (const char* key : {"$schema", "tasks", "conditions", "operator", "questionnaire", "compare", "findings"}) keys.push_back(key);
  CATENA_CHECK(json::check_known_keys(root, keys));
  CATENA_CHECK(study_table().read_own_keys(kNoContext, root, study));
  CATENA_CHECK(read_items(root, "tasks", 1, study.tasks,
                          [](const json::Node& node, Task& task) { return task_table().read(kNoContext, node, task); }));
  const auto read_condition = [&](const json::Node& node, Condition& condition) -> Outcome {
    CATENA_CHECK(json::check_known_keys(node, schema::key_names(condition_keys())));
    CATENA_CHECK(schema::read_value(condition_keys()[0], node, condition.name));
    return read_chains(node, study.tasks, condition);
  };
  CATENA_CHECK(read_items(root, "conditions", 1, study.conditions, read_condition));
  if (const json::Node* model = root.find("operator")) {
    CATENA_CHECK(json::expect_object(*model, "operator"));
    CATENA_CHECK(human_model_table().read(kNoContext, *model, study.human_model));
  }
  CATENA_CHECK(read_items(root, "questionnaire", 0, study.questions, read_question));
  CATENA_CHECK(read_analysis_plan(study));  // errors in the analysis plan are reported before the first subject starts
  return study;
}

Result<Study> read_study(const std::string& path) {
  CATENA_TRY(const std::string text, read_text_file(path, "a study file (JSON)", kMaxJsonBytes));
  return parse_study(text, path);
}

}  // namespace catena::study
