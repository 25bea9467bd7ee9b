/// What the servo needs of a haptic device: the pose in, the force out. Metres, newtons, the device's own axes.
/// `read` and `write` run on the haptic thread: no allocation, lock or throw, and they return at once.
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/vec.h"

namespace catena::haptics {

struct DeviceInput {
  Vec3 position_m{0.0};
  std::uint32_t buttons = 0;
  bool connected = true;  ///< false: the servo sends zero force in that tick
  bool recorded = false;  ///< a recorded path brings its own time, and its position is in world units already
  double t_s = 0;
};

struct DeviceCapabilities {
  std::string name;
  double workspace_m = 0.2;  ///< edge of a cube that the hand reaches
  double max_force_n = 0;    ///< 0: no force output (pseudo-haptics only)
};

class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceCapabilities& capabilities() const = 0;
  virtual DeviceInput read() noexcept = 0;
  virtual void write(const Vec3& force_n) noexcept = 0;
};

}  // namespace catena::haptics
