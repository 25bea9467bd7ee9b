// SPDX-License-Identifier: MIT
#include "render/xr/actions.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace catena::render::xr {

namespace {

/// Bindings of an interaction profile, for each hand; empty: not bound.
struct Profile {
  const char *name, *select, *grab, *stick;
  const char *left_menu, *right_menu;
};
constexpr Profile kProfiles[] = {
    {"khr/simple_controller", "select/click", "", "", "menu/click", "menu/click"},
    {"oculus/touch_controller", "trigger/value", "squeeze/value", "thumbstick", "menu/click", "b/click"},
    {"valve/index_controller", "trigger/value", "squeeze/value", "thumbstick", "b/click", "b/click"},
    {"htc/vive_controller", "trigger/value", "squeeze/click", "trackpad", "menu/click", "menu/click"},
    {"microsoft/motion_controller", "trigger/value", "squeeze/click", "thumbstick", "menu/click", "menu/click"},
};
constexpr const char* kHandPaths[kControllers] = {"/user/hand/left", "/user/hand/right"};

double clamped(float value, double lower_bound) { return std::isfinite(value) ? std::clamp(double(value), lower_bound, 1.0) : 0.0; }

}  // namespace

Result<XrPath> Actions::make_path(const char* text) {
  XrPath made = XR_NULL_PATH;
  CATENA_XR_CHECK(*session_, session_->dispatch().StringToPath(session_->instance().handle(), text, &made), "create a path");
  return made;
}

Result<XrAction> Actions::make_action(XrActionType type, const char* name, const char* localized_name, bool per_hand) {
  XrActionCreateInfo info{};
  info.type = XR_TYPE_ACTION_CREATE_INFO;
  info.actionType = type;
  std::strcpy(info.actionName, name);
  std::strcpy(info.localizedActionName, localized_name);
  info.countSubactionPaths = per_hand ? std::uint32_t(hand_paths_.size()) : 0;
  info.subactionPaths = hand_paths_.data();
  XrAction made = XR_NULL_HANDLE;
  CATENA_XR_CHECK(*session_, session_->dispatch().CreateAction(set_, &info, &made), "create an action");
  return made;
}

Result<XrSpace> Actions::make_pose_space(XrAction pose, XrPath controller_path) {
  XrActionSpaceCreateInfo info{};
  info.type = XR_TYPE_ACTION_SPACE_CREATE_INFO;
  info.action = pose;
  info.subactionPath = controller_path;
  info.poseInActionSpace.orientation.w = 1;
  XrSpace made = XR_NULL_HANDLE;
  CATENA_XR_CHECK(*session_, session_->dispatch().CreateActionSpace(session_->handle(), &info, &made), "create a pose space");
  return made;
}

Result<std::unique_ptr<Actions>> Actions::create(Session& session) {
  std::unique_ptr<Actions> self(new Actions(session));
  CATENA_CHECK(self->create_actions());
  return self;
}

Actions::~Actions() {
  for (const auto& spaces : {aim_spaces_, grip_spaces_})
    for (XrSpace space : spaces)
      if (space) (void)session_->dispatch().DestroySpace(space);
  if (gaze_space_) (void)session_->dispatch().DestroySpace(gaze_space_);
  if (set_) (void)session_->dispatch().DestroyActionSet(set_);
}

Outcome Actions::create_actions() {
  const DispatchTable& xr = session_->dispatch();
  XrActionSetCreateInfo info{};
  info.type = XR_TYPE_ACTION_SET_CREATE_INFO;
  std::strcpy(info.actionSetName, "hands");
  std::strcpy(info.localizedActionSetName, "Hands");
  CATENA_XR_CHECK(*session_, xr.CreateActionSet(session_->instance().handle(), &info, &set_), "create the action set");
  for (std::size_t k = 0; k < kControllers; ++k) {
    CATENA_TRY(hand_paths_[k], make_path(kHandPaths[k]));
  }
  CATENA_TRY(aim_, make_action(XR_ACTION_TYPE_POSE_INPUT, "aim", "Aim pose"));
  CATENA_TRY(grip_, make_action(XR_ACTION_TYPE_POSE_INPUT, "grip", "Grip pose"));
  CATENA_TRY(select_, make_action(XR_ACTION_TYPE_FLOAT_INPUT, "select", "Select"));
  CATENA_TRY(grab_, make_action(XR_ACTION_TYPE_FLOAT_INPUT, "grab", "Grab"));
  CATENA_TRY(stick_, make_action(XR_ACTION_TYPE_VECTOR2F_INPUT, "stick", "Turn"));
  CATENA_TRY(menu_, make_action(XR_ACTION_TYPE_BOOLEAN_INPUT, "menu", "Panel"));
  CATENA_TRY(vibration_, make_action(XR_ACTION_TYPE_VIBRATION_OUTPUT, "vibration", "Vibration"));
  const bool has_gaze = session_->instance().capabilities().gaze;
  if (has_gaze) {
    CATENA_TRY(gaze_, make_action(XR_ACTION_TYPE_POSE_INPUT, "gaze", "Gaze", false));
    CATENA_CHECK(suggest_gaze_binding());
  }
  CATENA_CHECK(suggest_bindings());
  XrSessionActionSetsAttachInfo attach{};
  attach.type = XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO;
  attach.countActionSets = 1;
  attach.actionSets = &set_;
  CATENA_XR_CHECK(*session_, xr.AttachSessionActionSets(session_->handle(), &attach), "attach the action set");
  for (std::size_t k = 0; k < kControllers; ++k) {
    CATENA_TRY(aim_spaces_[k], make_pose_space(aim_, hand_paths_[k]));
    CATENA_TRY(grip_spaces_[k], make_pose_space(grip_, hand_paths_[k]));
  }
  if (has_gaze) {
    CATENA_TRY(gaze_space_, make_pose_space(gaze_, XR_NULL_PATH));
  }
  return Done{};
}

