/// What the trials of a study say: the paper's section 7.2 on any data folder. A pure function of the study, its inquiry and the rows; the
/// same input gives the same bits.
///
///   kept        trials within the study's limits that ended at their target; training is not looked at
///   a subject   in a task and condition: mean and standard deviation of error and time over its kept trials, and the trade: the slope of
///               log error on log time over them (three at least)
///   tests       paired over the subjects that have both values (engine/study/statistics): whoever lacks one is left out of that test, by
///   name families    p-values are corrected by Holm's method within one: conditions, tasks, trade, correlations, changes of correlations
/// Differences are first - second: the baseline less the other condition, so that a gain is positive.
#pragma once
#include <limits>
#include <optional>

#include "engine/app/study/analyse/answers.h"
#include "engine/study/analysis_plan.h"
#include "engine/study/statistics/correlation.h"
#include "engine/study/statistics/permutation.h"
#include "engine/study/statistics/summary.h"
#include "engine/study/trial_table.h"

namespace catena::app::analysis {

using study::Study;

inline constexpr double kAlpha = 0.05, kConfidence = 0.95;
inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

/// Of a subject in a task and a condition.
enum class Quantity { error, time, error_deviation, time_deviation, slope };
inline constexpr int kQuantities = 5;
const char* to_string(Quantity q);       ///< "error_deviation"
const char* quantity_label(Quantity q);  ///< "deviation of the error"
const char* quantity_unit(Quantity q);   ///< "mm", "s"; "" of slopes

struct Cell {
  int trials = 0, accepted = 0;
  std::array<double, kQuantities> values{kNotComputed, kNotComputed, kNotComputed, kNotComputed,
                                         kNotComputed};  ///< NaN: too few kept trials
};

/// Trials of a task in a condition, and why some were left out. One reason each.
struct Rejections {
  int trials = 0;
  int error = 0, time = 0, both = 0;  ///< beyond the study's limits
  int unfinished = 0;                 ///< the trial's own limit came before the target
  int total() const { return error + time + both + unfinished; }
};

/// A task in a condition, by their indices.
struct TaskCondition {
  int task = 0, condition = 0;
  bool operator==(const TaskCondition&) const = default;
};

struct PairedComparison {
  Quantity quantity = Quantity::error;
  TaskCondition first, second;
  std::vector<int> excluded_subjects;  ///< subjects
  statistics::Summary first_summary, second_summary;
  std::optional<statistics::PairedTest> test;
  std::optional<statistics::SignFlipTest> sign_flip_test;
  double corrected_p = kNotComputed;
  std::string skip_reason;  ///< where there is no test
};

struct ConditionMean {
  Quantity quantity = Quantity::error;
  TaskCondition task_condition;
  std::optional<statistics::Summary> result;  ///< over the subjects
  std::optional<bool> overlaps_baseline;      ///< with the baseline's interval, where this is not the baseline
  std::string skip_reason;
};

struct ConditionCorrelation {
  TaskCondition task_condition;
  std::vector<int> excluded_subjects;
  std::optional<statistics::Correlation> result;
  double corrected_p = kNotComputed;
  std::string skip_reason;
};

/// The correlation of a condition beside the baseline's.
struct CorrelationChange {
  TaskCondition task_condition;
  std::optional<statistics::CorrelationDifference> result;  ///< baseline, condition
  double corrected_p = kNotComputed;
  std::string skip_reason;
};

enum class Verdict { supported, not_supported, not_testable };
const char* to_string(Verdict verdict);

struct FindingResult {
  Verdict verdict = Verdict::not_testable;
  std::string supported_count;       ///< "3 of 4", where it has several parts
  std::vector<std::string> details;  ///< what these data say of each part, in words and numbers
  std::string text() const;          ///< all of it
};

struct Analysis {
  std::vector<int> subjects;  ///< numbers, rising
  int row_count = 0, training_count = 0;
  std::vector<Cell> cells;             ///< by subject, task, condition
  std::vector<Rejections> rejections;  ///< by task, condition
  std::vector<ConditionMean> means;
  std::vector<PairedComparison> condition_comparisons, task_comparisons, tradeoff_comparisons;
  std::vector<ConditionCorrelation> correlations;
  std::vector<CorrelationChange> correlation_changes;
  std::vector<FindingResult> findings;    ///< of the inquiry, in its order
  std::vector<std::string> missing_data;  ///< "subject 7: no kept trials of tracing_2d in iso"
  std::vector<std::string> notes;         ///< what of the data is not as the study's design has it

