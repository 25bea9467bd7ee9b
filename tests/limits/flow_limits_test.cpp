// SPDX-License-Identifier: MIT
// Rows of the flow: limit cycles, discontinuities, exits of the domain, for traced lines and links.
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/limits/flow_fixture.h"
#include "tests/limits/limits_table.h"

namespace catena::extremes {
namespace flow_limits_test {

using catena::LinkStatus;
using catena::test::lambda_field;
using haptics::tests::Rig;

// ---- limit cycles ----

Vec3 cycle(const Vec3& p) {
  const double r2 = p.x * p.x + p.y * p.y;
  return {p.x * (1 - r2) - p.y, p.y * (1 - r2) + p.x, -p.z};
}
Vec3 repelling_cycle(const Vec3& p) { return -cycle(p); }

double off_the_cycle(const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 1, p.z); }

std::string onto_a_limit_cycle() {
  const auto field = lambda_field(cycle);
  Findings found;
  double off = 0;
  for (const Vec3& seed : {Vec3(0.2, 0, 0), Vec3(0, 1.7, 0.5)}) {
    const auto curve = trace(field, seed);
    found.add(stop_names(*curve));
    off = std::max(off, off_the_cycle(curve->knots().back().p));
  }
  return found.at_most("distance of the end from the cycle", off / 4, 1e-9, "L");
}

std::string along_a_limit_cycle(Velocity velocity, double proxy_bound) {
  const auto curve = trace(lambda_field(velocity), {1, 0, 0});
  double off = 0;
  for (const flow::Knot& knot : curve->knots()) off = std::max(off, off_the_cycle(knot.p));
  Rig rig(haptics::make_selected_streamline(curve));
  double distance = 0;
  for (int i = 0; i < 2000; ++i) {
    const double a = 0.01 * i;
    rig.tick(Vec3(1.3 * std::cos(a), 1.3 * std::sin(a), 0.1));
    distance = std::max(distance, norm(rig.state.proxy - Vec3(std::cos(a), std::sin(a), 0)));
  }
  return Findings()
      .add(stop_names(*curve))
      .at_most("distance from the cycle", off / 4, 1e-7, "L")
      .at_most("distance of the proxy from the closest point in three laps", distance / 4, proxy_bound, "L");
}

// ---- discontinuities ----

/// A line from (-0.7, 0, 0) into the plane x = 0, where the velocity changes; `beyond`: direction behind the plane.
std::string across_a_jump(double degrees) {
  const Vec3 beyond(std::cos(degrees * M_PI / 180), std::sin(degrees * M_PI / 180), 0);
  const auto field = lambda_field([beyond](const Vec3& p) { return p.x < 0 ? Vec3(1, 0, 0) : beyond; });
  const Vec3 seed(-0.7, 0, 0);
  const auto curve = trace(field, seed);
  Findings found;
  found.add(stop_names(*curve));
  const bool passes = curve->last_end() == flow::Termination::length;
  const auto on = [&](double s) { return s < 0.7 ? Vec3(s - 0.7, 0, 0) : (passes ? s - 0.7 : 0.0) * beyond; };
  double off = 0, distance = 0;
  for (double s = 0; s <= std::min(1.5, curve->knots().back().s); s += 0.01) off = std::max(off, norm(curve->position(s) - on(s)));
  Rig rig = make_online_rig(field, seed);
  for (int i = 0; i <= 300; ++i) rig.tick(passes ? on(0.005 * i) : Vec3(0.005 * i - 0.7, 0, 0));
  distance = norm(rig.state.proxy - on(1.5));
  return found.at_most("distance from the closed form", off / 4, 1e-6, "L")
      .at_most("distance of the proxy from the end", distance / 4, 1e-6, "L")
      .add(to_string(rig.state.status));
}

/// 33^3 voxels on [-2, 2]^3.
auto grid_of(const std::function<Vec3(const Vec3&)>& velocity) {
  return test::sample_vector_grid(field::Mapping::from_linear(Mat3(0.125), Vec3(-2.0)), {33, 33, 33}, velocity);
}

std::string steep_walls_of_a_grid() {
  // towards y = 0 from both sides, over one voxel
  const auto grid = grid_of([](const Vec3& p) { return Vec3(1, p.y > 0 ? -1 : p.y < 0 ? 1 : 0, 0); });
  const auto curve = trace(grid, {-1.5, 0.53, 0.1});
  return Findings()
      .add(stop_names(*curve))
      .at_most("distance of its end from the sheet", std::fabs(curve->knots().back().p.y) / 4, 1e-9, "L");
}

// ---- exits of the domain ----

std::string out_through_a_corner() {
  const auto grid = grid_of([](const Vec3&) { return Vec3(1.0); });
  const auto curve = trace(grid, {0.3, 0.3, 0.3});
  const double off = std::max(norm(curve->knots().back().p - Vec3(2.0)), norm(curve->knots().front().p - Vec3(-2.0)));
  return Findings().add(stop_names(*curve)).at_most("distance from the corners", off / 4, 1e-12, "L");
}

std::string out_and_back_at_ten_metres_a_second() {
  const auto grid = grid_of([](const Vec3&) { return Vec3(1, 0.2, 0); });
  const Vec3 seed(0.1, 0, 0), way = direction(Vec3(1, 0.2, 0)), wall(2, 1.9 * 0.2, 0);
  const auto curve = trace(grid, seed);
  Rig rigs[] = {make_online_rig(grid, seed), Rig(haptics::make_selected_streamline(curve))};
  double off = 0, back = 0;
  long long right = 0, asked = 0;
  for (Rig& rig : rigs) {
    for (int i = 0; i <= 30; ++i) rig.tick(seed + 0.2 * i * way);  // 0.2 units per tick, up to 4 units beyond the boundary
    right += rig.state.status == LinkStatus::boundary && rig.state.reason == SampleStatus::outside_box;
    off = std::max(off, norm(rig.state.proxy - wall));
    for (int i = 30; i >= 0; --i) rig.tick(seed + 0.2 * i * way);
    for (int i = 0; i < 5; ++i) rig.tick(seed);
    right += rig.state.status == LinkStatus::ok;
    back = std::max(back, norm(rig.state.proxy - seed));
    asked += 2;
  }
  return Findings()
      .all("BOUNDARY with BOX outside, OK again inside,", right, asked)
      .at_most("distance from the boundary", off / 4, 1e-8, "L")
      .at_most("distance from the seed after the return", back / 4, 1e-8, "L");
}

}  // namespace flow_limits_test

