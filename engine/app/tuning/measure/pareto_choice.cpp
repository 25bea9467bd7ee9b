// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/pareto_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/app/tuning/measure/format_number.h"

namespace catena::app::tuning {
namespace {

constexpr double kKnee = 0.1;  // fraction of the chord: a knee less deep does not count

bool counts(const Point& p, CostKind cost) { return p.is_selectable && std::isfinite(p.error) && std::isfinite(get_cost(p, cost)); }

/// Logarithm with a lower bound, so that an exact result also has a position on a logarithmic axis.
double log_of(double value, double minimum) { return std::log(std::max(value, minimum)); }

/// Returns the index of the knee of the front; -1: none, error and cost change evenly.
int knee(const std::vector<Point>& points, const std::vector<int>& front, CostKind cost) {
  if (front.size() < 3) return front.back();
  double minimum = 1e-300;
  for (const int i : front)
    if (points[i].error > 0) minimum = points[i].error;  // errors fall along the front
  const auto x = [&](int i) { return log_of(get_cost(points[i], cost), 1e-300); };
  const auto y = [&](int i) { return log_of(points[i].error, 0.1 * minimum); };
  const double x0 = x(front.front()), dx = x(front.back()) - x0, y0 = y(front.front()), dy = y(front.back()) - y0;
  if (!(dx > 0) || !(dy < 0)) return front.back();
  int best = front.back();
  double deepest = 0;
  for (const int i : front) {
    const double below = (y(i) - y0) / dy - (x(i) - x0) / dx;
    if (below > deepest + 1e-9) deepest = below, best = i;
  }
  return deepest < kKnee ? -1 : best;
}

bool alike(const Point& a, const Point& b, CostKind cost) {
  if (cost != CostKind::time) return get_cost(a, cost) == get_cost(b, cost);
  return a.time.lower_quartile <= b.time.upper_quartile && b.time.lower_quartile <= a.time.upper_quartile;
}

/// Returns the cheapest of the points in `good`.
int cheapest(const std::vector<Point>& points, const std::vector<int>& good, CostKind cost) {
  const int minimum =
      *std::min_element(good.begin(), good.end(), [&](int a, int b) { return get_cost(points[a], cost) < get_cost(points[b], cost); });
  int best = minimum;
  for (const int i : good) {
    if (!alike(points[i], points[minimum], cost)) continue;
    const double work = std::isfinite(points[i].work) ? points[i].work : 0,
                 best_work = std::isfinite(points[best].work) ? points[best].work : 0;
    if (work < best_work || (work == best_work && points[i].error < points[best].error)) best = i;
  }
  return best;
}

}  // namespace

std::vector<int> pareto_front(std::span<const Point> points, CostKind cost) {
  std::vector<int> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(points[i], cost)) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const double ca = get_cost(points[a], cost), cb = get_cost(points[b], cost);
    return ca != cb ? ca < cb : points[a].error < points[b].error;
  });
  std::vector<int> front;
  for (const int i : order)
    if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
  return front;
}

double min_resolvable_error(const Curve& curve) {
  const auto known = [](double error) { return std::isfinite(error) ? error : 0.0; };
  return std::max(known(curve.discretization_error), known(curve.reference_error));
}

PickedPoint pick_point(const Curve& curve, const Target& target) {
  const std::vector<Point>& points = curve.points;
  const double floor = min_resolvable_error(curve);
  std::vector<int> all, good;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(points[i], curve.cost)) all.push_back(static_cast<int>(i));
  if (all.empty()) return {-1, false, false};
  const auto error = [&](int i) { return std::max(points[i].error, floor); };
  const auto cost = [&](int i) { return get_cost(points[i], curve.cost); };
  PickedPoint picked;
  double maximum = 0;  // maximum acceptable error
  if (target.error) {
    picked.at_floor = *target.error < floor;
    maximum = std::max(*target.error, floor);
    const double minimum = error(*std::min_element(all.begin(), all.end(), [&](int a, int b) { return error(a) < error(b); }));
    picked.meets_target = minimum <= maximum;
    maximum = std::max(maximum, minimum);
    good = all;
  } else {
    for (const int i : all)
      if (cost(i) <= *target.cost) good.push_back(i);
    picked.meets_target = !good.empty();
    if (good.empty()) return {*std::min_element(all.begin(), all.end(), [&](int a, int b) { return cost(a) < cost(b); }), false, false};
    maximum = error(*std::min_element(good.begin(), good.end(), [&](int a, int b) { return error(a) < error(b); }));
    picked.at_floor = floor > 0 && maximum <= floor;
  }
  std::erase_if(good, [&](int i) { return error(i) > maximum; });
  picked.point = cheapest(points, good, curve.cost);
  return picked;
}

