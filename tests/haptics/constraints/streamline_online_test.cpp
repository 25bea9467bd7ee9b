// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/online_streamline.h"

#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::streamline_online_test {

using test::analytic_vector;
using test::lambda_field;
using test::sample_vector_grid;
using tests::Rig;

OnlineStreamlineSpec from_seed(const Vec3& seed, flow::Method method = flow::Method::rkf34) {
  OnlineStreamlineSpec spec;
  spec.seed = seed;
  spec.method = method;
  return spec;
}

Rig online(const field::VectorFieldPtr& field, OnlineStreamlineSpec spec) {
  spec.field = field;
  return Rig(make_online_streamline(spec));
}

// the distance of the proxy from the circle of radius 0.05 in one lap of the probe at 0.2 units/s and 1 kHz
TEST(StreamlineOnline, DriftOfOneLapOfTheCircle) {
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
  const int ticks = static_cast<int>(std::lround(2 * M_PI * 0.05 / 0.2e-3));
  for (const auto& c : cases) {
    SCOPED_TRACE(flow::to_string(c.method));
    Rig hand = online(analytic_vector("circle"), from_seed(Vec3(0.05, 0.0, 0.0), c.method));
    double drift = 0;
    for (int i = 0; i <= ticks; ++i) {
      const double angle = 0.2e-3 * i / 0.05;
      hand.tick(Vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0));
      drift = std::max(drift, std::fabs(norm(hand.state.proxy) - 0.05));
      EXPECT_LE(hand.state.evaluations, c.method == flow::Method::linear ? 2 : kMaxEvaluations);
      EXPECT_EQ(hand.state.status, LinkStatus::ok);
    }
    EXPECT_LE(drift, c.greatest);
    EXPECT_GE(drift, c.least);
  }
}

TEST(StreamlineOnline, ConvergesFromAnyDistanceToACircleAndRests) {
  // R = 1, the probe at d in [0.2, 6] R, 20 degrees off
  const auto circle = analytic_vector("circle");
  for (const double d : {0.2, 0.5, 0.9, 1.0, 1.1, 1.9, 2.1, 2.5, 4.0, 6.0}) {
    Rig hand = online(circle, from_seed(Vec3(1.0, 0.0, 0.0)));
    const double angle = 20 * M_PI / 180;
    const Vec3 probe(d * std::cos(angle), d * std::sin(angle), 0.0);
    EXPECT_LE(hand.tick(probe).evaluations, kMaxEvaluations) << d;
    EXPECT_EQ(hand.state.status, LinkStatus::ok) << d;
    EXPECT_LE(norm(hand.state.proxy - Vec3(std::cos(angle), std::sin(angle), 0.0)), 4e-8) << d;
    // tangential residual
    EXPECT_LE(hand.state.residual, 1e-9) << d;
    const Vec3 rest = hand.state.proxy;
    EXPECT_EQ(hand.tick(probe).proxy, rest);
    EXPECT_EQ(hand.state.evaluations, 0);
  }
}

TEST(StreamlineOnline, DistanceNeverGrowsFromColdStarts) {
  const auto abc = analytic_vector("abc");
  std::mt19937 random(17);
  std::uniform_real_distribution<double> place(-4, 4);
  int budget = 0;
  for (int i = 0; i < 600; ++i) {
    const Vec3 seed(place(random), place(random), place(random)), probe(place(random), place(random), place(random));
    Rig hand = online(i % 2 ? analytic_vector("circle") : abc, from_seed(seed));
    double distance = norm(seed - probe);
    for (int tick = 0; tick < 6; ++tick) {
      ASSERT_LE(hand.tick(probe).evaluations, kMaxEvaluations);
      const double now = norm(hand.state.proxy - probe);
      ASSERT_LE(now, distance * (1 + 1e-15) + 1e-15);
      distance = now;
    }
    budget += hand.state.status == LinkStatus::budget;
  }
  EXPECT_LE(budget, 30);
}

TEST(StreamlineOnline, NodesAndStraightManifoldsStopAsCriticalAndAreLeft) {
  const auto node = lambda_field([](const Vec3& p) { return Vec3(-p.x, -2 * p.y, -3 * p.z); });
  const auto saddle = lambda_field([](const Vec3& p) { return Vec3(2 * p.x, -p.y, 0.0); });
  for (const auto method : {flow::Method::euler, flow::Method::rk2, flow::Method::rk4, flow::Method::rkf34, flow::Method::dp54})
    for (const auto& [field, seed] :
         {std::pair{node, Vec3(1.0, 0.0, 0.0)}, std::pair{saddle, Vec3(0.0, 1.0, 0.0)}, std::pair{node, Vec3(0.0, 0.0, 0.7)}}) {
      Rig hand = online(field, from_seed(seed, method));
      for (int tick = 0; tick < 6; ++tick) {
        EXPECT_LE(hand.tick(-0.5 * seed).evaluations, kMaxEvaluations);
      }
      EXPECT_EQ(hand.state.status, LinkStatus::critical) << flow::to_string(method);
      EXPECT_LE(norm(hand.state.proxy), 4e-6) << flow::to_string(method);
      EXPECT_EQ(hand.tick(-0.1 * seed).evaluations, 0);
      // the hand reverses
      for (int tick = 0; tick < 3; ++tick) hand.tick(0.3 * seed);
      EXPECT_EQ(hand.state.status, LinkStatus::ok);
      EXPECT_LE(norm(hand.state.proxy - 0.3 * seed), 1e-6) << flow::to_string(method);
    }
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
      Rig hand = online(field, from_seed(on(1), method));
      for (double y = 0.99; y > -0.3; y -= 0.02) {
        const double before = norm(hand.state.proxy - on(y));
        const bool started = hand.state.started;
        ASSERT_TRUE(norm(hand.tick(on(y)).proxy - on(y)) <= before + 1e-14 || !started) << i;
      }
      EXPECT_EQ(hand.state.status, LinkStatus::critical) << i;
      EXPECT_LE(norm(hand.state.proxy - zero), 4e-6) << i;
      for (double y = -0.3; y < 0.5; y += 0.02) hand.tick(on(y));
      EXPECT_EQ(hand.state.status, LinkStatus::ok) << i;
      EXPECT_LE(norm(hand.state.proxy - on(0.48)), 0.02) << i;
    }
}

