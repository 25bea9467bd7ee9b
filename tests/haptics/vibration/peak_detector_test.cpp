// SPDX-License-Identifier: MIT
/// Peaks of a 1 kHz force taken some dozens of times a second: detents, contact and friction of the real tick.
#include "haptics/vibration/peak_detector.h"

#include <gtest/gtest.h>

#include <thread>

#include "haptics/servo/servo_tick.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/support/simple_links.h"

namespace peak_detector_test {

using namespace catena;
using namespace catena::haptics;

/// A hand on a prescribed path, unaffected by forces, in the real tick.
struct PrescribedHand : test::ChainDriver {
  explicit PrescribedHand(Link link) : ChainDriver({std::move(link)}, 8) { program.meters_per_unit = 0.1; }
  void to(const Vec3& hand_m) {
    step(world_from_device(program, hand_m));
    const DeviceOutput sent = make_device_output(program, out, state);
    peaks.add({sent.requested_force_n, hand_m, sent.accounted_j, sent.forces_active});
  }
  PeakDetector peaks;
};

Link drag(double threshold) {
  Link link;
  link.name = "drag";
  link.constraint = tests::build(R"({"name": "drag", "type": "drag", "threshold": )" + std::to_string(threshold) + "}");
  link.stiffness_n_per_m = 500;
  return link;
}

/// The coupling's damping does not count as a peak.
TEST(Peaks, AFreelyMovingHandGivesNoPeaks) {
  PrescribedHand hand(drag(0.01));
  hand.program.coupling.damping_ns_per_m = 1;
  hand.program.links[0].active_when.disabled = true;
  double pushed = 0;
  for (int k = 0; k < 1000; ++k) {
    hand.to({0.1 * std::sin(6.28e-3 * k), 0.0, 0.0});
    pushed = std::max(pushed, norm(hand.out.force_n));
  }
  EXPECT_GT(pushed, 0.5);  // the coupling's damping gives a force
  const ForcePeaks found = hand.peaks.take_peaks();
  EXPECT_LT(found.change_n, 1e-9);
  EXPECT_LT(found.friction_n, 1e-9);
}

TEST(Peaks, ATwoMillisecondDetentIsFoundWheneverPeaksAreTaken) {
  for (int first = 0; first < 11; ++first) {
    Link link = test::hold_height("plane", 0);
    link.release_cue = {.type = ReleaseCue::Type::detent, .distance = 0.01, .amplitude_n = 0.5, .duration_s = 0.002};
    PrescribedHand hand(link);
    double max_change_n = 0, before = 0;
    // slowly away from the plane, past the release distance of 1 mm; peaks are taken every 11 ms
    for (int k = 0; k < 400; ++k) {
      hand.to({0.0, 0.0, 5e-6 * k});
      if (k % 11 != first) continue;
      const double change = hand.peaks.take_peaks().change_n;
      if (k < 190) before = std::max(before, change);
      max_change_n = std::max(max_change_n, change);
    }
    EXPECT_NEAR(max_change_n, 0.5, 0.06) << "looked at tick " << first;
    EXPECT_LT(before, 0.06) << "the spring alone is no detent";
  }
}

TEST(Peaks, ContactIsAForceChangeWithoutFriction) {
  PrescribedHand hand(test::hold_height("plane", 0));
  // pressed at 0.1 m/s into 500 N/m: 50 N/s, for 5 mm
  for (int k = 0; k < 50; ++k) hand.to({0.0, 0.0, -1e-4 * k});
  const ForcePeaks found = hand.peaks.take_peaks();
  EXPECT_NEAR(found.change_n, 50 * PeakDetector::kTau_s, 0.02);
  EXPECT_LT(found.friction_n, 0.03) << "what a spring stores is not lost";
  for (int k = 0; k < 100; ++k) hand.to({0.0, 0.0, -5e-3});
  hand.peaks.take_peaks();
  for (int k = 0; k < 100; ++k) hand.to({0.0, 0.0, -5e-3});
  EXPECT_LT(hand.peaks.take_peaks().change_n, 1e-4) << "a hand that holds still is told nothing";
  EXPECT_EQ(hand.peaks.take_peaks().friction_n, 0);
}

TEST(Peaks, FrictionIsTheForceOfASlippingDrag) {
  PrescribedHand hand(drag(0.04));  // threshold of 4 mm at the hand: 2 N
  for (int k = 0; k < 300; ++k) hand.to({1e-4 * k, 0.0, 0.0});
  hand.peaks.take_peaks();
  for (int k = 300; k < 330; ++k) hand.to({1e-4 * k, 0.0, 0.0});
  const ForcePeaks found = hand.peaks.take_peaks();
  EXPECT_NEAR(found.friction_n, 2, 0.02);
  EXPECT_NEAR(found.speed_m_per_s, 0.1, 1e-3);
  EXPECT_LT(found.change_n, 1e-3);
}

TEST(Peaks, AForceAtTheReturnOfTheHandIsNotAStep) {
  PeakDetector peaks;
  for (int k = 0; k < 10; ++k) peaks.add({});
  peaks.add({.is_live = false});
  for (int k = 0; k < 10; ++k) peaks.add({Vec3(3, 0, 0), Vec3(1, 0, 0), -5});
  peaks.add({Vec3(NAN, 0, 0), Vec3(0.0), 0});
  peaks.add({Vec3(-2, 0, 0), Vec3(0, 1, 0), 7});
  const ForcePeaks found = peaks.take_peaks();
  EXPECT_LT(found.change_n, 1e-6);
  EXPECT_EQ(found.friction_n, 0);
}

TEST(Peaks, NoPeakIsLostBetweenTwoThreads) {
  PeakDetector peaks;
  constexpr int kTaken = 1000;
  int taken = 0;
  std::atomic<bool> enough{false}, done{false};
  int pulses = 0;  // written only by the servo thread until it ends
  // pulses grow: the largest pulse taken is the last one
  std::thread servo([&] {
    while (!enough) {
      peaks.add({.is_live = false});
      peaks.add({});
      peaks.add({.requested_force_n = Vec3(++pulses, 0, 0)});
    }
    done = true;
  });
  double max_change_n = 0;
  for (bool last = false; !last;) {
    last = done;
    const double change = peaks.take_peaks().change_n;
    ASSERT_TRUE(change == 0 || change >= max_change_n) << "an old peak was kept beside a newer one";
    max_change_n = std::max(max_change_n, change);
    taken += change > 0;
    enough = enough || taken >= kTaken;
  }
  servo.join();
  EXPECT_EQ(max_change_n, static_cast<float>(pulses));
}

}  // namespace peak_detector_test
