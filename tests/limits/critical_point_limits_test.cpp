// SPDX-License-Identifier: MIT
// Rows of critical points of every type: traced lines, and links.
#include "engine/base/numbers.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/limits/flow_fixture.h"
#include "tests/limits/limits_table.h"

namespace catena::extremes {
namespace critical_point_limits_test {

using catena::LinkStatus;
using catena::test::lambda_field;
using haptics::tests::Rig;
using Distance = double (*)(const Vec3&);

double from_origin(const Vec3& p) { return norm(p); }

struct Bounds {
  double zero = 1e-6, online = 1e-6;  ///< bounds in L
};

/// A hand moves from the seed over the zero to the other side and back, on a selected and on an online line.
/// `off`: distance of a position from the zeros.
std::string over_a_zero(Velocity velocity, const Vec3& seed, const Bounds& bounds, Distance off) {
  const auto field = lambda_field(velocity);
  const flow::CurvePtr curve = trace(field, seed);
  Findings found;
  found.add(stop_names(*curve));
  double missed = 0;
  if (curve->first_end() == flow::Termination::critical) missed = std::max(missed, off(curve->knots().front().p));
  if (curve->last_end() == flow::Termination::critical) missed = std::max(missed, off(curve->knots().back().p));
  found.at_most("distance of CRITICAL ends from the zero", missed / 4, bounds.zero, "L");

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
  return found.all("links OK, CRITICAL or BUDGET within 257 fetches", good, ticks)
      .at_most("distance of the proxy from the traced line", beside / 4, bounds.online, "L");
}

/// The row of over_a_zero; `ends`: how the traced line ends.
Row zero(const std::string& name, const std::string& input, const std::string& ends, Velocity velocity, const Vec3& seed,
         const Bounds& bounds = {}, const std::string& should = {}, Distance off = from_origin) {
  const std::string expected = ends + "; distance of CRITICAL ends from the zero at most " + to_text(bounds.zero) +
                               " L; links OK, CRITICAL or BUDGET within 257 fetches in every case; distance of the proxy from the traced "
                               "line at most " +
                               to_text(bounds.online) + " L";
  return {name, input, expected, [=] { return over_a_zero(velocity, seed, bounds, off); }, should, {}};
}

}  // namespace critical_point_limits_test

Group critical_rows() {
  using namespace critical_point_limits_test;
  const std::string parted =
      "At most 1e-06 L. An online streamline leaves the zero along another line when the probe returns, because lines near the zero are "
      "closer than the tolerance of a step. A `selected` streamline is not affected";
  const Velocity spiral_saddle = [](const Vec3& p) { return Vec3(-p.x - 3 * p.y, 3 * p.x - p.y, p.z); };
  return {"Critical points",
          {
              proved_elsewhere("Attracting, repelling and star nodes, the straight separatrices of saddles, a zero of third order",
                               "held within 1e-6 L of the zero within 6 ticks, CRITICAL; released when the probe turns back",
                               "CriticalPoints.StraightPathsStopOnTheZeroAndLeaveIt"),
              proved_elsewhere("The curved separatrices of a saddle", "the proxy reaches the zero within 1e-4 L",
                               "CriticalPoints.CurvedManifoldsAreReachedWhenDragged"),
              zero("AttractingSpiral", "Probe moves across an attracting spiral (3 radians per unit)", "from LENGTH to CRITICAL",
                   [](const Vec3& p) { return Vec3(-p.x - 3 * p.y, 3 * p.x - p.y, -p.z); }, {0.8, 0, 0}),
              zero("RepellingSpiral", "Repelling spiral", "from CRITICAL to LENGTH",
                   [](const Vec3& p) { return Vec3(p.x + 3 * p.y, -3 * p.x + p.y, p.z); }, {0.8, 0, 0}),
              zero("SpiralSaddle", "Spiral saddle, in the plane of its spirals", "from LENGTH to CRITICAL", spiral_saddle, {0.8, 0, 0}),
              zero("BesideASpiralSaddle", "The same, 0.01 beside that plane: the line passes the saddle", "from LENGTH to LENGTH",
                   spiral_saddle, {0.8, 0, 0.01}),
              zero(
                  "ImproperNode", "Improper node (one eigenvector)", "from LENGTH to CRITICAL",
                  [](const Vec3& p) { return Vec3(-p.x + p.y, -p.y, -p.z); }, {0.5, 0.5, 0}, {1e-6, 0.01}, parted),
              zero("WeakSpiral", "Weak spiral: a centre with 0.1 % of attraction", "from LENGTH to LENGTH",
                   [](const Vec3& p) { return Vec3(-1e-3 * p.x - p.y, p.x - 1e-3 * p.y, 0); }, {0.8, 0, 0}),
              zero("Centre", "Centre with elliptic orbits", "from LAP to LAP", [](const Vec3& p) { return Vec3(-p.y, 4 * p.x, 0); },
                   {0.8, 0, 0}),
              zero(
                  "LineOfZeros", "Line of zeros", "from LENGTH to CRITICAL", [](const Vec3& p) { return Vec3(-p.x, -2 * p.y, 0); },
                  {0.6, 0.4, 0.3}, {1e-6, 0.01}, parted, [](const Vec3& p) { return std::hypot(p.x, p.y); }),
              zero(
                  "PlaneOfZeros", "Plane of zeros", "from CRITICAL to LENGTH", [](const Vec3& p) { return Vec3(p.x, 0, 0); }, {0.8, 0, 0},
                  {}, {}, [](const Vec3& p) { return std::fabs(p.x); }),
              zero(
                  "CubicZero", "Zero of third order along one axis", "from LENGTH to CRITICAL",
                  [](const Vec3& p) { return Vec3(-p.x * p.x * p.x, -p.y, -p.z); }, {0.6, 0.4, 0.2}, {1e-3, 0.2},
                  "At most 1e-06 L, both. Beside the line that enters the zero the flow is 1e6 times as fast: the tolerance of a step "
                  "turns the line before the zero, and a proxy that returns leaves its line"),
              zero(
                  "MonkeySaddle", "Monkey saddle (index -2), straight across", "from LENGTH to LENGTH",
                  [](const Vec3& p) { return Vec3(p.x * p.x - p.y * p.y, -2 * p.x * p.y, 0); }, {-0.8, 0, 0}, {},
                  "From LENGTH to CRITICAL. The velocity vanishes on the line but has the same direction on both sides, so the integrator "
                  "does not detect the zero"),
              zero("Dipole", "Dipole (index 2): its streamlines are circles through the zero", "from CRITICAL to CRITICAL",
                   [](const Vec3& p) { return Vec3(p.x * p.x - p.y * p.y, 2 * p.x * p.y, 0); }, {0, 0.6, 0}),
          }};
}

}  // namespace catena::extremes
