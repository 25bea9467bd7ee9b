// SPDX-License-Identifier: MIT
/// One opened Falcon whose firmware runs: one packet out, packets in until a frame, and the interpretation of the frames. It has no thread
/// and uses only the clock that it is given, so that a test can run it cycle by cycle. I/O thread.
///   homing:  the homing bit in every packet, red, zero force, until all three axes are homed in three frames in a row; the
///            origin jumps at that moment
///   arming:  blue, zero force, until the grip has been further out than 0.170 m: so the user holds it, and is aware of it
///   ready:   green while forces are active, blue while they are not
/// A frame that jumps further than a user can move (1000 counts) is accepted only when the next one agrees. A pose out of reach, or a frame
/// that is suddenly not homed, keeps the last position and stops the forces in that cycle.
#pragma once
#include "haptics/device/usb/falcon_codec.h"
#include "haptics/device/usb/falcon_kinematics.h"
#include "haptics/device/usb/ftdi.h"

namespace catena::haptics::usb {

/// State of the device: not plugged in, firmware being loaded, homing, waiting for the grip to be pulled out, operational.
enum class FalconState : std::uint8_t { absent, booting, homing, arming, ready };

/// Pose that the I/O thread passes to the haptic thread.
struct FalconPose {
  Vec3 position_m{0.0};  ///< the last valid one
  FalconCounts encoders{};
  std::uint32_t buttons = 0;
  FalconState state = FalconState::booting;
  bool valid = false;  ///< position_m is of this frame
  std::int64_t sampled_ns = 0;
};

/// Counters written by the I/O thread, read by any thread.
struct FalconCounters {
  FtdiCounters ftdi;
  std::atomic<std::uint64_t> cycles{0}, frames{0}, bad_cycles{0}, resyncs{0}, dropped_bytes{0};
  std::atomic<std::uint64_t> jumps{0}, out_of_reach{0}, saturated{0}, stale_commands{0}, uploads{0}, disconnects{0}, reconnects{0};
};

inline constexpr Vec3 kFalconWorkspaceCenter{0, 0, 0.125};  ///< center of the comfortable workspace, meters
inline constexpr double kFalconArmingZ = 0.170;             ///< z of the grip that arms the device, meters

/// The session of one opened device.
class FalconSession {
 public:
  using Clock = std::int64_t (*)();

  /// `last_m`: position to report until there is a valid one, meters.
  FalconSession(Ftdi& ftdi, FalconCounters& counters, double force_gain, Clock clock, const Vec3& last_m = kFalconWorkspaceCenter)
      : ftdi_(ftdi),
        counters_(counters),
        force_gain_(force_gain),
        clock_(clock),
        pose_{.position_m = last_m, .state = FalconState::homing} {}

  /// Result of a cycle.
  enum class Cycle : std::uint8_t { frame, no_frame, disconnected };
  /// Sends one packet and receives until a frame. `force_n` is applied only if `forces` and the state allow it.
  Cycle cycle(const Vec3& force_n, bool forces) noexcept { return send(force_n, forces) ? receive() : Cycle::disconnected; }
  /// The two halves of cycle(). send returns false if the device is disconnected.
  bool send(const Vec3& force_n, bool forces) noexcept;
  Cycle receive() noexcept;
  /// Sends the shutdown packet, the last one before closing: zero force, all LEDs off. Repeated on a timeout.
  void send_shutdown() noexcept;
  /// Sends zero force until the next valid frame: after cycles without a frame.
  void release_force() noexcept;

  const FalconPose& pose() const { return pose_; }
  std::uint8_t homed() const { return homed_; }  ///< bits 0-2, of the last frame
  /// Returns whether the last packet had zero force and was transferred to the device.
  bool zero_force_confirmed() const { return acknowledged_ && sent_.motors == FalconCounts{}; }

 private:
  FalconCommand make_command(const Vec3& force_n, bool forces) noexcept;
  void handle_frame(const FalconFrame& frame) noexcept;
  bool is_plausible(const FalconFrame& frame) noexcept;
  void update_position(const FalconFrame& frame) noexcept;

  Ftdi& ftdi_;
  FalconCounters& counters_;
  double force_gain_;
  Clock clock_;
  FalconPose pose_;
  FalconFramer framer_;
  FalconState state_ = FalconState::homing;
  FalconCommand sent_;
  bool acknowledged_ = false;
  FalconCounts last_encoders_{};
  bool has_encoders_ = false;
  std::uint8_t homed_ = 0;
  int homed_run_ = 0, unhomed_run_ = 0;  ///< number of frames in a row
  Mat3 meters_per_rad_{0.0};
};

}  // namespace catena::haptics::usb