Group flow_rows() {
  using namespace flow_limits_test;
  return {
      "Flow",
      {
          {"OntoALimitCycle", "Streamlines onto an attracting limit cycle, from inside and from beside it",
           "from CRITICAL to LENGTH; from LENGTH to LENGTH; distance of the end from the cycle at most 1e-09 L", onto_a_limit_cycle},
          {"AlongAnAttractingCycle", "Streamline on that cycle",
           "from LAP to LAP; distance from the cycle at most 1e-07 L; distance of the proxy from the closest point in three laps at "
           "most 1e-07 L",
           [] { return along_a_limit_cycle(cycle, 1e-7); }},
          {"AlongARepellingCycle", "Streamline on a repelling limit cycle, where errors grow 2.9e5 times per lap",
           "from LAP to LAP; distance from the cycle at most 1e-07 L; distance of the proxy from the closest point in three laps at "
           "most 1e-06 L",
           [] { return along_a_limit_cycle(repelling_cycle, 1e-6); },
           "At most 1e-07 L for the proxy, too. A lap closes over a gap of at most 1e-7 L in its last piece, which turns that piece"},
          {"AKink", "Velocity turns by 45 degrees at a plane",
           "from LENGTH to LENGTH; distance from the closed form at most 1e-06 L; distance of the proxy from the end at most 1e-06 L; OK",
           [] { return across_a_jump(45); }},
          {"ASharpTurn", "Velocity turns by 120 degrees: the flow returns to the plane",
           "from LENGTH to CRITICAL; distance from the closed form at most 1e-06 L; distance of the proxy from the end at most 1e-06 L; "
           "CRITICAL",
           [] { return across_a_jump(120); }},
          {"HeadOn", "Velocity reverses",
           "from LENGTH to CRITICAL; distance from the closed form at most 1e-06 L; distance of the proxy from the end at most 1e-06 L; "
           "CRITICAL",
           [] { return across_a_jump(180); }},
          {"SteepWallsOfAGrid", "Grid whose flow turns towards a sheet within one voxel on both sides",
           "from BOUNDARY to BOUNDARY; distance of its end from the sheet at most 1e-09 L", steep_walls_of_a_grid},
          {"OutThroughACorner", "Streamline through two corners of its grid",
           "from BOUNDARY to BOUNDARY; distance from the corners at most 1e-12 L", out_through_a_corner},
          {"OutAndBackAtTenMetresASecond", "Probe follows a streamline out of the grid and back at 0.2 units a tick",
           "BOUNDARY with BOX outside, OK again inside, in every case; distance from the boundary at most 1e-08 L; distance from the "
           "seed after the return at most 1e-08 L",
           out_and_back_at_ten_metres_a_second},
          proved_elsewhere("A Runge-Kutta stage outside the domain while the line is inside", "the line equals that of the grid",
                           "GridBoundary.AStageBeyondTheBoundaryDoesNotEndTheLine"),
          proved_elsewhere("NaN on the path of a streamline", "the line ends before it, BOUNDARY; the proxy follows the probe back",
                           "NanRegion.AStreamlineEndsBeforeTheNanRegionAndReturns"),
          proved_elsewhere("NaN on an isosurface", "the proxy stops there", "NanRegion.AnIsosurfaceEndsAtTheNanRegion"),
      }};
}

}  // namespace catena::extremes
