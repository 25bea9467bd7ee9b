/// What the trials of a study say: the paper's section 7.2 on any data folder. A pure function of the study, its inquiry and the rows; the
/// same input gives the same bits.
///
///   kept        trials within the study's limits that ended at their target; training is not looked at
///   a subject   in a task and condition: mean and standard deviation of error and time over its kept trials, and the trade: the slope of
///               log error on log time over them (three at least)
///   tests       paired over the subjects that have both values (engine/statistics): whoever lacks one is left out of that test, by name
///   families    p-values are corrected by Holm's method within one: conditions, tasks, trade, correlations, changes of correlations
/// Differences are first - second: the baseline less the other condition, so that a gain is positive.
#pragma once
#include <limits>
#include <optional>

#include "engine/app/study/analyse/answers.h"
#include "engine/statistics/correlation.h"
#include "engine/statistics/permutation.h"
#include "engine/statistics/summary.h"
#include "engine/study/inquiry.h"
#include "engine/study/trial_table.h"

namespace catena::app::analysis {

using study::Study;

inline constexpr double kAlpha = 0.05, kConfidence = 0.95;
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Of a subject in a task and a condition.
enum class Quantity { error, time, error_deviation, time_deviation, slope };
inline constexpr int kQuantities = 5;
const char* quantity_word(Quantity q);  ///< "error_deviation"
const char* quantity_name(Quantity q);  ///< "deviation of the error"
const char* unit_of(Quantity q);        ///< "mm", "s"; "" of slopes

struct Cell {
  int trials = 0, kept = 0;
  std::array<double, kQuantities> values{kNone, kNone, kNone, kNone, kNone};  ///< NaN: too few kept trials
};

/// Trials of a task in a condition, and why some were left out. One reason each.
struct Rejections {
  int trials = 0;
  int error = 0, time = 0, both = 0;  ///< beyond the study's limits
  int unfinished = 0;                 ///< the trial's own limit came before the target
  int rejected() const { return error + time + both + unfinished; }
};

/// A task in a condition, by their indices.
struct Place {
  int task = 0, condition = 0;
  bool operator==(const Place&) const = default;
};

struct Paired {
  Quantity quantity = Quantity::error;
  Place first, second;
  std::vector<int> left_out;  ///< subjects
  statistics::Summary of_first, of_second;
  std::optional<statistics::PairedTest> test;
  std::optional<statistics::SignFlipTest> flips;
  double corrected = kNone;
  std::string why_not;  ///< where there is no test
};

struct Mean {
  Quantity quantity = Quantity::error;
  Place place;
  std::optional<statistics::Summary> of;  ///< over the subjects
  std::optional<bool> overlaps;           ///< with the baseline's interval, where this is not the baseline
  std::string why_not;
};

struct Correlated {
  Place place;
  std::vector<int> left_out;
  std::optional<statistics::Correlation> of;
  double corrected = kNone;
  std::string why_not;
};

/// The correlation of a condition beside the baseline's.
struct Change {
  Place place;
  std::optional<statistics::CorrelationDifference> of;  ///< baseline, condition
  double corrected = kNone;
  std::string why_not;
};

enum class Verdict { supported, not_supported, not_testable };
const char* verdict_word(Verdict verdict);

struct Judged {
  Verdict verdict = Verdict::not_testable;
  std::string count;                 ///< "3 of 4", where it has several parts
  std::vector<std::string> numbers;  ///< what these data say of each part, in words and numbers
  std::string text() const;          ///< all of it
};

struct Analysis {
  std::vector<int> subjects;  ///< numbers, rising
  int rows = 0, training = 0;
  std::vector<Cell> cells;             ///< by subject, task, condition
  std::vector<Rejections> rejections;  ///< by task, condition
  std::vector<Mean> means;
  std::vector<Paired> conditions, tasks, trade;
  std::vector<Correlated> correlations;
  std::vector<Change> changes;
  std::vector<Judged> findings;    ///< of the inquiry, in its order
  std::vector<std::string> gaps;   ///< "subject 7: no kept trials of tracing_2d in iso"
  std::vector<std::string> notes;  ///< what of the data is not as the study's design has it

