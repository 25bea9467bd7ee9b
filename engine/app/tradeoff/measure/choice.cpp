#include "engine/app/tradeoff/measure/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

void choose(Curve& curve) {
  curve.front = pareto_front(curve.points, curve.cost);
  curve.chosen = -1;
  if (curve.front.empty()) return;
  const std::vector<Point>& points = curve.points;
  const double reached = std::isfinite(curve.floor) ? least_told(curve) : 0;
  std::vector<int> good;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(points[i], curve.cost) && points[i].error <= reached) good.push_back(static_cast<int>(i));
  std::vector<int> all;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts(points[i], curve.cost)) continue;
    all.push_back(static_cast<int>(i));
    least = std::min(least, points[i].error), most = std::max(most, points[i].error);
  }
  if (points.size() == 1) {
    curve.chosen = curve.front.front();
    curve.why = fmt::format("There is one setting; its error is {:.2g}.", points[0].error);
  } else if (most <= least) {
    const int now = curve.current, least_cost = cheapest(points, all, curve.cost);
    // the first as listed of those that noise cannot tell apart
    const int best = *std::find_if(all.begin(), all.end(), [&](int i) { return alike(points[i], points[least_cost], curve.cost); });
    curve.chosen = now >= 0 && alike(points[now], points[best], curve.cost) ? now : best;
    curve.why = fmt::format("No setting changes the error here, {:.2g}{}.", least,
                            now == curve.chosen ? ", so that what the scene has may stay" : ", so that the cheapest will do");
  } else if (curve.front.size() == 1) {
    curve.chosen = curve.front.front();
    curve.why = "It is the cheapest and the most exact at once.";
  } else if (reached > 0 && !good.empty()) {
    curve.chosen = cheapest(points, good, curve.cost);
    const Point& p = points[curve.chosen];
    curve.why = fmt::format(
        "It is the cheapest whose error, {:.2g}, is not above {}, {:.2g}: to go below costs more and gains nothing that can be told.",
        p.error, curve.floor >= reached ? curve.floor_name : "what the reference can tell", reached);
  } else {
    const int bend = knee(points, curve.front, curve.cost);
    const bool keeps = bend < 0 && std::find(curve.front.begin(), curve.front.end(), curve.current) != curve.front.end();
    curve.chosen = bend >= 0 ? bend : keeps ? curve.current : curve.front.back();
    const Point& p = points[curve.chosen];
    const std::string none = reached > 0 ? fmt::format("None reaches {}, {:.2g}; t", curve.floor_name, reached) : "T";
    if (keeps) {
      curve.why = fmt::format(
          "Error and cost trade evenly, and no setting stands out: what the scene has is as good as any, with an error of {:.2g}. Which "
          "one is "
          "needed is for you to say.",
          p.error);
    } else if (curve.chosen == curve.front.back()) {
      curve.why = fmt::format("{}his is the most exact, with an error of {:.2g}.", none, p.error);
    } else {
      const auto at = static_cast<std::size_t>(std::find(curve.front.begin(), curve.front.end(), curve.chosen) - curve.front.begin());
      const Point& next = points[curve.front[at + 1]];
      curve.why = fmt::format("{}his is the knee of the front", none);
      if (at > 0) {
        const Point& last = points[curve.front[at - 1]];
        curve.why += fmt::format(": {} costs {:.2g} times less and has {:.2g} times the error", last.setting,
                                 cost_of(p, curve.cost) / cost_of(last, curve.cost), last.error / p.error);
      }
      curve.why += fmt::format("{} {} costs {:.2g} times as much and has {} error.", at > 0 ? ";" : ":", next.setting,
                               cost_of(next, curve.cost) / cost_of(p, curve.cost),
                               next.error > 0 ? fmt::format("{:.2g} times less", p.error / next.error) : "no");
      if (p.error <= curve.reference_error)
        curve.why += fmt::format(" What is below {:.2g}, the error of the reference, cannot be told.", curve.reference_error);
    }
  }
}

}  // namespace catena::app::tradeoff
