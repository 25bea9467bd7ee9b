#include "render/extract/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/result.h"

namespace catena::render {

namespace {

constexpr double kChordShare = 0.02;  // chord error by the radius
constexpr double kLargestTurn = 0.2;  // radians a segment

/// The largest |p''| on a Hermite interval: p'' is linear in s, so it is at one of the ends.
double curvature_bound(const flow::Knot& a, const flow::Knot& b, double radius) {
  const double h = b.s - a.s;
  if (!(h > 0)) return 0;
  // on a tiny interval the positions' rounding would count, the tangents' does not
  if (h < 1e-3 * radius) return 2 * norm(b.t - a.t) / h;
  const Vec3 chord = (6 / (h * h)) * (b.p - a.p);
  return std::max(norm(chord - (1 / h) * (4.0 * a.t + 2.0 * b.t)), norm((1 / h) * (2.0 * a.t + 4.0 * b.t) - chord));
}

/// |chord error| <= d^2 / 8 max|p''|,  turn <= d max|p''|
double longest_step(double bound, const FlattenOptions& options, double coarsen) {
  const double longest = options.longest > 0 ? options.longest : std::numeric_limits<double>::infinity();
  if (!(bound > 0)) return coarsen * longest;
  return coarsen * std::min(std::min(std::sqrt(8 * kChordShare * options.radius / bound), kLargestTurn / bound), longest);
}

}  // namespace

std::vector<FlatPoint> flatten_places(const flow::Curve& curve, const FlattenOptions& options) {
  const std::vector<flow::Knot>& knots = curve.knots();
  CATENA_ASSERT(knots.size() >= 2 && options.radius > 0 && options.most_points >= 2);
  std::vector<double> bounds(knots.size(), 0.0);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) bounds[k] = curvature_bound(knots[k], knots[k + 1], options.radius);

  std::vector<FlatPoint> points;
  for (double coarsen = 1;; coarsen *= 2) {
    points.assign(1, {knots.front().p, knots.front().s});
    double from = knots.front().s, bound = 0;
    bool fits = true;
    for (std::size_t k = 0; k + 1 < knots.size() && fits;) {
      // this interval's curvature joins the segment, or ends it at the knot
      const bool at_start = from >= knots[k].s;
      const double with = at_start ? bounds[k] : std::max(bound, bounds[k]);
      const double reach = from + longest_step(with, options, coarsen);
      if (!at_start && reach <= knots[k].s) {
        points.push_back({knots[k].p, knots[k].s});
        from = knots[k].s;
      } else if (reach < knots[k + 1].s) {
        Vec3 p, derivative;
        curve.evaluate_in(k, reach, p, derivative);
        points.push_back({p, reach});
        if (!(reach > from)) return points;  // below the resolution of s
        from = reach;
      } else {
        bound = with;
        ++k;
      }
      fits = points.size() < options.most_points;
    }
    if (fits) break;
  }
  points.push_back({curve.closed() ? points.front().p : knots.back().p, knots.back().s});
  return points;
}

std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options) {
  std::vector<Vec3> points;
  for (const FlatPoint& point : flatten_places(curve, options)) points.push_back(point.p);
  return points;
}

}  // namespace catena::render
