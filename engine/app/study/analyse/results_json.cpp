// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/app/study/analyse/analysis.h"
#include "engine/base/json_text.h"

namespace catena::app::analysis {
namespace {

/// Writes an object on one line, member by member.
class Members {
 public:
  Members& word(const char* key, const std::string& value) { return raw(key, json_string(value)); }
  Members& number(const char* key, double value) { return raw(key, json_number(value)); }
  Members& raw(const char* key, const std::string& json) {
    text_ += (text_.empty() ? "\"" : ", \"") + std::string(key) + "\": " + json;
    return *this;
  }
  std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

Members members_of(const Study& study, const TaskCondition& p) {
  return Members()
      .word("task", study.tasks[static_cast<std::size_t>(p.task)].name)
      .word("condition", study.conditions[static_cast<std::size_t>(p.condition)].name);
}

std::string numbers_list(const std::vector<int>& numbers) {
  return json_list(numbers, [](int n) { return std::to_string(n); });
}

std::string json_of(const statistics::Summary& s) {
  return Members().number("n", s.n).number("mean", s.mean).number("sd", s.sd).number("low", s.low()).number("high", s.high()).text();
}

std::string json_of(const Study& study, const PairedComparison& p) {
  Members m;
  m.word("measure", to_string(p.quantity))
      .raw("first", members_of(study, p.first).text())
      .raw("second", members_of(study, p.second).text());
  m.raw("left_out", numbers_list(p.excluded_subjects));
  if (!p.test) return m.word("why_not", p.skip_reason).text();
  const statistics::PairedTest& t = *p.test;
  m.raw("of_first", json_of(p.first_summary)).raw("of_second", json_of(p.second_summary));
  m.number("n", t.n).number("difference", t.difference).number("low", t.low).number("high", t.high).number("sd", t.sd);
  m.number("t", t.t).number("df", t.df).number("p", t.p).number("p_holm", p.corrected_p);
  m.number("d_z", t.effect).number("d_z_low", t.effect_low).number("d_z_high", t.effect_high);
  if (p.sign_flip_test) m.number("p_sign_flips", p.sign_flip_test->p).raw("sign_flips_exact", p.sign_flip_test->exact ? "true" : "false");
  return m.text();
}

std::string json_of(const Study& study, const ConditionMean& mean) {
  Members m = members_of(study, mean.task_condition);
  m.word("measure", to_string(mean.quantity));
  if (!mean.result) return m.word("why_not", mean.skip_reason).text();
  m.raw("of_subjects", json_of(*mean.result));
  if (mean.overlaps_baseline) m.raw("overlaps_baseline", *mean.overlaps_baseline ? "true" : "false");
  return m.text();
}

std::string json_of(const Study& study, const ConditionCorrelation& x) {
  Members m = members_of(study, x.task_condition);
  m.raw("left_out", numbers_list(x.excluded_subjects));
  if (!x.result) return m.word("why_not", x.skip_reason).text();
  m.number("n", x.result->n).number("r", x.result->r).number("low", x.result->low).number("high", x.result->high);
  return m.number("t", x.result->t).number("df", x.result->df).number("p", x.result->p).number("p_holm", x.corrected_p).text();
}

std::string json_of(const Study& study, const CorrelationChange& x) {
  Members m = members_of(study, x.task_condition);
  if (!x.result) return m.word("why_not", x.skip_reason).text();
  m.number("n", x.result->n).number("r_baseline", x.result->first).number("r", x.result->second);
  return m.number("z", x.result->z).number("p", x.result->p).number("p_holm", x.corrected_p).text();
}

/// Writes a list with one line per item.
template <class Items, class Print>
std::string lines(const Items& items, const Print& print) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "\n   " : ",\n   ") + print(item);
  return "[" + text + "]";
}

std::string json_of_finding(const study::Finding& f, const FindingResult& judged) {
  return Members()
      .word("paper", f.claim)
      .word("reported", f.reported)
      .word("test", study::to_string(f.test))
      .word("verdict", to_string(judged.verdict))
      .word("numbers", judged.text())
      .text();
}

}  // namespace

std::string to_json(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers) {
  std::string rejections, findings;
  for (int t = 0; t < static_cast<int>(analysis.task_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.condition_count); ++c) {
      const Rejections& r = analysis.rejections_in({t, c});
      Members m = members_of(study, {t, c});
      m.number("trials", r.trials).number("error", r.error).number("time", r.time).number("both", r.both);
      rejections += (rejections.empty() ? "\n   " : ",\n   ") + m.number("unfinished", r.unfinished).text();
    }
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i)
    findings += (findings.empty() ? "\n   " : ",\n   ") + json_of_finding(inquiry.findings[i], analysis.findings[i]);
  const auto paired = [&](const PairedComparison& p) { return json_of(study, p); };
  const auto plain = [&](const auto& item) { return json_of(study, item); };
  const Rejections all = analysis.total_rejections();
  std::string text = fmt::format("{{\"catena_study_analysis\": 1,\n \"study\": {}, \"simulated\": {}, \"alpha\": {}, \"confidence\": {},\n",
                                 json_string(study.name), source.is_simulated, kAlpha, kConfidence);
  if (source.is_simulated) text += fmt::format(" \"note\": {},\n", json_string(kSimulatedDataNotice));
  text += fmt::format(" \"subjects\": {}, \"trials\": {}, \"rejected\": {}, \"training\": {},\n", numbers_list(analysis.subjects),
                      all.trials, all.total(), analysis.training_count);
  text += fmt::format(" \"gaps\": {},\n", json_list(analysis.missing_data, json_string));
  text += fmt::format(" \"notes\": {},\n", json_list(analysis.notes, json_string));
  const auto part = [&](const char* key, const std::string& json) { text += fmt::format(" \"{}\": {},\n", key, json); };
  part("findings", "[" + findings + "]");
  part("rejections", "[" + rejections + "]");
  part("answers", answers_json(study, answers));
  part("means", lines(analysis.means, plain));
  part("conditions", lines(analysis.condition_comparisons, paired));
  part("tasks", lines(analysis.task_comparisons, paired));
  part("correlations", lines(analysis.correlations, plain));
  part("changes", lines(analysis.correlation_changes, plain));
  return text + " \"trade\": " + lines(analysis.tradeoff_comparisons, paired) + "}\n";
}

}  // namespace catena::app::analysis
