// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/selected_streamline.h"

#include "engine/base/memory_limit.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::streamline_test {

using test::analytic_vector;
using test::lambda_field;
using test::sample_vector_grid;
using tests::Fields;
using tests::Rig;

Fields fields_of(const field::VectorFieldPtr& v) {
  Fields fields;
  fields.named["f"].vector = v;
  return fields;
}
std::string streamline(const std::string& keys) { return R"({"name": "a", "type": "streamline", )" + keys + "}"; }
/// A link that follows the line of the field "f" through the seed.
Rig selected(const Fields& fields, const std::string& seed) {
  return Rig(tests::build(streamline(R"("field": "f", "seed": )" + seed), fields));
}

TEST(Streamline, KeysAreCheckedWithTheirLine) {
  Fields fields = fields_of(analytic_vector("circle"));
  fields.named["s"].scalar = tests::analytic_field("sphere");
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
  for (const std::string& more : bad) tests::expect_refused(link(more), 3, {}, fields);
  for (const char* good :
       {R"(, "field": "f")", R"(, "field": "f", "method": "dp54")", R"(, "field": "f", "seed": [1, 0, 0], "follow": "selected")",
        R"(, "field": "f", "seed": [1, 0, 0], "follow": "online", "method": "linear", "kind": "line", "min_speed": 0.1)"})
    EXPECT_TRUE(tests::try_build(link(good), fields)) << good;
}

TEST(Streamline, SeedOutsideAGridIsAnError) {
  const Fields fields = fields_of(sample_vector_grid(field::Mapping{}, {8, 8, 8}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }));
  for (const char* more : {"", R"(, "method": "rk4")"})
    tests::expect_refused(streamline(std::string(R"("field": "f", "seed": [9, 0, 0])") + more), 1, {"outside"}, fields);
}

TEST(Streamline, SelectedStartsOnTheSeedAndRestsThere) {
  const Fields fields = fields_of(analytic_vector("circle"));
  Rig hand = selected(fields, "[0.05, 0, 0]");
  EXPECT_EQ(hand.tick(Vec3(0.05, 0.0, 0.0)).proxy, Vec3(0.05, 0.0, 0.0));
  EXPECT_EQ(hand.tick(Vec3(0.08, 0.0, 0.3)).proxy, Vec3(0.05, 0.0, 0.0));
  EXPECT_EQ(hand.state.evaluations, 0);
  EXPECT_EQ(hand.state.status, LinkStatus::ok);
}

TEST(Streamline, SelectedLapOfTheCircle) {
  const Fields fields = fields_of(analytic_vector("circle"));
  Rig hand = selected(fields, "[0.05, 0, 0]");
  const int ticks = static_cast<int>(2 * M_PI * 0.05 / 0.2e-3);
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double angle = 0.2e-3 * i / 0.05;
    const Vec3 probe(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0);
    const Vec3 proxy = hand.tick(probe).proxy;
    EXPECT_LE(std::fabs(norm(proxy) - 0.05), 5e-10);
    EXPECT_LE(norm(proxy - probe), 1e-9);
    EXPECT_LE(memory_as<SelectedStreamlineMemory>(hand.state).knots_visited, 8);
    EXPECT_EQ(hand.state.evaluations, 0);
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
    // on the drawn curve
    EXPECT_LE(norm(proxy - fields.last_curve->position(memory_as<SelectedStreamlineMemory>(hand.state).s)), 1e-12 * 4);
  }
}

TEST(Streamline, AProbeAtTheCentreOfACircleKeepsTheProxy) {
  const Fields fields = fields_of(analytic_vector("circle"));
  Rig hand = selected(fields, "[0.05, 0, 0]");
  for (const double z : {0.0, 0.3, -2.0}) EXPECT_EQ(hand.tick(Vec3(0.0, 0.0, z)).proxy, Vec3(0.05, 0.0, 0.0));
  // and with a very far probe
  for (const double far : {1e100, 1e299, 1.7e308}) {
    EXPECT_LE(norm(hand.tick(Vec3(-far, far, -far)).proxy - Vec3(-std::sqrt(0.5), std::sqrt(0.5), 0.0) * 0.05), 1e-8) << far;
  }
}

