/// "--head": where a person's head is before a screen of the scene, so that the window shows what lies behind it (a fish tank).
///   FILE.csv, recorded:FILE.csv   t,x,y,z in world units, played from its first row on by the time that passes, as `render --head` goes
///   along
///                                 it (render/frame/camera_path.h); it rests at its end
///   DEVICE                        a name of haptics/device/registry.h: its place, by the scene's "workspace", read by a thread of its own
/// Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/scene/stereo.h"
#include "render/frame/camera_path.h"

namespace catena::app {

/// The head that is shown, of one that is tracked.
///   follows   at once, to the bit
///   lost      not known, or not before the screen (render/stereo/stereo_views.h): it stays where it is
///   leaps     by more than kJumpDiagonals + kFast dt screen diagonals since the last picture, or after it was lost: it glides there in
///   kGlideS, the
///             difference fading as 1 - u^2 (3 - 2u)
class SmoothedHead {
 public:
  static constexpr double kJumpDiagonals = 0.05, kMaxDiagonalsPerS = 5, kMaxStepS = 0.2, kGlideS = 0.3;

  /// `screen`: before which it is.
  explicit SmoothedHead(const scene::DisplayScreen& screen) : screen_(screen) {}
  /// Each picture, `t_s` rising. Nothing before it was known for the first time.
  std::optional<Vec3> update(double t_s, const std::optional<Vec3>& tracked);
  bool is_lost() const { return is_lost_; }

 private:
  scene::DisplayScreen screen_;
  std::optional<Vec3> smoothed_, tracked_;
  Vec3 glide_offset_{0.0};  ///< from the tracked one, when it began to glide
  double glide_start_s_ = -1e300, last_s_ = 0;
  bool is_lost_ = false;
};

class TrackedHead {
 public:
  /// `words`: as --head has them. Errors: a file that is no such table, a first place that is not before the screen, a device that cannot
  /// be opened, or a scene without the workspace that a device needs.
  static Result<std::unique_ptr<TrackedHead>> open(const std::string& words, const scene::Scene& scene);
  ~TrackedHead();

  /// The device begins; a table is played from that time on.
  Outcome start(double t_s);
  /// Where it is shown now.
  std::optional<Vec3> position_at(double t_s) { return smoothed_.update(t_s, tracked_position(t_s)); }
  /// It is lost, or not before the screen, since the last call that said so; once for each time.
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
