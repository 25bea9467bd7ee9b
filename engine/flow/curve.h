/// A streamline as an arc-length curve: knots (s, position, unit tangent) with cubic Hermite dense output between them.
/// `trace` writes these knots, the tubes draw this object and the selected streamline link moves on it: what is seen is felt.
/// Immutable once traced. Any thread; reading allocates nothing.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/base/reason.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/flow/flow.h"

namespace catena::flow {

struct Knot {
  double s = 0;  ///< arc length from the seed, signed, world units
  Vec3 p{0.0};
  Vec3 t{0.0};  ///< unit tangent
};

enum class End { boundary, critical, length, lap, incoherent };
const char* end_word(End end);  ///< BOUNDARY CRITICAL LENGTH LAP INCOHERENT

/// How a line ends, and what the field says there: boundary (box, mask or not_finite), critical (zero), incoherent, or nothing.
struct LineEnd {
  End end;
  Reason reason;
  LineEnd(End how = End::length, Reason why = Reason::none) : end(how), reason(why) {}
  bool operator==(const LineEnd&) const = default;
  bool operator==(End how) const { return end == how; }
};

class Curve {
 public:
  Curve(std::vector<Knot> knots, bool closed, LineEnd first_end, LineEnd last_end, double domain_length);

  const std::vector<Knot>& knots() const { return knots_; }
  bool closed() const { return closed_; }  ///< the last knot repeats the first one's place; s wraps with period()
  double period() const { return knots_.back().s - knots_.front().s; }
  const LineEnd& first_end() const { return first_end_; }
  const LineEnd& last_end() const { return last_end_; }
  double domain_length() const { return domain_length_; }

  /// Cubic Hermite on the knot interval k: position and d/ds at s (world units; s within the interval).
  void evaluate_in(std::size_t k, double s, Vec3& p, Vec3& derivative) const noexcept;
  Vec3 position(double s) const noexcept;  ///< clamped to the ends, or wrapped
  std::size_t interval_of(double s) const noexcept;

 private:
  std::vector<Knot> knots_;
  bool closed_;
  LineEnd first_end_, last_end_;
  double domain_length_;
};
using CurvePtr = std::shared_ptr<const Curve>;

struct TraceOptions {
  double length = 0;                 ///< longest arc length in each direction, world units; 0: 10 L
  double tolerance = 1e-10;          ///< of the embedded error of one step, times L
  double hermite_tolerance = 1e-11;  ///< of the Hermite midpoint against a half step, times L
  std::size_t max_knots = 2000000;
};

/// Traces both directions from the seed with DP5(4); on grids with knots on cell faces. Ends at the domain's boundary, a
/// critical point (or min_speed), where a line field is incoherent, at the length, or after one lap. A seed outside the domain, not finite,
/// or at a zero is an error (the caller prefixes file and line).
Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options = {});

inline constexpr int kNearestWork = 512;

struct NearestPlace {
  std::size_t interval = 0;
  double s = 0;          ///< arc length, within the interval
  double distance2 = 0;  ///< squared, world units
  int work = 0;          ///< boxes and pieces looked at
};

/// The place of a curve nearest to any point, over the whole curve and in bounded work: a tree of boxes about runs of knot
/// intervals (about the Bezier hull of each Hermite piece), nearest box first. A function of the point alone: no memory, so that
/// the same point gives the same bits. At most kNearestWork boxes and pieces are looked at; where many places are all but
/// equally near (the centre of a circle) one of them is taken. Made off the tick; asked on any thread, without allocation.
class NearestOnCurve {
 public:
  explicit NearestOnCurve(CurvePtr curve);
  /// |x| <= 1e150, or squares overflow.
  NearestPlace at(const Vec3& x) const noexcept;

 private:
  struct Node {
    Vec3 lo{0.0}, hi{0.0};
    std::uint32_t first = 0, count = 0;  ///< intervals
    std::uint32_t right = 0;             ///< the second child; 0: a leaf. The first child is the next node
  };
  std::uint32_t make(std::uint32_t first, std::uint32_t count);
  void look(std::size_t k, const Vec3& x, NearestPlace& best) const noexcept;

  CurvePtr curve_;
  std::vector<Node> nodes_;
};

}  // namespace catena::flow
