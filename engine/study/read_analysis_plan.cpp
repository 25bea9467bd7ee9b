// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>

#include "engine/base/text.h"
#include "engine/schema/struct_schema.h"
#include "engine/study/analysis_plan.h"

namespace catena::study {
namespace {

const std::vector<std::string> kTestNames{"difference",         "intervals", "tasks",      "correlation",
                                          "weaker_correlation", "largest",   "rejections", "untestable"};
const std::vector<std::string> kAlternativeNames{"by_test", "lower", "higher", "apart", "overlap", "negative", "positive"};

/// Keys that a test accepts beside "claim", "reported" and "test", and the alternatives for "alternative"; the first one is the default.
struct TestSchema {
  std::vector<std::string_view> keys;
  std::vector<Alternative> allowed_alternatives;
};

const TestSchema& schema_of(TestKind test_kind) {
  static const std::vector<TestSchema> forms{
      {{"measure", "of", "tasks", "conditions", "alternative"}, {Alternative::lower, Alternative::higher}},
      {{"measure", "tasks", "conditions", "alternative"}, {Alternative::apart, Alternative::overlap}},
      {{"measure", "tasks", "conditions", "alternative"}, {Alternative::lower, Alternative::higher}},
      {{"tasks", "conditions", "alternative"}, {Alternative::negative, Alternative::positive}},
      {{"tasks", "conditions"}, {}},
      {{"measure", "tasks", "conditions"}, {}},
      {{"rejected", "trials"}, {}},
      {{"reason"}, {}}};
  return forms[static_cast<std::size_t>(test_kind)];
}

template <class Items>
std::vector<std::string_view> names_in(const Items& items) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Reads a list of names as indices into `names`; returns all indices if the key is missing.
Result<std::vector<int>> read_names(const json::Node& object, std::string_view key, const std::vector<std::string_view>& names) {
  std::vector<int> found;
  const json::Node* list = object.find(key);
  if (list == nullptr) {
    found.resize(names.size());
    std::iota(found.begin(), found.end(), 0);
    return found;
  }
  if (list->kind != json::Kind::array || list->items.empty())
    return json::error_at(*list, in_quotes(key) + " is no list of names; some of " + join_words(names) + " were expected");
  for (const json::Node& item : list->items) {
    CATENA_TRY(const std::string name, json::as_string(item, key));
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      return json::error_at(
          item, in_quotes(name) + " in " + in_quotes(key) + suggestion(name, names) + "; " + join_alternatives(names) + " was expected");
    const int index = static_cast<int>(at - names.begin());
    if (std::count(found.begin(), found.end(), index) > 0)
      return json::error_at(item, in_quotes(name) + " stands twice in " + in_quotes(key) + "; different names were expected");
    found.push_back(index);
  }
  return found;
}

const schema::StructSchema<Finding, const Study>& finding_table() {
  using T = Finding;
  static const auto table =
      schema::StructSchema<T, const Study>()
          .bind(schema::text("claim", "Claim of the paper, a sentence.").required(), &T::claim)
          .bind(schema::text("reported", "Numbers of the claim, as the paper prints them.").with_default("none"), &T::reported)
          .bind(schema::choice("test", kTestNames, "Test that can support the claim; study.md describes each.").required(), &T::test)
          .bind(schema::choice("measure", {"error", "time"}, "Quantity that is compared."), &T::measure)
          .bind(schema::choice("of", {"mean", "deviation"},
                               "`difference` only: compares the subjects' means over their trials, or their standard deviations."),
                &T::uses_deviations)
          .custom(schema::texts("tasks", "Names of tasks: two for the test `tasks`, one for `largest`.").with_default("all"),
                  [](const Study& study, const json::Node& object, T& finding) -> Outcome {
                    CATENA_TRY(finding.tasks, read_names(object, "tasks", names_in(study.tasks)));
                    return Done{};
                  })
          .custom(schema::texts("conditions", "Names of conditions.").with_default("all; without the baseline in tests against it"),
                  [](const Study& study, const json::Node& object, T& finding) -> Outcome {
                    CATENA_TRY(finding.conditions, read_names(object, "conditions", names_in(study.conditions)));
                    return Done{};
                  })
          .bind(
              schema::choice("alternative", kAlternativeNames,
                             "Alternative hypothesis: `lower` or `higher` than the baseline or the second task; intervals that are `apart` "
                             "or `overlap`; a `negative` or `positive` correlation.")
                  .with_default("the first that the test accepts"),
              &T::alternative)
          .bind(schema::integer("rejected", "", "Number of trials that the paper rejected.", 0, 1'000'000'000), &T::rejected)
          .bind(schema::integer("trials", "", "Number of trials of the paper.", 0, 1'000'000'000), &T::trials)
          .bind(schema::text("reason", "Reason why these data cannot test the claim.").with_default("none"), &T::reason);
  return table;
}

/// Checks that a finding has only keys of its test, and all that the test needs.
Outcome check_finding(const Study& study, const std::vector<std::array<int, 2>>& pairs, Finding& f) {
  const TestSchema& form = schema_of(f.test);
  for (const auto& [key, node] : f.where.members) {
    const bool common = key == "claim" || key == "reported" || key == "test";
    if (!common && std::count(form.keys.begin(), form.keys.end(), key) == 0)
      return json::error_at(node, in_quotes(key) + " means nothing to the test \"" + to_string(f.test) + "\"; " +
                                      (form.keys.empty() ? "nothing" : join_alternatives(form.keys)) + " was expected");
  }
  if (f.alternative == Alternative::from_test && !form.allowed_alternatives.empty()) f.alternative = form.allowed_alternatives.front();
  if (f.alternative != Alternative::from_test &&
      std::count(form.allowed_alternatives.begin(), form.allowed_alternatives.end(), f.alternative) == 0) {
    std::vector<std::string_view> words;
    for (const Alternative e : form.allowed_alternatives) words.push_back(to_string(e));
    return json::error_at(*f.where.find("alternative"), "\"alternative\" is \"" + std::string(to_string(f.alternative)) + "\"; " +
                                                            join_alternatives(words) + " was expected");
  }
  const json::Node& tasks = json::member_or_parent(f.where, "tasks");
  if (f.test == TestKind::tasks && (f.tasks.size() != 2 || std::count(pairs.begin(), pairs.end(), std::array{f.tasks[0], f.tasks[1]}) == 0))
    return json::error_at(tasks, "\"tasks\" is no pair that \"compare\" has in this order; one was expected");
  if (f.test == TestKind::largest && (f.tasks.size() != 1 || study.tasks.size() < 2))
    return json::error_at(tasks, "\"tasks\" is not one of several tasks; the one with the largest gain was expected");
  if (f.test == TestKind::rejections && !(f.trials > 0 && f.rejected <= f.trials))
    return json::error_at(f.where, "\"rejected\" of \"trials\" is no share; at least one trial, and at most all rejected, was expected");
  if (f.test == TestKind::untestable && f.reason.empty())
    return json::error_at(f.where, "key \"reason\" is missing; the reason was expected");
  if (f.test != TestKind::tasks && f.test != TestKind::correlation) {
    if (f.where.find("conditions") != nullptr && std::count(f.conditions.begin(), f.conditions.end(), 0) > 0)
      return json::error_at(*f.where.find("conditions"),
                            "\"conditions\" names the first condition, with which the others are compared; "
                            "another one was expected");
    std::erase(f.conditions, 0);
  }
  return Done{};
}

Result<std::vector<json::Node>> list_at(const json::Node& root, std::string_view key, std::string_view expected) {
  const json::Node* list = root.find(key);
  if (list == nullptr) return std::vector<json::Node>{};
  if (list->kind != json::Kind::array)
    return json::error_at(*list, in_quotes(key) + " is no list; " + std::string(expected) + " were expected");
  return list->items;
}

schema::Keys pair_keys() {
  return {schema::texts("tasks", "Two tasks, compared in every condition and both measures: first - second.").required()};
}

}  // namespace

const char* to_string(TestKind test_kind) { return kTestNames[static_cast<std::size_t>(test_kind)].c_str(); }
const char* to_string(Alternative alternative) { return kAlternativeNames[static_cast<std::size_t>(alternative)].c_str(); }

Result<AnalysisPlan> read_analysis_plan(const Study& study) {
  AnalysisPlan plan;
  CATENA_TRY(const std::vector<json::Node> pairs, list_at(study.document, "compare", "objects with the names of two tasks"));
  for (const json::Node& item : pairs) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::check_known_keys(item, schema::key_names(pair_keys())));
    CATENA_TRY(const std::vector<int> tasks, read_names(item, "tasks", names_in(study.tasks)));
    if (tasks.size() != 2) return json::error_at(json::member_or_parent(item, "tasks"), "\"tasks\" names no two tasks; two were expected");
    plan.pairs.push_back({tasks[0], tasks[1]});
  }
  CATENA_TRY(const std::vector<json::Node> findings, list_at(study.document, "findings", "objects with a sentence and its test"));
  for (const json::Node& item : findings) {
    CATENA_CHECK(json::expect_object(item, item.label));
    Finding& finding = plan.findings.emplace_back();
    finding.where = item;
    CATENA_CHECK(finding_table().read(study, item, finding));
    CATENA_CHECK(check_finding(study, plan.pairs, finding));
  }
  return plan;
}

std::vector<schema::Section> analysis_plan_components() {
  using Shape = schema::Section::Layout;
  return {{"compare", "Pairs of tasks that are compared over the subjects.", Shape::list, pair_keys()},
          {"findings", "Claims of a paper, each with the test that can support it.", Shape::list, finding_table().keys()}};
}

}  // namespace catena::study
