/// The hands in OpenXR's words: what a person does with controllers, whichever they are, and the vibration that they feel. The runtime maps
/// what is suggested here for the common controllers (KHR simple, Oculus LinkContact, Valve Index, HTC Vive, Windows motion controllers),
/// and for others what it thinks best.
///   aim    where the hand points: along -z        grip   where the controller is held; the probe is its origin
///   select trigger, 0..1                          grab   squeeze, 0..1
///   stick  thumbstick or trackpad, right and up   menu   the panel
/// Where a headset sees the eyes (XR_EXT_eye_gaze_interaction), their gaze is a pose like the others: along -z from between them.
/// A hand whose controller is off, or which the runtime cannot see, is not there. One object a session; it goes before the session.
/// Frame thread; the haptic thread never comes here.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "engine/base/vec.h"
#include "render/xr/session.h"

namespace catena::render::xr {

struct ControllerState {
  bool is_tracked = false;  ///< position and direction of the grip are known
  bool has_aim = false;     ///< those of the aim are
  bool is_focused = false;  ///< buttons count
  XrPose grip, aim;
  double select = 0, grab = 0, stick_x = 0, stick_y = 0;
  bool menu = false;
};

inline constexpr std::size_t kControllers = 2;  ///< 0 left, 1 right

class Actions {
 public:
  static Result<std::unique_ptr<Actions>> create(Session& session);
  ~Actions();
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  /// Buttons and poses from now on are the newest; once a frame.
  Outcome sync();
  /// A hand at a time of the runtime's clock: `now` for what it does, the frame's time for what is drawn of it.
  Result<ControllerState> controller(std::size_t which, XrTime at);

  /// Where the person looks then; nothing where the headset does not know. Nothing without focus.
  Result<std::optional<XrPose>> gaze(XrTime at);

  /// Replaces what the hand feels. amplitude 0..1; frequency in Hz, 0: the runtime's choice; what it cannot make it clamps.
  /// Nothing without focus.
  Outcome vibrate(std::size_t which, double amplitude, double frequency_hz, std::int64_t duration_ns);
  Outcome stop_vibration(std::size_t which);

  /// "/interaction_profiles/valve/index_controller"; empty: no controller.
  Result<std::string> interaction_profile(std::size_t which);

 private:
  explicit Actions(Session& session) : session_(&session) {}
  Outcome create_actions();
  Outcome suggest_bindings();
  Outcome suggest_gaze_binding();
  Result<XrPath> make_path(const char* text);
  Result<XrAction> make_action(XrActionType type, const char* name, const char* words, bool of_hands = true);
  Result<XrSpace> make_pose_space(XrAction pose, XrPath hand);
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
