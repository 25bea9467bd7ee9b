// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/curve.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/result.h"

namespace catena::flow {

const char* to_string(Termination end) {
  switch (end) {
    case Termination::boundary:
      return "BOUNDARY";
    case Termination::critical:
      return "CRITICAL";
    case Termination::length:
      return "LENGTH";
    case Termination::lap:
      return "LAP";
    case Termination::incoherent:
      return "INCOHERENT";
    case Termination::time:
      return "TIME";
  }
  return "LENGTH";
}

double Hermite::foot(const Vec3& x, double g0, double g1) const noexcept {
  if (g0 == 0) return 0;
  if (g1 == 0) return 1;
  const Vec3 e = x - c0;
  const std::array<double, 6> g{
      dot(e, c1),      2 * dot(e, c2) - dot(c1, c1), 3 * (dot(e, c3) - dot(c1, c2)), -4 * dot(c1, c3) - 2 * dot(c2, c2), -5 * dot(c2, c3),
      -3 * dot(c3, c3)};
  double size = 0;
  for (const double term : g) size += std::fabs(term);
  const double rounding = std::numeric_limits<double>::epsilon() * size;
  double lo = 0, hi = 1, theta = g0 / (g0 - g1), last = 1;
  for (int i = 0; i < 64; ++i) {
    if (!(theta > lo && theta < hi)) theta = 0.5 * (lo + hi);
    const double value = g[0] + theta * (g[1] + theta * (g[2] + theta * (g[3] + theta * (g[4] + theta * g[5]))));
    if (std::fabs(value) <= rounding) break;
    ((value > 0) == (g0 > 0) ? lo : hi) = theta;
    const double slope = g[1] + theta * (2 * g[2] + theta * (3 * g[3] + theta * (4 * g[4] + theta * 5 * g[5])));
    double step = -value / slope;
    if (!(std::fabs(step) <= 0.5 * last)) step = 0.5 * (lo + hi) - theta;
    last = std::fabs(step);
    if (theta + step == theta) break;
    theta += step;
  }
  return theta;
}

double Hermite::length() const noexcept {
  constexpr double abscissae[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double weights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  double sum = weights[0] * norm(derivative(0.5));
  for (int i = 1; i < 3; ++i) sum += weights[i] * (norm(derivative(0.5 - 0.5 * abscissae[i])) + norm(derivative(0.5 + 0.5 * abscissae[i])));
  return 0.5 * sum;
}

Curve::Curve(std::vector<Knot> knots, bool closed, LineEnd first_end, LineEnd last_end, double domain_length, std::vector<double> times)
    : knots_(std::move(knots)),
      closed_(closed),
      first_end_(first_end),
      last_end_(last_end),
      domain_length_(domain_length),
      times_(std::move(times)) {
  CATENA_ASSERT(knots_.size() >= 2 && (times_.empty() || times_.size() == knots_.size()));
  for (std::size_t k = 1; k < knots_.size(); ++k) CATENA_ASSERT(knots_[k].s > knots_[k - 1].s);
}

void Curve::evaluate_interval(std::size_t k, double s, Vec3& p, Vec3& derivative) const noexcept {
  const Knot &a = knots_[k], &b = knots_[k + 1];
  const double h = b.s - a.s;
  const Hermite hermite(a.p, a.vector_to(b), h, a.t, b.t);
  const double theta = (s - a.s) / h;
  p = theta == 1 ? b.p : hermite.evaluate(theta);
  derivative = theta == 1 ? b.t : hermite.derivative(theta) / h;
}

std::size_t Curve::find_interval(double s) const noexcept {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s, [](double value, const Knot& knot) { return value < knot.s; });
  const auto index = after - knots_.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index - 1, 0, static_cast<std::ptrdiff_t>(knots_.size()) - 2));
}

double Curve::time(double s) const noexcept {
  const std::size_t k = find_interval(s);
  const double theta = std::clamp((s - knots_[k].s) / (knots_[k + 1].s - knots_[k].s), 0.0, 1.0);
  return times_[k] + theta * (times_[k + 1] - times_[k]);
}

Vec3 Curve::position(double s) const noexcept {
  const double lo = knots_.front().s, hi = knots_.back().s;
  if (closed_ && (s < lo || s > hi)) s -= period() * std::floor((s - lo) / period());
  s = std::clamp(s, lo, hi);
  Vec3 p, derivative;
  evaluate_interval(find_interval(s), s, p, derivative);
  return p;
}

namespace {

constexpr std::uint32_t kLeaf = 4;
constexpr std::size_t kDepth = 48;

double distance2_to_box(const Vec3& x, const Vec3& lo, const Vec3& hi) noexcept {
  Vec3 d;
  for (int a = 0; a < 3; ++a) d[a] = std::max(0.0, std::max(lo[a] - x[a], x[a] - hi[a]));
  return dot(d, d);
}

}  // namespace

