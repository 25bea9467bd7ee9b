/// What `catena tradeoff SCENE` measures: curves of error against cost. One knob of the hand or of the eye is one curve; each of its
/// settings is a point. Plain data: written as JSON and CSV, read back for --compare.
/// NaN stands for what was not measured, or means nothing for this curve.
#pragma once
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace catena::app::tradeoff {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Of repeats that were interleaved with those of the other settings (timing.h).
struct Timing {
  double median = kNotMeasured, lower_quartile = kNotMeasured, upper_quartile = kNotMeasured;  ///< the quartiles
  int repeats = 0;
};

struct Point {
  std::string setting;  ///< for a person: "rkf34, tolerance 1e-6"
  /// What to write to get it: keys of the scene, an option; where words stand beside these, they stand between backquotes. Empty: it
  /// cannot be asked for.
  std::string config_text;
  std::string series;  ///< points of one series are joined in the plot: "rkf34"
  double error = kNotMeasured;
  double work = kNotMeasured;  ///< counted, the same on every machine
  Timing time{};
  double bytes = kNotMeasured;
  std::vector<double> extra_values{};  ///< one a name of Curve::more
  bool is_selectable = true;           ///< false: shown beside the others, never chosen
};

/// Which cost a choice goes by.
enum class CostKind { time, work, bytes };

struct Curve {
  std::string id;                                            ///< of its CSV: "hand-streamline-curve"
  std::string category;                                      ///< hand, eye or data
  std::string title;                                         ///< "How the streamline `curve` is followed"
  std::string description;                                   ///< what was done, in a sentence or two
  std::string error_name, work_name, time_name, bytes_name;  ///< with their units; empty: there is none
  std::vector<std::string> extra_columns;                    ///< further columns
  std::vector<Point> points;
  double discretization_error = kNotMeasured;                        ///< the data's own error, in the unit of `error`
  std::string discretization_error_name = "the data's own error";    ///< ends in ", at least" where `floor` is a lower bound
  std::string discretization_error_method;                           ///< how it was found
  double reference_error = kNotMeasured;                             ///< of what the errors are measured against: less cannot be told
  std::string reference;                                             ///< what that is, and how its convergence was seen
  std::string reference_error_name = "what the reference can tell";  ///< of reference_error, in `why`; not written to files
  CostKind cost = CostKind::time;
  int current = -1;           ///< the point that the scene has now; -1: none of them
  std::vector<int> front;     ///< the Pareto front, cheapest first (choice.h)
  int chosen = -1;            ///< -1: there is nothing to choose
  std::string choice_reason;  ///< one sentence
  bool is_flat = false;       ///< no setting stands out, and what the scene has stays: it is no demand; not written to files
};

inline bool is_on_front(const Curve& c, int i) { return std::find(c.front.begin(), c.front.end(), i) != c.front.end(); }
inline double get_cost(const Point& p, CostKind cost) {
  return cost == CostKind::time ? p.time.median : cost == CostKind::work ? p.work : p.bytes;
}

}  // namespace catena::app::tradeoff
