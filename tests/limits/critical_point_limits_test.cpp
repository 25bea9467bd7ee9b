// SPDX-License-Identifier: MIT
// Rows of critical points: of every type, traced, and under the hand.
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/limits/flow_fixture.h"
#include "tests/limits/limits_table.h"

namespace catena::extremes {
namespace critical_test {

using catena::LinkStatus;
using catena::test::lambda_field;
using flow::CurvePtr;
using haptics::tests::Rig;
using Distance = double (*)(const Vec3&);

double from_origin(const Vec3& p) { return norm(p); }

struct Bounds {
  double zero = 1e-6, online = 1e-6;  ///< L
};

/// A hand goes from the seed over the zero to the other side and back, with its line traced once and integrated in every tick.
/// `off`: how far a place is from the zeros.
std::string over_a_zero(Velocity velocity, const Vec3& seed, Distance off = from_origin, const Bounds& bounds = {}) {
  const auto field = lambda_field(velocity);
  const auto traced = flow::trace({field.get()}, seed);
  if (!traced) return traced.error().message;
  const CurvePtr& curve = *traced;
  Findings found;
  found.add(stop_names(*curve));
  double missed = 0;
  if (curve->first_end() == flow::Termination::critical) missed = std::max(missed, off(curve->knots().front().p));
  if (curve->last_end() == flow::Termination::critical) missed = std::max(missed, off(curve->knots().back().p));
  found.at_most("CRITICAL ends off the zero", missed / 4, bounds.zero, "L");

  const flow::NearestOnCurve nearest(curve);
  Rig rigs[] = {make_online_rig(field, seed), Rig(haptics::make_selected_streamline(curve))};
  double beside = 0;
  long long good = 0, ticks = 0;
  for (int i = 0; i < 1400; ++i) {
    const double u = i < 600 ? 1 - 1.6 * i / 600.0 : i < 700 ? -0.6 : i < 1300 ? -0.6 + 1.6 * (i - 700) / 600.0 : 1;
    for (Rig& rig : rigs) {
      rig.tick(u * seed);
      const LinkStatus status = rig.state.status;
      good += is_finite(rig.state.proxy) && rig.state.evaluations <= haptics::kMaxEvaluations &&
              (status == LinkStatus::ok || status == LinkStatus::critical || status == LinkStatus::budget);
      ++ticks;
      if (is_finite(rig.state.proxy)) beside = std::max(beside, std::sqrt(nearest.find(rig.state.proxy).distance2));
    }
  }
  return found.all("under the hand OK, CRITICAL or BUDGET within 257 fetches", good, ticks)
      .at_most("online off the traced line", beside / 4, bounds.online, "L");
}

std::string attracting_spiral() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x - 3 * p.y, 3 * p.x - p.y, -p.z); }, {0.8, 0, 0});
}
std::string repelling_spiral() {
  return over_a_zero([](const Vec3& p) { return Vec3(p.x + 3 * p.y, -3 * p.x + p.y, p.z); }, {0.8, 0, 0});
}
std::string spiral_saddle() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x - 3 * p.y, 3 * p.x - p.y, p.z); }, {0.8, 0, 0});
}
std::string beside_a_spiral_saddle() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x - 3 * p.y, 3 * p.x - p.y, p.z); }, {0.8, 0, 0.01});
}
std::string improper_node() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x + p.y, -p.y, -p.z); }, {0.5, 0.5, 0}, from_origin, {1e-6, 0.01});
}
std::string weak_spiral() {
  return over_a_zero([](const Vec3& p) { return Vec3(-1e-3 * p.x - p.y, p.x - 1e-3 * p.y, 0); }, {0.8, 0, 0});
}
std::string centre() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.y, 4 * p.x, 0); }, {0.8, 0, 0});
}
std::string plane_of_zeros() {
  return over_a_zero([](const Vec3& p) { return Vec3(p.x, 0, 0); }, {0.8, 0, 0}, [](const Vec3& p) { return std::fabs(p.x); });
}
std::string line_of_zeros() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x, -2 * p.y, 0); }, {0.6, 0.4, 0.3},
                     [](const Vec3& p) { return std::hypot(p.x, p.y); }, {1e-6, 0.01});
}
std::string cubic_zero() {
  return over_a_zero([](const Vec3& p) { return Vec3(-p.x * p.x * p.x, -p.y, -p.z); }, {0.6, 0.4, 0.2}, from_origin, {1e-3, 0.2});
}
std::string monkey_saddle() {
  return over_a_zero([](const Vec3& p) { return Vec3(p.x * p.x - p.y * p.y, -2 * p.x * p.y, 0); }, {-0.8, 0, 0});
}
std::string dipole() {
  return over_a_zero([](const Vec3& p) { return Vec3(p.x * p.x - p.y * p.y, 2 * p.x * p.y, 0); }, {0, 0.6, 0});
}

}  // namespace critical_test

