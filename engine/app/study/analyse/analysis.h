// SPDX-License-Identifier: MIT
/// Statistical analysis of a study's trials: the paper's section 7.2 for any data folder. A pure function of the study, its analysis plan
/// and the rows; the same input gives the same bits.
///
///   accepted    trials within the study's rejection limits that ended at their target; training trials are excluded
///   a subject   in a task and condition: mean and standard deviation of error and time over its accepted trials, and the speed-accuracy
///               trade-off: the slope of log error on log time over them (at least three)
///   tests       paired over the subjects that have both values (engine/study/statistics); a subject that lacks one is excluded from that
///               test, and listed
///   families    p-values are corrected by Holm's method within a family: conditions, tasks, trade-offs, correlations, changes of
///               correlations
/// Differences are first - second: the baseline minus the other condition, so that a gain is positive.
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

/// Significance level, and confidence level of all intervals.
inline constexpr double kAlpha = 0.05, kConfidence = 0.95;
/// Value of a number that could not be computed.
inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

/// A measured quantity of a subject in a task and a condition.
enum class Quantity { error, time, error_deviation, time_deviation, slope };
/// Number of quantities.
inline constexpr int kQuantities = 5;
const char* to_string(Quantity q);       ///< Identifier, "error_deviation"
const char* quantity_label(Quantity q);  ///< Label, "deviation of the error"
const char* quantity_unit(Quantity q);   ///< Unit, "mm" or "s"; empty for slopes

/// Results of one subject in one task and condition.
struct Cell {
  int trials = 0, accepted = 0;
  /// Indexed by Quantity; NaN: too few accepted trials
  std::array<double, kQuantities> values{kNotComputed, kNotComputed, kNotComputed, kNotComputed, kNotComputed};
};

/// Numbers of trials of a task in a condition, in all and rejected, by reason; every rejected trial counts under one reason.
struct Rejections {
  int trials = 0;
  int error = 0, time = 0, both = 0;  ///< Beyond the study's limits for error, for time, or for both
  int unfinished = 0;                 ///< The timeout came before the target
  int total() const { return error + time + both + unfinished; }
};

/// A pair of task and condition, by their indices.
struct TaskCondition {
  int task = 0, condition = 0;
  bool operator==(const TaskCondition&) const = default;
};

/// Comparison of one quantity between two task/condition pairs, paired over the subjects.
struct PairedComparison {
  Quantity quantity = Quantity::error;
  TaskCondition first, second;
  std::vector<int> excluded_subjects;  ///< Numbers of subjects that lack a value
  statistics::Summary first_summary, second_summary;
  std::optional<statistics::PairedTest> test;
  std::optional<statistics::SignFlipTest> sign_flip_test;
  double corrected_p = kNotComputed;
  std::string skip_reason;  ///< Why there is no test
};

/// Mean of a quantity over the subjects in one task and condition.
struct ConditionMean {
  Quantity quantity = Quantity::error;
  TaskCondition task_condition;
  std::optional<statistics::Summary> result;  ///< Empty: not computed
  /// Whether its confidence interval overlaps the baseline's; empty for the baseline itself
  std::optional<bool> overlaps_baseline;
  std::string skip_reason;
};

/// Correlation of error and time over the subjects in one task and condition.
struct ConditionCorrelation {
  TaskCondition task_condition;
  std::vector<int> excluded_subjects;
  std::optional<statistics::Correlation> result;
  double corrected_p = kNotComputed;
  std::string skip_reason;
};

/// Comparison of a condition's correlation with the baseline's.
struct CorrelationChange {
  TaskCondition task_condition;
  std::optional<statistics::CorrelationDifference> result;  ///< first: baseline; second: condition
  double corrected_p = kNotComputed;
  std::string skip_reason;
};

/// Outcome of a finding's test on these data.
enum class Verdict { supported, not_supported, not_testable };
const char* to_string(Verdict verdict);

/// Result of one finding of the analysis plan.
struct FindingResult {
  Verdict verdict = Verdict::not_testable;
  /// "3 of 4" if the finding has several parts, else empty
  std::string supported_count;
  std::vector<std::string> details;  ///< What these data show for each part, in words and numbers
  std::string text() const;          ///< Returns the count and the details as one text
};

/// All results of the analysis.
struct Analysis {
  std::vector<int> subjects;  ///< Numbers of the subjects, ascending
  int row_count = 0, training_count = 0;
  std::vector<Cell> cells;             ///< Indexed by subject, task, condition; see cell()
  std::vector<Rejections> rejections;  ///< Indexed by task, condition; see rejections_in()
  std::vector<ConditionMean> means;
  std::vector<PairedComparison> condition_comparisons, task_comparisons, tradeoff_comparisons;
  std::vector<ConditionCorrelation> correlations;
  std::vector<CorrelationChange> correlation_changes;
  std::vector<FindingResult> findings;    ///< results of the findings, in the order of the analysis plan
  std::vector<std::string> missing_data;  ///< "subject 7: no accepted trial of tracing_2d, iso (0 done)"
  std::vector<std::string> notes;         ///< Differences between the data and the study's design