TEST(StreamlineOnline, SmallCirclesAreNotMistakenForTheirCentre) {
  for (const double radius : {1e-5, 1e-4, 1e-3}) {
    Rig hand = online(analytic_vector("circle"), from_seed(Vec3(radius, 0.0, 0.0)));
    for (int i = 0; i < 200; ++i) {
      const Vec3 direction(std::cos(0.05 * i), std::sin(0.05 * i), 0.0);
      ASSERT_EQ(hand.tick(1.2 * radius * direction).status, LinkStatus::ok) << radius << " " << i;
      ASSERT_LE(norm(hand.state.proxy - radius * direction), 1e-3 * radius + 1e-10) << radius;
    }
  }
}

TEST(StreamlineOnline, TheMinimumSpeedStopsAsCritical) {
  const auto field = lambda_field([](const Vec3& p) { return Vec3(1 - 0.5 * p.x, 0.0, 0.0); });
  OnlineStreamlineSpec with = from_seed(Vec3(0.0));
  with.min_speed = 0.25;
  Rig hand = online(field, with);
  for (int i = 0; i < 4; ++i) hand.tick(Vec3(1.9, 0.0, 0.0));
  EXPECT_EQ(hand.state.status, LinkStatus::critical);
  EXPECT_NEAR(hand.state.proxy.x, 1.5, 1e-6);
  EXPECT_EQ(hand.tick(Vec3(1.0, 0.2, 0.0)).status, LinkStatus::ok);
  EXPECT_NEAR(hand.state.proxy.x, 1, 1e-10);
}

TEST(StreamlineOnline, BoundaryHoldsUntilTheProbeTurnsBack) {
  const auto grid = sample_vector_grid(field::Mapping{}, {9, 9, 9}, [](const Vec3& p) { return Vec3(1.0, 0.1 * p.x, 0.0); });
  for (const auto method : {flow::Method::linear, flow::Method::euler, flow::Method::rkf34, flow::Method::dp54}) {
    Rig hand = online(grid, from_seed(Vec3(4.0, 4.0, 4.0), method));
    for (int i = 0; i < 4; ++i) {
      EXPECT_LE(hand.tick(Vec3(9.5, 6.0, 4.0)).evaluations, kMaxEvaluations);
    }
    EXPECT_EQ(hand.state.status, LinkStatus::boundary);
    EXPECT_LE(hand.state.proxy.x, 8 + 1e-8);
    if (method != flow::Method::linear) {
      EXPECT_NEAR(hand.state.proxy.x, 8, 1e-7);
      EXPECT_EQ(hand.state.evaluations, 0);
    }
    for (int i = 0; i < 3; ++i) hand.tick(Vec3(5.0, 5.0, 4.0));
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
    EXPECT_NEAR(hand.state.proxy.x, 5, 0.5);
  }
}

TEST(StreamlineOnline, WithoutASeedItStartsAtTheProbe) {
  const auto grid = sample_vector_grid(field::Mapping{}, {9, 9, 9}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  Rig hand = online(grid, OnlineStreamlineSpec{});
  EXPECT_EQ(hand.tick(Vec3(-1.0, 3.0, 3.0)).proxy, Vec3(-1.0, 3.0, 3.0));
  EXPECT_EQ(hand.state.status, LinkStatus::boundary);
  EXPECT_EQ(hand.tick(Vec3(2.0, 3.0, 3.0)).proxy, Vec3(2.0, 3.0, 3.0));
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
  EXPECT_LE(norm(hand.tick(Vec3(2.5, 4.0, 3.0)).proxy - Vec3(2.5, 3.0, 3.0)), 1e-10);
}

TEST(StreamlineOnline, SurvivesBadValuesAndFarProbes) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf, 0.0, 1e-323, 1e308})
    for (const auto method : {flow::Method::linear, flow::Method::euler, flow::Method::rk3, flow::Method::rkf34, flow::Method::dp54}) {
      const auto field = lambda_field([bad](const Vec3& p) { return p.x > 0.5 ? Vec3(bad) : Vec3(1.0, 0.2, 0.0); });
      Rig hand = online(field, from_seed(Vec3(0.0), method));
      for (const Vec3& probe : {Vec3(2.0), Vec3(-1e9), Vec3(1e300, 0.0, 0.0), Vec3(0.0), Vec3(0.7)}) {
        EXPECT_TRUE(is_finite(hand.tick(probe).proxy));
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
  OnlineStreamlineSpec with = from_seed(Vec3(1.0, 0.2, 0.1));
  Rig plain = online(steady, with);
  with.is_line_field = true;
  Rig fibres = online(flipping, with), same = online(steady, with);
  for (int i = 0; i < 200; ++i) {
    const double a = 0.01 * i;
    const Vec3 probe(std::cos(a + 0.2), std::sin(a + 0.2), 0.1 + 0.25 * a);
    const Vec3 p = fibres.tick(probe).proxy;
    EXPECT_LE(norm(p - same.tick(probe).proxy), 1e-12);
    EXPECT_LE(norm(p - plain.tick(probe).proxy), 2e-5) << "dyads are another interpolation than vectors";
  }
}

}  // namespace catena::haptics::streamline_online_test
