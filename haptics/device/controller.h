// SPDX-License-Identifier: MIT
/// A tracked hand controller: time-stamped poses in, vibration out. It has no force output: the chain force goes to a PeakDetector
/// (haptics/vibration), from which a sender thread takes it. The tracker's thread pushes some 60 to 1000 poses per second; `read` resamples
/// them to one per tick, without jumps.
///   playback  a clock that lags behind the samples by 1.1 times the longest of the last intervals between them, so that there is nearly
///             always a later sample; between two samples the position is interpolated linearly, the orientation along the shorter arc
///   rate      dP/dt = 1 + (lag - target lag) / 0.1 s, within 0.8 to 1.25; the clock stops at the newest sample. So a late sample makes
///             the probe stop and then catch up at most a quarter faster than the controller moved: the position never jumps
///   corners   the remaining change of speed at each sample is low-pass filtered over `smoothing_s` (pose_filter.h)
/// Lost: the tracker reports it, or no pose arrives for `lost_timeout_s`. Then the status is lost, so that the servo sends no force; when
/// tracking resumes, the pose is the new one at once, and the force ramps in (haptics/servo/device_limits.h). Before the first pose the
/// status is starting. Meters, the tracker's axes; buttons: bit 0 select, bit 1 grab.
#pragma once
#include <array>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/triple_buffer.h"
#include "haptics/device/pose_filter.h"
#include "haptics/vibration/peak_detector.h"

namespace catena::haptics {

/// Parameters of a TrackedController.
struct ControllerParameters {
  double rate_hz = 1000;             ///< tick rate of the servo that reads it
  double smoothing_s = 0.004;        ///< time constant of the low-pass filter; 0: none
  double lost_timeout_s = 0.1;       ///< time without a pose after which the status is lost
  std::int64_t (*clock)() = now_ns;  ///< clock of the poses' time stamps; must return at once
};

/// Pose of the controller at one time, meters, the tracker's axes.
struct ControllerPose {
  std::int64_t t_ns = 0;
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  std::uint32_t buttons = 0;
  bool tracked = true;  ///< false: the pose is unknown
};

/// The device. push_pose: the tracker's thread; read and write: the haptic thread.
class TrackedController final : public Device {
 public:
  /// Bits of ControllerPose::buttons.
  static constexpr std::uint32_t kSelect = 1, kGrab = 2;

  explicit TrackedController(const ControllerParameters& parameters = {});

  /// Adds a pose. The tracker's thread, times increasing. A pose that is not finite, or not later than the last one, is ignored.
  void push_pose(const ControllerPose& pose);
  /// Returns the change and friction peaks of the force, for the thread that sends vibrations to the controller.
  PeakDetector& peaks() { return peaks_; }

  // haptic thread
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;

  static DeviceCapabilities nominal_capabilities();

 private:
  /// The newest poses since tracking began, newest first; written by the tracker's thread. Covers lost_timeout_s at 1000 poses a second:
  /// after a pause of the tracker the playback clock lags by as much, and continues from there.
  struct PoseHistory {
    static constexpr int kMaxPoses = 128;
    std::array<ControllerPose, kMaxPoses> poses{};
    int count = 0;                 ///< number of valid poses; 0: not tracked
    std::uint32_t session_id = 0;  ///< incremented each time tracking begins after a loss
  };
  void advance_playback(const PoseHistory& past, std::int64_t now_ns) noexcept;

  ControllerParameters parameters_;
  DeviceCapabilities capabilities_;
  TripleBuffer<PoseHistory> shared_;
  PoseHistory history_;  ///< the tracker's thread
  PeakDetector peaks_;

  // haptic thread
  PoseFilter filter_;
  std::int64_t playback_ns_ = 0, last_ns_ = 0;
  std::uint32_t session_id_ = 0;
  bool tracked_ = false;
};

}  // namespace catena::haptics