Group critical_rows() {
  using namespace critical_test;
  const std::string under =
      "; under the hand OK, CRITICAL or BUDGET within 257 fetches in every one; online off the traced line at most 1e-06 L";
  const auto zero = [&](const char* ends) { return ends + std::string("; CRITICAL ends off the zero at most 1e-06 L") + under; };
  const std::string wide = "; under the hand OK, CRITICAL or BUDGET within 257 fetches in every one; online off the traced line at most ";
  const std::string parted =
      "Online at most 1e-06 L off: a hand that comes back from the node leaves it by another line, for there lines lie nearer together "
      "than a step's tolerance. A line that is traced once (`selected`) keeps its way";
  return {
      "Critical points",
      {
          proved_elsewhere("Nodes (attracting, repelling, star), saddles on their straight ways, a zero of third order",
                           "held within 1e-6 L of the zero in 6 ticks, CRITICAL; let go when the hand turns back",
                           "CriticalPoints.StraightWaysStopOnTheZeroAndLetGo"),
          proved_elsewhere("A saddle's curved ways", "reached within 1e-4 L when the hand drags along them",
                           "CriticalPoints.CurvedManifoldsAreReachedWhenDragged"),
          {"AttractingSpiral", "A hand over an attracting spiral, three radians a unit", zero("from LENGTH to CRITICAL"),
           attracting_spiral},
          {"RepellingSpiral", "Over a repelling spiral", zero("from CRITICAL to LENGTH"), repelling_spiral},
          {"SpiralSaddle", "Over a spiral saddle, in the plane of its spirals", zero("from LENGTH to CRITICAL"), spiral_saddle},
          {"BesideASpiralSaddle", "The same 0.01 beside that plane: the line passes by", zero("from LENGTH to LENGTH"),
           beside_a_spiral_saddle},
          {"ImproperNode", "Over a node with one direction only",
           "from LENGTH to CRITICAL; CRITICAL ends off the zero at most 1e-06 L" + wide + "0.01 L", improper_node, parted},
          {"WeakSpiral", "Over a spiral that is a centre but for 0.1 %", zero("from LENGTH to LENGTH"), weak_spiral},
          {"Centre", "Over a centre of ellipses", zero("from LAP to LAP"), centre},
          {"LineOfZeros", "Over a line of zeros", "from LENGTH to CRITICAL; CRITICAL ends off the zero at most 1e-06 L" + wide + "0.01 L",
           line_of_zeros, parted},
          {"PlaneOfZeros", "Over a plane of zeros", zero("from CRITICAL to LENGTH"), plane_of_zeros},
          {"CubicZero", "Over a zero that is of third order along one axis",
           "from LENGTH to CRITICAL; CRITICAL ends off the zero at most 0.001 L" + wide + "0.2 L", cubic_zero,
           "At most 1e-06 L, both. The line comes in along a way beside which the flow is 1e6 times as fast: the tolerance of a step turns "
           "it before the zero, and a hand that goes back is thrown off it"},
          {"MonkeySaddle", "Straight over a saddle of index -2", zero("from LENGTH to LENGTH"), monkey_saddle,
           "From LENGTH to CRITICAL: the velocity vanishes on the way, but has the same direction on both sides, so that the march does "
           "not see it"},
          {"Dipole", "Over a dipole (index 2), whose lines are circles through the zero", zero("from CRITICAL to CRITICAL"), dipole},
      }};
}

}  // namespace catena::extremes