/// Suggests bindings for all profiles; one that the runtime accepts suffices.
Outcome Actions::suggest_bindings() {
  XrResult last = XR_SUCCESS;
  bool taken = false;
  for (const Profile& profile : kProfiles) {
    std::vector<XrActionSuggestedBinding> bindings;
    for (std::size_t k = 0; k < kControllers; ++k) {
      const auto bind = [&](XrAction of, const std::string& where) -> Outcome {
        if (where.ends_with('/')) return Done{};
        CATENA_TRY(const XrPath to, make_path((std::string(kHandPaths[k]) + where).c_str()));
        bindings.push_back({of, to});
        return Done{};
      };
      CATENA_CHECK(bind(aim_, "/input/aim/pose"));
      CATENA_CHECK(bind(grip_, "/input/grip/pose"));
      CATENA_CHECK(bind(vibration_, "/output/haptic"));
      CATENA_CHECK(bind(select_, std::string("/input/") + profile.select));
      CATENA_CHECK(bind(grab_, std::string("/input/") + profile.grab));
      CATENA_CHECK(bind(stick_, std::string("/input/") + profile.stick));
      CATENA_CHECK(bind(menu_, std::string("/input/") + (k == 0 ? profile.left_menu : profile.right_menu)));
    }
    XrInteractionProfileSuggestedBinding info{};
    info.type = XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING;
    CATENA_TRY(info.interactionProfile, make_path((std::string("/interaction_profiles/") + profile.name).c_str()));
    info.countSuggestedBindings = std::uint32_t(bindings.size());
    info.suggestedBindings = bindings.data();
    const XrResult result = session_->dispatch().SuggestInteractionProfileBindings(session_->instance().handle(), &info);
    taken = taken || XR_SUCCEEDED(result);
    if (XR_FAILED(result)) last = result;
  }
  return taken ? Outcome(Done{}) : Outcome(session_->failed(last, "attach the action set"));
}

Outcome Actions::suggest_gaze_binding() {
  XrActionSuggestedBinding binding{gaze_, XR_NULL_PATH};
  CATENA_TRY(binding.binding, make_path("/user/eyes_ext/input/gaze_ext/pose"));
  XrInteractionProfileSuggestedBinding info{};
  info.type = XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING;
  CATENA_TRY(info.interactionProfile, make_path("/interaction_profiles/ext/eye_gaze_interaction"));
  info.countSuggestedBindings = 1;
  info.suggestedBindings = &binding;
  CATENA_XR_CHECK(*session_, session_->dispatch().SuggestInteractionProfileBindings(session_->instance().handle(), &info), "bind the gaze");
  return Done{};
}

Outcome Actions::sync() {
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  XrActionsSyncInfo info{};
  info.type = XR_TYPE_ACTIONS_SYNC_INFO;
  info.countActiveActionSets = 1;
  info.activeActionSets = &active;
  CATENA_XR_CHECK(*session_, session_->dispatch().SyncActions(session_->handle(), &info), "read the controls");
  return Done{};
}

Result<bool> Actions::locate(XrSpace space, XrTime at, XrPose& pose) {
  CATENA_TRY(const std::optional<XrPose> found, session_->locate(space, at, "locate a hand"));
  if (found) pose = *found;
  return found.has_value();
}

