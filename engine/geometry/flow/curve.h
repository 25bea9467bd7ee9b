// SPDX-License-Identifier: MIT
/// Streamlines as arc-length curves: the cubic between two knots, the traced curve, and its point nearest to a query point.
/// Any thread; functions for the haptic thread are noexcept and neither allocate nor lock.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/sample_status.h"
#include "engine/base/vec.h"
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

/// Finds a bracketed root by the Illinois method, bounded and bitwise repeatable: f(a) and f(b) have opposite signs (or one is 0).
template <class F>
double illinois_root(double a, double fa, double b, double fb, F&& f) noexcept {
  if (fa == 0) return a;
  if (fb == 0) return b;
  double best = std::fabs(fa) < std::fabs(fb) ? a : b, last = best;
  for (int i = 0; i < 64; ++i) {
    double m = a + (b - a) * (fa / (fa - fb));
    if (i > 32 || !(m > std::fmin(a, b) && m < std::fmax(a, b))) m = 0.5 * (a + b);
    const double fm = f(m);
    best = m;
    if (fm == 0 || std::fabs(m - last) <= 1e-16 * std::fabs(m) || m == a || m == b) break;
    last = m;
    if ((fm > 0) == (fb > 0)) {
      b = m;
      fb = fm;
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
      b = m;
      fb = fm;
    }
  }
  return best;
}

/// Cubic Hermite polynomial of one step, from position and rate at both ends: c(theta), theta in [0, 1]; exact at theta = 0. Does not
/// allocate, lock or throw.
struct CATENA_EXPORT Hermite {
  Vec3 c0, c1, c2, c3;  ///< Coefficients of 1, theta, theta^2, theta^3; world units.

  /// Builds the cubic from q to q + displacement for a step of length h with rates w0 and w1 at its ends.
  Hermite(const Vec3& q, const Vec3& displacement, double h, const Vec3& w0, const Vec3& w1)
      : c0(q), c1(h * w0), c2(3.0 * displacement - 2.0 * c1 - h * w1), c3(c1 + h * w1 - 2.0 * displacement) {}

  /// Position at theta.
  Vec3 evaluate(double theta) const { return c0 + theta * (c1 + theta * (c2 + theta * c3)); }
  Vec3 derivative(double theta) const { return c1 + theta * (2.0 * c2 + theta * (3.0 * c3)); }  ///< Derivative with respect to theta.

  /// Arc length of the piece, by the Gauss-Legendre rule of five points; units of the positions.
  double length() const noexcept;
  /// Returns the theta where g = (x - c).c' = 0, given g(0) and g(1), which have opposite signs (or one is 0): the foot of x on this piece,
  /// up to the rounding of g. Newton's method on the quintic g, with bisection where a step would leave the bracket or hardly moves.
  /// Bounded and bitwise repeatable.
  double foot(const Vec3& x, double g0, double g1) const noexcept;
};

/// A knot of a Curve.
struct Knot {
  double s = 0;  ///< Signed arc length from the seed, world units.
  Vec3 p{0.0};   ///< Position, world units.
  Vec3 t{0.0};   ///< Unit tangent.
  /// Rounding error of p, for grids so far from the origin that it matters; else 0. An interval between two knots may be so short that the
  /// rounding of its ends would change its direction.
  glm::vec3 position_low{0.0f};

  /// Vector from this knot to the position x.
  Vec3 vector_to(const Vec3& x) const { return position_low == glm::vec3(0.0f) ? x - p : x - p - Vec3(position_low); }
  /// Vector from this knot to the next knot.
  Vec3 vector_to(const Knot& next) const {
    return position_low == next.position_low ? next.p - p : next.p - p + (Vec3(next.position_low) - Vec3(position_low));
  }
};

/// Reason for the end of a line: at the domain boundary, at a critical point, at the maximum length, after a lap, in an incoherent cell, or
/// at the end of the time of a path line or streak line.
enum class Termination { boundary, critical, length, lap, incoherent, time };
CATENA_EXPORT const char* to_string(Termination end);  ///< One of BOUNDARY, CRITICAL, LENGTH, LAP, INCOHERENT, TIME.

/// Reason for the end of a line, and the sample status there: boundary (box, mask or not_finite), critical (zero), incoherent, or ok.
struct LineEnd {
  Termination termination;  ///< Reason for the end.
  SampleStatus status;      ///< Status of the sample at the end.
  /// Combines the reason for the end of a line with the sample status there.
  LineEnd(Termination reason = Termination::length, SampleStatus sample_status = SampleStatus::ok)
      : termination(reason), status(sample_status) {}
  bool operator==(const LineEnd&) const = default;
  /// Compares the termination only.
  bool operator==(Termination reason) const { return termination == reason; }
};

/// A streamline as an arc-length curve: knots (s, position, unit tangent) with cubic Hermite dense output between them.
/// The `trace` command writes these knots, the tubes render this object and the selected streamline link moves on it, so that rendering and
/// haptics agree. Arc lengths and positions in world units. Immutable; any thread; reading does not allocate.
class CATENA_EXPORT Curve {
 public:
  /// Creates a curve from at least two knots with increasing s; `closed`: the last knot repeats the position of the first. `times`: empty,
  /// or one per knot.
  Curve(std::vector<Knot> knots, bool closed, LineEnd first_end, LineEnd last_end, double domain_length, std::vector<double> times = {});

