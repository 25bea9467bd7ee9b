// SPDX-License-Identifier: MIT
#include "haptics/chain/release_cue.h"

#include <limits>

#include "tests/haptics/chain/plane_links.h"

namespace catena::haptics::release_cue_test {

using Cue = ReleaseCue::Type;

/// One link on the plane z = 0 that the hand pulls away from.
struct Pull {
  ReleaseCue indication;
  LinkState link;
  ReleaseCueState state;
  LinkReport report;
  double t = 0;
  explicit Pull(Cue cue, double at = 0.1) {
    indication.type = cue;
    indication.distance = at;
    link.switched_on = true;
  }
  Vec3 to(double gap, double dt = 1e-3) {
    report.gap = std::fabs(gap);
    t += dt;
    return update_release_cue(indication, link, Vec3(0, 0, -gap), t, dt, state, report);
  }
};

TEST(ReleaseCue, TheReleaseRatioIsTheGapOverTheDistance) {
  Pull pull(Cue::none);
  for (const double gap : {0.0, 0.02, 0.05, 0.099}) {
    EXPECT_EQ(pull.to(gap), Vec3(0.0));
    EXPECT_DOUBLE_EQ(pull.report.release_ratio, gap / 0.1);
    EXPECT_FALSE(pull.report.released);
  }
  pull.to(0.1);
  EXPECT_TRUE(pull.report.released);
  pull.to(0.3);
  EXPECT_DOUBLE_EQ(pull.report.release_ratio, 3);
}

TEST(ReleaseCue, TheDefaultDistanceIsTheLinksLimitAndWithoutOneThereIsNoCue) {
  Pull pull(Cue::none, 0);
  pull.link.limit = 0.2;
  pull.to(0.1);
  EXPECT_DOUBLE_EQ(pull.report.release_ratio, 0.5);
  pull.link.limit = 0;
  pull.to(1e9);
  EXPECT_EQ(pull.report.release_ratio, 0);
  EXPECT_FALSE(pull.report.released);
  pull.link.released = true;
  pull.to(0);
  EXPECT_EQ(pull.report.release_ratio, 1);
  EXPECT_TRUE(pull.report.released);
  pull.link.switched_on = false;
  pull.to(0);
  EXPECT_FALSE(pull.report.released);
}

TEST(ReleaseCue, ADetentAtTheReleaseAndAtTheReturn) {
  Pull pull(Cue::detent);
  pull.indication.amplitude_n = 0.5;
  pull.indication.duration_s = 0.01;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(pull.to(0.05), Vec3(0.0));
  for (int n = 0; n < 20; ++n) {
    const Vec3 force = pull.to(0.11);
    EXPECT_NEAR(force.z, -0.5 * std::max(0.0, 1 - 0.1 * n), 1e-12) << n;  // towards the feature
  }
  EXPECT_EQ(pull.to(0.097), Vec3(0.0)) << "not back yet";
  EXPECT_NEAR(pull.to(0.05).z, -0.5, 1e-12);
  for (int i = 0; i < 20; ++i) pull.to(0.05);
  EXPECT_EQ(pull.to(0.05), Vec3(0.0));
}

TEST(ReleaseCue, TheDetentOfAReleasePointsToTheLastProxy) {
  Pull pull(Cue::detent, 0);
  pull.link.limit = 0.1;
  pull.to(0.09);
  pull.link.released = true;
  EXPECT_NEAR(pull.to(0).z, -0.5, 1e-12);
}

TEST(ReleaseCue, OneDetentWhileAProxySlipsAtItsLimit) {
  // a dragged proxy: the gap equals its limit up to round-off
  Pull pull(Cue::detent, 0);
  pull.link.limit = 0.1;
  pull.to(0.05);
  int pulses = 0;
  double last = 0;
  for (int i = 0; i < 500; ++i) {
    const double now = norm(pull.to(0.1 * (1 + ((i * 7) % 5 - 2) * 1e-16)));
    pulses += now > last;
    last = now;
  }
  EXPECT_EQ(pulses, 1);
}

TEST(ReleaseCue, AVibrationNearTheRelease) {
  Pull pull(Cue::vibration);
  pull.indication.amplitude_n = 0.4;
  pull.indication.frequency_hz = 50;
  pull.indication.onset = 0.8;
  for (int i = 0; i < 30; ++i) EXPECT_EQ(pull.to(0.0799), Vec3(0.0));
  double minimum = 0, maximum = 0, sum = 0;
  for (int i = 0; i < 200; ++i) {
    const double z = pull.to(0.09).z;
    minimum = std::min(minimum, z);
    maximum = std::max(maximum, z);
    sum += z;
  }
  EXPECT_NEAR(minimum, -0.4, 1e-9);
  EXPECT_NEAR(maximum, 0.4, 1e-9);
  EXPECT_NEAR(sum, 0, 1e-9);  // ten whole periods
  pull.link.released = true;
  EXPECT_EQ(pull.to(0), Vec3(0.0));
}

TEST(ReleaseCue, ExtremesStayFinite) {
  for (const Cue cue : {Cue::detent, Cue::vibration})
    for (const double gap : {1e300, 1e-320, std::numeric_limits<double>::infinity(), 0.0})
      for (const double dt : {1e308, 1e-300, 0.0}) {
        Pull pull(cue, 1e-300);
        pull.indication.frequency_hz = 1e10;
        for (int i = 0; i < 4; ++i) {
          EXPECT_TRUE(is_finite(pull.to(i % 2 == 0 ? gap : 1.0, dt)));
          EXPECT_TRUE(std::isfinite(pull.report.release_ratio));
        }
      }
}

TEST(ReleaseCue, InTheChainCuesRampInAndEndWithTheirLink) {
  HapticProgram program;
  program.links = {test::hold_plane("a", {0, 0, 1}, 0, 0)};  // no stiffness: the cue alone
  program.links[0].active_when.button = 1;
  program.links[0].release_cue = {.type = Cue::vibration, .distance = 0.1, .onset = 0, .amplitude_n = 1, .frequency_hz = 10};
  program.coupling.ramp_s = 0.1;
  test::ChainDriver hand(program);
  const Vec3 probe(0, 0, 0.05);
  hand.step(probe);
  double swing = 0;
  for (int i = 0; i < 600; ++i) {
    const double before = hand.out.force_n.z;
    hand.step(probe, i < 200 ? 1 : i < 300 ? 0 : static_cast<std::uint32_t>(i / 20 % 2));
    // per tick the wave changes by at most 4 x 10 Hz x 1 ms, the ramp by 0.01
    const bool on = i < 200 || (i >= 300 && i / 20 % 2 == 1);
    if (on)
      EXPECT_LE(std::fabs(hand.out.force_n.z - before), 0.04 + 0.01 + 1e-9) << i;
    else
      EXPECT_EQ(hand.out.force_n, Vec3(0.0)) << i;
    swing = std::max(swing, std::fabs(hand.out.force_n.z));
    EXPECT_DOUBLE_EQ(i >= 101 && i < 200 ? hand.link().release_ratio : 0.5, 0.5);
  }
  EXPECT_GT(swing, 0.9);
}

TEST(ReleaseCue, ABadProbeReportsNoGap) {
  test::ChainDriver hand(test::make_order_program(0));
  hand.step({0.3, 0.4, 3}, 3);
  EXPECT_TRUE(hand.out.links[2].released);
  hand.out = {};
  hand.step({0, std::numeric_limits<double>::quiet_NaN(), 0}, 3);
  EXPECT_EQ(hand.out.links[2].gap, 0);
  EXPECT_TRUE(hand.out.links[2].released);
  EXPECT_EQ(hand.out.force_n, Vec3(0.0));
}

}  // namespace catena::haptics::release_cue_test
