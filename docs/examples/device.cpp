// SPDX-License-Identifier: MIT
// A device of one's own before Catena's haptic thread: a mass on a spring, moved by the force that the chain gives. A real one reads its
// encoders in read() and sends its motors what write() gets.
#include <cstdio>
#include <thread>

#include "engine/scene/scene.h"
#include "haptics/build/build_program.h"
#include "haptics/device/device.h"
#include "haptics/servo/device_limits.h"
#include "haptics/servo/servo.h"

using namespace catena;
using namespace catena::haptics;

class SpringDevice final : public Device {
 public:
  SpringDevice() {
    capabilities_.name = "spring";
    capabilities_.max_force_n = 5;
    capabilities_.mechanics.mass_kg = kMass;
    capabilities_.mechanics.damping_ns_per_m = kDamping;
  }
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  // Haptic thread: both return at once, allocate nothing, throw nothing.
  DeviceInput read() noexcept override {
    DeviceInput input;
    input.position_m = place_;
    return input;
  }
  void write(const DeviceOutput& output) noexcept override {
    const Vec3 pull = kSpring * (kRest - place_) - kDamping * velocity_ + output.force_n;
    velocity_ += kPeriod / kMass * pull;
    place_ += kPeriod * velocity_;
  }

 private:
  static constexpr double kMass = 0.2, kSpring = 100, kDamping = 4, kPeriod = 1e-3;
  const Vec3 kRest{0.0, 0.0, -0.01};
  DeviceCapabilities capabilities_;
  Vec3 place_{0.0, 0.0, 0.05}, velocity_{0.0};
};

Outcome run() {
  SpringDevice device;
  CATENA_TRY(scene::Scene scene, scene::parse_scene(R"({"chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0],
    "normal": [0, 0, 1], "free": "above"}]})",
                                                    "device"));
  // what this mechanism may be asked for: its safe stiffness, its force, its passivity
  CATENA_TRY(const std::shared_ptr<const HapticProgram> program, build_program(scene, compute_device_limits(device.capabilities(), {})));
  ServoOptions options;
  options.paced = false;  // a simulated device needs no clock; a real one has true, which is the default
  options.max_ticks = 3000;
  Servo servo(device, program, options);
  CATENA_CHECK(servo.start());
  while (servo.running()) std::this_thread::yield();
  servo.stop();
  HapticState state;
  servo.receive(state);
  std::printf("after %llu ticks the hand is at %.5f m, the floor pushes with %.3f N\n", static_cast<unsigned long long>(state.tick),
              state.probe.z, state.force_n.z);
  return Done{};
}

int main() {
  if (const Outcome done = run(); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 2;
  return 0;
}
