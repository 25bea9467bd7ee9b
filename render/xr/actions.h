// SPDX-License-Identifier: MIT
/// Controller input as OpenXR actions, independent of the controller type, and vibration output. The runtime applies the bindings suggested
/// here for common controllers (KHR simple, Oculus Touch, Valve Index, HTC Vive, Windows motion controllers), and its own choice for
/// others.
///   aim    pointing direction: along -z               grip   where the controller is held; the probe is its origin
///   select trigger, 0..1                              grab   squeeze, 0..1
///   stick  thumbstick or trackpad, right and up       menu   the panel
/// If the headset tracks the eyes (XR_EXT_eye_gaze_interaction), the gaze is a pose like the others: along -z from between the eyes. A
/// controller that is off, or that the runtime cannot track, is reported as not tracked. One object per session; to be destroyed before the
/// session. Frame thread; never used by the haptic thread.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "engine/base/vec.h"
#include "render/xr/session.h"

namespace catena::render::xr {

/// State of one controller.
struct ControllerState {
  bool is_tracked = false;  ///< pose of the grip is known
  bool has_aim = false;     ///< pose of the aim is known
  bool is_focused = false;  ///< input is valid: the session has focus
  XrPose grip, aim;
  /// Trigger and squeeze, 0..1; stick to the right and up, -1..1.
  double select = 0, grab = 0, stick_x = 0, stick_y = 0;
  bool menu = false;
};

inline constexpr std::size_t kControllers = 2;  ///< 0 left, 1 right

/// Actions of one session.
class Actions {
 public:
  /// Creates the actions and suggests the bindings. An Error if the runtime refuses.
  static Result<std::unique_ptr<Actions>> create(Session& session);
  ~Actions();
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  /// Updates buttons and poses to the latest state; to be called every frame.
  Outcome sync();
  /// Returns a controller's state at a time of the runtime's clock: the current time for interaction, the frame's display time for
  /// rendering.
  Result<ControllerState> controller(std::size_t index, XrTime at);

  /// Returns the user's gaze at that time; nullopt if the headset does not know it or the session has no focus.
  Result<std::optional<XrPose>> gaze(XrTime at);

  /// Replaces the vibration of a controller. amplitude 0..1; frequency in Hz, 0: chosen by the runtime, which clamps unsupported values.
  /// Does nothing without focus.
  Outcome vibrate(std::size_t index, double amplitude, double frequency_hz, std::int64_t duration_ns);
  /// Stops the vibration of a controller.
  Outcome stop_vibration(std::size_t index);

  /// Returns, for instance, "/interaction_profiles/valve/index_controller"; empty: no controller.
  Result<std::string> interaction_profile(std::size_t index);

 private:
  explicit Actions(Session& session) : session_(&session) {}
  Outcome create_actions();
  Outcome suggest_bindings();
  Outcome suggest_gaze_binding();
  Result<XrPath> make_path(const char* text);
  Result<XrAction> make_action(XrActionType type, const char* name, const char* localized_name, bool per_hand = true);
  Result<XrSpace> make_pose_space(XrAction pose, XrPath controller_path);
  Result<bool> locate(XrSpace space, XrTime at, XrPose& pose);

  Session* session_;
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction aim_ = XR_NULL_HANDLE, grip_ = XR_NULL_HANDLE, select_ = XR_NULL_HANDLE, grab_ = XR_NULL_HANDLE, stick_ = XR_NULL_HANDLE,
           menu_ = XR_NULL_HANDLE, vibration_ = XR_NULL_HANDLE, gaze_ = XR_NULL_HANDLE;
  std::array<XrPath, kControllers> hand_paths_{};
  std::array<XrSpace, kControllers> aim_spaces_{}, grip_spaces_{};
  XrSpace gaze_space_ = XR_NULL_HANDLE;
};

}  // namespace catena::render::xr
