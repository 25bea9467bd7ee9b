// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/seeds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "engine/base/result.h"
#include "engine/geometry/flow/curve.h"

namespace catena::flow {

namespace {

constexpr double kPi = std::numbers::pi;
const double kGoldenAngle = kPi * (3 - std::sqrt(5.0));

double parameter_of(int i, int count) { return count > 1 ? static_cast<double>(i) / (count - 1) : 0.5; }

double fraction(double x) { return x - std::floor(x); }

Vec3 on_unit_sphere(double a, double b) {
  const double z = 2 * a - 1, r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * kPi * b;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Computes the interval [first, last] (parameters 0 to 1 between the end points) of a segment that lies in the box of the domain, in
/// index coordinates; returns false if it is empty.
bool clip(const field::Box& box, const Vec3& from, const Vec3& to, double& first, double& last) {
  first = 0;
  last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double delta = to[axis] - from[axis];
    if (delta == 0) {
      if (from[axis] < box.lo[axis] || from[axis] > box.hi[axis]) return false;
      continue;
    }
    double a = (box.lo[axis] - from[axis]) / delta, b = (box.hi[axis] - from[axis]) / delta;
    if (a > b) std::swap(a, b);
    first = std::max(first, a);
    last = std::min(last, b);
  }
  return first < last;
}

}  // namespace

std::vector<Vec3> seeds_on_line(const Vec3& from, const Vec3& to, int count) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double t = parameter_of(i, count);
    seeds.push_back((1 - t) * from + t * to);
  }
  return seeds;
}

std::vector<Vec3> seeds_on_plane(const Vec3& origin, const Vec3& u, const Vec3& v, int count_u, int count_v) {
  std::vector<Vec3> seeds;
  for (int j = 0; j < count_v; ++j)
    for (int i = 0; i < count_u; ++i) seeds.push_back(origin + parameter_of(i, count_u) * u + parameter_of(j, count_v) * v);
  return seeds;
}

std::vector<Vec3> seeds_on_sphere(const Vec3& centre, double radius, int count, bool inside) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count;
    // in the ball the radius must not correlate with the height: a sequence of another irrational number determines it
    const double r = inside ? radius * std::cbrt(fraction(0.5 + i * 0.7548776662466927)) : radius;
    seeds.push_back(centre + r * on_unit_sphere(at, fraction(i * kGoldenAngle / (2 * kPi))));
  }
  return seeds;
}

std::vector<Vec3> seeds_on_isosurface(const field::ScalarField& field, double level, int count) {
  // bounding sphere of the domain
  const field::Box& box = field.index_box();
  const field::Mapping& mapping = field.mapping();
  const Vec3 centre = mapping.world_from_index(0.5 * (box.lo + box.hi));
  double radius = 0;
  for (int c = 0; c < 8; ++c) radius = std::max(radius, norm(field.corner(c) - centre));
  const double step = field.is_grid() ? 0.5 * mapping.min_voxel_edge() : field.domain_length() / 128;

  std::vector<Vec3> seeds;
  field::Cursor cursor;
  const long most_lines = std::max(4096L, 64L * count);
  for (long n = 1; n <= most_lines && static_cast<int>(seeds.size()) < count; ++n) {
    const double line_number = static_cast<double>(n);
    const Vec3 from =
        centre + radius * on_unit_sphere(fraction(line_number * 0.8566748838545029), fraction(line_number * 0.7338918566271260));
    const Vec3 to =
        centre + radius * on_unit_sphere(fraction(line_number * 0.6287067210378087), fraction(line_number * 0.5385972572236101));
    double first, last;
    if (!clip(box, mapping.index_from_world(from), mapping.index_from_world(to), first, last)) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil((last - first) * norm(to - from) / step)));
    const auto point_at = [&](double t) { return (1 - t) * from + t * to; };
    double t_before = first;
    field::ScalarSample previous = field.sample(point_at(first), cursor);
    for (int i = 1; i <= steps && static_cast<int>(seeds.size()) < count; ++i) {
      const double t = first + (last - first) * i / steps;
      const field::ScalarSample current = field.sample(point_at(t), cursor);
      const double a = previous.value - level, b = current.value - level;
      if (previous.inside && current.inside && std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0))
        seeds.push_back(
            point_at(illinois_root(t_before, a, t, b, [&](double at) { return field.sample(point_at(at), cursor).value - level; })));
      previous = current;
      t_before = t;
    }
  }
  return seeds;
}

