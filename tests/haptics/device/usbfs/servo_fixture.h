// SPDX-License-Identifier: MIT
/// Servo, Falcon driver, libusb and the emulated mechanism, connected by USB bytes, for both buses. The program's constraint is a
/// ball |x| = 0.5 at 0.04 m per unit around the device's (0, 0, 0.12) m: radius 20 mm.
#pragma once
#include "haptics/servo/servo.h"
#include "tests/haptics/device/usbfs/falcon_fixture.h"

namespace catena::haptics::tests {

inline constexpr double kBallRadiusM = 0.02, kBallStiffness = 400;
inline const Vec3 kBallCenterM{0, 0, 0.12};

inline Vec3 to_world(const Vec3& device_m) { return (device_m - kBallCenterM) / 0.04; }

/// A fixed sequence of grip positions in the shell 16..25 mm around the ball's centre.
struct GripWalk {
  std::uint64_t state = 88172645463325252u;
  double next_uniform() {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) * 0x1p-53;
  }
  Vec3 next() {
    Vec3 d{2 * next_uniform() - 1, 2 * next_uniform() - 1, 2 * next_uniform() - 1};
    d = norm(d) > 0.1 ? direction(d) : Vec3(0, 0, 1);
    return snap_to_whole_counts(kBallCenterM + d * (0.016 + 0.009 * next_uniform()));
  }
};

/// Arms a homed device behind an open driver, then runs the servo on it.
template <class Bus>
class ServoRig {
 public:
  ServoRig(Bus& bus, usb::Falcon& falcon, std::shared_ptr<const HapticProgram> program, const ServoOptions& options)
      : bus_(bus), falcon_(falcon), servo_(falcon, std::move(program), options) {}
  ~ServoRig() { servo_.stop(); }

  bool start() {
    if (!move_grip(bus_, {0.165, 0.175, 0.165, 0.155})) return false;
    if (!wait_until([&] { return falcon_.state() == usb::FalconState::ready; })) return false;
    return static_cast<bool>(servo_.start());
  }

  /// Holds the grip and waits until the tick's probe and the motors' force have settled.
  bool settle(const Vec3& grip_m, HapticState& tick, EmulatedFalcon::Exchange& exchange) {
    bus_.with([&](EmulatedFalcon& device) { device.mechanism().hold(grip_m); });
    // excludes late ticks, which hold an earlier force, and proxies that ran out of budget and have not arrived
    const bool arrived = wait_until([&] {
      servo_.receive(tick);
      return tick.force_state == ForceState::on && norm(tick.probe - to_world(grip_m)) < 1e-7 && tick.links[0].status != LinkStatus::budget;
    });
    // the command may have been written just after the I/O thread's read: two more frames, and one for the tick itself
    // the driver sends zeros for a servo that gets no processor: the motors are off until it returns
    return arrived && wait_until([&] {
             if (!wait_for_frames(bus_, 4)) return false;
             exchange = bus_.with([](EmulatedFalcon& device) { return device.last_exchange(); });
             servo_.receive(tick);
             const Vec3 quantum = force_quantum(grip_m);
             bool weak = true;  // force below half a motor count
             for (int j = 0; j < 3; ++j) weak = weak && std::abs(tick.force_n[j]) <= quantum[j] + 1e-9;
             return weak || exchange.motors != EmulatedMechanism::Counts{};
           });
  }

  /// Checks that the motors' force is the tick's up to whole counts, the proxy is on the surface, and the probe is the grip.
  void check(const Vec3& grip_m) {
    HapticState tick;
    EmulatedFalcon::Exchange exchange;
    ASSERT_TRUE(settle(grip_m, tick, exchange));
    const double radius_m = norm(grip_m - kBallCenterM);
    EXPECT_LT(norm(tick.probe - to_world(grip_m)) * 0.04, 1e-10) << "at whole counts the encoders say it all";
    const Vec3 bound = force_quantum(grip_m);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(exchange.force_n[j], tick.force_n[j], bound[j] + 1e-9) << "axis " << j;
    if (radius_m < kBallRadiusM - 1e-9) {
      EXPECT_NEAR(norm(tick.links[0].proxy), 0.5, 1e-9);
      EXPECT_NEAR(norm(tick.force_n), kBallStiffness * (kBallRadiusM - radius_m), 1e-6);
      EXPECT_GT(dot(tick.force_n, grip_m - kBallCenterM), 0) << "outwards";
      ++held;
    } else {
      EXPECT_EQ(exchange.motors, (EmulatedMechanism::Counts{}));
      ++free;
    }
    worst_n = std::max(worst_n, max_abs(exchange.force_n - tick.force_n));
  }

  Servo& servo() { return servo_; }
  int held = 0, free = 0;
  double worst_n = 0;

 private:
  Bus& bus_;
  usb::Falcon& falcon_;
  Servo servo_;
};

}  // namespace catena::haptics::tests