std::string describe_discretization_error(const Curve& curve) {
  const bool bound = curve.discretization_error_name.ends_with(", at least");
  return curve.discretization_error_name + (bound ? " " : ", ") + format_number(curve.discretization_error);
}

namespace {

/// Makes the choice on one curve and states its reason. Errors that the reference cannot resolve count as equal.
class Chooser {
 public:
  explicit Chooser(Curve& curve);
  void choose();

 private:
  void take(int point, std::string why) { curve_.chosen = point, curve_.choice_reason = std::move(why); }
  void take_of_equals();
  void take_knee();
  std::string cheap_enough(int i, const std::string& level) const;
  std::string knee_words(const std::string& begin) const;
  std::string told_words() const { return curve_.reference_error_name + ", " + format_number(told_); }
  double error(int i) const { return seen_[static_cast<std::size_t>(i)].error; }

  Curve& curve_;
  const std::vector<Point>& points_;
  const bool bytes_;
  double told_ = 0, reached_ = 0;         // resolvable error of the reference; discretization error
  std::vector<Point> seen_;               // with errors limited to the resolvable error
  std::vector<int> all_, good_, untold_;  // selectable; at the discretization error; below the resolvable error
};

Chooser::Chooser(Curve& curve) : curve_(curve), points_(curve.points), bytes_(curve.cost == CostKind::bytes), seen_(curve.points) {
  told_ = std::isfinite(curve.reference_error) ? curve.reference_error : 0;
  reached_ = std::isfinite(curve.discretization_error) ? min_resolvable_error(curve) : 0;
  for (Point& p : seen_)
    if (std::isfinite(p.error)) p.error = std::max(p.error, told_);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!counts(points_[i], curve.cost)) continue;
    all_.push_back(static_cast<int>(i));
    if (points_[i].error <= reached_) good_.push_back(static_cast<int>(i));
    if (told_ > 0 && points_[i].error <= told_) untold_.push_back(static_cast<int>(i));
  }
}

void Chooser::choose() {
  curve_.front = pareto_front(seen_, curve_.cost);
  curve_.chosen = -1;
  curve_.is_flat = false;
  if (curve_.front.empty()) return;
  const auto [minimum, maximum] = std::ranges::minmax(all_, {}, [&](int i) { return error(i); });
  if (points_.size() == 1) {
    take(curve_.front.front(), fmt::format("There is only one setting; its error is {}.", format_number(points_[0].error)));
  } else if (error(maximum) <= error(minimum)) {
    take_of_equals();
  } else if (curve_.front.size() == 1) {
    take(curve_.front.front(),
         fmt::format("This setting {} the most accurate{}.", bytes_ ? "has the fewest bytes and is also" : "is the cheapest and also",
                     untold_.empty() ? "" : ", within the error of the reference"));
  } else if (reached_ > 0 && !good_.empty()) {
    const int best = cheapest(points_, good_, curve_.cost);
    take(best, cheap_enough(best, curve_.discretization_error >= reached_ ? describe_discretization_error(curve_) : told_words()));
  } else {
    take_knee();
  }
}

std::string Chooser::cheap_enough(int i, const std::string& level) const {
  const std::string error = format_number(points_[static_cast<std::size_t>(i)].error);
  if (bytes_)
    return fmt::format(
        "Among the settings with an error not above {}, this one has the fewest bytes, with an error of {}; a smaller error takes more "
        "bytes without a resolvable gain.",
        level, error);
  return fmt::format("This is the cheapest setting whose error, {}, is not above {}; a smaller error costs more without a resolvable gain.",
                     error, level);
}

