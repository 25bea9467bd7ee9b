/// The mouse as a haptic device without force output: the frame writes where the hand is, the servo reads it each tick.
/// Between the two: a wait-free box of three slots (one writer, one reader, neither ever waits), so a slow picture never
/// delays a tick; the hand then stays where it was. Motion is eased over `smoothing_s` towards the newest place, because a
/// picture's 60 Hz steps would otherwise reach the tick as jumps:  x += (target - x) (1 - exp(-dt / smoothing)) at 1 / rate.
#pragma once
#include <array>
#include <atomic>

#include "haptics/device/device.h"

namespace catena::haptics {

struct MouseParameters {
  double smoothing_s = 0.02;  ///< 0: none
  double rate_hz = 1000;      ///< of the servo that reads it
};

class MouseDevice final : public Device {
 public:
  explicit MouseDevice(const Vec3& start_m, const MouseParameters& parameters = {});

  /// Frame thread. Metres, the device's own axes. A non-finite position is ignored.
  void move_to(const Vec3& position_m, std::uint32_t buttons);

  // haptic thread
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override {}  ///< a mouse cannot push: the force is drawn

 private:
  struct Slot {
    Vec3 position_m{0.0};
    std::uint32_t buttons = 0;
  };
  static constexpr unsigned kIndex = 3, kFresh = 4;

  DeviceCapabilities capabilities_;
  double share_;  ///< of the way to the target that one tick covers
  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<unsigned> middle_{1};
  alignas(64) unsigned back_ = 0;   ///< frame thread's
  alignas(64) unsigned front_ = 2;  ///< haptic thread's
  Vec3 position_m_;                 ///< haptic thread's
};

}  // namespace catena::haptics
