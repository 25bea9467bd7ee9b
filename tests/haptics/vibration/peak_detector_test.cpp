// SPDX-License-Identifier: MIT
/// What a sender that looks some dozens of times a second learns of a force at 1 kHz: detents, contact, friction, of the real tick.
#include "haptics/vibration/peak_detector.h"

#include <gtest/gtest.h>

#include <thread>

#include "haptics/chain/tick.h"
#include "haptics/servo/servo_tick.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/support/simple_links.h"

namespace peaks_test {

using namespace catena;
using namespace catena::haptics;

/// A hand that goes its way whatever it feels, on the real tick.
struct Way {
  explicit Way(Link link) {
    program.links = {std::move(link)};
    program.meters_per_unit = 0.1;
  }
  void to(const Vec3& hand_m) {
    tick(program, {1e-3 * static_cast<double>(ticks++), world_from_device(program, hand_m)}, *state, *scratch, out);
    const DeviceOutput sent = make_device_output(program, out, *state);
    peaks.add({sent.requested_force_n, hand_m, sent.accounted_j, sent.forces_active});
  }
  HapticProgram program;
  std::unique_ptr<ChainState> state = std::make_unique<ChainState>();
  std::unique_ptr<ChainScratch> scratch = std::make_unique<ChainScratch>();
  HapticState out;
  PeakDetector peaks;
  int ticks = 0;
};

Link drag(double threshold) {
  Link link;
  link.name = "drag";
  link.constraint = tests::build(R"({"name": "drag", "type": "drag", "threshold": )" + std::to_string(threshold) + "}");
  link.stiffness_n_per_m = 500;
  return link;
}

/// The damping of the hand's own coupling is for hands that can be pushed.
TEST(Peaks, AHandThatWavesInTheAirIsToldNothing) {
  Way way(drag(0.01));
  way.program.coupling.damping_ns_per_m = 1;
  way.program.links[0].active_when.disabled = true;
  double pushed = 0;
  for (int k = 0; k < 1000; ++k) {
    way.to({0.1 * std::sin(6.28e-3 * k), 0.0, 0.0});
    pushed = std::max(pushed, norm(way.out.force_n));
  }
  EXPECT_GT(pushed, 0.5);  // or it would prove nothing
  const ForcePeaks felt = way.peaks.take_peaks();
  EXPECT_LT(felt.change_n, 1e-9);
  EXPECT_LT(felt.friction_n, 1e-9);
}

TEST(Peaks, ADetentOfTwoMillisecondsIsSeenWheneverTheSenderLooks) {
  for (int first = 0; first < 11; ++first) {
    Link link = test::hold_height("plane", 0);
    link.release_cue = {.type = ReleaseCue::Type::detent, .distance = 0.01, .amplitude_n = 0.5, .duration_s = 0.002};
    Way way(link);
    double most = 0, before = 0;
    // slowly away from the plane, past the place where the link is left at 1 mm; the sender looks every 11 ms
    for (int k = 0; k < 400; ++k) {
      way.to({0.0, 0.0, 5e-6 * k});
      if (k % 11 != first) continue;
      const double change = way.peaks.take_peaks().change_n;
      if (k < 190) before = std::max(before, change);
      most = std::max(most, change);
    }
    EXPECT_NEAR(most, 0.5, 0.06) << "looked at tick " << first;
    EXPECT_LT(before, 0.06) << "the spring alone is no detent";
  }
}

TEST(Peaks, ContactIsTheRateOfTheForceAndNoFriction) {
  Way way(test::hold_height("plane", 0));
  // pressed at 0.1 m/s into 500 N/m: 50 N/s, for 5 mm
  for (int k = 0; k < 50; ++k) way.to({0.0, 0.0, -1e-4 * k});
  const ForcePeaks felt = way.peaks.take_peaks();
  EXPECT_NEAR(felt.change_n, 50 * PeakDetector::kTau_s, 0.02);
  EXPECT_LT(felt.friction_n, 0.03) << "what a spring stores is not lost";
  for (int k = 0; k < 100; ++k) way.to({0.0, 0.0, -5e-3});
  way.peaks.take_peaks();
  for (int k = 0; k < 100; ++k) way.to({0.0, 0.0, -5e-3});
  EXPECT_LT(way.peaks.take_peaks().change_n, 1e-4) << "a hand that holds still is told nothing";
  EXPECT_EQ(way.peaks.take_peaks().friction_n, 0);
}

TEST(Peaks, FrictionIsTheForceOfADragThatSlips) {
  Way way(drag(0.04));  // 4 mm of hand: 2 N
  for (int k = 0; k < 300; ++k) way.to({1e-4 * k, 0.0, 0.0});
  way.peaks.take_peaks();
  for (int k = 300; k < 330; ++k) way.to({1e-4 * k, 0.0, 0.0});
  const ForcePeaks felt = way.peaks.take_peaks();
  EXPECT_NEAR(felt.friction_n, 2, 0.02);
  EXPECT_NEAR(felt.speed_m_per_s, 0.1, 1e-3);
  EXPECT_LT(felt.change_n, 1e-3);
}

TEST(Peaks, WhatIsThereWhenTheHandComesBackIsNoStep) {
  PeakDetector peaks;
  for (int k = 0; k < 10; ++k) peaks.add({});
  peaks.add({.is_live = false});
  for (int k = 0; k < 10; ++k) peaks.add({Vec3(3, 0, 0), Vec3(1, 0, 0), -5});
  peaks.add({Vec3(NAN, 0, 0), Vec3(0.0), 0});
  peaks.add({Vec3(-2, 0, 0), Vec3(0, 1, 0), 7});
  const ForcePeaks felt = peaks.take_peaks();
  EXPECT_LT(felt.change_n, 1e-6);
  EXPECT_EQ(felt.friction_n, 0);
}

TEST(Peaks, NoneIsLostBetweenTwoThreads) {
  PeakDetector peaks;
  constexpr int kTaken = 1000;
  int taken = 0;
  std::atomic<bool> enough{false}, done{false};
  int pulses = 0;  // of the servo's thread, until it has ended
  // pulses that grow: the largest one ever taken is the last one, and what is taken never exceeds what was
  std::thread servo([&] {
    while (!enough) {
      peaks.add({.is_live = false});
      peaks.add({});
      peaks.add({.requested_force_n = Vec3(++pulses, 0, 0)});
    }
    done = true;
  });
  double most = 0;
  for (bool last = false; !last;) {
    last = done;
    const double change = peaks.take_peaks().change_n;
    ASSERT_TRUE(change == 0 || change >= most) << "an old peak was kept beside a newer one";
    most = std::max(most, change);
    taken += change > 0;
    enough = enough || taken >= kTaken;
  }
  servo.join();
  EXPECT_EQ(most, static_cast<float>(pulses));
}

}  // namespace peaks_test
