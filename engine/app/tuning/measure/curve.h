// SPDX-License-Identifier: MIT
/// Curves of error against cost, as measured by `catena tradeoff SCENE`. One parameter of haptics or rendering is one curve; each of its
/// settings is a point. Plain data: written as JSON and CSV, and read back for --compare.
/// NaN denotes a value that was not measured or has no meaning for the curve.
#pragma once
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace catena::app::tuning {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Time of a setting over repeats interleaved with those of the other settings (timing.h), in the unit of Curve::time_name.
struct Timing {
  double median = kNotMeasured, lower_quartile = kNotMeasured, upper_quartile = kNotMeasured;
  /// Number of timed repeats.
  int repeats = 0;
};

/// One setting and what was measured of it.
struct Point {
  std::string setting;  ///< Label for the user: "rkf34, tolerance 1e-6".
  /// Text that requests the setting: keys of the scene or a command line option; where it also contains prose, the keys stand between
  /// backquotes. Empty: it cannot be requested.
  std::string config_text;
  std::string series;  ///< Points of one series are connected in the plot: "rkf34".
  double error = kNotMeasured;
  double work = kNotMeasured;  ///< Operation count, the same on every system.
  Timing time{};
  double bytes = kNotMeasured;
  std::vector<double> extra_values{};  ///< One per name in Curve::extra_columns.
  bool is_selectable = true;           ///< False: shown for comparison, never chosen.
};

/// The cost that a choice minimizes.
enum class CostKind { time, work, bytes };

/// One measured curve, with the setting chosen from it.
struct Curve {
  std::string id;                                            ///< Identifier and name of its CSV file: "hand-streamline-curve".
  std::string category;                                      ///< "hand" (haptics), "eye" (rendering) or "data".
  std::string title;                                         ///< Title for the user: "Method of the streamline link `curve`".
  std::string description;                                   ///< Description of the measurement, in a sentence or two.
  std::string error_name, work_name, time_name, bytes_name;  ///< Names with units; empty: not applicable.
  std::vector<std::string> extra_columns;                    ///< Names of Point::extra_values.
  std::vector<Point> points;
  double discretization_error = kNotMeasured;                          ///< Discretization error, in the unit of Point::error.
  std::string discretization_error_name = "the discretization error";  ///< Ends in ", at least" for a lower bound.
  std::string discretization_error_method;                             ///< How it was estimated.
  double reference_error = kNotMeasured;  ///< Error of the reference itself; smaller errors are not resolvable.
  std::string reference;                  ///< The reference that errors are measured against, and how its convergence was checked.
  std::string reference_error_name = "the error of the reference";  ///< Name of reference_error in choice_reason; not written to files.
  /// The cost used by the choice.
  CostKind cost = CostKind::time;
  int current = -1;           ///< Index of the point that the scene uses; -1: none of them.
  std::vector<int> front;     ///< Indices of the Pareto front, cheapest first (pareto_choice.h).
  int chosen = -1;            ///< Index of the chosen point; -1: there is nothing to choose.
  std::string choice_reason;  ///< Reason of the choice, one sentence.
  bool is_flat = false;       ///< No setting stands out, so the current setting stays and nothing is recommended; not written to files.
};

inline bool is_on_front(const Curve& c, int i) { return std::find(c.front.begin(), c.front.end(), i) != c.front.end(); }
inline double get_cost(const Point& p, CostKind cost) {
  return cost == CostKind::time ? p.time.median : cost == CostKind::work ? p.work : p.bytes;
}

}  // namespace catena::app::tuning
