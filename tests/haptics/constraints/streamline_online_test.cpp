// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/online_streamline.h"

#include <cstring>
#include <limits>
#include <random>

#include "engine/base/memory_limit.h"
#include "tests/engine/geometry/flow/advection_reference.h"
#include "tests/haptics/constraints/streamline_fixture.h"

namespace catena::haptics {
namespace streamline_online_test {

using test::analytic_vector;
using test::lambda_field;
using test::LinkDriver;
using test::sample_vector_grid;

struct Online {
  std::optional<Vec3> seed;
  flow::Method method = flow::Method::rkf34;
  bool line = false;
  double min_speed = 0, tolerance = 1e-9;
};

LinkDriver online(const field::VectorFieldPtr& field, const Online& with) {
  OnlineStreamlineSpec spec;
  spec.field = field;
  spec.seed = with.seed;
  spec.method = with.method;
  spec.is_line_field = with.line;
  spec.min_speed = with.min_speed;
  spec.tolerance = with.tolerance;
  return LinkDriver(make_online_streamline(spec));
}

/// Distance of the proxy from the circle of radius 0.05 after one lap of the probe at 0.2 units/s and 1 kHz.
double drift_of_a_lap(flow::Method method, int& max_evaluations) {
  LinkDriver hand = online(analytic_vector("circle"), {Vec3(0.05, 0.0, 0.0), method});
  const int ticks = static_cast<int>(std::lround(2 * M_PI * 0.05 / 0.2e-3));
  double worst = 0;
  max_evaluations = 0;
  for (int i = 0; i <= ticks; ++i) {
    const double angle = 0.2e-3 * i / 0.05;
    hand.to(Vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0));
    worst = std::max(worst, std::fabs(norm(hand.state.proxy) - 0.05));
    max_evaluations = std::max(max_evaluations, hand.state.evaluations);
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
  }
  return worst;
}

TEST(StreamlineOnline, DriftOfOneLapOfTheCircle) {
  int max_evaluations = 0;
  const struct {
    flow::Method method;
    double least, greatest;
  } cases[] = {{flow::Method::linear, 0.61e-3, 0.65e-3},
               {flow::Method::euler, 0.61e-3, 0.65e-3},
               {flow::Method::rk2, 0, 1e-5},
               {flow::Method::rk3, 0, 2e-9},
               {flow::Method::rk4, 0, 5e-10},
               {flow::Method::rkf34, 0, 5e-10},
               {flow::Method::dp54, 0, 5e-10}};
  for (const auto& c : cases) {
    const double drift = drift_of_a_lap(c.method, max_evaluations);
    std::printf("online circle %s: drift %.3e, evaluations a tick <= %d\n", flow::to_string(c.method), drift, max_evaluations);
    EXPECT_LE(drift, c.greatest) << flow::to_string(c.method);
    EXPECT_GE(drift, c.least) << flow::to_string(c.method);
    if (c.method == flow::Method::linear) {
      EXPECT_LE(max_evaluations, 2);
    }
  }
}

TEST(StreamlineOnline, ConvergesFromAnyDistanceToACircleAndRests) {
  // R = 1, the probe at d in [0.2, 6] R, 20 degrees off
  const auto circle = analytic_vector("circle");
  int max_evaluations = 0;
  for (const double d : {0.2, 0.5, 0.9, 1.0, 1.1, 1.9, 2.1, 2.5, 4.0, 6.0}) {
    LinkDriver hand = online(circle, {Vec3(1.0, 0.0, 0.0)});
    const double angle = 20 * M_PI / 180;
    const Vec3 probe(d * std::cos(angle), d * std::sin(angle), 0.0);
    hand.to(probe);
    max_evaluations = std::max(max_evaluations, hand.state.evaluations);
    EXPECT_EQ(hand.state.status, LinkStatus::ok) << d;
    EXPECT_LE(norm(hand.state.proxy - Vec3(std::cos(angle), std::sin(angle), 0.0)), 4e-8) << d;
    // tangential residual
    EXPECT_LE(hand.state.residual, 1e-9) << d;
    const Vec3 rest = hand.state.proxy;
    hand.to(probe);
    EXPECT_EQ(hand.state.proxy, rest);
    EXPECT_EQ(hand.state.evaluations, 0);
  }
  std::printf("online, 20 degrees off: evaluations <= %d\n", max_evaluations);
  EXPECT_LE(max_evaluations, kMaxEvaluations);
}

TEST(StreamlineOnline, DistanceNeverGrowsFromColdStarts) {
  const auto abc = analytic_vector("abc");
  std::mt19937 random(17);
  std::uniform_real_distribution<double> place(-4, 4);
  int budget = 0, max_evaluations = 0;
  for (int i = 0; i < 600; ++i) {
    const Vec3 seed(place(random), place(random), place(random)), probe(place(random), place(random), place(random));
    LinkDriver hand = online(i % 2 ? analytic_vector("circle") : abc, {seed});
    double distance = norm(seed - probe);
    for (int tick = 0; tick < 6; ++tick) {
      hand.to(probe);
      ASSERT_LE(hand.state.evaluations, kMaxEvaluations);
      const double now = norm(hand.state.proxy - probe);
      ASSERT_LE(now, distance * (1 + 1e-15) + 1e-15);
      distance = now;
      max_evaluations = std::max(max_evaluations, hand.state.evaluations);
    }
    budget += hand.state.status == LinkStatus::budget;
  }
  std::printf("cold starts: %d of 600 still under way after 6 ticks, evaluations <= %d\n", budget, max_evaluations);
  EXPECT_LE(budget, 30);
}

TEST(StreamlineOnline, Equation3AsPrintedFailsBeyondTwoRadii) {
  // negative control: the iteration as printed
  const auto circle = analytic_vector("circle");
  const flow::Flow flow{circle.get()};
  field::Cursor cursor;
  const double angle = 20 * M_PI / 180;
  const auto converges = [&](double d) {
    const Vec3 x(d * std::cos(angle), d * std::sin(angle), 0.0);
    Vec3 p(1.0, 0.0, 0.0);
    for (int j = 0; j < 64; ++j) {
      const Vec3 v = circle->sample(p, cursor).value;
      p += flow::advect(flow, p, dot(v, x - p) / dot(v, v), flow::Method::rkf34, 1e-9, cursor).displacement;
    }
    return std::fabs(dot(direction(circle->sample(p, cursor).value), x - p)) < 1e-9;
  };
  EXPECT_FALSE(converges(2.5));
  EXPECT_TRUE(converges(1.2));
}

TEST(StreamlineOnline, NodesAndStraightManifoldsStopAsCriticalAndAreLeft) {
  const auto node = lambda_field([](const Vec3& p) { return Vec3(-p.x, -2 * p.y, -3 * p.z); });
  const auto saddle = lambda_field([](const Vec3& p) { return Vec3(2 * p.x, -p.y, 0.0); });
  for (const auto method : {flow::Method::euler, flow::Method::rk2, flow::Method::rk4, flow::Method::rkf34, flow::Method::dp54})
    for (const auto& [field, seed] :
         {std::pair{node, Vec3(1.0, 0.0, 0.0)}, std::pair{saddle, Vec3(0.0, 1.0, 0.0)}, std::pair{node, Vec3(0.0, 0.0, 0.7)}}) {
      LinkDriver hand = online(field, {seed, method});
      for (int tick = 0; tick < 6; ++tick) {
        hand.to(-0.5 * seed);
        EXPECT_LE(hand.state.evaluations, kMaxEvaluations);
      }
      EXPECT_EQ(hand.state.status, LinkStatus::critical) << flow::to_string(method);
      EXPECT_LE(norm(hand.state.proxy), 4e-6) << flow::to_string(method);
      hand.to(-0.1 * seed);
      EXPECT_EQ(hand.state.evaluations, 0);
      // the hand reverses
      for (int tick = 0; tick < 3; ++tick) hand.to(0.3 * seed);
      EXPECT_EQ(hand.state.status, LinkStatus::ok);
      EXPECT_LE(norm(hand.state.proxy - 0.3 * seed), 1e-6) << flow::to_string(method);
    }
}

TEST(StreamlineOnline, CurvedManifoldIsReachedWhenDragged) {
  // x = y^2 / 3 is the stable manifold of the saddle at 0
  const auto field = lambda_field([](const Vec3& p) { return Vec3(p.x - p.y * p.y, -p.y, 0.0); });
  LinkDriver hand = online(field, {Vec3(1.0 / 3, 1.0, 0.0)});
  bool reached = false;
  for (double y = 1; y > -0.3; y -= 0.02) {
    hand.to(Vec3(y * y / 3, y, 0.0));
    if (hand.state.status == LinkStatus::critical) reached = true;
    if (reached) {
      EXPECT_LE(norm(hand.state.proxy), 4e-4);
      EXPECT_EQ(hand.state.status, LinkStatus::critical);
    }
  }
  EXPECT_TRUE(reached);
  for (double y = -0.3; y < 0.5; y += 0.02) hand.to(Vec3(y * y / 3, y, 0.0));
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
  EXPECT_LE(std::fabs(hand.state.proxy.x - hand.state.proxy.y * hand.state.proxy.y / 3), 1e-6);
}

TEST(StreamlineOnline, CurvedManifoldsInAnyPositionAreReachedAndLeft) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const auto method : {flow::Method::rkf34, flow::Method::dp54})
    for (int i = 0; i < 40; ++i) {
      const Vec3 a = direction(Vec3(value(random), value(random), value(random)));
      const Vec3 b = direction(cross(a, Vec3(value(random), value(random), value(random)))), c = cross(a, b);
      const Vec3 zero = 0.3 * Vec3(value(random), value(random), value(random));
      const double bend = value(random), third = (i % 2 ? 1 : -1) * (0.1 + 0.7 * std::fabs(value(random)));
      const auto field = lambda_field([=](const Vec3& p) {
        const double x = dot(p - zero, a), y = dot(p - zero, b), z = dot(p - zero, c);
        return (x - bend * y * y) * a - y * b + third * z * c;
      });
      const auto on = [&](double y) { return zero + (bend * y * y / 3) * a + y * b; };
      LinkDriver hand = online(field, {on(1), method});
      for (double y = 0.99; y > -0.3; y -= 0.02) {
        const double before = norm(hand.state.proxy - on(y));
        const bool started = hand.started;
        hand.to(on(y));
        if (started) {
          ASSERT_LE(norm(hand.state.proxy - on(y)), before + 1e-14) << i;
        }
      }
      EXPECT_EQ(hand.state.status, LinkStatus::critical) << i;
      EXPECT_LE(norm(hand.state.proxy - zero), 4e-6) << i;
      for (double y = -0.3; y < 0.5; y += 0.02) hand.to(on(y));
      EXPECT_EQ(hand.state.status, LinkStatus::ok) << i;
      EXPECT_LE(norm(hand.state.proxy - on(0.48)), 0.02) << i;
    }
}