  /// All knots, s increasing.
  const std::vector<Knot>& knots() const { return knots_; }
  bool is_closed() const { return closed_; }  ///< The last knot repeats the position of the first; s wraps with period().
  /// Arc length from the first knot to the last, world units.
  double period() const { return knots_.back().s - knots_.front().s; }
  /// End of the line at the smallest s.
  const LineEnd& first_end() const { return first_end_; }
  /// End of the line at the largest s.
  const LineEnd& last_end() const { return last_end_; }
  /// Times of the knots: when the particle of a path line is there, or when that of a streak line was released; empty: a streamline.
  const std::vector<double>& times() const { return times_; }
  /// Time at s, linear between the knots; s clamped to the ends. Not for a streamline.
  double time(double s) const noexcept;
  /// L of the field in which the line was traced, world units.
  double domain_length() const { return domain_length_; }

  /// Evaluates the cubic Hermite of knot interval k: position p and derivative dp/ds at s (world units; s within the interval).
  void evaluate_interval(std::size_t k, double s, Vec3& p, Vec3& derivative) const noexcept;
  Vec3 position(double s) const noexcept;  ///< Clamped to the ends, or wrapped.
  /// Returns the index of the knot interval that contains s, clamped to the first and the last one.
  std::size_t find_interval(double s) const noexcept;

 private:
  std::vector<Knot> knots_;
  bool closed_;
  LineEnd first_end_, last_end_;
  double domain_length_;
  std::vector<double> times_;
};
/// Shared, immutable curve.
using CurvePtr = std::shared_ptr<const Curve>;

/// Accuracy and length limits of trace().
struct TraceOptions {
  double length = 0;                 ///< Maximum arc length in each direction, world units; 0: 10 L.
  double tolerance = 1e-10;          ///< Limit on the embedded error of one step, times L.
  double hermite_tolerance = 1e-11;  ///< Limit on the difference of the Hermite midpoint from a half step, times L.
  std::size_t max_knots = 2000000;   ///< Maximum number of knots, both directions together.
  double max_step = 0;               ///< Maximum step size, world units; 0: two voxels, or a tenth of L.
};

/// Traces both directions from the seed with DP5(4); on grids with knots on cell faces. The line ends at the domain boundary, at a
/// critical point (or at min_speed), where a line field is incoherent, at the maximum length, or after one lap. Returns an Error when the
/// seed is outside the domain, not finite, or at a zero (the caller adds file and line).
CATENA_EXPORT Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options = {});

inline constexpr int kMaxNearestWork = 512;  ///< Maximum number of tree boxes and curve intervals that find() examines.

/// Result of a NearestOnCurve search.
struct NearestPoint {
  std::size_t line = 0;      ///< Index of the curve.
  std::size_t interval = 0;  ///< Index of its knot interval.
  double s = 0;              ///< Arc length, within the interval, world units.
  double distance2 = 0;      ///< Squared distance from the query point, world units^2.
  int work = 0;              ///< Number of boxes and intervals examined.
};

/// Finds the point nearest to a query point on one or several curves, in bounded work: a tree of boxes around runs of knot intervals
/// (around the Bezier hull of each Hermite interval), nearest box first. Stateless, so that the same point gives bitwise equal results. At
/// most kMaxNearestWork boxes and intervals are examined; where many points are almost equally near (the center of a circle) one of them is
/// returned. Built off the haptic thread; queries run on any thread and do not allocate.
class CATENA_EXPORT NearestOnCurve {
 public:
  /// Builds the tree for one curve; off the haptic thread.
  explicit NearestOnCurve(CurvePtr curve) : NearestOnCurve(std::vector<CurvePtr>{std::move(curve)}) {}
  /// Builds the tree for at least one curve; off the haptic thread.
  explicit NearestOnCurve(std::vector<CurvePtr> curves);
  /// Finds the nearest point. |x| <= 1e150, or squares overflow. If no point lies within the distance `within`, the distance is infinite.
  NearestPoint find(const Vec3& x, double within = std::numeric_limits<double>::infinity()) const noexcept {
    return search(x, kMaxNearestWork, within);
  }
  /// Finds the nearest point without a work limit, for measurements: for a long line that winds around itself, the bounded search may
  /// return a point that is not the nearest. Off the haptic thread.
  NearestPoint find_exact(const Vec3& x) const noexcept {
    return search(x, std::numeric_limits<int>::max(), std::numeric_limits<double>::infinity());
  }

 private:
  NearestPoint search(const Vec3& x, int max_candidates, double within) const noexcept;
  struct Node {
    Vec3 lo{0.0}, hi{0.0};
    std::uint32_t line = 0, first = 0, count = 0;  ///< Leaf: curve, first interval and number of intervals.
    std::uint32_t right = 0;                       ///< Second child; 0: a leaf. The first child is the next node.
  };
  void build_node(std::vector<std::uint32_t>& lines, std::size_t begin, std::size_t end);
  std::uint32_t build_node(std::uint32_t line, std::uint32_t first, std::uint32_t count);
  void enclose_children(std::uint32_t parent, std::uint32_t right);
  void test_interval(std::size_t line, std::size_t k, const Vec3& x, NearestPoint& best) const noexcept;

  std::vector<CurvePtr> curves_;
  std::vector<Node> nodes_;
};

}  // namespace catena::flow
