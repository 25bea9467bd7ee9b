// SPDX-License-Identifier: MIT
// Acceptance tests of the projector onto a streamline, online and selected, and of critical points.
#include "haptics/constraints/streamline/online_streamline.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::acceptance::streamline_acceptance_test {

using catena::test::analytic_vector;
using catena::test::lambda_field;
using flow::Method;
using haptics::bitwise_equal;
using haptics::kMaxEvaluations;
using haptics::tests::Quantiles;
using haptics::tests::Random;
using haptics::tests::Rig;

Rig online(field::VectorFieldPtr field, const Vec3& seed, Method method = Method::rkf34, double tolerance = 1e-9) {
  haptics::OnlineStreamlineSpec spec;
  spec.field = std::move(field);
  spec.seed = seed;
  spec.method = method;
  spec.tolerance = tolerance;
  return Rig(haptics::make_online_streamline(spec));
}

Vec3 on_circle(double d, double degrees) { return {d * std::cos(degrees * M_PI / 180), d * std::sin(degrees * M_PI / 180), 0}; }

constexpr double kFarness[] = {0.2, 0.35, 0.5, 0.7, 0.9, 1.0, 1.1, 1.5, 1.9, 2.1, 2.5, 3.0, 4.0, 5.0, 6.0};

TEST(StreamlineProjection, NoDistanceIncreaseFromRandomStarts) {
  Random random(5);
  int increases = 0, under_way = 0, runs = 0, max_evaluations = 0;
  for (const char* name : {"circle", "abc", "hill", "saddle", "helix", "rankine", "lamb-oseen", "node"}) {
    const auto field = analytic_vector(name);
    for (int i = 0; i < 500; ++i) {
      const Vec3 seed = random.box(2), probe = random.box(3);
      Rig rig = online(field, seed, i % 3 ? Method::rkf34 : Method::dp54);
      double distance = norm(probe - seed);
      for (int tick = 0; tick < 8; ++tick) {
        rig.tick(probe);
        const double now = norm(probe - rig.state.proxy);
        increases += now > distance * (1 + 1e-15);
        distance = now;
        max_evaluations = std::max(max_evaluations, rig.state.evaluations);
      }
      ++runs;
      under_way += rig.state.status == LinkStatus::budget;
    }
  }
  record_result("starts", runs);
  expect_at_most("distance increases", increases, 0);
  expect_at_most("most evaluations a tick (cap 257)", max_evaluations, kMaxEvaluations);
  expect_at_most("starts still under way after 8 ticks", under_way, runs / 100);
}

TEST(StreamlineProjection, ACircleFromTwentyDegreesOff) {
  // each iteration is one integration step of 6 samples (Dormand-Prince), and 6 more where it lands on the root
  double worst = 0, worst_place = 0;
  int max_evaluations = 0, most_paper = 0;
  for (const double d : kFarness) {
    Rig rig = online(analytic_vector("circle"), {1, 0, 0}, Method::dp54);
    const Vec3 probe = on_circle(d, 20);
    rig.tick(probe);
    EXPECT_EQ(rig.state.status, LinkStatus::ok) << d;
    const Vec3 e = probe - rig.state.proxy;
    worst = std::max(worst, std::fabs(dot(direction(Vec3(-rig.state.proxy.y, rig.state.proxy.x, 0)), e)));
    worst_place = std::max(worst_place, norm(rig.state.proxy - on_circle(1, 20)));
    max_evaluations = std::max(max_evaluations, rig.state.evaluations);

    Rig paper = online(analytic_vector("circle"), {1, 0, 0});
    paper.tick(probe);
    EXPECT_EQ(paper.state.status, LinkStatus::ok) << d;
    EXPECT_LE(paper.state.residual, 1e-9) << d;
    most_paper = std::max(most_paper, paper.state.evaluations);
  }
  expect_at_most("tangential residual, d = 0.2-6 R, one tick", worst, 1e-9);
  expect_at_most("distance from the closed form / R, DP5(4)", worst_place, 1e-7);
  expect_at_most("evaluations, DP5(4)", max_evaluations, 8 * 2 * 6);
  expect_at_most("evaluations, RKF3(4) at tolerance 1e-9", most_paper, kMaxEvaluations);
}