TEST(StreamlineOnline, SmallCirclesAreNotMistakenForTheirCentre) {
  for (const double radius : {1e-5, 1e-4, 1e-3}) {
    LinkDriver hand = online(analytic_vector("circle"), {Vec3(radius, 0.0, 0.0)});
    for (int i = 0; i < 200; ++i) {
      const Vec3 direction(std::cos(0.05 * i), std::sin(0.05 * i), 0.0);
      hand.to(1.2 * radius * direction);
      ASSERT_EQ(hand.state.status, LinkStatus::ok) << radius << " " << i;
      ASSERT_LE(norm(hand.state.proxy - radius * direction), 1e-3 * radius + 1e-10) << radius;
    }
  }
}

TEST(StreamlineOnline, TheMinimumSpeedStopsAsCritical) {
  const auto field = lambda_field([](const Vec3& p) { return Vec3(1 - 0.5 * p.x, 0.0, 0.0); });
  Online with{Vec3(0.0)};
  with.min_speed = 0.25;
  LinkDriver hand = online(field, with);
  for (int i = 0; i < 4; ++i) hand.to(Vec3(1.9, 0.0, 0.0));
  EXPECT_EQ(hand.state.status, LinkStatus::critical);
  EXPECT_NEAR(hand.state.proxy.x, 1.5, 1e-6);
  hand.to(Vec3(1.0, 0.2, 0.0));
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
  EXPECT_NEAR(hand.state.proxy.x, 1, 1e-10);
}

