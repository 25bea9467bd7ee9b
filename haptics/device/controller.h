/// A tracked controller in the hand: poses with times in, vibration out. No force: what the tick would push with goes to PeakDetector
/// (haptics/vibration), whence a sender takes it. Its poses come from the thread that has the tracker, some 60 to 1000 a second; `read`
/// makes of them one a tick, without jumps.
///   play      a clock that runs behind the samples by the longest of the last intervals between them and a tenth, so that there is nearly
///             always a sample after it; between two samples the place moves evenly, and turns the shorter way
///   pace      dP/dt = 1 + (lag - wanted lag) / 0.1 s, within 0.8 to 1.25; it stands still at the newest sample. So a sample that is late
///             makes the hand wait and then catch up at most a quarter faster than it moved: a place never jumps, whatever the tracker does
///   corners   what remains, a change of speed at each sample, is eased over `smoothing_s` (eased_pose.h)
/// Lost: the tracker says so, or says nothing for `lost_timeout_s`. Then the status is lost, so that the servo sends no force; found again
/// the hand is where it is, at once, and the force rises from zero (limits_for.h: the ramp in). Before the first pose it is starting.
/// Metres, the tracker's axes; buttons: bit 0 select, bit 1 grab.
#pragma once
#include <array>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/triple_buffer.h"
#include "haptics/device/pose_filter.h"
#include "haptics/vibration/peak_detector.h"

namespace catena::haptics {

struct ControllerParameters {
  double rate_hz = 1000;             ///< of the servo that reads it
  double smoothing_s = 0.004;        ///< of the corners
  double lost_timeout_s = 0.1;       ///< without a pose
  std::int64_t (*clock)() = now_ns;  ///< the clock that the poses' times are of; returns at once
};

/// Where the controller was at that time.
struct ControllerPose {
  std::int64_t t_ns = 0;
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  std::uint32_t buttons = 0;
  bool tracked = true;  ///< false: the place is not known
};

class TrackedController final : public Device {
 public:
  static constexpr std::uint32_t kSelect = 1, kGrab = 2;

  explicit TrackedController(const ControllerParameters& parameters = {});

  /// The tracker's thread, times rising. A pose that is not finite, or not later than the one before, is ignored.
  void push_pose(const ControllerPose& pose);
  /// What is felt, for the thread that asks the controller to vibrate.
  PeakDetector& peaks() { return peaks_; }

  // haptic thread
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;

  static DeviceCapabilities nominal_capabilities();

 private:
  /// The newest poses of one stay, the newest first; what the tracker's thread keeps. All of lost_timeout_s at 1000 a second: after a pause
  /// of the tracker the clock is as far behind, and goes on from where it is.
  struct PoseHistory {
    static constexpr int kMaxPoses = 128;
    std::array<ControllerPose, kMaxPoses> poses{};
    int count = 0;                 ///< 0: not tracked
    std::uint32_t session_id = 0;  ///< counted: another one after each loss
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
