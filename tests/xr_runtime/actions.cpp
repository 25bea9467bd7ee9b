// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "tests/xr_runtime/runtime.h"

namespace catena::test::xr_runtime {

namespace {

const std::string& path_text(std::uint64_t instance, XrPath path) {
  static const std::string none;
  auto* object = world().find<InstanceObject>(instance, Kind::instance);
  return object && path < object->paths.size() ? object->paths[path] : none;
}

constexpr const char* kEyes = "/interaction_profiles/ext/eye_gaze_interaction";

int hand_of(const std::string& path) { return path.find("/right") != std::string::npos ? 1 : 0; }

XRAPI_ATTR XrResult XRAPI_CALL create_action_set(XrInstance handle, const XrActionSetCreateInfo*, XrActionSet* made) {
  ENTER(xrCreateActionSet);
  FIND(InstanceObject, instance, handle, instance);
  *made = as_handle<XrActionSet>(world().add(std::make_unique<ActionSetObject>(number(handle))));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL destroy_action_set(XrActionSet handle) {
  ENTER_TO_DESTROY(xrDestroyActionSet);
  FIND(ActionSetObject, set, handle, action_set);
  world().remove(number(handle));
  return answer;
}

XRAPI_ATTR XrResult XRAPI_CALL create_action(XrActionSet handle, const XrActionCreateInfo* info, XrAction* made) {
  ENTER(xrCreateAction);
  FIND(ActionSetObject, set, handle, action_set);
  if (set->attached) return illegal(self, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the set is attached");
  auto action = std::make_unique<ActionObject>(number(handle));
  action->name = info->actionName;
  action->type = info->actionType;
  *made = as_handle<XrAction>(world().add(std::move(action)));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL suggest(XrInstance handle, const XrInteractionProfileSuggestedBinding* info) {
  ENTER(xrSuggestInteractionProfileBindings);
  FIND(InstanceObject, instance, handle, instance);
  const std::string& profile = path_text(number(handle), info->interactionProfile);
  if (profile == kEyes && !instance->extensions.contains(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME))
    return illegal(self, XR_ERROR_PATH_UNSUPPORTED, "the gaze's extension was not asked for");
  auto& bindings = instance->suggested[profile];
  bindings.clear();
  for (std::uint32_t i = 0; i < info->countSuggestedBindings; ++i) {
    const XrActionSuggestedBinding& one = info->suggestedBindings[i];
    FIND(ActionObject, action, one.action, action);
    auto* set = world().find<ActionSetObject>(action->parent, Kind::action_set);
    if (set->attached) return illegal(self, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the set is attached");
    bindings[number(one.action)].push_back(path_text(number(handle), one.binding));
  }
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL attach(XrSession handle, const XrSessionActionSetsAttachInfo* info) {
  ENTER(xrAttachSessionActionSets);
  FIND(SessionObject, session, handle, session);
  if (!session->action_sets.empty()) return illegal(self, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "sets are attached");
  for (std::uint32_t i = 0; i < info->countActionSets; ++i) {
    FIND(ActionSetObject, set, info->actionSets[i], action_set);
    set->attached = true;
    session->action_sets.push_back(number(info->actionSets[i]));
  }
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL create_action_space(XrSession handle, const XrActionSpaceCreateInfo* info, XrSpace* made) {
  ENTER(xrCreateActionSpace);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_POSE_INPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a pose");
  auto space = std::make_unique<SpaceObject>(number(handle));
  space->action = number(info->action);
  space->hand = hand_of(path_text(session->parent, info->subactionPath));
  *made = as_handle<XrSpace>(world().add(std::move(space)));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL sync(XrSession handle, const XrActionsSyncInfo* info) {
  ENTER(xrSyncActions);
  FIND(SessionObject, session, handle, session);
  for (std::uint32_t i = 0; i < info->countActiveActionSets; ++i)
    if (std::ranges::find(session->action_sets, number(info->activeActionSets[i].actionSet)) == session->action_sets.end())
      return illegal(self, XR_ERROR_ACTIONSET_NOT_ATTACHED, "the set is not attached");
  session->synced = true;
  return session->state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

/// The hand, if the action is bound in the scripted profile and the session has focus; otherwise null.
const ScriptedHand* active_hand(const SessionObject& session, std::uint64_t action, XrPath hand_path) {
  auto* instance = world().find<InstanceObject>(session.parent, Kind::instance);
  const Script& script = world().shared.script;
  const auto profile = instance->suggested.find(script.profile);
  if (session.state != XR_SESSION_STATE_FOCUSED || profile == instance->suggested.end() || !session.synced) return nullptr;
  const auto bound = profile->second.find(action);
  const int hand = hand_of(path_text(session.parent, hand_path));
  if (bound == profile->second.end() || !script.hands[hand].active) return nullptr;
  const bool has = std::ranges::any_of(bound->second, [&](const std::string& path) { return hand_of(path) == hand; });
  return has ? &script.hands[hand] : nullptr;
}

/// True if the eyes are tracked and the action is bound to their gaze.
bool sees_gaze(const SessionObject& session, std::uint64_t action) {
  auto* instance = world().find<InstanceObject>(session.parent, Kind::instance);
  const Script& script = world().shared.script;
  const auto profile = instance->suggested.find(kEyes);
  return script.supports_gaze && script.gaze && session.state == XR_SESSION_STATE_FOCUSED && session.synced &&
         profile != instance->suggested.end() && profile->second.contains(action);
}

float amount_of(const std::string& name, const ScriptedHand& hand) {
  if (name.find("grab") != std::string::npos) return hand.squeeze;
  if (name.find("menu") != std::string::npos) return hand.menu ? 1.0f : 0.0f;
  return hand.select;
}

/// Common fields of an action's state; `value` of the bound hand, null if there is none.
template <class State, class Value>
XrResult fill_state(const SessionObject& session, const XrActionStateGetInfo* info, State* out, const Value& value) {
  const ScriptedHand* hand = active_hand(session, number(info->action), info->subactionPath);
  out->isActive = hand != nullptr;
  out->currentState = value(hand);
  out->changedSinceLastSync = XR_FALSE;
  out->lastChangeTime = 0;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL boolean_state(XrSession handle, const XrActionStateGetInfo* info, XrActionStateBoolean* out) {
  ENTER(xrGetActionStateBoolean);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_BOOLEAN_INPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a yes or no");
  return fill_state(*session, info, out, [&](const ScriptedHand* hand) { return hand && amount_of(action->name, *hand) > 0.5f; });
}

XRAPI_ATTR XrResult XRAPI_CALL float_state(XrSession handle, const XrActionStateGetInfo* info, XrActionStateFloat* out) {
  ENTER(xrGetActionStateFloat);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_FLOAT_INPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a number");
  return fill_state(*session, info, out, [&](const ScriptedHand* hand) { return hand ? amount_of(action->name, *hand) : 0.0f; });
}

XRAPI_ATTR XrResult XRAPI_CALL vector_state(XrSession handle, const XrActionStateGetInfo* info, XrActionStateVector2f* out) {
  ENTER(xrGetActionStateVector2f);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_VECTOR2F_INPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a stick");
  return fill_state(*session, info, out, [&](const ScriptedHand* hand) { return hand ? hand->stick : XrVector2f{0, 0}; });
}

XRAPI_ATTR XrResult XRAPI_CALL pose_state(XrSession handle, const XrActionStateGetInfo* info, XrActionStatePose* out) {
  ENTER(xrGetActionStatePose);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_POSE_INPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a pose");
  out->isActive = active_hand(*session, number(info->action), info->subactionPath) != nullptr || sees_gaze(*session, number(info->action));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL current_profile(XrSession handle, XrPath, XrInteractionProfileState* out) {
  ENTER(xrGetCurrentInteractionProfile);
  FIND(SessionObject, session, handle, session);
  if (session->action_sets.empty()) return illegal(self, XR_ERROR_ACTIONSET_NOT_ATTACHED, "no set is attached");
  auto* instance = world().find<InstanceObject>(session->parent, Kind::instance);
  const auto it = std::ranges::find(instance->paths, world().shared.script.profile);
  out->interactionProfile = it == instance->paths.end() ? XR_NULL_PATH : XrPath(it - instance->paths.begin());
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL apply_haptic(XrSession handle, const XrHapticActionInfo* info, const XrHapticBaseHeader* haptic) {
  ENTER(xrApplyHapticFeedback);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  if (action->type != XR_ACTION_TYPE_VIBRATION_OUTPUT) return illegal(self, XR_ERROR_ACTION_TYPE_MISMATCH, "not a vibration");
  if (haptic->type != XR_TYPE_HAPTIC_VIBRATION) return illegal(self, XR_ERROR_VALIDATION_FAILURE, "no vibration");
  const auto& vibration = reinterpret_cast<const XrHapticVibration&>(*haptic);
  if (!(vibration.amplitude >= 0 && vibration.amplitude <= 1))
    return illegal(self, XR_ERROR_VALIDATION_FAILURE, "an amplitude beyond 0..1");
  if (session->state != XR_SESSION_STATE_FOCUSED) return XR_SESSION_NOT_FOCUSED;
  world().shared.record.vibrations.push_back({hand_of(path_text(session->parent, info->subactionPath)), false, vibration.amplitude,
                                              vibration.frequency, vibration.duration, session->frame});
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL stop_haptic(XrSession handle, const XrHapticActionInfo* info) {
  ENTER(xrStopHapticFeedback);
  FIND(SessionObject, session, handle, session);
  FIND(ActionObject, action, info->action, action);
  world().shared.record.vibrations.push_back({hand_of(path_text(session->parent, info->subactionPath)), true, 0, 0, 0, session->frame});
  return session->state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

}  // namespace

PFN_xrVoidFunction find_action_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrCreateActionSet", reinterpret_cast<PFN_xrVoidFunction>(create_action_set)},
      {"xrDestroyActionSet", reinterpret_cast<PFN_xrVoidFunction>(destroy_action_set)},
      {"xrCreateAction", reinterpret_cast<PFN_xrVoidFunction>(create_action)},
      {"xrSuggestInteractionProfileBindings", reinterpret_cast<PFN_xrVoidFunction>(suggest)},
      {"xrAttachSessionActionSets", reinterpret_cast<PFN_xrVoidFunction>(attach)},
      {"xrCreateActionSpace", reinterpret_cast<PFN_xrVoidFunction>(create_action_space)},
      {"xrSyncActions", reinterpret_cast<PFN_xrVoidFunction>(sync)},
      {"xrGetActionStateBoolean", reinterpret_cast<PFN_xrVoidFunction>(boolean_state)},
      {"xrGetActionStateFloat", reinterpret_cast<PFN_xrVoidFunction>(float_state)},
      {"xrGetActionStateVector2f", reinterpret_cast<PFN_xrVoidFunction>(vector_state)},
      {"xrGetActionStatePose", reinterpret_cast<PFN_xrVoidFunction>(pose_state)},
      {"xrGetCurrentInteractionProfile", reinterpret_cast<PFN_xrVoidFunction>(current_profile)},
      {"xrApplyHapticFeedback", reinterpret_cast<PFN_xrVoidFunction>(apply_haptic)},
      {"xrStopHapticFeedback", reinterpret_cast<PFN_xrVoidFunction>(stop_haptic)}};
  const auto it = all.find(name);
  return it == all.end() ? nullptr : it->second;
}

}  // namespace catena::test::xr_runtime