TEST(StreamlineOnline, BoundaryHoldsUntilTheProbeTurnsBack) {
  const auto grid = sample_vector_grid(field::Mapping{}, {9, 9, 9}, [](const Vec3& p) { return Vec3(1.0, 0.1 * p.x, 0.0); });
  for (const auto method : {flow::Method::linear, flow::Method::euler, flow::Method::rkf34, flow::Method::dp54}) {
    LinkDriver hand = online(grid, {Vec3(4.0, 4.0, 4.0), method});
    for (int i = 0; i < 4; ++i) {
      hand.to(Vec3(9.5, 6.0, 4.0));
      EXPECT_LE(hand.state.evaluations, kMaxEvaluations);
    }
    EXPECT_EQ(hand.state.status, LinkStatus::boundary);
    EXPECT_LE(hand.state.proxy.x, 8 + 1e-8);
    if (method != flow::Method::linear) {
      EXPECT_NEAR(hand.state.proxy.x, 8, 1e-7);
      EXPECT_EQ(hand.state.evaluations, 0);
    }
    for (int i = 0; i < 3; ++i) hand.to(Vec3(5.0, 5.0, 4.0));
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
    EXPECT_NEAR(hand.state.proxy.x, 5, 0.5);
  }
}

TEST(StreamlineOnline, WithoutASeedItStartsAtTheProbe) {
  const auto grid = sample_vector_grid(field::Mapping{}, {9, 9, 9}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  LinkDriver hand = online(grid, {});
  EXPECT_EQ(hand.to(Vec3(-1.0, 3.0, 3.0)), Vec3(-1.0, 3.0, 3.0));
  EXPECT_EQ(hand.state.status, LinkStatus::boundary);
  EXPECT_EQ(hand.to(Vec3(2.0, 3.0, 3.0)), Vec3(2.0, 3.0, 3.0));
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
  EXPECT_LE(norm(hand.to(Vec3(2.5, 4.0, 3.0)) - Vec3(2.5, 3.0, 3.0)), 1e-10);
}

TEST(StreamlineOnline, FieldScaleDoesNotMatter) {
  std::vector<Vec3> reference;
  for (const double scale : {1.0, 1e-300, 1e300}) {
    const auto field = lambda_field([scale](const Vec3& p) { return scale * Vec3(-p.y, p.x, 0.3); });
    LinkDriver hand = online(field, {Vec3(0.5, 0.0, 0.0)});
    for (int i = 0; i < 50; ++i) {
      const Vec3 proxy = hand.to(Vec3(0.5 * std::cos(0.03 * i), 0.6 * std::sin(0.03 * i), 0.01 * i));
      if (scale == 1) reference.push_back(proxy);
      EXPECT_LE(norm(proxy - reference[static_cast<std::size_t>(i)]), 1e-9);
    }
  }
}

TEST(StreamlineOnline, SurvivesBadValuesAndFarProbes) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf, 0.0, 1e-323, 1e308})
    for (const auto method : {flow::Method::linear, flow::Method::euler, flow::Method::rk3, flow::Method::rkf34, flow::Method::dp54}) {
      const auto field = lambda_field([bad](const Vec3& p) { return p.x > 0.5 ? Vec3(bad) : Vec3(1.0, 0.2, 0.0); });
      LinkDriver hand = online(field, {Vec3(0.0), method});
      for (const Vec3& probe : {Vec3(2.0), Vec3(-1e9), Vec3(1e300, 0.0, 0.0), Vec3(0.0), Vec3(0.7)}) {
        hand.to(probe);
        EXPECT_TRUE(is_finite(hand.state.proxy));
        EXPECT_LE(hand.state.evaluations, kMaxEvaluations);
      }
    }
}