TEST(StreamlineProjection, TypicalEvaluationsPerTick) {
  // a hand at 0.2 L/s on and off the line, then one that is eight integration steps away in every tick
  for (const auto& [farness, method] : {std::pair{1, Method::rkf34}, std::pair{8, Method::rkf34}, std::pair{1, Method::dp54}}) {
    Quantiles spread;
    for (const char* name : {"circle", "abc", "hill", "helix"}) {
      const auto field = analytic_vector(name);
      Rig rig = online(field, {0.6, 0.1, 0.05}, method);
      Random random(55);
      Vec3 probe(0.6, 0.1, 0.05), velocity(0.0);
      for (int i = 0; i < 3000; ++i) {
        velocity = direction(velocity + 3e-4 * random.unit()) * (2e-4 * 4 * farness);
        probe = norm(probe + velocity) > 1.5 ? 0.99 * probe : probe + velocity;
        if (norm(probe - rig.state.proxy) > 0.8 && i > 0) probe = rig.state.proxy + 0.5 * (probe - rig.state.proxy);
        rig.tick(probe);
        if (i > 0) spread.add(rig.state.evaluations);
      }
    }
    const std::string who = std::string(flow::to_string(method)) + ", " + std::to_string(farness) + " x 0.2 L/s, evaluations ";
    record_result(who + "p50", spread.at_quantile(0.5));
    expect_at_most(who + "p99", spread.at_quantile(0.99), 80);
    expect_at_most(who + "max", spread.at_quantile(1), kMaxEvaluations);
  }
}

/// Eq. 3 as printed on the circle, with the exact advection function: f_V(p, dt) rotates p by the angle dt.
int iterations_as_printed(const Vec3& probe, double goal) {
  Vec3 p(1, 0, 0);
  for (int j = 0; j < 64; ++j) {
    const Vec3 v(-p.y, p.x, 0);
    const double dt = dot(v, probe - p) / dot(v, v);
    if (std::fabs(dt) * norm(v) < goal) return j;
    p = Vec3(p.x * std::cos(dt) - p.y * std::sin(dt), p.x * std::sin(dt) + p.y * std::cos(dt), 0);
  }
  return -1;
}

TEST(PublishedEquation3, Equation3AsPrintedFailsAtTwoAndAHalfRadii) {
  EXPECT_EQ(iterations_as_printed(on_circle(2.5, 20), 1e-9), -1);
  EXPECT_EQ(iterations_as_printed(on_circle(4.0, 20), 1e-9), -1);
  // check of the control: it converges where the theory predicts it
  for (const double d : {0.5, 0.9, 1.2, 1.6}) EXPECT_GT(iterations_as_printed(on_circle(d, 20), 1e-9), 0) << d;
  // from random starts in [-4R, 4R]^2 16 % converge and 37 % end further away
  Random random(6);
  int converged = 0;
  for (int i = 0; i < 4000; ++i) converged += iterations_as_printed({random.uniform(-4, 4), random.uniform(-4, 4), 0}, 1e-9) >= 0;
  record_result("Eq. 3 as printed, part that converges in 64 iterations", converged / 4000.0);
  EXPECT_NEAR(converged / 4000.0, 0.16, 0.05);
  // the safeguarded form from the same start
  Rig rig = online(analytic_vector("circle"), {1, 0, 0});
  rig.tick(on_circle(2.5, 20));
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - on_circle(1, 20)), 1e-7);
}

/// Twenty forward and backward sweeps over the curve: the same proxy at the same probe, bit for bit.
struct Sweeps {
  double hysteresis = 0;
  int knots = 0;
};
Sweeps sweep(const flow::CurvePtr& curve, double from, double to, double step, const Vec3& aside) {
  Rig rig(haptics::make_selected_streamline(curve));
  Sweeps out;
  const int stations = static_cast<int>((to - from) / step);
  std::vector<Vec3> first(static_cast<std::size_t>(stations + 1));
  rig.tick(curve->position(0.5 * (from + to)));
  for (int k = 0; k < 600 && k * step < 0.5 * (to - from); ++k) rig.tick(curve->position(0.5 * (from + to) - k * step));
  for (int pass = 0; pass < 40; ++pass)
    for (int i = 0; i <= stations; ++i) {
      const auto at = static_cast<std::size_t>(pass % 2 ? stations - i : i);
      rig.tick(curve->position(from + static_cast<double>(at) * step) + aside);
      if (pass > 0 || i > 0)
        out.knots = std::max(out.knots, haptics::memory_as<haptics::SelectedStreamlineMemory>(rig.state).knots_visited);
      if (pass == 0)
        first[at] = rig.state.proxy;
      else if (!bitwise_equal(first[at], rig.state.proxy))
        out.hysteresis = std::max(out.hysteresis, norm(first[at] - rig.state.proxy));
    }
  return out;
}

