/// StreamlineTracing as arc-length curves: the cubic between two knots, the traced curve, and the place of it that is nearest to a point.
/// Any thread; what runs in a tick is noexcept, and allocates and locks nothing.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/sample_status.h"
#include "engine/base/vec.h"
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

/// A bracketed root by the Illinois rule, bounded and bit for bit repeatable: f(a) and f(b) have opposite signs (or one is 0).
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

/// The cubic Hermite of one step: place and rate at both ends. c(theta), theta in [0, 1]; exact at theta = 0. No allocation, lock or throw.
struct Hermite {
  Vec3 c0, c1, c2, c3;  ///< coefficients of 1, theta, theta^2, theta^3; world units

  /// From q over `displacement`, in a step of length h with rates w0 and w1 at its ends.
  Hermite(const Vec3& q, const Vec3& displacement, double h, const Vec3& w0, const Vec3& w1)
      : c0(q), c1(h * w0), c2(3.0 * displacement - 2.0 * c1 - h * w1), c3(c1 + h * w1 - 2.0 * displacement) {}

  /// The place at theta.
  Vec3 evaluate(double theta) const { return c0 + theta * (c1 + theta * (c2 + theta * c3)); }
  Vec3 derivative(double theta) const { return c1 + theta * (2.0 * c2 + theta * (3.0 * c3)); }  ///< by theta

  /// theta where g = (x - c).c' = 0, given g(0) and g(1), which have opposite signs (or one is 0): the foot of x on this piece, to the
  /// rounding of g. Newton's method on the quintic g, with halving where it would leave the bracket or hardly moves. Bounded and bit for
  /// bit repeatable.
  double foot(const Vec3& x, double g0, double g1) const noexcept;
};

/// A knot of a Curve.
struct Knot {
  double s = 0;  ///< arc length from the seed, signed, world units
  Vec3 p{0.0};   ///< the place, world units
  Vec3 t{0.0};   ///< unit tangent
  /// What p has lost by rounding, of grids so far from the origin that it counts; else 0. A piece between two knots may be so short that
  /// the rounding of its ends would turn it.
  glm::vec3 position_low{0.0f};

  /// From here to a place; from here to the next knot.
  Vec3 vector_to(const Vec3& x) const { return position_low == glm::vec3(0.0f) ? x - p : x - p - Vec3(position_low); }
  /// From here to the next knot.
  Vec3 vector_to(const Knot& next) const {
    return position_low == next.position_low ? next.p - p : next.p - p + (Vec3(next.position_low) - Vec3(position_low));
  }
};

/// Why a line ends: at the domain's boundary, at a critical point, at the length that was asked for, after a lap, in an incoherent cell.
enum class Termination { boundary, critical, length, lap, incoherent };
const char* to_string(Termination end);  ///< BOUNDARY CRITICAL LENGTH LAP INCOHERENT

/// How a line ends, and what the field says there: boundary (box, mask or not_finite), critical (zero), incoherent, or nothing.
struct LineEnd {
  Termination termination;  ///< how
  SampleStatus status;      ///< what the field says there
  /// As trace() makes them.
  LineEnd(Termination how = Termination::length, SampleStatus why = SampleStatus::ok) : termination(how), status(why) {}
  bool operator==(const LineEnd&) const = default;
  /// Compares how it ends, whatever the reason.
  bool operator==(Termination how) const { return termination == how; }
};

/// A streamline as an arc-length curve, traced once: knots (s, position, unit tangent) with cubic Hermite dense output between them.
/// `trace` writes these knots, the tubes draw this object and the selected streamline link moves on it: what is seen is felt.
/// Arc lengths and places in world units. Immutable; any thread; reading allocates nothing.
class Curve {
 public:
  /// From knots in order, at least two; `closed`: the last one repeats the first one's place.
  Curve(std::vector<Knot> knots, bool closed, LineEnd first_end, LineEnd last_end, double domain_length);

  /// All knots, s rising.
  const std::vector<Knot>& knots() const { return knots_; }
  bool is_closed() const { return closed_; }  ///< the last knot repeats the first one's place; s wraps with period()
  /// Arc length from the first knot to the last.
  double period() const { return knots_.back().s - knots_.front().s; }
  /// At the least s.
  const LineEnd& first_end() const { return first_end_; }
  /// At the greatest s.
  const LineEnd& last_end() const { return last_end_; }
  /// L of the field that it was traced in, world units.
  double domain_length() const { return domain_length_; }

