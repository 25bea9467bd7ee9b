// SPDX-License-Identifier: MIT
/// A device that plays a recorded probe path, one sample per tick, in world units and with its own time. After the last sample
/// it stays there. The forces written to it are only counted. Haptic thread.
#pragma once
#include <memory>
#include <vector>

#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// The device of a recorded path.
class RecordedPath final : public Device {
 public:
  /// One sample of the path; position in world units.
  struct Sample {
    double t_s = 0;
    Vec3 position{0.0};
    std::uint32_t buttons = 0;
    Quat orientation{kIdentityRotation};
  };
  explicit RecordedPath(std::vector<Sample> samples, bool has_orientation = false);
  /// Reads a file of rows `t,x,y,z[,buttons][,qw,qx,qy,qz]`; an Error names file and line.
  static Result<std::unique_ptr<Device>> open(const std::string& path);

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override { ++forces_written_; }
  std::uint64_t forces_written() const { return forces_written_; }

 private:
  std::vector<Sample> samples_;
  DeviceCapabilities capabilities_;
  std::size_t next_ = 0;
  std::uint64_t forces_written_ = 0;
};

}  // namespace catena::haptics
