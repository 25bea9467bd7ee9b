// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/streamline.h"

#include <cstring>
#include <random>

#include "engine/base/memory_limit.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/haptics/constraints/streamline_fixture.h"

namespace catena::haptics {
namespace streamline_test {

using test::analytic_vector;
using test::lambda_field;
using test::LinkDriver;
using test::sample_vector_grid;
using test::StreamlineFixture;

const std::string kCircle = R"({"name": "a", "type": "streamline", "field": "f", "seed": [0.05, 0, 0]})";

std::string failure(const StreamlineFixture& bench, const std::string& text) {
  const auto built = bench.build(text);
  EXPECT_FALSE(built) << text;
  return built ? "" : built.error().message;
}

TEST(Streamline, KeysAreCheckedWithTheirLine) {
  StreamlineFixture bench;
  bench.with("f", analytic_vector("circle"));
  bench.fields["s"].scalar = field::make_analytic("sphere")->scalar;
  const auto link = [](const std::string& more) { return "\n\n{\"name\": \"a\", \"type\": \"streamline\"" + more + "}"; };
  const std::string bad[] = {"",
                             R"(, "field": "s", "seed": [1, 0, 0])",
                             R"(, "field": "none", "seed": [1, 0, 0])",
                             R"(, "field": 3)",
                             R"(, "field": "f", "seed": [1, 0])",
                             R"(, "field": "f", "seed": [1, 0, "z"])",
                             R"(, "field": "f", "seed": [1, 0, 0], "method": "rk5")",
                             R"(, "field": "f", "seed": [1, 0, 0], "follow": "me")",
                             R"(, "field": "f", "seed": [1, 0, 0], "kind": "tensor")",
                             R"(, "field": "f", "seed": [1, 0, 0], "tolerance": 0)",
                             R"(, "field": "f", "seed": [1, 0, 0], "tolerance": -1e-9)",
                             R"(, "field": "f", "seed": [1, 0, 0], "tolerance": 1)",
                             R"(, "field": "f", "seed": [1, 0, 0], "tolerance": 1e999)",
                             R"(, "field": "f", "seed": [1, 0, 0], "min_speed": -1)",
                             R"(, "field": "f", "follow": "selected")",
                             R"(, "field": "f", "seed": [1, 0, 0], "follow": "selected", "method": "rk4")",
                             R"(, "field": "f", "seed": [0, 0, 0])",
                             R"(, "field": "f", "seed": [0, 0, 0], "follow": "online")",
                             R"(, "field": "f", "seed": [0.1, 0, 0], "method": "rk2", "min_speed": 0.2)"};
  for (const std::string& more : bad) {
    const std::string message = failure(bench, link(more));
    EXPECT_EQ(message.rfind("scene.json:3: ", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  for (const char* good :
       {R"(, "field": "f")", R"(, "field": "f", "method": "dp54")", R"(, "field": "f", "seed": [1, 0, 0], "follow": "selected")",
        R"(, "field": "f", "seed": [1, 0, 0], "follow": "online", "method": "linear", "kind": "line", "min_speed": 0.1)"})
    EXPECT_TRUE(bench.build(link(good))) << good;
}

TEST(Streamline, SeedOutsideAGridIsAnError) {
  StreamlineFixture bench;
  bench.with("f", sample_vector_grid(field::Mapping{}, {8, 8, 8}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }));
  for (const char* more : {"", R"(, "method": "rk4")"})
    EXPECT_NE(failure(bench, std::string(R"({"field": "f", "seed": [9, 0, 0])") + more + "}").find("outside"), std::string::npos);
}

TEST(Streamline, SelectedStartsOnTheSeedAndRestsThere) {
  StreamlineFixture bench;
  bench.with("f", analytic_vector("circle"));
  LinkDriver hand(bench.link(kCircle));
  EXPECT_EQ(hand.to(Vec3(0.05, 0.0, 0.0)), Vec3(0.05, 0.0, 0.0));
  EXPECT_EQ(hand.to(Vec3(0.08, 0.0, 0.3)), Vec3(0.05, 0.0, 0.0));
  EXPECT_EQ(hand.state.evaluations, 0);
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
}

TEST(Streamline, SelectedLapOfTheCircle) {
  StreamlineFixture bench;
  bench.with("f", analytic_vector("circle"));
  LinkDriver hand(bench.link(kCircle));
  const int ticks = static_cast<int>(2 * M_PI * 0.05 / 0.2e-3);
  double off = 0, lag = 0;
  int work = 0;
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double angle = 0.2e-3 * i / 0.05;
    const Vec3 probe(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0);
    const Vec3 proxy = hand.to(probe);
    off = std::max(off, std::fabs(norm(proxy) - 0.05));
    lag = std::max(lag, norm(proxy - probe));
    work = std::max(work, memory_as<SelectedStreamlineMemory>(hand.state).knots_visited);
    EXPECT_EQ(hand.state.evaluations, 0);
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
    // on the drawn curve
    EXPECT_LE(norm(proxy - bench.last_curve->position(memory_as<SelectedStreamlineMemory>(hand.state).s)), 1e-12 * 4);
  }
  std::printf("selected circle: off %.2e, lag %.2e, knots a tick %d\n", off, lag, work);
  EXPECT_LE(off, 5e-10);
  EXPECT_LE(lag, 1e-9);
  EXPECT_LE(work, 8);
}

TEST(Streamline, AProbeAtTheCentreOfACircleKeepsTheProxy) {
  StreamlineFixture bench;
  bench.with("f", analytic_vector("circle"));
  LinkDriver hand(bench.link(kCircle));
  for (const double z : {0.0, 0.3, -2.0}) EXPECT_EQ(hand.to(Vec3(0.0, 0.0, z)), Vec3(0.05, 0.0, 0.0));
  // and with a very far probe
  for (const double far : {1e100, 1e299, 1.7e308}) {
    hand.to(Vec3(-far, far, -far));
    EXPECT_LE(norm(hand.state.proxy - Vec3(-std::sqrt(0.5), std::sqrt(0.5), 0.0) * 0.05), 1e-8) << far;
  }
}

TEST(Streamline, SweepsHaveNoHysteresis) {
  StreamlineFixture bench;
  const auto abc = analytic_vector("abc");
  bench.with("f", abc);
  LinkDriver hand(bench.link(R"({"field": "f", "seed": [0.3, 0.2, 0.1]})"));
  std::vector<Vec3> first;
  for (int sweep = 0; sweep < 20; ++sweep)
    for (int i = 0; i <= 400; ++i) {
      const int at = sweep % 2 ? 400 - i : i;
      const Vec3 probe = bench.last_curve->position(-0.4 + 0.002 * at) + Vec3(0.01, -0.02, 0.015);
      const Vec3 proxy = hand.to(probe);
      if (sweep == 0) first.push_back(proxy);
      ASSERT_EQ(std::memcmp(&first[static_cast<std::size_t>(at)], &proxy, sizeof proxy), 0) << sweep << " " << at;
    }
}

TEST(Streamline, SelectedMovesOnlyAlongDecreasingDistance) {
  StreamlineFixture bench;
  bench.with("f", lambda_field([](const Vec3& p) { return Vec3(-2 * p.y, 2 * p.x, 0.1); }));
  LinkDriver hand(bench.link(R"({"field": "f", "seed": [1, 0, 0]})"));
  hand.to(Vec3(1.0, 0.0, 0.0));
  // near the next turn of the helix the proxy stays on its own turn
  const Vec3 proxy = hand.to(Vec3(1.0, 0.0, 0.3));
  EXPECT_LT(std::fabs(proxy.z), 0.1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 probe(place(random), place(random), place(random));
    const Vec3 before = hand.state.proxy;
    hand.to(probe);
    EXPECT_LE(norm(hand.state.proxy - probe), norm(before - probe) + 1e-9);
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
  }
}

TEST(Streamline, OpenEndsHoldAndReportTheirCause) {
  StreamlineFixture bench;
  bench.with("grid", sample_vector_grid(field::Mapping{}, {9, 9, 9}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }));
  bench.with("node", lambda_field([](const Vec3& p) { return -p; }));
  bench.with("far", lambda_field([](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }));
  LinkDriver boundary(bench.link(R"({"field": "grid", "seed": [4, 4, 4]})"));
  EXPECT_EQ(boundary.to(Vec3(11.0, 5.0, 4.0)), Vec3(8.0, 4.0, 4.0));
  EXPECT_EQ(boundary.state.status, LinkStatus::boundary);
  EXPECT_EQ(boundary.to(Vec3(-3.0, 5.0, 4.0)), Vec3(0.0, 4.0, 4.0));
  EXPECT_EQ(boundary.state.status, LinkStatus::boundary);
  EXPECT_LE(norm(boundary.to(Vec3(6.25, 5.0, 4.0)) - Vec3(6.25, 4.0, 4.0)), 1e-12);
  EXPECT_EQ(boundary.state.status, LinkStatus::ok);
  LinkDriver critical(bench.link(R"({"field": "node", "seed": [1, 0, 0]})"));
  EXPECT_LE(norm(critical.to(Vec3(-1.0, 0.0, 0.0))), 4e-6);
  EXPECT_EQ(critical.state.status, LinkStatus::critical);
  LinkDriver ended(bench.link(R"({"field": "far", "seed": [0, 0, 0]})"));
  ended.to(Vec3(1e6, 0.0, 0.0));
  EXPECT_NEAR(ended.state.proxy.x, 40, 1e-9);
  EXPECT_EQ(ended.state.status, LinkStatus::ok);
}

TEST(Streamline, SelectedAllocatesNothingAndFollowsAFastHand) {
  StreamlineFixture bench;
  bench.with("f", analytic_vector("abc"));
  LinkDriver hand(bench.link(R"({"field": "f", "seed": [0.3, 0.2, 0.1]})"));
  hand.to(Vec3(0.3, 0.2, 0.1));
  int max_knots = 0;
  const AllocationCounter guard;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 target = bench.last_curve->position(0.004 * i);
    hand.to(target);
    EXPECT_NE(hand.state.status, LinkStatus::budget);
    EXPECT_LE(norm(hand.state.proxy - target), 1e-9);
    max_knots = std::max(max_knots, memory_as<SelectedStreamlineMemory>(hand.state).knots_visited);
  }
  EXPECT_EQ(guard.count(), 0u);
  std::printf("selected abc at 1e-3 L a tick: knots a tick %d\n", max_knots);
  EXPECT_LE(max_knots, 8);
}

}  // namespace streamline_test
}  // namespace catena::haptics