namespace {

constexpr std::size_t kAtOnce = 16;   ///< candidates traced together
constexpr double kSampleShare = 0.2;  ///< spacing of a line's samples, as a fraction of the test distance

struct Sample {
  Vec3 p{0.0};
  double s = 0;
};

/// Samples of all lines, hashed into cubes whose edge is the separation distance.
class Neighbours {
 public:
  explicit Neighbours(double distance) : distance_(distance) {}

  void add(const Sample& sample) { cubes_[key(cube(sample.p))].push_back(sample); }

  /// Returns true if a sample accepted by `counts` is nearer to p than d; d must not exceed `distance`.
  template <class Counts>
  bool near(const Vec3& p, double d, Counts&& counts) const {
    const Vec3 middle = cube(p);
    for (int n = 0; n < 27; ++n) {
      const auto found = cubes_.find(key(middle + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (found == cubes_.end()) continue;
      for (const Sample& sample : found->second)
        if (dot(sample.p - p, sample.p - p) < d * d && counts(sample)) return true;
    }
    return false;
  }

 private:
  Vec3 cube(const Vec3& p) const { return {std::floor(p.x / distance_), std::floor(p.y / distance_), std::floor(p.z / distance_)}; }
  static std::uint64_t key(const Vec3& c) {
    const auto part = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)) & 0x1fffff; };
    return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
  }

  double distance_;
  std::unordered_map<std::uint64_t, std::vector<Sample>> cubes_;
};

/// Returns the arc length from the seed in the direction `sign` of s up to which the line keeps its distance from others and itself. Adds
/// the samples to `own_samples` and `own_neighbours`, not to `neighbours`.
double free_length(const Curve& curve, double sign, double d_test, const Neighbours& neighbours, std::vector<Sample>& own_samples,
                   Neighbours& own_neighbours) {
  const double end = sign > 0 ? curve.knots().back().s : -curve.knots().front().s, step = kSampleShare * d_test;
  double reached = 0;
  for (double s = step;; s += step) {
    const double at = std::min(s, end);
    const Vec3 p = curve.position(sign * at);
    if (neighbours.near(p, d_test, [](const Sample&) { return true; })) return reached;
    // samples of the same line count if it returns to them: along the line they must be more than 2 * d_test away
    const auto returns_here = [&](const Sample& sample) {
      const double difference = std::fabs(sample.s - sign * at), round = curve.is_closed() ? curve.period() - difference : difference;
      return std::min(difference, round) > 2 * d_test;
    };
    if (own_neighbours.near(p, d_test, returns_here)) return reached;
    own_samples.push_back({p, sign * at});
    own_neighbours.add(own_samples.back());
    reached = at;
    if (s >= end) return reached;
  }
}

}  // namespace

