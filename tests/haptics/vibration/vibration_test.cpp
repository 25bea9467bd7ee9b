/// The stated map, and what the sender asks of the runtime in which order. CATENA_PLOT=FILE.png draws the map with gnuplot.
#include "haptics/vibration/vibration.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/support.h"

namespace vibration_test {

using namespace catena;
using namespace catena::haptics;
using What = VibrationSender::What;

constexpr std::int64_t kCall_ns = 11'111'111;

/// One tick's step of force, so that the next take has that change.
void step(Peaks& peaks, double newtons) {
  peaks.add({.live = false});
  peaks.add({});
  peaks.add({.force_n = Vec3(newtons, 0, 0)});
}

/// So much friction at 0.1 m/s.
void rub(Peaks& peaks, double newtons) {
  peaks.add({.live = false});
  for (int k = 0; k < 60; ++k) peaks.add({Vec3(newtons, 0, 0), Vec3(1e-4 * k, 0, 0), -newtons * 1e-4 * k});
}

/// Friction lasts until the next call, whatever the time between calls is.
TEST(VibrationSender, FrictionLastsUntilTheNextCall) {
  for (const double call_s : {0.008, 1.0 / 60, 0.025}) {
    Peaks peaks;
    VibrationSender sender;
    std::int64_t now = 1'000'000'000;
    double duration_s = 0;
    double booked_j = 10;
    for (int turn = 0; turn < 8; ++turn) {
      for (int k = 0; k < int(1000 * call_s); ++k) peaks.add({{1.0, 0.0, 0.0}, {1e-4 * (k + 40 * turn), 0.0, 0.0}, booked_j -= 1e-4, true});
      const auto call = sender.next(peaks, now, true);
      if (call.what == VibrationSender::What::vibrate && !call.vibration.is_pulse) duration_s = 1e-9 * double(call.vibration.duration_ns);
      now += std::int64_t(1e9 * call_s);
    }
    EXPECT_NEAR(duration_s, 1.5 * call_s, 1e-6);
  }
}

TEST(Vibration, TheMapIsLinearUpToItsEnds) {
  const VibrationMap map;
  EXPECT_EQ(vibration_of({}, 0.01), Vibration{});
  EXPECT_EQ(vibration_of({.change_n = 0.75}, 0.01), (Vibration{0.5, map.pulse_hz, 20'000'000, true}));
  EXPECT_EQ(vibration_of({.change_n = 100}, 0.01).amplitude, 1);
  EXPECT_EQ(vibration_of({.change_n = 0.02 * map.full_change_n * 0.99}, 0.01).amplitude, 0) << "less than the least";
  EXPECT_EQ(vibration_of({0, 1, 0.05}, 0.01), (Vibration{0.3, 100, 15'000'000, false}));
  EXPECT_EQ(vibration_of({0, 50, 5}, 0.01), (Vibration{0.6, 250, 15'000'000, false}));
  EXPECT_EQ(vibration_of({0, 1, 1e-3}, 0.01).frequency_hz, 40);
  EXPECT_TRUE(vibration_of({0.6, 1, 0.05}, 0.01).is_pulse) << "the stronger one";
  EXPECT_FALSE(vibration_of({0.3, 1, 0.05}, 0.01).is_pulse);
}

TEST(Vibration, AWeakerOneDoesNotCutAPulseShortButAStrongerOneReplacesIt) {
  Peaks peaks;
  VibrationSender sender;
  std::int64_t now = 0;
  EXPECT_EQ(sender.next(peaks, now, true).what, What::nothing);
  step(peaks, 0.75);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).vibration.amplitude, 0.5);
  step(peaks, 0.3);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).what, What::nothing) << "the pulse lasts 20 ms";
  step(peaks, 0.3);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).what, What::vibrate) << "it is over";
  step(peaks, 1.5);
  EXPECT_EQ(sender.next(peaks, now += kCall_ns, true).vibration.amplitude, 1);
  EXPECT_EQ(sender.next(peaks, now += 10 * kCall_ns, true).what, What::nothing) << "silence needs no call: a vibration ends by itself";
}

TEST(Vibration, FrictionGoesOnWithoutAGapAndFollowsTheForceDown) {
  Peaks peaks;
  VibrationSender sender;
  std::int64_t now = 0, ends = 0;
  sender.next(peaks, now, true);
  double last = 1;
  for (double newtons = 2; newtons > 0.2; newtons -= 0.1) {
    rub(peaks, newtons);
    const VibrationSender::Call call = sender.next(peaks, now += kCall_ns, true);
    ASSERT_EQ(call.what, What::vibrate);
    EXPECT_FALSE(call.vibration.is_pulse);
    EXPECT_LT(call.vibration.amplitude, last);
    EXPECT_TRUE(ends == 0 || now <= ends) << "a gap";
    last = call.vibration.amplitude;
    ends = now + call.vibration.duration_ns;
  }
}

TEST(Vibration, ItStopsOnceWhereItIsNotAllowedAndForgetsWhatWasFeltThere) {
  Peaks peaks;
  VibrationSender sender;
  EXPECT_EQ(sender.next(peaks, 0, false).what, What::nothing) << "nothing was begun";
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 1, true).what, What::nothing) << "felt before it was allowed";
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 2, true).what, What::vibrate);
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 3, false).what, What::stop);
  step(peaks, 1);
  EXPECT_EQ(sender.next(peaks, 4, false).what, What::nothing);
  EXPECT_EQ(sender.next(peaks, 5, true).what, What::nothing);
  step(peaks, 0.1);
  EXPECT_EQ(sender.next(peaks, 6, true).what, What::vibrate) << "the pulse of before does not last";
}

// Not a test of its own: the plot of docs/headset.md.
TEST(Vibration, Plot) {
  const char* file = std::getenv("CATENA_PLOT");
  if (file == nullptr) GTEST_SKIP() << "CATENA_PLOT=FILE.png draws the map";
  const test::TemporaryFolder folder;
  std::string contact, friction;
  for (int i = 0; i <= 120; ++i) {
    const double newtons = 0.025 * i;
    Peaks peaks;
    step(peaks, newtons);
    contact += fmt::format("{} {}\n", newtons, vibration_of(peaks.take(), 1e-9 * kCall_ns).amplitude);
    rub(peaks, newtons);
    FeltPeaks felt = peaks.take();
    felt.change_n = 0;
    friction += fmt::format("{} {}\n", newtons, vibration_of(felt, 1e-9 * kCall_ns).amplitude);
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