  std::size_t task_count = 0, condition_count = 0;
  /// The values of the `subject`-th subject.
  const Cell& cell(std::size_t subject, const TaskCondition& p) const {
    return cells[(subject * task_count + static_cast<std::size_t>(p.task)) * condition_count + static_cast<std::size_t>(p.condition)];
  }
  /// One value of the `subject`-th subject; NaN: not computed.
  double value(std::size_t subject, const TaskCondition& p, Quantity q) const {
    return cell(subject, p).values[static_cast<std::size_t>(q)];
  }
  /// Rejections of one task and condition.
  const Rejections& rejections_in(const TaskCondition& p) const {
    return rejections[static_cast<std::size_t>(p.task) * condition_count + static_cast<std::size_t>(p.condition)];
  }
  /// Sum over all tasks and conditions.
  Rejections total_rejections() const;
};

/// Analyzes the rows. `where`: name of the data in errors. Error: a row whose task, condition or design is not the study's, or a duplicate
/// trial.
Result<Analysis> analyze(const Study& study, const study::AnalysisPlan& inquiry, const std::vector<study::TrialRow>& rows,
                         const std::string& where);

/// The steps of analyze(), in this order; each uses the results of the previous ones.
Outcome compute_descriptive_stats(const Study& study, const std::vector<study::TrialRow>& rows, const std::string& where,
                                  Analysis& analysis);
void run_paired_tests(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis);
void evaluate_findings(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis);

/// Compares a quantity between two task/condition pairs; subjects with a NaN are excluded.
PairedComparison compare_paired(const Analysis& analysis, Quantity quantity, const TaskCondition& first, const TaskCondition& second);
/// Sets corrected_p by Holm's method over the comparisons that have a test.
void apply_holm_correction(std::vector<PairedComparison>& family);

// ---- outputs ----

/// Origin of the trials, as far as the data folder shows it.
struct DataSource {
  std::string folder;         ///< Name of the folder, without its parents
  bool is_simulated = false;  ///< The trials were simulated with the human model
};

/// The results as CSV tables.
std::string subjects_csv(const Study& study, const Analysis& analysis);
std::string means_csv(const Study& study, const Analysis& analysis);
std::string tests_csv(const Study& study, const Analysis& analysis);
std::string correlations_csv(const Study& study, const Analysis& analysis);
std::string slopes_csv(const Study& study, const Analysis& analysis);
std::string rejections_csv(const Study& study, const Analysis& analysis);
std::string findings_csv(const study::AnalysisPlan& inquiry, const Analysis& analysis);
/// All results as JSON.
std::string to_json(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers);

/// A gnuplot script and the names of the images that it writes: the means (Figs 9 and 10), error and time of the subjects (Fig. 11), the
/// trade-off.
struct Plots {
  std::string script;
  std::vector<std::string> files;
};
Plots means_plots(const Study& study, const Analysis& analysis);
Plots correlation_plots(const Study& study, const Analysis& analysis);
Plots tradeoff_plots(const Study& study, const Analysis& analysis);

/// The plots as SVG text; empty if gnuplot is not installed.
struct PlotImages {
  std::vector<std::string> means, correlations, tradeoffs;
};
/// All results as an HTML page.
std::string to_html(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers, const PlotImages& images);

/// Notice that accompanies every result of simulated trials.
inline constexpr const char* kSimulatedDataNotice =
    "These trials were made by a model of a person, not by people. The results describe the model; they do not replace results of people.";

/// Formats a p-value: "0.0381", "5.3e-04", "< 1e-15"; "-" if it is not finite.
std::string format_p(double p);
/// "p = 0.0381 (corrected 0.11)", "p < 1e-15 (corrected 2.1e-14)".
std::string format_p_values(double p, double corrected);
/// "tracing_3d, iso".
std::string task_condition_label(const Study& study, const TaskCondition& task_condition);
/// "iso - aniso"; for two tasks "tracing_3d - tracing_2d".
std::string difference_label(const Study& study, const PairedComparison& paired);
/// "iso - aniso = 3.21 mm (2.90 to 3.52), t(19) = 7.38, p = 5.3e-04 (corrected 0.0085), d_z = 1.65"; or the reason why there is no test.
std::string comparison_text(const Study& study, const PairedComparison& paired);

}  // namespace catena::app::analysis