TEST(SelectedStreamline, MatchesClosedForms) {
  const auto position = [](const char* name, const Vec3& seed) {
    return [curve = *flow::trace({analytic_vector(name).get()}, seed)](double s) { return curve->position(s); };
  };
  const auto circle = position("circle", {0.9, 0, 0}), hill = position("hill", {0.5, 0, 0}), helix = position("helix", {0.8, 0, 0});
  double off_circle = 0, off_hill = 0, off_helix = 0, off_abc = 0;
  for (int i = 0; i < 20000; ++i) {
    off_circle = std::max(off_circle, std::fabs(norm(circle(6 * i / 20000.0)) - 0.9));
    off_hill = std::max(off_hill, hill_streamline_distance(hill(3.2 * i / 20000.0), 0.5L));
  }
  const double speed = std::sqrt(1.6 * 1.6 + 0.25);
  for (int i = -20000; i < 20000; ++i) {
    const double s = 8 * i / 20000.0, t = s / speed;
    off_helix = std::max(off_helix, norm(helix(s) - Vec3(0.8 * std::cos(2 * t), 0.8 * std::sin(2 * t), 0.5 * t)));
  }
  const Vec3 seed(0.3, -0.7, 0.4);
  const auto chaotic = position("abc", seed);
  Real3 p(seed);
  for (int i = 1; i <= 400; ++i) {
    p = integrate_rk4([](const Real3& q) { return unit_direction(abc_flow(q)); }, p, 0.01L, 20);
    off_abc = std::max(off_abc, norm(chaotic(0.01 * i) - p.rounded()));
  }
  expect_at_most("circle, error / L", off_circle / 4, 1e-9);
  expect_at_most("Hill, error / L", off_hill / 4, 1e-9);
  expect_at_most("helix over 16, error / L", off_helix / 4, 1e-9);
  expect_at_most("ABC over L, error / L", off_abc / 4, 1e-9);
}

TEST(SelectedStreamline, HasNoHysteresisAndVisitsFewKnotsPerTick) {
  struct Case {
    const char* name;
    field::VectorFieldPtr field;
    Vec3 seed;
    double from, to;
  };
  const auto hill_grid = field::sample_on_grid(*analytic_vector("hill"), 256, -1.2, 1.2);
  const Case cases[] = {{"circle", analytic_vector("circle"), {0.9, 0, 0}, 0.2, 3},
                        {"ABC", analytic_vector("abc"), {0.3, -0.7, 0.4}, -2, 2},
                        {"Hill", analytic_vector("hill"), {0.5, 0, 0}, 0.1, 1.5},
                        {"Hill 256^3", hill_grid, {0.5, 0, 0}, 0.1, 1.5}};
  for (const Case& c : cases) {
    const auto curve = flow::trace({c.field.get()}, c.seed);
    ASSERT_TRUE(curve);
    for (const double part : {0.05, 0.2}) {
      const double step = part * 1e-3 * c.field->domain_length();
      const Sweeps sweeps = sweep(*curve, c.from, c.to, step, Vec3(0.01, -0.015, 0.02));
      const std::string who = std::string(c.name) + " at " + (part > 0.1 ? "0.2" : "0.05") + " L/s: ";
      expect_at_most(who + "hysteresis over 20 sweeps", sweeps.hysteresis, 0);
      expect_at_most(who + "knots a tick", sweeps.knots, 8);
    }
  }
}

struct Zero {
  std::string name;
  field::VectorFieldPtr field;
  Vec3 seed;
};

std::vector<Zero> zeros_with_straight_ways() {
  return {{"attracting node", lambda_field([](const Vec3& p) { return Vec3(-p.x, -2 * p.y, -3 * p.z); }), {0.9, 0, 0}},
          {"repelling node", analytic_vector("node"), {0.5, 0.4, -0.3}},
          {"star node", lambda_field([](const Vec3& p) { return -p; }), {0.2, 0.7, 0.5}},
          {"saddle, stable", analytic_vector("saddle"), {0, 0.8, 0}},
          {"saddle, unstable", analytic_vector("saddle"), {0.8, 0, 0}},
          {"saddle in space", lambda_field([](const Vec3& p) { return Vec3(2 * p.x, -p.y, -3 * p.z); }), {0, 0, 0.6}},
          {"slow zero", lambda_field([](const Vec3& p) { return -dot(p, p) * p; }), {0.4, -0.3, 0.2}}};
}

