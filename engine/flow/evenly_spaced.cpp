#include "engine/flow/evenly_spaced.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "engine/base/assert.h"

namespace catena::flow {

namespace {

constexpr std::size_t kAtOnce = 16;   ///< candidates traced together
constexpr double kSampleShare = 0.2;  ///< of the test distance: spacing of a line's samples

struct Sample {
  Vec3 p{0.0};
  double s = 0;
};

/// The samples of all lines, in cubes of one distance.
class Neighbours {
 public:
  explicit Neighbours(double distance) : distance_(distance) {}

  void add(const Sample& sample) { cubes_[key(cube(sample.p))].push_back(sample); }

  /// Is a sample that counts nearer to p than d <= distance?
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

/// Walks from the seed, `sign` of s, as far as the line keeps its distance. Adds nothing to the neighbours.
double reach(const Curve& curve, double sign, double d_test, const Neighbours& neighbours, std::vector<Sample>& own,
             Neighbours& own_neighbours) {
  const double end = sign > 0 ? curve.knots().back().s : -curve.knots().front().s, step = kSampleShare * d_test;
  double kept = 0;
  for (double s = step;; s += step) {
    const double at = std::min(s, end);
    const Vec3 p = curve.position(sign * at);
    if (neighbours.near(p, d_test, [](const Sample&) { return true; })) return kept;
    // itself, where it comes back
    const auto comes_back = [&](const Sample& sample) {
      const double way = std::fabs(sample.s - sign * at), round = curve.closed() ? curve.period() - way : way;
      return std::min(way, round) > 2 * d_test;
    };
    if (own_neighbours.near(p, d_test, comes_back)) return kept;
    own.push_back({p, sign * at});
    own_neighbours.add(own.back());
    kept = at;
    if (s >= end) return kept;
  }
}

}  // namespace

CurvePtr part_of(const Curve& curve, double s0, double s1) {
  const auto& knots = curve.knots();
  CATENA_ASSERT(s0 < s1 && s0 >= knots.front().s && s1 <= knots.back().s);
  const auto knot_at = [&](double s) {
    Knot knot{s, Vec3(0.0), Vec3(0.0)};
    Vec3 derivative;
    curve.evaluate_in(curve.interval_of(s), s, knot.p, derivative);
    knot.t = direction(derivative);
    return knot;
  };
  const double least = 1e-10 * curve.domain_length();
  const bool from_start = s0 - knots.front().s <= least, to_end = knots.back().s - s1 <= least;
  if (from_start && to_end) return std::make_shared<const Curve>(curve);
  std::vector<Knot> part{from_start ? knots.front() : knot_at(s0)};
  for (const Knot& knot : knots)
    if (knot.s > s0 + least && knot.s < s1 - least) part.push_back(knot);
  part.push_back(to_end ? knots.back() : knot_at(s1));
  const bool cut = curve.closed();
  return std::make_shared<const Curve>(std::move(part), false, from_start && !cut ? curve.first_end() : LineEnd{},
                                       to_end && !cut ? curve.last_end() : LineEnd{}, curve.domain_length());
}

std::vector<CurvePtr> evenly_spaced(const Flow& flow, const EvenlySpaced& spacing, const BatchOptions& options) {
  CATENA_ASSERT(spacing.distance > 0 && spacing.test > 0 && spacing.test <= 1);
  const BatchTracer tracer(flow, options);
  const double d_sep = spacing.distance, d_test = spacing.test * d_sep;
  Neighbours neighbours(d_sep);
  std::vector<CurvePtr> lines;
  const auto is_free = [&](const Vec3& p) { return !neighbours.near(p, d_sep * (1 - 1e-9), [](const Sample&) { return true; }); };

  // traces the candidates together, takes them in their order
  std::vector<Vec3> candidates;
  const auto take = [&] {
    const auto traced = tracer.trace(candidates);
    for (std::size_t i = 0; i < candidates.size() && lines.size() < spacing.most_lines; ++i) {
      if (!traced[i] || !is_free(candidates[i])) continue;
      const Curve& curve = **traced[i];
      std::vector<Sample> own{{candidates[i], 0}};
      Neighbours own_neighbours(d_sep);
      own_neighbours.add(own.front());
      const double ahead = reach(curve, 1, d_test, neighbours, own, own_neighbours);
      const bool whole = curve.closed() && ahead >= curve.period();
      const double behind = curve.closed() ? 0 : reach(curve, -1, d_test, neighbours, own, own_neighbours);
      if (ahead + behind < d_sep) continue;
      lines.push_back(whole ? *traced[i] : part_of(curve, -behind, ahead));
      for (const Sample& sample : own) neighbours.add(sample);
    }
    candidates.clear();
  };

  for (const Vec3& start : spacing.start) {
    candidates.assign(1, start);
    take();
  }
  field::Cursor cursor;
  for (std::size_t next = 0; next < lines.size() && lines.size() < spacing.most_lines; ++next) {
    const CurvePtr line = lines[next];
    const double s0 = line->knots().front().s, s1 = line->knots().back().s;
    const int places = std::max(1, static_cast<int>((s1 - s0) / d_sep));
    for (int i = 0; i <= places; ++i) {
      const double s = s0 + (s1 - s0) * i / places;
      Vec3 p, t;
      line->evaluate_in(line->interval_of(s), s, p, t);
      t = direction(t);
      const Vec3 a = direction(cross(t, std::fabs(t.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))), b = cross(t, a);
      for (const Vec3& side : {a, b, -a, -b}) {
        const Vec3 candidate = p + d_sep * side;
        if (!flow.field->sample(candidate, cursor).inside || !is_free(candidate)) continue;
        const auto crowds = [&](const Vec3& other) { return norm(other - candidate) < d_sep; };
        if (std::any_of(candidates.begin(), candidates.end(), crowds)) continue;
        candidates.push_back(candidate);
        if (candidates.size() == kAtOnce) take();
      }
    }
    take();
  }
  return lines;
}

}  // namespace catena::flow