  /// Cubic Hermite on the knot interval k: position and d/ds at s (world units; s within the interval).
  void evaluate_interval(std::size_t k, double s, Vec3& p, Vec3& derivative) const noexcept;
  Vec3 position(double s) const noexcept;  ///< clamped to the ends, or wrapped
  /// The interval of knots that s lies in, clamped to the ends.
  std::size_t find_interval(double s) const noexcept;

 private:
  std::vector<Knot> knots_;
  bool closed_;
  LineEnd first_end_, last_end_;
  double domain_length_;
};
/// Curves are shared and never change.
using CurvePtr = std::shared_ptr<const Curve>;

/// How finely and how far trace() goes.
struct TraceOptions {
  double length = 0;                 ///< longest arc length in each direction, world units; 0: 10 L
  double tolerance = 1e-10;          ///< of the embedded error of one step, times L
  double hermite_tolerance = 1e-11;  ///< of the Hermite midpoint against a half step, times L
  std::size_t max_knots = 2000000;   ///< of both directions together
  double max_step = 0;               ///< of one step, world units; 0: two voxels, or a tenth of L
};

/// Traces both directions from the seed with DP5(4); on grids with knots on cell faces. Ends at the domain's boundary, a
/// critical point (or min_speed), where a line field is incoherent, at the length, or after one lap. A seed outside the domain, not finite,
/// or at a zero is an error (the caller prefixes file and line).
Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options = {});

inline constexpr int kMaxNearestWork = 512;  ///< Boxes and pieces that a search may look at.

/// What NearestOnCurve finds.
struct NearestPoint {
  std::size_t line = 0;      ///< the curve, of several
  std::size_t interval = 0;  ///< its interval between knots
  double s = 0;              ///< arc length, within the interval
  double distance2 = 0;      ///< squared, world units
  int work = 0;              ///< boxes and pieces looked at
};

/// The place of one or several curves nearest to any point, over all of them and in bounded work: a tree of boxes about runs of knot
/// intervals (about the Bezier hull of each Hermite piece), nearest box first. A function of the point alone: no memory, so that
/// the same point gives the same bits. At most kMaxNearestWork boxes and pieces are looked at; where many places are all but
/// equally near (the centre of a circle) one of them is taken. Made off the tick; asked on any thread, without allocation.
class NearestOnCurve {
 public:
  /// Builds the tree; off the tick.
  explicit NearestOnCurve(CurvePtr curve) : NearestOnCurve(std::vector<CurvePtr>{std::move(curve)}) {}
  /// Of several curves, at least one.
  explicit NearestOnCurve(std::vector<CurvePtr> curves);
  /// |x| <= 1e150, or squares overflow. Nothing beyond `within` is looked for: then the distance is infinite.
  NearestPoint find(const Vec3& x, double within = std::numeric_limits<double>::infinity()) const noexcept {
    return search(x, kMaxNearestWork, within);
  }
  /// The same with as much work as it takes, for measurements: of a long line that winds through itself, the bounded search may give a
  /// place that is not the nearest. Off the tick.
  NearestPoint find_exact(const Vec3& x) const noexcept {
    return search(x, std::numeric_limits<int>::max(), std::numeric_limits<double>::infinity());
  }

 private:
  NearestPoint search(const Vec3& x, int most, double within) const noexcept;
  struct Node {
    Vec3 lo{0.0}, hi{0.0};
    std::uint32_t line = 0, first = 0, count = 0;  ///< of a leaf: intervals
    std::uint32_t right = 0;                       ///< the second child; 0: a leaf. The first child is the next node
  };
  void build_node(std::vector<std::uint32_t>& lines, std::size_t begin, std::size_t end);
  std::uint32_t build_node(std::uint32_t line, std::uint32_t first, std::uint32_t count);
  void enclose_children(std::uint32_t parent, std::uint32_t right);
  void test_interval(std::size_t line, std::size_t k, const Vec3& x, NearestPoint& best) const noexcept;

  std::vector<CurvePtr> curves_;
  std::vector<Node> nodes_;
};

}  // namespace catena::flow
