// SPDX-License-Identifier: MIT
/// The vibration mapping, and the sender's calls to the runtime in order. CATENA_PLOT=FILE.png draws the map with gnuplot.
#include "haptics/vibration/vibration.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/support.h"

namespace vibration_test {

using namespace catena;
using namespace catena::haptics;
using What = VibrationSender::Action;

constexpr std::int64_t kCall_ns = 11'111'111;

/// Adds a force step of one tick, so that the next take_peaks() has that change.
void step(PeakDetector& peaks, double newtons) {
  peaks.add({.is_live = false});
  peaks.add({});
  peaks.add({.requested_force_n = Vec3(newtons, 0, 0)});
}

/// Adds friction of `newtons` at 0.1 m/s.
void rub(PeakDetector& peaks, double newtons) {
  peaks.add({.is_live = false});
  for (int k = 0; k < 60; ++k) peaks.add({Vec3(newtons, 0, 0), Vec3(1e-4 * k, 0, 0), -newtons * 1e-4 * k});
}

/// Friction lasts until the next call, whatever the time between calls is.
TEST(VibrationSender, FrictionLastsUntilTheNextCall) {
  for (const double call_s : {0.008, 1.0 / 60, 0.025}) {
    PeakDetector peaks;
    VibrationSender sender;
    std::int64_t now = 1'000'000'000;
    double duration_s = 0;
    double booked_j = 10;
    for (int turn = 0; turn < 8; ++turn) {
      for (int k = 0; k < int(1000 * call_s); ++k) peaks.add({{1.0, 0.0, 0.0}, {1e-4 * (k + 40 * turn), 0.0, 0.0}, booked_j -= 1e-4, true});
      const auto call = sender.next(peaks, now, true);
      if (call.action == VibrationSender::Action::vibrate && !call.vibration.is_pulse)
        duration_s = 1e-9 * double(call.vibration.duration_ns);
      now += std::int64_t(1e9 * call_s);
    }
    EXPECT_NEAR(duration_s, 1.5 * call_s, 1e-6);
  }
}

TEST(Vibration, TheMapIsLinearBetweenItsLimits) {
  const VibrationMapping map;
  EXPECT_EQ(compute_vibration({}, 0.01), Vibration{});
  EXPECT_EQ(compute_vibration({.change_n = 0.75}, 0.01), (Vibration{0.5, map.pulse_hz, 20'000'000, true}));
  EXPECT_EQ(compute_vibration({.change_n = 100}, 0.01).amplitude, 1);
  EXPECT_EQ(compute_vibration({.change_n = 0.02 * map.saturation_change_n * 0.99}, 0.01).amplitude, 0) << "less than the least";
  EXPECT_EQ(compute_vibration({0, 1, 0.05}, 0.01), (Vibration{0.3, 100, 15'000'000, false}));
  EXPECT_EQ(compute_vibration({0, 50, 5}, 0.01), (Vibration{0.6, 250, 15'000'000, false}));
  EXPECT_EQ(compute_vibration({0, 1, 1e-3}, 0.01).frequency_hz, 40);
  EXPECT_TRUE(compute_vibration({0.6, 1, 0.05}, 0.01).is_pulse) << "the stronger one";
  EXPECT_FALSE(compute_vibration({0.3, 1, 0.05}, 0.01).is_pulse);
}

TEST(Vibration, OnlyAStrongerVibrationReplacesAPulse) {
  PeakDetector peaks;
  VibrationSender sender;
  std::int64_t now = 0;
  EXPECT_EQ(sender.next(peaks, now, true).action, What::nothing);
  step(peaks, 0.75);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).vibration.amplitude, 0.5);
  step(peaks, 0.3);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).action, What::nothing) << "the pulse lasts 20 ms";
  step(peaks, 0.3);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).action, What::vibrate) << "it is over";
  step(peaks, 1.5);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).vibration.amplitude, 1);
  EXPECT_EQ(sender.next(peaks, now += 10 * kCall_ns, true).action, What::nothing) << "silence needs no call: a vibration ends by itself";
}

TEST(Vibration, FrictionContinuesWithoutGapsAndFollowsADecreasingForce) {
  PeakDetector peaks;
  VibrationSender sender;
  std::int64_t now = 0, ends = 0;
  sender.next(peaks, now, true);
  double last = 1;
  for (double newtons = 2; newtons > 0.2; newtons -= 0.1) {
    rub(peaks, newtons);
    const VibrationSender::Command call = sender.next(peaks, now += kCall_ns, true);
    ASSERT_EQ(call.action, What::vibrate);
    EXPECT_FALSE(call.vibration.is_pulse);
    EXPECT_LT(call.vibration.amplitude, last);
    EXPECT_TRUE(ends == 0 || now <= ends) << "a gap";
    last = call.vibration.amplitude;
    ends = now + call.vibration.duration_ns;
  }
}

TEST(Vibration, WhenDisallowedItStopsOnceAndDropsPendingPeaks) {
  PeakDetector peaks;
  VibrationSender sender;
  EXPECT_EQ(sender.next(peaks, 0, false).action, What::nothing) << "nothing was begun";
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 1, true).action, What::nothing) << "felt before it was allowed";
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 2, true).action, What::vibrate);
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 3, false).action, What::stop);
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 4, false).action, What::nothing);
  EXPECT_EQ(sender.next(peaks, 5, true).action, What::nothing);
  step(peaks, 0.1);
  EXPECT_EQ(sender.next(peaks, 6, true).action, What::vibrate) << "the pulse of before does not last";
}

// Draws the plot of docs/user/headset.md.
TEST(Vibration, Plot) {
  const char* file = std::getenv("CATENA_PLOT");
  if (file == nullptr) GTEST_SKIP() << "CATENA_PLOT=FILE.png draws the map";
  const test::TemporaryFolder folder;
  std::string contact, friction;
  for (int i = 0; i <= 120; ++i) {
    const double newtons = 0.025 * i;
    PeakDetector peaks;
    step(peaks, newtons);
    contact += fmt::format("{} {}\n", newtons, compute_vibration(peaks.take_peaks(), 1e-9 * kCall_ns).amplitude);
    rub(peaks, newtons);
    ForcePeaks found = peaks.take_peaks();
    found.change_n = 0;
    friction += fmt::format("{} {}\n", newtons, compute_vibration(found, 1e-9 * kCall_ns).amplitude);
  }
  test::write_file(folder / "plot",
                   "set terminal png size 520,320 background 'white'\nset output '" + std::string(file) +
                       "'\nset xlabel 'force (N)'\nset ylabel 'amplitude of the vibration'\nset yrange [0:1.05]\nset key bottom "
                       "right\nset grid\n$contact << E\n" +
                       contact + "E\n$friction << E\n" + friction +
                       "E\nplot $contact with lines lw 2 title 'step of force (contact, detent), 20 ms', $friction with "
                       "lines lw 2 title 'friction, while it lasts'\n");
  EXPECT_EQ(std::system(("gnuplot " + folder / "plot").c_str()), 0);
}

}  // namespace vibration_test