NearestOnCurve::NearestOnCurve(std::vector<CurvePtr> curves) : curves_(std::move(curves)) {
  CATENA_ASSERT(!curves_.empty());
  std::size_t intervals = curves_.size();
  std::vector<std::uint32_t> lines;
  for (const CurvePtr& curve : curves_) {
    intervals += curve->knots().size() - 1;
    lines.push_back(static_cast<std::uint32_t>(lines.size()));
  }
  nodes_.reserve(intervals);
  build_node(lines, 0, lines.size());
}

/// Builds the subtree of several curves: they are split at the median of the midpoints of their ends, along the longest axis of these.
void NearestOnCurve::build_node(std::vector<std::uint32_t>& lines, std::size_t begin, std::size_t end) {
  if (end - begin == 1) {
    build_node(lines[begin], 0, static_cast<std::uint32_t>(curves_[lines[begin]]->knots().size() - 1));
    return;
  }
  const auto middle = [&](std::uint32_t k) { return 0.5 * (curves_[k]->knots().front().p + curves_[k]->knots().back().p); };
  Vec3 lo = middle(lines[begin]), hi = lo;
  for (std::size_t k = begin; k < end; ++k) {
    lo = glm::min(lo, middle(lines[k]));
    hi = glm::max(hi, middle(lines[k]));
  }
  const Vec3 edge = hi - lo;
  const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t k) { return lines.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) { return middle(a)[axis] < middle(b)[axis]; });
  const auto me = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity())});
  build_node(lines, begin, half);
  const auto right = static_cast<std::uint32_t>(nodes_.size());
  build_node(lines, half, end);
  enclose_children(me, right);
}

/// Sets the box of a node to enclose its two children: the first one is the next node, the second one is `right`.
void NearestOnCurve::enclose_children(std::uint32_t parent, std::uint32_t right) {
  Node& node = nodes_[parent];
  node.right = right;
  for (const std::uint32_t child : {parent + 1, right}) {
    node.lo = glm::min(node.lo, nodes_[child].lo);
    node.hi = glm::max(node.hi, nodes_[child].hi);
  }
}

std::uint32_t NearestOnCurve::build_node(std::uint32_t line, std::uint32_t first, std::uint32_t count) {
  const auto me = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity()), line, first, count, 0});
  if (count > kLeaf) {
    const std::uint32_t half = count / 2;
    build_node(line, first, half);
    enclose_children(me, build_node(line, first + half, count - half));
    return me;
  }
  Node& node = nodes_[me];
  for (std::uint32_t k = first; k < first + count; ++k) {
    const Knot &a = curves_[line]->knots()[k], &b = curves_[line]->knots()[k + 1];
    const double third = (b.s - a.s) / 3;
    for (const Vec3& corner : {a.p, a.p + third * a.t, b.p - third * b.t, b.p})
      for (int axis = 0; axis < 3; ++axis) {
        node.lo[axis] = std::min(node.lo[axis], corner[axis]);
        node.hi[axis] = std::max(node.hi[axis], corner[axis]);
      }
  }
  return me;
}

void NearestOnCurve::test_interval(std::size_t line, std::size_t k, const Vec3& x, NearestPoint& best) const noexcept {
  const Knot &a = curves_[line]->knots()[k], &b = curves_[line]->knots()[k + 1];
  const double h = b.s - a.s, below = dot(a.vector_to(x), a.t), above = dot(b.vector_to(x), b.t);
  const auto update_best = [&](double s, const Vec3& p) {
    const Vec3 e = x - p;
    if (!(dot(e, e) < best.distance2)) return;
    best.line = line;
    best.interval = k;
    best.s = s;
    best.distance2 = dot(e, e);
  };
  update_best(a.s, a.p);
  update_best(b.s, b.p);
  if (!(below >= 0 && above <= 0)) return;
  const Hermite piece(a.p, a.vector_to(b), h, a.t, b.t);
  const double theta = piece.foot(x, below * h, above * h);
  update_best(theta >= 1 ? b.s : a.s + theta * h, theta >= 1 ? b.p : piece.evaluate(theta));
}

NearestPoint NearestOnCurve::search(const Vec3& x, int max_work, double within) const noexcept {
  NearestPoint best;
  best.distance2 = within * within;
  best.s = curves_.front()->knots().front().s;
  struct Waiting {
    std::uint32_t node;
    double distance2;
  };
  std::array<Waiting, kDepth> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0};
  while (count > 0 && best.work < max_work) {
    const Waiting next = waiting[--count];
    if (!(next.distance2 < best.distance2)) continue;
    const Node& node = nodes_[next.node];
    ++best.work;
    if (node.right == 0) {
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k, ++best.work) test_interval(node.line, k, x, best);
      continue;
    }
    Waiting near{next.node + 1, distance2_to_box(x, nodes_[next.node + 1].lo, nodes_[next.node + 1].hi)};
    Waiting far{node.right, distance2_to_box(x, nodes_[node.right].lo, nodes_[node.right].hi)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (count + 2 > kDepth) break;
    waiting[count++] = far;
    waiting[count++] = near;
  }
  if (best.distance2 >= within * within) best.distance2 = std::numeric_limits<double>::infinity();
  return best;
}

}  // namespace catena::flow