/// No setting changes the error: the scene's setting stays, unless another one is clearly cheaper.
void Chooser::take_of_equals() {
  const int now = curve_.current, min_cost = cheapest(seen_, all_, curve_.cost);
  // the first in the list of those whose costs differ only by noise
  const int best = *std::find_if(all_.begin(), all_.end(), [&](int i) { return alike(points_[i], points_[min_cost], curve_.cost); });
  curve_.is_flat = now >= 0 && alike(points_[now], points_[best], curve_.cost);
  take(curve_.is_flat ? now : best, fmt::format("{}{}.",
                                                untold_.empty() ? "No setting changes the error, " + format_number(error(all_.front()))
                                                                : "No setting has a larger error than " + told_words(),
                                                curve_.is_flat ? ", so that the scene's setting is kept"
                                                : bytes_       ? ", so that the one with the fewest bytes is chosen"
                                                               : ", so that the cheapest is chosen"));
}

/// Error and cost are in conflict: the knee of the front is chosen, if there is one.
void Chooser::take_knee() {
  const std::vector<int>& front = curve_.front;
  const int bend = knee(seen_, front, curve_.cost);
  curve_.is_flat = bend < 0 && std::ranges::find(front, curve_.current) != front.end();
  curve_.chosen = bend >= 0 ? bend : curve_.is_flat ? curve_.current : front.back();
  const std::string chosen_error = format_number(points_[curve_.chosen].error);
  const std::string begin =
      reached_ > 0 ? fmt::format("No setting reaches {}; this is ", describe_discretization_error(curve_)) : "This is ";
  if (curve_.is_flat) {
    curve_.choice_reason = fmt::format(
        "Error and cost change evenly along the front, and no setting stands out: the scene's setting is kept, with an error of {}. The "
        "best choice depends on the accuracy that you need.",
        chosen_error);
  } else if (curve_.chosen == front.back() && !untold_.empty()) {
    const int best = cheapest(points_, untold_, curve_.cost);
    take(best, cheap_enough(best, told_words()));
  } else if (curve_.chosen == front.back()) {
    curve_.choice_reason = fmt::format("{}the most accurate setting, with an error of {}.", begin, chosen_error);
  } else {
    curve_.choice_reason = knee_words(begin);
  }
}

/// Describes the error and cost differences to the neighbors on the front.
std::string Chooser::knee_words(const std::string& begin) const {
  const std::vector<int>& front = curve_.front;
  const auto at = static_cast<std::size_t>(std::ranges::find(front, curve_.chosen) - front.begin());
  const Point &p = points_[curve_.chosen], &next = points_[front[at + 1]];
  const double here = error(curve_.chosen), next_error = error(front[at + 1]);
  std::string why = begin + "the knee of the front";
  if (at > 0) {
    const Point& last = points_[front[at - 1]];
    why +=
        fmt::format(": {} {} {:.2g} times {} and has {:.2g} times the error", last.setting, bytes_ ? "takes" : "costs",
                    get_cost(p, curve_.cost) / get_cost(last, curve_.cost), bytes_ ? "fewer bytes" : "less", error(front[at - 1]) / here);
  }
  why += fmt::format("{} {} {} {:.2g} times as {} and has {} error.", at > 0 ? ";" : ":", next.setting, bytes_ ? "takes" : "costs",
                     get_cost(next, curve_.cost) / get_cost(p, curve_.cost), bytes_ ? "many bytes" : "much",
                     next_error <= 0            ? "no"
                     : here < 1.05 * next_error ? "hardly less"
                                                : fmt::format("{:.2g} times less", here / next_error));
  if (next_error <= told_ && told_ > 0) why += fmt::format(" Errors below {} cannot be resolved.", format_number(told_));
  return why;
}

}  // namespace

void choose_setting(Curve& curve) { Chooser(curve).choose(); }

}  // namespace catena::app::tuning