  std::size_t task_count = 0, condition_count = 0;
  const Cell& cell(std::size_t subject, const TaskCondition& p) const {
    return cells[(subject * task_count + static_cast<std::size_t>(p.task)) * condition_count + static_cast<std::size_t>(p.condition)];
  }
  double value(std::size_t subject, const TaskCondition& p, Quantity q) const {
    return cell(subject, p).values[static_cast<std::size_t>(q)];
  }
  const Rejections& rejections_in(const TaskCondition& p) const {
    return rejections[static_cast<std::size_t>(p.task) * condition_count + static_cast<std::size_t>(p.condition)];
  }
  Rejections total_rejections() const;
};

/// `where` names the data in errors: a row of another task, condition or design than the study's, or a trial that is there twice.
Result<Analysis> analyze(const Study& study, const study::AnalysisPlan& inquiry, const std::vector<study::TrialRow>& rows,
                         const std::string& where);

/// Steps of analyse(), each on what the ones before it made.
Outcome compute_descriptive_stats(const Study& study, const std::vector<study::TrialRow>& rows, const std::string& where,
                                  Analysis& analysis);
void run_paired_tests(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis);
void evaluate_findings(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis);

/// The paired test of values of the subjects; NaN: left out.
PairedComparison compare_paired(const Analysis& analysis, Quantity quantity, const TaskCondition& first, const TaskCondition& second);
/// Holm's method over the tests that there are.
void apply_holm_correction(std::vector<PairedComparison>& family);

// ---- its outputs ----

/// Where the trials come from, as far as the data folder says.
struct DataSource {
  std::string folder;         ///< the folder's name, without what it lies in
  bool is_simulated = false;  ///< by a model
};

std::string subjects_csv(const Study& study, const Analysis& analysis);
std::string means_csv(const Study& study, const Analysis& analysis);
std::string tests_csv(const Study& study, const Analysis& analysis);
std::string correlations_csv(const Study& study, const Analysis& analysis);
std::string slopes_csv(const Study& study, const Analysis& analysis);
std::string rejections_csv(const Study& study, const Analysis& analysis);
std::string findings_csv(const study::AnalysisPlan& inquiry, const Analysis& analysis);
std::string to_json(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers);

/// gnuplot scripts and the pictures that they draw: the means (Figs 9 and 10), error and time of the subjects (Fig. 11), the trade.
struct Plots {
  std::string script;
  std::vector<std::string> files;
};
Plots means_plots(const Study& study, const Analysis& analysis);
Plots correlation_plots(const Study& study, const Analysis& analysis);
Plots tradeoff_plots(const Study& study, const Analysis& analysis);

/// SVG, empty where there is no gnuplot.
struct PlotImages {
  std::vector<std::string> means, correlations, tradeoffs;
};
std::string to_html(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers, const PlotImages& drawn);

/// The sentence that goes with every result of simulated trials.
inline constexpr const char* kSimulatedDataNotice =
    "These trials were done by a model of a person, not by people. What is found here is found about the model; it cannot stand in for "
    "people.";

/// "0.0381", "5.3e-04", "< 1e-15", "-".
std::string format_p(double p);
/// "p = 0.0381 (corrected 0.11)", "p < 1e-15 (corrected 2.1e-14)".
std::string format_p_values(double p, double corrected);
/// "tracing_3d, iso"
std::string task_condition_label(const Study& study, const TaskCondition& place);
/// "iso - aniso"; of two tasks "tracing_3d - tracing_2d"
std::string difference_label(const Study& study, const PairedComparison& paired);
/// "iso - aniso = 3.21 mm (2.90 to 3.52), t(19) = 7.38, p = 5.3e-04 (corrected 0.0085), d_z = 1.65"; or why there is none
std::string comparison_text(const Study& study, const PairedComparison& paired);

}  // namespace catena::app::analysis