Result<ControllerState> Actions::controller(std::size_t index, XrTime at) {
  const DispatchTable& xr = session_->dispatch();
  ControllerState state;
  state.is_focused = session_->is_focused();
  XrActionStateGetInfo info{};
  info.type = XR_TYPE_ACTION_STATE_GET_INFO;
  info.subactionPath = hand_paths_[index];
  info.action = grip_;
  XrActionStatePose pose{};
  pose.type = XR_TYPE_ACTION_STATE_POSE;
  CATENA_XR_CHECK(*session_, xr.GetActionStatePose(session_->handle(), &info, &pose), "read the controls");
  if (!pose.isActive) return state;
  CATENA_TRY(state.is_tracked, locate(grip_spaces_[index], at, state.grip));
  CATENA_TRY(state.has_aim, locate(aim_spaces_[index], at, state.aim));
  if (!state.is_focused) return state;

  const auto amount = [&](XrAction of, double& value) -> Outcome {
    XrActionStateFloat found{};
    found.type = XR_TYPE_ACTION_STATE_FLOAT;
    info.action = of;
    CATENA_XR_CHECK(*session_, xr.GetActionStateFloat(session_->handle(), &info, &found), "read the controls");
    value = found.isActive ? clamped(found.currentState, 0) : 0;
    return Done{};
  };
  CATENA_CHECK(amount(select_, state.select));
  CATENA_CHECK(amount(grab_, state.grab));
  XrActionStateVector2f stick{};
  stick.type = XR_TYPE_ACTION_STATE_VECTOR2F;
  info.action = stick_;
  CATENA_XR_CHECK(*session_, xr.GetActionStateVector2f(session_->handle(), &info, &stick), "read the controls");
  if (stick.isActive) {
    state.stick_x = clamped(stick.currentState.x, -1);
    state.stick_y = clamped(stick.currentState.y, -1);
  }
  XrActionStateBoolean menu{};
  menu.type = XR_TYPE_ACTION_STATE_BOOLEAN;
  info.action = menu_;
  CATENA_XR_CHECK(*session_, xr.GetActionStateBoolean(session_->handle(), &info, &menu), "read the controls");
  state.menu = menu.isActive && menu.currentState;
  return state;
}

Result<std::optional<XrPose>> Actions::gaze(XrTime at) {
  const std::optional<XrPose> none;
  if (!gaze_space_ || !session_->is_focused()) return none;
  XrActionStateGetInfo info{};
  info.type = XR_TYPE_ACTION_STATE_GET_INFO;
  info.action = gaze_;
  XrActionStatePose state{};
  state.type = XR_TYPE_ACTION_STATE_POSE;
  CATENA_XR_CHECK(*session_, session_->dispatch().GetActionStatePose(session_->handle(), &info, &state), "read the gaze");
  if (!state.isActive) return none;
  XrPose pose;
  CATENA_TRY(const bool known, locate(gaze_space_, at, pose));
  return known ? std::optional(pose) : none;
}

Outcome Actions::vibrate(std::size_t index, double amplitude, double frequency_hz, std::int64_t duration_ns) {
  if (!session_->is_focused()) return Done{};
  XrHapticActionInfo info{};
  info.type = XR_TYPE_HAPTIC_ACTION_INFO;
  info.action = vibration_;
  info.subactionPath = hand_paths_[index];
  XrHapticVibration vibration{};
  vibration.type = XR_TYPE_HAPTIC_VIBRATION;
  vibration.amplitude = float(std::isfinite(amplitude) ? std::clamp(amplitude, 0.0, 1.0) : 0);
  vibration.frequency = float(frequency_hz > 0 && std::isfinite(frequency_hz) ? frequency_hz : 0);  // 0: XR_FREQUENCY_UNSPECIFIED
  vibration.duration = duration_ns > 0 ? duration_ns : XR_MIN_HAPTIC_DURATION;
  CATENA_XR_CHECK(
      *session_,
      session_->dispatch().ApplyHapticFeedback(session_->handle(), &info, reinterpret_cast<const XrHapticBaseHeader*>(&vibration)),
      "vibrate");
  return Done{};
}

Outcome Actions::stop_vibration(std::size_t index) {
  XrHapticActionInfo info{};
  info.type = XR_TYPE_HAPTIC_ACTION_INFO;
  info.action = vibration_;
  info.subactionPath = hand_paths_[index];
  CATENA_XR_CHECK(*session_, session_->dispatch().StopHapticFeedback(session_->handle(), &info), "stop the vibration");
  return Done{};
}

Result<std::string> Actions::interaction_profile(std::size_t index) {
  XrInteractionProfileState state{};
  state.type = XR_TYPE_INTERACTION_PROFILE_STATE;
  CATENA_XR_CHECK(*session_, session_->dispatch().GetCurrentInteractionProfile(session_->handle(), hand_paths_[index], &state),
                  "report the controller type");
  if (state.interactionProfile == XR_NULL_PATH) return std::string();
  std::array<char, XR_MAX_PATH_LENGTH> text{};
  std::uint32_t count = 0;
  CATENA_XR_CHECK(*session_,
                  session_->dispatch().PathToString(session_->instance().handle(), state.interactionProfile, std::uint32_t(text.size()),
                                                    &count, text.data()),
                  "report the controller type");
  return std::string(text.data());
}

}  // namespace catena::render::xr
