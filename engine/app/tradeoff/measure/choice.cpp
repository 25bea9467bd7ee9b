#include "engine/app/tradeoff/measure/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/app/tradeoff/measure/number.h"

namespace catena::app::tradeoff {
namespace {

constexpr double kKnee = 0.1;  // of the chord: what is less deep is none

bool counts(const Point& p, Cost cost) { return p.offered && std::isfinite(p.error) && std::isfinite(cost_of(p, cost)); }

/// What is exact to the last bit has a place on a logarithmic axis, too.
double log_of(double value, double least) { return std::log(std::max(value, least)); }

/// -1: error and cost trade evenly.
int knee(const std::vector<Point>& points, const std::vector<int>& front, Cost cost) {
  if (front.size() < 3) return front.back();
  double least = 1e-300;
  for (const int i : front)
    if (points[i].error > 0) least = points[i].error;  // falls along the front
  const auto x = [&](int i) { return log_of(cost_of(points[i], cost), 1e-300); };
  const auto y = [&](int i) { return log_of(points[i].error, 0.1 * least); };
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

bool alike(const Point& a, const Point& b, Cost cost) {
  if (cost != Cost::time) return cost_of(a, cost) == cost_of(b, cost);
  return a.time.low <= b.time.high && b.time.low <= a.time.high;
}

/// Of those that reach the floor.
int cheapest(const std::vector<Point>& points, const std::vector<int>& good, Cost cost) {
  const int least =
      *std::min_element(good.begin(), good.end(), [&](int a, int b) { return cost_of(points[a], cost) < cost_of(points[b], cost); });
  int best = least;
  for (const int i : good) {
    if (!alike(points[i], points[least], cost)) continue;
    const double work = std::isfinite(points[i].work) ? points[i].work : 0,
                 best_work = std::isfinite(points[best].work) ? points[best].work : 0;
    if (work < best_work || (work == best_work && points[i].error < points[best].error)) best = i;
  }
  return best;
}

}  // namespace

std::vector<int> pareto_front(std::span<const Point> points, Cost cost) {
  std::vector<int> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(points[i], cost)) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const double ca = cost_of(points[a], cost), cb = cost_of(points[b], cost);
    return ca != cb ? ca < cb : points[a].error < points[b].error;
  });
  std::vector<int> front;
  for (const int i : order)
    if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
  return front;
}

double least_told(const Curve& curve) {
  const auto known = [](double error) { return std::isfinite(error) ? error : 0.0; };
  return std::max(known(curve.floor), known(curve.reference_error));
}

Picked pick(const Curve& curve, const Target& target) {
  const std::vector<Point>& points = curve.points;
  const double floor = least_told(curve);
  std::vector<int> all, good;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(points[i], curve.cost)) all.push_back(static_cast<int>(i));
  if (all.empty()) return {-1, false, false};
  const auto error = [&](int i) { return std::max(points[i].error, floor); };
  const auto cost = [&](int i) { return cost_of(points[i], curve.cost); };
  Picked picked;
  double most = 0;  // of the errors that will do
  if (target.error) {
    picked.floored = *target.error < floor;
    most = std::max(*target.error, floor);
    const double least = error(*std::min_element(all.begin(), all.end(), [&](int a, int b) { return error(a) < error(b); }));
    picked.reached = least <= most;
    most = std::max(most, least);
    good = all;
  } else {
    for (const int i : all)
      if (cost(i) <= *target.cost) good.push_back(i);
    picked.reached = !good.empty();
    if (good.empty()) return {*std::min_element(all.begin(), all.end(), [&](int a, int b) { return cost(a) < cost(b); }), false, false};
    most = error(*std::min_element(good.begin(), good.end(), [&](int a, int b) { return error(a) < error(b); }));
    picked.floored = floor > 0 && most <= floor;
  }
  std::erase_if(good, [&](int i) { return error(i) > most; });
  picked.point = cheapest(points, good, curve.cost);
  return picked;
}

std::string floor_words(const Curve& curve) {
  const bool bound = curve.floor_name.ends_with(", at least");
  return curve.floor_name + (bound ? " " : ", ") + number_text(curve.floor);
}