CurvePtr extract_subcurve(const Curve& curve, double s0, double s1) {
  const auto& knots = curve.knots();
  CATENA_ASSERT(s0 < s1 && s0 >= knots.front().s && s1 <= knots.back().s);
  const auto knot_at = [&](double s) {
    Knot knot{s, Vec3(0.0), Vec3(0.0)};
    Vec3 derivative;
    curve.evaluate_interval(curve.find_interval(s), s, knot.p, derivative);
    knot.t = direction(derivative);
    return knot;
  };
  const double tolerance = 1e-10 * curve.domain_length();
  const bool from_start = s0 - knots.front().s <= tolerance, to_end = knots.back().s - s1 <= tolerance;
  if (from_start && to_end) return std::make_shared<const Curve>(curve);
  std::vector<Knot> part{from_start ? knots.front() : knot_at(s0)};
  for (const Knot& knot : knots)
    if (knot.s > s0 + tolerance && knot.s < s1 - tolerance) part.push_back(knot);
  part.push_back(to_end ? knots.back() : knot_at(s1));
  const bool cut = curve.is_closed();
  return std::make_shared<const Curve>(std::move(part), false, from_start && !cut ? curve.first_end() : LineEnd{},
                                       to_end && !cut ? curve.last_end() : LineEnd{}, curve.domain_length());
}

std::vector<CurvePtr> trace_evenly_spaced(const Flow& flow, const EvenSpacingOptions& spacing, const BatchOptions& options) {
  CATENA_ASSERT(spacing.distance > 0 && spacing.termination_ratio > 0 && spacing.termination_ratio <= 1);
  const BatchTracer tracer(flow, options);
  const double d_sep = spacing.distance, d_test = spacing.termination_ratio * d_sep;
  Neighbours neighbours(d_sep);
  std::vector<CurvePtr> lines;
  const auto is_free = [&](const Vec3& p) { return !neighbours.near(p, d_sep * (1 - 1e-9), [](const Sample&) { return true; }); };

  // traces the candidates together and accepts them in their order
  std::vector<Vec3> candidates;
  const auto accept_candidates = [&] {
    const auto traced = tracer.trace(candidates);
    for (std::size_t i = 0; i < candidates.size() && lines.size() < spacing.max_lines; ++i) {
      if (!traced[i] || !is_free(candidates[i])) continue;
      const Curve& curve = **traced[i];
      std::vector<Sample> own_samples{{candidates[i], 0}};
      Neighbours own_neighbours(d_sep);
      own_neighbours.add(own_samples.front());
      const double forward_length = free_length(curve, 1, d_test, neighbours, own_samples, own_neighbours);
      const bool is_complete = curve.is_closed() && forward_length >= curve.period();
      const double backward_length = curve.is_closed() ? 0 : free_length(curve, -1, d_test, neighbours, own_samples, own_neighbours);
      if (forward_length + backward_length < d_sep) continue;
      lines.push_back(is_complete ? *traced[i] : extract_subcurve(curve, -backward_length, forward_length));
      for (const Sample& sample : own_samples) neighbours.add(sample);
    }
    candidates.clear();
  };

  for (const Vec3& start : spacing.start_points) {
    candidates.assign(1, start);
    accept_candidates();
  }
  field::Cursor cursor;
  for (std::size_t next = 0; next < lines.size() && lines.size() < spacing.max_lines; ++next) {
    const CurvePtr line = lines[next];
    const double s0 = line->knots().front().s, s1 = line->knots().back().s;
    const int intervals = std::max(1, static_cast<int>((s1 - s0) / d_sep));
    for (int i = 0; i <= intervals; ++i) {
      const double s = s0 + (s1 - s0) * i / intervals;
      Vec3 p, t;
      line->evaluate_interval(line->find_interval(s), s, p, t);
      t = direction(t);
      const Vec3 a = direction(cross(t, std::fabs(t.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))), b = cross(t, a);
      for (const Vec3& side : {a, b, -a, -b}) {
        const Vec3 candidate = p + d_sep * side;
        if (!flow.field->sample(candidate, cursor).inside || !is_free(candidate)) continue;
        const auto crowds = [&](const Vec3& other) { return norm(other - candidate) < d_sep; };
        if (std::any_of(candidates.begin(), candidates.end(), crowds)) continue;
        candidates.push_back(candidate);
        if (candidates.size() == kAtOnce) accept_candidates();
      }
    }
    accept_candidates();
  }
  return lines;
}

}  // namespace catena::flow
