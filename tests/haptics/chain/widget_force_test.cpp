// SPDX-License-Identifier: MIT
// Widgets in the tick: no force jumps at switches, reorders or changes of shape; hostile input; determinism; no allocation.
#include <random>

#include "engine/base/memory_limit.h"
#include "haptics/chain/state_hash.h"
#include "tests/haptics/chain/plane_links.h"
#include "tests/haptics/chain/widget_probe.h"

namespace catena::haptics::widget_force_test {

using test::make_widget_program;
using test::make_widget_spec;
using test::WidgetProbe;
using widget::Kind;
using widget::RotationMode;
using widget::Spec;

struct Step {
  Vec3 to;
  std::uint32_t buttons;
};

// Every transition of a cutting plane: buttons are pressed and released where the springs are stretched.
std::vector<Step> plane_script() {
  const double a = 0.48 * 0.6, b = 0.48 * 0.8;
  return {{{1, 0, 0.5}, 0},         {{1, 0, 0.07}, 0},        {{1, 0, 0.19}, 0},      {{1, 0, 0.3}, 0},        // explore, away
          {{1, 0, 0.07}, 0},        {{1, 0, 0.15}, 0},        {{1, 0, 0.15}, 1},      {{1.07, 0.07, 0.1}, 1},  // translate
          {{1.5, 0.07, 0.1}, 1},    {{1.5, 0.6, -0.4}, 1},    {{1.07, 0.07, 0.1}, 1}, {{1.07, 0.07, 0.1}, 0},  // explore
          {{0, a, b}, 0},           {{0.05, a, b + 0.05}, 0},                                                  // rotate
          {{0.05, a, b + 0.05}, 1}, {{0.07, b, a}, 1},        {{0.2, b, a}, 1},       {{-0.3, -b, a}, 1},      // turn, freely
          {{-0.3, -b, a}, 0},       {{-0.2, -b, a}, 0},       {{-0.2, 0, 0.03}, 0},   {{2, 2, 2}, 0}};
}

std::vector<Step> handles_script() {
  return {{{1, 0, 0.5}, 0},     {{1, 0, 0.1}, 0},  {{1, 0.06, 0.1}, 1}, {{1.07, 0.1, 0.05}, 1}, {{1.7, 0.1, 0.9}, 1},
          {{1.7, 0.1, 0.9}, 0}, {{1, 0, 0.9}, 0},  {{0, 1, 0.1}, 0},    {{0, 1, 0.1}, 1},       {{0.6, 1, 0.5}, 1},
          {{0.6, 1, 0.5}, 0},   {{-1, 0, 0.1}, 0}, {{-1, 0, 0.1}, 1},   {{-1.7, 0.5, 0.1}, 1},  {{-1.7, 0.5, 0.1}, 0}};
}

struct Jumps {
  double maximum = 0;
  double over = 0;  // maximum excess of a tick over the bound of ramp.h
  int changes = 0;
};

Jumps drive(const HapticProgram& program, const std::vector<Step>& script, double speed, double dt, double ramp_s) {
  const double move = speed * dt;
  WidgetProbe hand(program);
  hand.step({1, 0, 0.5});
  Jumps out;
  Vec3 before = hand.out.force_n;
  LinkOrder order = hand.state.order;
  for (const Step& step : script) {
    const Vec3 from = hand.position;
    const int n = std::max(1, static_cast<int>(std::ceil(norm(step.to - from) / move)));
    for (int i = 1; i <= n + 60; ++i) {  // then rests for 60 ticks
      hand.step(i >= n ? step.to : from + (step.to - from) * (static_cast<double>(i) / n), step.buttons, dt);
      const double jump = norm(hand.out.force_n - before);
      out.maximum = std::max(out.maximum, jump);
      // max_force dt / ramp_s + K |dx|, with an upper bound of K
      out.over = std::max(out.over, jump - (dt / ramp_s * program.coupling.max_force_n + 8 * 500 * (i <= n ? move : 0)));
      before = hand.out.force_n;
      out.changes += order == hand.state.order ? 0 : 1;
      order = hand.state.order;
    }
  }
  return out;
}

std::vector<Link> scene_links() { return {test::hold_plane("a", {0.2, 1, 0}, 0.1, 300), test::hold_plane("b", {1, 0, 0.3}, -0.2, 400)}; }

TEST(WidgetForce, NoTransitionOfACuttingPlaneMakesTheForceJump) {
  for (const RotationMode turning : {RotationMode::any, RotationMode::free, RotationMode::axis})
    for (const bool touch : {false, true})
      for (const bool with_links : {false, true}) {
        std::vector<double> maximum;
        for (const double dt : {1e-3, 2.5e-4, 6.25e-5}) {
          Spec spec = make_widget_spec(Kind::cutting_plane);
          spec.rotation = turning;
          spec.rotate_on_contact = touch;
          const HapticProgram program = make_widget_program({spec}, with_links ? scene_links() : std::vector<Link>{}, 0.05);
          const Jumps jumps = drive(program, plane_script(), 2, dt, 0.05);
          EXPECT_GT(jumps.changes, 12);
          EXPECT_LE(jumps.over, 1e-9) << dt;
          maximum.push_back(jumps.maximum);
        }
        // the largest force step scales with the tick, so none is a jump
        EXPECT_LT(maximum[1], 0.6 * maximum[0]);
        EXPECT_LT(maximum[2], 0.6 * maximum[1]);
      }
}

TEST(WidgetForce, WithoutTheRampTheForceJumps) {
  const HapticProgram program = make_widget_program({make_widget_spec(Kind::cutting_plane)}, scene_links(), 0);
  const Jumps jumps = drive(program, plane_script(), 2, 1e-3, 0.05);
  EXPECT_GT(jumps.maximum, 50);
  EXPECT_GT(jumps.over, 20) << "what the other tests hold forces to is no idle bound";
}

TEST(WidgetForce, NoTransitionOfHandlesMakesTheForceJump) {
  std::vector<Spec> specs{make_widget_spec(Kind::seed, {1, 0, 0}), make_widget_spec(Kind::rake, {0, 1, 0}, {0, 1, 1}),
                          make_widget_spec(Kind::box, {-1, -0.5, -0.4}, {-0.5, 0.5, 0.6})};
  std::vector<double> maximum;
  for (const double dt : {1e-3, 2.5e-4}) {
    const Jumps jumps = drive(make_widget_program(specs, scene_links(), 0.05), handles_script(), 2, dt, 0.05);
    EXPECT_GT(jumps.changes, 9);
    EXPECT_LE(jumps.over, 1e-9) << dt;
    maximum.push_back(jumps.maximum);
  }
  EXPECT_LT(maximum[1], 0.6 * maximum[0]);
}

// plane z of mode explore passes through the centre, that of mode translate through the probe: the same link with another shape
TEST(WidgetForce, ALinkWithAChangedShapeRestartsAndItsOldForceRampsOut) {
  WidgetProbe hand(make_widget_program({make_widget_spec(Kind::cutting_plane)}, {}, 0.1));
  hand.step({1, 0, 0.5});
  hand.step({1, 0, 0.05});
  for (int k = 0; k < 150; ++k) hand.step({1, 0, 0.1});
  EXPECT_NEAR(hand.out.force_n.z, -50, 1e-9);
  hand.expect({1, 0, 0.1}, 1, "translate", "widget_x widget_y widget_z");
  EXPECT_NEAR(hand.out.force_n.z, -50 + 5, 1e-9) << "max_force in 0.1 s";
  EXPECT_NEAR(hand.out.links[2].weight, 0.01, 1e-12);
  for (int k = 2; k <= 10; ++k) {
    hand.step({1, 0, 0.1}, 1);
    ASSERT_NEAR(hand.out.force_n.z, -50 + 5 * k, 1e-9);
  }
  hand.step({1, 0, 0.1}, 1);
  EXPECT_NEAR(norm(hand.out.force_n), 0, 1e-9);
}

TEST(WidgetForce, WhileAWidgetIsGrabbedTheScenesLinksAreOff) {
  WidgetProbe hand(make_widget_program({make_widget_spec(Kind::cutting_plane)}, scene_links()));
  hand.expect({1, 0, 0}, 0, "explore", "a b widget_z");
  hand.expect({1, 0, 0}, 1, "translate", "widget_x widget_y widget_z");
  EXPECT_FALSE(hand.out.links[0].active);
  EXPECT_EQ(hand.out.links[0].proxy, Vec3(1, 0, 0));
  hand.expect({1, 0, 0}, 0, "explore", "a b widget_z");
}

HapticProgram everything(double ramp_s) {
  Spec free = make_widget_spec(Kind::cutting_plane, {-0.4, 0.2, 0.1});
  free.rotation = RotationMode::free;
  free.rotate_on_contact = true;
  free.button = 2;
  free.pose.orientation = test::kTilted;
  return make_widget_program(
      {make_widget_spec(Kind::cutting_plane, {0.2, 0, 0}), free, make_widget_spec(Kind::seed, {0.5, 0.5, 0.5}),
       make_widget_spec(Kind::rake, {-1, 0, 0}, {-0.5, 0.5, 0.5}), make_widget_spec(Kind::box, {-0.5, -0.5, -0.5}, {0.5, 0.4, 0.3}),
       make_widget_spec(Kind::ruler, {0, -0.5, 0}, {0.4, -0.5, 0.6})},
      scene_links(), ramp_s);
}

// Ticks with random buttons and probes, including far away and non-finite positions.
std::uint64_t hostile(std::uint64_t seed, int ticks) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> anywhere(-1.2, 1.2), unit(0, 1);
  WidgetProbe hand(everything(0.02));
  Vec3 at(0.0);
  std::uint32_t buttons = 0;
  StateHash hash;
  int grabbed = 0;
  for (int k = 0; k < ticks; ++k) {
    const double chance = unit(random);
    if (chance < 0.02) at = {anywhere(random), anywhere(random), anywhere(random)};
    if (chance < 0.1) buttons = static_cast<std::uint32_t>(random());
    at += Vec3(anywhere(random), anywhere(random), anywhere(random)) * (chance < 0.9 ? 0.01 : 0.2);
    if (norm(at) > 2) at *= 0.3;
    Vec3 probe = at;
    if (chance > 0.998) probe = at * 1e300;
    if (chance > 0.997 && chance < 0.998) probe.y = NAN;
    hand.step(probe, buttons);
    hash.add(hand.out);
    EXPECT_TRUE(is_finite(hand.out.force_n)) << k;
    int engaged = 0;
    for (std::size_t i = 0; i < hand.program.widgets.size(); ++i) {
      const WidgetReport& w = hand.out.widgets[i];
      EXPECT_TRUE(is_finite(w.pose.points[0]) && is_finite(w.pose.points[1])) << k;
      const Quat& q = w.pose.orientation;
      EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-14) << k;
      engaged += w.mode != WidgetMode::idle;
      grabbed += widget::is_grabbed(w.mode);
    }
    EXPECT_LE(engaged, 1) << k;
    const WidgetPose& box = hand.out.widgets[4].pose;
    for (int a = 0; a < 3; ++a) EXPECT_LE(box.points[0][a], box.points[1][a]) << k;
    if (testing::Test::HasFailure()) return 0;
  }
  EXPECT_GT(grabbed, ticks / 50);
  return hash.value();
}

TEST(WidgetForce, HostileTicksKeepPosesValidAndAreRepeatable) {
  const std::uint64_t first = hostile(7, 100000);
  EXPECT_EQ(first, hostile(7, 100000));
  EXPECT_NE(first, hostile(8, 1000));
}

TEST(WidgetForce, ATickAllocatesNothing) {
  WidgetProbe hand(everything(0.02));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const AllocationCounter guard;
  for (int k = 0; k < 5000; ++k) {
    if (k % 50 == 0) hand.position = {anywhere(random), anywhere(random), anywhere(random)};
    hand.step(hand.position + Vec3(anywhere(random), anywhere(random), anywhere(random)) * 0.02, static_cast<std::uint32_t>(random() & 3));
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace catena::haptics::widget_force_test
