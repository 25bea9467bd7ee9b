// SPDX-License-Identifier: MIT
/// A study of two tasks with findings of all kinds, and generated tables of trials with a known difference or none.
#pragma once
#include <cmath>
#include <random>
#include <stdexcept>

#include "engine/app/study/analyse/analysis.h"

namespace study_tables {

using namespace catena;
using namespace catena::app::analysis;
using study::TrialRow;

/// Two tasks in two conditions, with findings of all kinds.
inline const std::string kStudy = R"({
  "name": "two tasks", "subjects": 20, "trials": 10, "training": 0,
  "tasks": [
    {"name": "trace", "kind": "tracing", "dimensions": 2, "field": "flow",
     "limits": {"reject_error_mm": 30, "reject_time_s": 12},
     "scene": {
       "fields": {"flow": {"analytic": "vortices", "dimensions": 2, "seed": "$seed"}},
       "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0]},
       "workspace": {"metres_per_unit": 0.05}}},
    {"name": "follow", "kind": "advection", "dimensions": 3, "field": "flow",
     "limits": {"reject_error_mm": 100, "reject_time_s": 15},
     "scene": {
       "fields": {"flow": {"analytic": "vortices", "dimensions": 3, "seed": "$seed"}},
       "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0]},
       "workspace": {"metres_per_unit": 0.05}}}],
  "conditions": [{"name": "free", "chain": []}, {"name": "held", "chain": []}],
  "questionnaire": [{"name": "hard", "question": "Was it <hard>?", "answers": ["no", "a bit", "yes"]},
                    {"name": "how", "question": "How was it?"}],
  "compare": [{"tasks": ["follow", "trace"]}],
  "findings": [
    {"claim": "held is more accurate", "test": "difference", "measure": "error", "tasks": ["trace"]},
    {"claim": "held is steadier", "test": "difference", "measure": "error", "of": "deviation", "tasks": ["trace"]},
    {"claim": "the times' intervals overlap", "test": "intervals", "measure": "time", "alternative": "overlap"},
    {"claim": "to follow is less accurate", "test": "tasks", "measure": "error", "tasks": ["follow", "trace"], "alternative": "higher"},
    {"claim": "haste costs accuracy", "test": "correlation", "tasks": ["trace"], "conditions": ["free"]},
    {"claim": "less so when held", "test": "weaker_correlation", "tasks": ["trace"]},
    {"claim": "the gain is largest when tracing", "test": "largest", "measure": "error", "tasks": ["trace"]},
    {"claim": "1 of 400 was rejected", "test": "rejections", "rejected": 1, "trials": 400},
    {"claim": "they liked it", "test": "untestable", "reason": "nobody was asked"}]
})";

struct StudyFixture {
  Study study = study::parse_study(kStudy, "two.json").value();
  study::AnalysisPlan inquiry = study::read_analysis_plan(study).value();
};
inline const StudyFixture& study_fixture() {
  static const StudyFixture m;
  return m;
}

/// The simulated effects on the error of `trace`, in units of the standard deviation of the differences of means.
struct EffectSpec {
  double effect = 0;  ///< d_z of free - held
  double haste = 0;   ///< dependence of the error on a subject's time in `free`; negative if haste costs accuracy
  int subjects = 20, trials = 10;
};

inline std::vector<TrialRow> make_trial_table(std::mt19937_64& random, const EffectSpec& planted) {
  std::normal_distribution<double> normal;
  constexpr double spread = 1, noise = 1;
  // The standard deviation of the differences of means over `trials`.
  const double deviation = std::sqrt(spread * spread + 2 * noise * noise / planted.trials);
  std::vector<TrialRow> rows;
  for (int subject = 1; subject <= planted.subjects; ++subject) {
    int index = 0;
    for (const char* task : {"trace", "follow"}) {
      const bool trace = std::string(task) == "trace";
      const double level = normal(random), pace = normal(random);
      const double gain = (trace ? planted.effect * deviation : 0) + spread * normal(random), later = 0.5 * normal(random);
      for (int condition = 0; condition < 2; ++condition)
        for (int k = 0; k < planted.trials; ++k) {
          const double haste = condition == 0 && trace ? planted.haste * pace : 0;
          TrialRow row{.subject = subject,
                       .index = index,
                       .block = trace ? 0 : 1,
                       .task = task,
                       .kind = trace ? "tracing" : "advection",
                       .dimensions = trace ? 2 : 3,
                       .condition = condition == 0 ? "free" : "held",
                       .stimulus = k,
                       .seed = k};
          row.error_mm = 14 + (trace ? 0 : 20) + level + haste - (condition == 1 ? gain : 0) + noise * normal(random);
          row.time_s = 6 + 0.8 * pace + (condition == 1 ? later : 0) + 0.3 * normal(random);
          rows.push_back(row);
          ++index;
        }
    }
  }
  return rows;
}

inline Analysis run_analysis(const std::vector<TrialRow>& rows) {
  return analyze(study_fixture().study, study_fixture().inquiry, rows, "data").value();
}

inline const PairedComparison& find_difference(const Analysis& a, Quantity q, int task) {
  for (const PairedComparison& p : a.condition_comparisons)
    if (p.quantity == q && p.first.task == task) return p;
  throw std::logic_error("no such test");
}

inline const FindingResult& find_finding(const Analysis& a, const std::string& paper) {
  for (std::size_t i = 0; i < a.findings.size(); ++i)
    if (study_fixture().inquiry.findings[i].claim == paper) return a.findings[i];
  throw std::logic_error(paper);
}

}  // namespace study_tables