TEST(Streamline, SweepsHaveNoHysteresis) {
  const Fields fields = fields_of(analytic_vector("abc"));
  Rig hand = selected(fields, "[0.3, 0.2, 0.1]");
  std::vector<Vec3> first;
  for (int sweep = 0; sweep < 20; ++sweep)
    for (int i = 0; i <= 400; ++i) {
      const int at = sweep % 2 ? 400 - i : i;
      const Vec3 probe = fields.last_curve->position(-0.4 + 0.002 * at) + Vec3(0.01, -0.02, 0.015);
      const Vec3 proxy = hand.tick(probe).proxy;
      if (sweep == 0) first.push_back(proxy);
      ASSERT_EQ(std::memcmp(&first[static_cast<std::size_t>(at)], &proxy, sizeof proxy), 0) << sweep << " " << at;
    }
}

TEST(Streamline, SelectedMovesOnlyAlongDecreasingDistance) {
  Rig hand = selected(fields_of(lambda_field([](const Vec3& p) { return Vec3(-2 * p.y, 2 * p.x, 0.1); })), "[1, 0, 0]");
  hand.tick(Vec3(1.0, 0.0, 0.0));
  // near the next turn of the helix the proxy stays on its own turn
  const Vec3 proxy = hand.tick(Vec3(1.0, 0.0, 0.3)).proxy;
  EXPECT_LT(std::fabs(proxy.z), 0.1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 probe(place(random), place(random), place(random));
    const Vec3 before = hand.state.proxy;
    EXPECT_LE(norm(hand.tick(probe).proxy - probe), norm(before - probe) + 1e-9);
    EXPECT_EQ(hand.state.status, LinkStatus::ok);
  }
}

TEST(Streamline, OpenEndsHoldAndReportTheirCause) {
  const auto along_x = [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); };
  Rig boundary = selected(fields_of(sample_vector_grid(field::Mapping{}, {9, 9, 9}, along_x)), "[4, 4, 4]");
  EXPECT_EQ(boundary.tick(Vec3(11.0, 5.0, 4.0)).proxy, Vec3(8.0, 4.0, 4.0));
  EXPECT_EQ(boundary.state.status, LinkStatus::boundary);
  EXPECT_EQ(boundary.tick(Vec3(-3.0, 5.0, 4.0)).proxy, Vec3(0.0, 4.0, 4.0));
  EXPECT_EQ(boundary.state.status, LinkStatus::boundary);
  EXPECT_LE(norm(boundary.tick(Vec3(6.25, 5.0, 4.0)).proxy - Vec3(6.25, 4.0, 4.0)), 1e-12);
  EXPECT_EQ(boundary.state.status, LinkStatus::ok);
  Rig critical = selected(fields_of(lambda_field([](const Vec3& p) { return -p; })), "[1, 0, 0]");
  EXPECT_LE(norm(critical.tick(Vec3(-1.0, 0.0, 0.0)).proxy), 4e-6);
  EXPECT_EQ(critical.state.status, LinkStatus::critical);
  Rig ended = selected(fields_of(lambda_field(along_x)), "[0, 0, 0]");
  EXPECT_NEAR(ended.tick(Vec3(1e6, 0.0, 0.0)).proxy.x, 40, 1e-9);
  EXPECT_EQ(ended.state.status, LinkStatus::ok);
}

TEST(Streamline, SelectedAllocatesNothingAndFollowsAFastHand) {
  const Fields fields = fields_of(analytic_vector("abc"));
  Rig hand = selected(fields, "[0.3, 0.2, 0.1]");
  hand.tick(Vec3(0.3, 0.2, 0.1));
  const AllocationCounter guard;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 target = fields.last_curve->position(0.004 * i);
    EXPECT_NE(hand.tick(target).status, LinkStatus::budget);
    EXPECT_LE(norm(hand.state.proxy - target), 1e-9);
    EXPECT_LE(memory_as<SelectedStreamlineMemory>(hand.state).knots_visited, 8);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace catena::haptics::streamline_test