void choose(Curve& curve) {
  // errors that the reference cannot tell apart are one
  const double told = std::isfinite(curve.reference_error) ? curve.reference_error : 0;
  const std::vector<Point>& points = curve.points;
  std::vector<Point> seen = points;
  for (Point& p : seen)
    if (std::isfinite(p.error)) p.error = std::max(p.error, told);
  const bool bytes = curve.cost == Cost::bytes;
  curve.front = pareto_front(seen, curve.cost);
  curve.chosen = -1;
  curve.even = false;
  if (curve.front.empty()) return;
  const double reached = std::isfinite(curve.floor) ? least_told(curve) : 0;
  std::vector<int> all, good, untold;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts(points[i], curve.cost)) continue;
    all.push_back(static_cast<int>(i));
    if (points[i].error <= reached) good.push_back(static_cast<int>(i));
    if (told > 0 && points[i].error <= told) untold.push_back(static_cast<int>(i));
    least = std::min(least, seen[i].error), most = std::max(most, seen[i].error);
  }
  const auto cheap_enough = [&](int i, const std::string& level) {
    const std::string error = number_text(points[i].error);
    if (bytes)
      return fmt::format(
          "Of those whose error is not above {}, it has the fewest bytes, with an error of {}: to go below takes more and gains nothing "
          "that can be told.",
          level, error);
    return fmt::format("It is the cheapest whose error, {}, is not above {}: to go below costs more and gains nothing that can be told.",
                       error, level);
  };
  const std::string told_words = curve.told_name + ", " + number_text(told);
  if (points.size() == 1) {
    curve.chosen = curve.front.front();
    curve.why = fmt::format("There is one setting; its error is {}.", number_text(points[0].error));
  } else if (most <= least) {
    const int now = curve.current, least_cost = cheapest(seen, all, curve.cost);
    // the first as listed of those that noise cannot tell apart
    const int best = *std::find_if(all.begin(), all.end(), [&](int i) { return alike(points[i], points[least_cost], curve.cost); });
    curve.chosen = now >= 0 && alike(points[now], points[best], curve.cost) ? now : best;
    curve.even = curve.chosen == now;
    curve.why = fmt::format(
        "{}{}.", untold.empty() ? "No setting changes the error here, " + number_text(least) : "No setting errs by more than " + told_words,
        curve.even ? ", so that what the scene has may stay"
        : bytes    ? ", so that the one of the fewest bytes will do"
                   : ", so that the cheapest will do");
  } else if (curve.front.size() == 1) {
    curve.chosen = curve.front.front();
    curve.why = fmt::format("It {} the most exact at once{}.", bytes ? "has the fewest bytes and is" : "is the cheapest and",
                            untold.empty() ? "" : ", as far as can be told");
  } else if (reached > 0 && !good.empty()) {
    curve.chosen = cheapest(points, good, curve.cost);
    curve.why = cheap_enough(curve.chosen, curve.floor >= reached ? floor_words(curve) : told_words);
  } else {
    const int bend = knee(seen, curve.front, curve.cost);
    const bool keeps = bend < 0 && std::find(curve.front.begin(), curve.front.end(), curve.current) != curve.front.end();
    curve.chosen = bend >= 0 ? bend : keeps ? curve.current : curve.front.back();
    curve.even = keeps;
    const Point& p = points[curve.chosen];
    const auto seen_error = [&](int i) { return seen[static_cast<std::size_t>(i)].error; };
    const std::string none = reached > 0 ? fmt::format("None reaches {}; t", floor_words(curve)) : "T";
    if (keeps) {
      curve.why = fmt::format(
          "Error and cost trade evenly, and no setting stands out: what the scene has is as good as any, with an error of {}. Which one is "
          "needed is for you to say.",
          number_text(p.error));
    } else if (curve.chosen == curve.front.back() && !untold.empty()) {
      curve.chosen = cheapest(points, untold, curve.cost);
      curve.why = cheap_enough(curve.chosen, told_words);
    } else if (curve.chosen == curve.front.back()) {
      curve.why = fmt::format("{}his is the most exact, with an error of {}.", none, number_text(p.error));
    } else {
      const auto at = static_cast<std::size_t>(std::find(curve.front.begin(), curve.front.end(), curve.chosen) - curve.front.begin());
      const Point& next = points[curve.front[at + 1]];
      const double error = seen_error(curve.chosen), next_error = seen_error(curve.front[at + 1]);
      curve.why = fmt::format("{}his is the knee of the front", none);
      if (at > 0) {
        const Point& last = points[curve.front[at - 1]];
        curve.why += fmt::format(": {} {} {:.2g} times {} and has {:.2g} times the error", last.setting, bytes ? "takes" : "costs",
                                 cost_of(p, curve.cost) / cost_of(last, curve.cost), bytes ? "fewer bytes" : "less",
                                 seen_error(curve.front[at - 1]) / error);
      }
      curve.why += fmt::format("{} {} {} {:.2g} times as {} and has {} error.", at > 0 ? ";" : ":", next.setting, bytes ? "takes" : "costs",
                               cost_of(next, curve.cost) / cost_of(p, curve.cost), bytes ? "many bytes" : "much",
                               next_error <= 0             ? "no"
                               : error < 1.05 * next_error ? "hardly less"
                                                           : fmt::format("{:.2g} times less", error / next_error));
      if (next_error <= told && told > 0) curve.why += fmt::format(" Errors below {} cannot be told.", number_text(told));
    }
  }
}

}  // namespace catena::app::tradeoff
