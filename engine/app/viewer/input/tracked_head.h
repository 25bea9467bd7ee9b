// SPDX-License-Identifier: MIT
/// Head tracking, option "--head": the position of the user's head in front of a display screen of the scene, so that the window shows the
/// scene behind it (fish tank VR).
///   FILE.csv, recorded:FILE.csv   t,x,y,z in world units, played in real time from the first row, as in `render --head`
///                                 (render/frame/camera_path.h); the last position is kept
///   DEVICE                        a name of haptics/device/registry.h: its position, by the scene's "workspace", read by its own thread
/// Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/scene/stereo.h"
#include "render/frame/camera_path.h"

namespace catena::app {

/// Smoothing of a tracked head position.
///   tracked   followed immediately and exactly
///   lost      unknown, or not in front of the screen (render/stereo/stereo_views.h): the last position is kept
///   jump      a motion of more than kJumpDiagonals + kMaxDiagonalsPerS dt screen diagonals since the last frame, or any after a loss: a
///             glide of kGlideS, the difference fading as 1 - u^2 (3 - 2u)
class SmoothedHead {
 public:
  static constexpr double kJumpDiagonals = 0.05, kMaxDiagonalsPerS = 5, kMaxStepS = 0.2, kGlideS = 0.3;

  /// `screen`: the screen in front of which the head is.
  explicit SmoothedHead(const scene::DisplayScreen& screen) : screen_(screen) {}
  /// Call once per frame with increasing `t_s`. Returns the smoothed position; nothing before the first tracked one.
  std::optional<Vec3> update(double t_s, const std::optional<Vec3>& tracked);
  bool is_lost() const { return is_lost_; }

 private:
  scene::DisplayScreen screen_;
  std::optional<Vec3> smoothed_, tracked_;
  Vec3 glide_offset_{0.0};  ///< Difference to the tracked position at the start of the glide.
  double glide_start_s_ = -1e300, last_s_ = 0;
  bool is_lost_ = false;
};

/// Owns the source of head positions: a table or a device with its own servo.
class TrackedHead {
 public:
  /// Opens the source; `words`: value of --head. An Error for an invalid table, a first position that is not in front of the screen, a
  /// device that cannot be opened, or a scene without the "workspace" that a device needs.
  static Result<std::unique_ptr<TrackedHead>> open(const std::string& words, const scene::Scene& scene);
  ~TrackedHead();

  /// Starts the device; a table is played from this time on. An Error if the device cannot be started.
  Outcome start(double t_s);
  /// Returns the smoothed position; nothing if it has never been known.
  std::optional<Vec3> position_at(double t_s) { return smoothed_.update(t_s, tracked_position(t_s)); }
  /// Returns true if the head was lost since the last loss was reported: one report per loss.
  bool take_lost();

 private:
  explicit TrackedHead(const scene::DisplayScreen& screen) : smoothed_(screen) {}
  std::optional<Vec3> tracked_position(double t_s);

  SmoothedHead smoothed_;
  std::optional<render::CameraPath> path_;
  double start_s_ = 0;
  HapticDeviceSetup device_;
  std::unique_ptr<haptics::Servo> servo_;
  HapticState state_;
  bool loss_reported_ = false;
};

}  // namespace catena::app
