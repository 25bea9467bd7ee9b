#include <algorithm>
#include <numeric>

#include "engine/base/text.h"
#include "engine/schema/table.h"
#include "engine/study/inquiry.h"

namespace catena::study {
namespace {

const std::vector<std::string> kAsks{"difference", "intervals", "tasks", "correlation", "weaker", "largest", "rejections", "none"};
const std::vector<std::string> kExpects{"by_test", "lower", "higher", "apart", "overlap", "negative", "positive"};

/// What a test takes beside "paper", "reported" and "test", and what may be expected of it, its default first.
struct TestForm {
  std::vector<std::string_view> keys;
  std::vector<Expect> expects;
};

const TestForm& form_of(Asks asks) {
  static const std::vector<TestForm> forms{{{"measure", "of", "tasks", "conditions", "expect"}, {Expect::lower, Expect::higher}},
                                           {{"measure", "tasks", "conditions", "expect"}, {Expect::apart, Expect::overlap}},
                                           {{"measure", "tasks", "conditions", "expect"}, {Expect::lower, Expect::higher}},
                                           {{"tasks", "conditions", "expect"}, {Expect::negative, Expect::positive}},
                                           {{"tasks", "conditions"}, {}},
                                           {{"measure", "tasks", "conditions"}, {}},
                                           {{"rejected", "trials"}, {}},
                                           {{"why"}, {}}};
  return forms[static_cast<std::size_t>(asks)];
}

template <class Items>
std::vector<std::string_view> names_in(const Items& items) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Names of a list as indices; all where the key is missing.
Result<std::vector<int>> read_names(const json::Node& object, std::string_view key, const std::vector<std::string_view>& names) {
  std::vector<int> found;
  const json::Node* list = object.find(key);
  if (list == nullptr) {
    found.resize(names.size());
    std::iota(found.begin(), found.end(), 0);
    return found;
  }
  if (list->kind != json::Kind::array || list->items.empty())
    return json::error_at(*list, in_quotes(key) + " is no list of names; some of " + joined(names) + " were expected");
  for (const json::Node& item : list->items) {
    CATENA_TRY(const std::string name, json::as_string(item, key));
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      return json::error_at(
          item, in_quotes(name) + " in " + in_quotes(key) + suggestion(name, names) + "; " + alternatives(names) + " was expected");
    const int index = static_cast<int>(at - names.begin());
    if (std::count(found.begin(), found.end(), index) > 0)
      return json::error_at(item, in_quotes(name) + " stands twice in " + in_quotes(key) + "; different names were expected");
    found.push_back(index);
  }
  return found;
}

const schema::Table<Finding, const Study>& finding_table() {
  using T = Finding;
  static const auto table =
      schema::Table<T, const Study>()
          .bind(schema::text("paper", "The sentence.").required(), &T::paper)
          .bind(schema::text("reported", "Its numbers, as the paper prints them.").by_default("none"), &T::reported)
          .bind(schema::word("test", kAsks, "What would bear it out; the kinds are described in study.md.").required(), &T::asks)
          .bind(schema::word("measure", {"error", "time"}, "What is compared."), &T::measure)
          .bind(schema::word("of", {"mean", "deviation"},
                             "Of a subject's trials: their mean, or their standard deviation. `difference` only."),
                &T::of_deviations)
          .hand(schema::texts("tasks", "Names of tasks; of `tasks` two, of `largest` one.").by_default("all"),
                [](const Study& study, const json::Node& object, T& finding) -> Outcome {
                  CATENA_TRY(finding.tasks, read_names(object, "tasks", names_in(study.tasks)));
                  return Done{};
                })
          .hand(schema::texts("conditions", "Names of conditions.").by_default("all; without the first where that is compared with"),
                [](const Study& study, const json::Node& object, T& finding) -> Outcome {
                  CATENA_TRY(finding.conditions, read_names(object, "conditions", names_in(study.conditions)));
                  return Done{};
                })
          .bind(schema::word("expect", kExpects,
                             "`lower` or `higher` than the baseline, or than the second task; intervals `apart` or that `overlap`; a "
                             "`negative` or `positive` correlation.")
                    .by_default("the first of these that the test knows"),
                &T::expect)
          .bind(schema::integer("rejected", "", "Trials that the paper left out.", 0, 1'000'000'000), &T::rejected)
          .bind(schema::integer("trials", "", "Of so many.", 0, 1'000'000'000), &T::trials)
          .bind(schema::text("why", "Why these data cannot say.").by_default("none"), &T::why);
  return table;
}

/// Only keys of its test, and what that needs.
Outcome check_finding(const Study& study, const std::vector<std::array<int, 2>>& pairs, Finding& f) {
  const TestForm& form = form_of(f.asks);
  for (const auto& [key, node] : f.where.members) {
    const bool common = key == "paper" || key == "reported" || key == "test";
    if (!common && std::count(form.keys.begin(), form.keys.end(), key) == 0)
      return json::error_at(node, in_quotes(key) + " means nothing to the test \"" + asks_word(f.asks) + "\"; " +
                                      (form.keys.empty() ? "nothing" : alternatives(form.keys)) + " was expected");
  }
  if (f.expect == Expect::by_test && !form.expects.empty()) f.expect = form.expects.front();
  if (f.expect != Expect::by_test && std::count(form.expects.begin(), form.expects.end(), f.expect) == 0) {
    std::vector<std::string_view> words;
    for (const Expect e : form.expects) words.push_back(expect_word(e));
    return json::error_at(*f.where.find("expect"),
                          "\"expect\" is \"" + std::string(expect_word(f.expect)) + "\"; " + alternatives(words) + " was expected");
  }
  const json::Node& tasks = json::member_or(f.where, "tasks");
  if (f.asks == Asks::tasks && (f.tasks.size() != 2 || std::count(pairs.begin(), pairs.end(), std::array{f.tasks[0], f.tasks[1]}) == 0))
    return json::error_at(tasks, "\"tasks\" is no pair that \"compare\" has in this order; one was expected");
  if (f.asks == Asks::largest && (f.tasks.size() != 1 || study.tasks.size() < 2))
    return json::error_at(tasks, "\"tasks\" is not one of several tasks; the one with the largest gain was expected");
  if (f.asks == Asks::rejections && !(f.trials > 0 && f.rejected <= f.trials))
    return json::error_at(f.where, "\"rejected\" of \"trials\" is no share; at least one trial, and at most all rejected, was expected");
  if (f.asks == Asks::none && f.why.empty()) return json::error_at(f.where, "key \"why\" is missing; the reason was expected");
  if (f.asks != Asks::tasks && f.asks != Asks::correlation) {
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

schema::Keys pair_keys() { return {schema::texts("tasks", "The two, in every condition and both measures: first - second.").required()}; }

}  // namespace

const char* asks_word(Asks asks) { return kAsks[static_cast<std::size_t>(asks)].c_str(); }
const char* expect_word(Expect expect) { return kExpects[static_cast<std::size_t>(expect)].c_str(); }

Result<Inquiry> read_inquiry(const Study& study) {
  Inquiry inquiry;
  CATENA_TRY(const std::vector<json::Node> pairs, list_at(study.document, "compare", "objects with the names of two tasks"));
  for (const json::Node& item : pairs) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, schema::names_of(pair_keys())));
    CATENA_TRY(const std::vector<int> tasks, read_names(item, "tasks", names_in(study.tasks)));
    if (tasks.size() != 2) return json::error_at(json::member_or(item, "tasks"), "\"tasks\" names no two tasks; two were expected");
    inquiry.pairs.push_back({tasks[0], tasks[1]});
  }
  CATENA_TRY(const std::vector<json::Node> findings, list_at(study.document, "findings", "objects with a sentence and its test"));
  for (const json::Node& item : findings) {
    CATENA_CHECK(json::expect_object(item, item.label));
    Finding& finding = inquiry.findings.emplace_back();
    finding.where = item;
    CATENA_CHECK(finding_table().read(study, item, finding));
    CATENA_CHECK(check_finding(study, inquiry.pairs, finding));
  }
  return inquiry;
}

std::vector<schema::Component> inquiry_components() {
  using Shape = schema::Component::Shape;
  return {{"compare", "Pairs of tasks that are compared over the subjects.", Shape::list, pair_keys()},
          {"findings", "What a paper found, each with the test that would bear it out.", Shape::list, finding_table().keys()}};
}

}  // namespace catena::study