TEST(StreamlineOnline, LineFieldsAreSignInvariant) {
  const auto helix = [](const Vec3& p) { return direction(Vec3(-2 * p.y, 2 * p.x, 0.5)); };
  const auto mapping = field::Mapping::from_linear(Mat3(4.0 / 31), Vec3(-2.0));
  std::mt19937 random(5);
  const auto flipping = sample_vector_grid(mapping, {32, 32, 32}, [&](const Vec3& p) { return (random() & 1 ? 1.0 : -1.0) * helix(p); });
  const auto steady = sample_vector_grid(mapping, {32, 32, 32}, helix);
  Online with{Vec3(1.0, 0.2, 0.1)};
  LinkDriver plain = online(steady, with);
  with.line = true;
  LinkDriver fibres = online(flipping, with), same = online(steady, with);
  for (int i = 0; i < 200; ++i) {
    const double a = 0.01 * i;
    const Vec3 probe(std::cos(a + 0.2), std::sin(a + 0.2), 0.1 + 0.25 * a);
    const Vec3 p = fibres.to(probe);
    EXPECT_LE(norm(p - same.to(probe)), 1e-12);
    EXPECT_LE(norm(p - plain.to(probe)), 2e-5) << "dyads are another interpolation than vectors";
  }
}

TEST(StreamlineOnline, IsRepeatableAndAllocatesNothing) {
  const auto abc = analytic_vector("abc");
  const auto walk = [&](std::vector<Vec3>& out) {
    LinkDriver hand = online(abc, {Vec3(0.3, 0.2, 0.1)});
    hand.to(Vec3(0.3, 0.2, 0.1));
    const AllocationCounter guard;
    for (int i = 0; i < 500; ++i) out[static_cast<std::size_t>(i)] = hand.to(Vec3(0.3 + 0.002 * i, 0.2 - 0.001 * i, 0.1 + 0.003 * i));
    EXPECT_EQ(guard.count(), 0u);
  };
  std::vector<Vec3> a(500), b(500);
  walk(a);
  walk(b);
  EXPECT_EQ(std::memcmp(a.data(), b.data(), 500 * sizeof(Vec3)), 0);
}

}  // namespace streamline_online_test
}  // namespace catena::haptics
