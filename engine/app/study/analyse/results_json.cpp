#include <fmt/format.h>

#include "engine/app/study/analyse/analysis.h"
#include "engine/base/json_text.h"

namespace catena::app::analysis {
namespace {

/// An object, member by member, on one line.
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

Members members_of(const Study& study, const Place& p) {
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

std::string json_of(const Study& study, const Paired& p) {
  Members m;
  m.word("measure", quantity_word(p.quantity))
      .raw("first", members_of(study, p.first).text())
      .raw("second", members_of(study, p.second).text());
  m.raw("left_out", numbers_list(p.left_out));
  if (!p.test) return m.word("why_not", p.why_not).text();
  const statistics::PairedTest& t = *p.test;
  m.raw("of_first", json_of(p.of_first)).raw("of_second", json_of(p.of_second));
  m.number("n", t.n).number("difference", t.difference).number("low", t.low).number("high", t.high).number("sd", t.sd);
  m.number("t", t.t).number("df", t.df).number("p", t.p).number("p_holm", p.corrected);
  m.number("d_z", t.effect).number("d_z_low", t.effect_low).number("d_z_high", t.effect_high);
  if (p.flips) m.number("p_sign_flips", p.flips->p).raw("sign_flips_exact", p.flips->exact ? "true" : "false");
  return m.text();
}

std::string json_of(const Study& study, const Mean& mean) {
  Members m = members_of(study, mean.place);
  m.word("measure", quantity_word(mean.quantity));
  if (!mean.of) return m.word("why_not", mean.why_not).text();
  m.raw("of_subjects", json_of(*mean.of));
  if (mean.overlaps) m.raw("overlaps_baseline", *mean.overlaps ? "true" : "false");
  return m.text();
}

std::string json_of(const Study& study, const Correlated& x) {
  Members m = members_of(study, x.place);
  m.raw("left_out", numbers_list(x.left_out));
  if (!x.of) return m.word("why_not", x.why_not).text();
  m.number("n", x.of->n).number("r", x.of->r).number("low", x.of->low).number("high", x.of->high);
  return m.number("t", x.of->t).number("df", x.of->df).number("p", x.of->p).number("p_holm", x.corrected).text();
}

std::string json_of(const Study& study, const Change& x) {
  Members m = members_of(study, x.place);
  if (!x.of) return m.word("why_not", x.why_not).text();
  m.number("n", x.of->n).number("r_baseline", x.of->first).number("r", x.of->second);
  return m.number("z", x.of->z).number("p", x.of->p).number("p_holm", x.corrected).text();
}

/// A list with a line an item.
template <class Items, class Print>
std::string lines(const Items& items, const Print& print) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "\n   " : ",\n   ") + print(item);
  return "[" + text + "]";
}

std::string json_of_finding(const study::Finding& f, const Judged& judged) {
  return Members()
      .word("paper", f.paper)
      .word("reported", f.reported)
      .word("test", study::asks_word(f.asks))
      .word("verdict", verdict_word(judged.verdict))
      .word("numbers", judged.text())
      .text();
}

}  // namespace

std::string to_json(const Study& study, const study::Inquiry& inquiry, const Analysis& analysis, const Source& source,
                    const std::vector<Answered>& answers) {
  std::string rejections, findings;
  for (int t = 0; t < static_cast<int>(analysis.tasks_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.conditions_count); ++c) {
      const Rejections& r = analysis.rejected({t, c});
      Members m = members_of(study, {t, c});
      m.number("trials", r.trials).number("error", r.error).number("time", r.time).number("both", r.both);
      rejections += (rejections.empty() ? "\n   " : ",\n   ") + m.number("unfinished", r.unfinished).text();
    }
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i)
    findings += (findings.empty() ? "\n   " : ",\n   ") + json_of_finding(inquiry.findings[i], analysis.findings[i]);
  const auto paired = [&](const Paired& p) { return json_of(study, p); };
  const auto plain = [&](const auto& item) { return json_of(study, item); };
  const Rejections all = analysis.all_rejected();
  std::string text = fmt::format("{{\"catena_study_analysis\": 1,\n \"study\": {}, \"simulated\": {}, \"alpha\": {}, \"confidence\": {},\n",
                                 json_string(study.name), source.simulated, kAlpha, kConfidence);
  if (source.simulated) text += fmt::format(" \"note\": {},\n", json_string(kModelSentence));
  text += fmt::format(" \"subjects\": {}, \"trials\": {}, \"rejected\": {}, \"training\": {},\n", numbers_list(analysis.subjects),
                      all.trials, all.rejected(), analysis.training);
  text += fmt::format(" \"gaps\": {},\n", json_list(analysis.gaps, json_string));
  text += fmt::format(" \"notes\": {},\n", json_list(analysis.notes, json_string));
  const auto part = [&](const char* key, const std::string& json) { text += fmt::format(" \"{}\": {},\n", key, json); };
  part("findings", "[" + findings + "]");
  part("rejections", "[" + rejections + "]");
  part("answers", answers_json(study, answers));
  part("means", lines(analysis.means, plain));
  part("conditions", lines(analysis.conditions, paired));
  part("tasks", lines(analysis.tasks, paired));
  part("correlations", lines(analysis.correlations, plain));
  part("changes", lines(analysis.changes, plain));
  return text + " \"trade\": " + lines(analysis.trade, paired) + "}\n";
}

}  // namespace catena::app::analysis