TEST(CriticalPoints, StraightPathsStopOnTheZeroAndLeaveIt) {
  double worst = 0, back = 0;
  int slowest = 0;
  for (const Zero& zero : zeros_with_straight_ways())
    for (const Method method : {Method::rk2, Method::rk4, Method::rkf34, Method::dp54}) {
      SCOPED_TRACE(zero.name + " " + flow::to_string(method));
      Rig rig = online(zero.field, zero.seed, method);
      int ticks = 0;
      for (; ticks < 6 && rig.state.status != LinkStatus::critical; ++ticks) rig.tick(-0.6 * zero.seed);
      EXPECT_EQ(rig.state.status, LinkStatus::critical);
      slowest = std::max(slowest, ticks);
      worst = std::max(worst, norm(rig.state.proxy) / 4);
      const Vec3 held = rig.state.proxy;
      rig.tick(-0.2 * zero.seed);
      EXPECT_TRUE(bitwise_equal(held, rig.state.proxy)) << zero.name;
      EXPECT_EQ(rig.state.status, LinkStatus::critical) << zero.name;
      // the hand reverses
      for (int k = 0; k < 4; ++k) rig.tick(0.4 * zero.seed);
      EXPECT_EQ(rig.state.status, LinkStatus::ok) << zero.name << " " << flow::to_string(method);
      back = std::max(back, norm(rig.state.proxy - 0.4 * zero.seed) / 4);
    }
  expect_at_most("distance from the zero / L", worst, 1e-6);
  expect_at_most("ticks", slowest, 6);
  expect_at_most("after the hand turned back, distance from its place on the way / L", back, 1e-6);
}

TEST(CriticalPoints, SelectedLinesEndOnTheZero) {
  for (const Zero& zero : zeros_with_straight_ways()) {
    if (zero.name == "slow zero") continue;
    const auto curve = flow::trace({zero.field.get()}, zero.seed);
    ASSERT_TRUE(curve) << zero.name;
    Rig rig(haptics::make_selected_streamline(*curve));
    for (int k = 0; k < 6; ++k) rig.tick(-0.6 * zero.seed);
    EXPECT_EQ(rig.state.status, LinkStatus::critical) << zero.name;
    EXPECT_LE(norm(rig.state.proxy) / 4, 1e-6) << zero.name;
    for (int k = 0; k < 3; ++k) rig.tick(0.4 * zero.seed);
    EXPECT_EQ(rig.state.status, LinkStatus::ok) << zero.name;
    EXPECT_LE(norm(rig.state.proxy - 0.4 * zero.seed) / 4, 1e-6) << zero.name;
  }
}

TEST(CriticalPoints, CurvedManifoldsAreReachedWhenDragged) {
  // x = bend y^2 / 3 is the stable manifold of the saddle at 0; the hand moves 0.005 L per tick
  // (a line that has drifted by eps turns at sqrt(eps) from the zero: third order suffices up to a bend of 1.5, fifth order further)
  double worst = 0, back = 0;
  for (const double bend : {-1.5, -0.7, 0.3, 1.0, 2.0})
    for (const Method method : {Method::rkf34, Method::dp54}) {
      if (method == Method::rkf34 && std::fabs(bend) > 1.5) continue;
      const auto field = lambda_field([bend](const Vec3& p) { return Vec3(p.x - bend * p.y * p.y, -p.y, 0.5 * p.z); });
      const auto on = [bend](double y) { return Vec3(bend * y * y / 3, y, 0); };
      Rig rig = online(field, on(1), method);
      for (double y = 0.98; y > -0.3; y -= 0.02) rig.tick(on(y));
      EXPECT_EQ(rig.state.status, LinkStatus::critical) << bend;
      worst = std::max(worst, norm(rig.state.proxy) / 4);
      for (double y = -0.3; y < 0.6; y += 0.02) rig.tick(on(y));
      EXPECT_EQ(rig.state.status, LinkStatus::ok) << bend;
      back = std::max(back, std::fabs(rig.state.proxy.x - bend * rig.state.proxy.y * rig.state.proxy.y / 3) / 4);
    }
  expect_at_most("curved manifold, distance from the zero / L", worst, 1e-4);
  expect_at_most("after the hand turned back, distance from the manifold / L", back, 1e-6);
}

}  // namespace catena::acceptance::streamline_acceptance_test