  std::size_t tasks_count = 0, conditions_count = 0;
  const Cell& cell(std::size_t subject, const Place& p) const {
    return cells[(subject * tasks_count + static_cast<std::size_t>(p.task)) * conditions_count + static_cast<std::size_t>(p.condition)];
  }
  double value(std::size_t subject, const Place& p, Quantity q) const { return cell(subject, p).values[static_cast<std::size_t>(q)]; }
  const Rejections& rejected(const Place& p) const {
    return rejections[static_cast<std::size_t>(p.task) * conditions_count + static_cast<std::size_t>(p.condition)];
  }
  Rejections all_rejected() const;
};

/// `where` names the data in errors: a row of another task, condition or design than the study's, or a trial that is there twice.
Result<Analysis> analyse(const Study& study, const study::Inquiry& inquiry, const std::vector<study::Row>& rows, const std::string& where);

/// Steps of analyse(), each on what the ones before it made.
Outcome sum_up_subjects(const Study& study, const std::vector<study::Row>& rows, const std::string& where, Analysis& analysis);
void compare(const Study& study, const study::Inquiry& inquiry, Analysis& analysis);
void judge_findings(const Study& study, const study::Inquiry& inquiry, Analysis& analysis);

/// The paired test of values of the subjects; NaN: left out.
Paired paired_over(const Analysis& analysis, Quantity quantity, const Place& first, const Place& second);
/// Holm's method over the tests that there are.
void correct(std::vector<Paired>& family);

// ---- its outputs ----

/// Where the trials come from, as far as the data folder says.
struct Source {
  std::string folder;      ///< the folder's name, without what it lies in
  bool simulated = false;  ///< by a model
};

std::string subjects_csv(const Study& study, const Analysis& analysis);
std::string means_csv(const Study& study, const Analysis& analysis);
std::string tests_csv(const Study& study, const Analysis& analysis);
std::string correlations_csv(const Study& study, const Analysis& analysis);
std::string slopes_csv(const Study& study, const Analysis& analysis);
std::string rejections_csv(const Study& study, const Analysis& analysis);
std::string findings_csv(const study::Inquiry& inquiry, const Analysis& analysis);
std::string to_json(const Study& study, const study::Inquiry& inquiry, const Analysis& analysis, const Source& source,
                    const std::vector<Answered>& answers);

/// gnuplot scripts and the pictures that they draw: the means (Figs 9 and 10), error and time of the subjects (Fig. 11), the trade.
struct Plots {
  std::string script;
  std::vector<std::string> files;
};
Plots means_plots(const Study& study, const Analysis& analysis);
Plots correlation_plots(const Study& study, const Analysis& analysis);
Plots trade_plots(const Study& study, const Analysis& analysis);

/// SVG, empty where there is no gnuplot.
struct Drawn {
  std::vector<std::string> means, correlations, trade;
};
std::string to_html(const Study& study, const study::Inquiry& inquiry, const Analysis& analysis, const Source& source,
                    const std::vector<Answered>& answers, const Drawn& drawn);

/// The sentence that goes with every result of simulated trials.
inline constexpr const char* kModelSentence =
    "These trials were done by a model of a person, not by people. What is found here is found about the model; it cannot stand in for "
    "people.";

/// "0.0381", "5.3e-04", "< 1e-15", "-".
std::string p_text(double p);
/// "p = 0.0381 (corrected 0.11)", "p < 1e-15 (corrected 2.1e-14)".
std::string p_words(double p, double corrected);
/// "tracing_3d, iso"
std::string place_text(const Study& study, const Place& place);
/// "iso - aniso"; of two tasks "tracing_3d - tracing_2d"
std::string difference_text(const Study& study, const Paired& paired);
/// "iso - aniso = 3.21 mm (2.90 to 3.52), t(19) = 7.38, p = 5.3e-04 (corrected 0.0085), d_z = 1.65"; or why there is none
std::string paired_text(const Study& study, const Paired& paired);

}  // namespace catena::app::analysis
