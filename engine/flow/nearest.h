/// The place of a curve nearest to any point, over the whole curve and in bounded work: a tree of boxes about runs of knot
/// intervals (about the Bezier hull of each Hermite piece), nearest box first. A function of the point alone: no memory, so that
/// the same point gives the same bits. At most kNearestWork boxes and pieces are looked at; where many places are all but
/// equally near (the centre of a circle) one of them is taken. Made off the tick; asked on any thread, without allocation.
#pragma once
#include <cstdint>

#include "engine/flow/curve.h"

namespace catena::flow {

inline constexpr int kNearestWork = 512;

struct NearestPlace {
  std::size_t interval = 0;
  double s = 0;          ///< arc length, within the interval
  double distance2 = 0;  ///< squared, world units
  int work = 0;          ///< boxes and pieces looked at
};

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
