// SPDX-License-Identifier: MIT
/// States of a session, as defined by OpenXR, and the action of the program on entering one:
///   unknown -> IDLE -> READY -(begin)-> SYNCHRONIZED <-> VISIBLE <-> FOCUSED
///   SYNCHRONIZED -> STOPPING -(end)-> IDLE -> EXITING;  READY -> STOPPING (canceled by the runtime);  any -> LOSS_PENDING
/// Frames are made from begin to end, images rendered from VISIBLE on, input is valid in FOCUSED. Pure functions, any thread.
#pragma once
#include "render/xr/xr_loader.h"

namespace catena::render::xr {

/// Action of the program on entering a state.
enum class SessionAction {
  none,
  begin,  ///< xrBeginSession
  end,    ///< xrEndSession
  exit,   ///< destroy the session and do not re-create it automatically: the user has left
  lost    ///< destroy the session; it may be re-created
};
/// Returns the action on entering a state.
SessionAction session_action(XrSessionState entered);

/// Returns whether the transition is in the diagram above. Other transitions of a runtime are followed nevertheless.
bool is_valid_transition(XrSessionState from, XrSessionState to);

inline bool is_visible(XrSessionState state) { return state == XR_SESSION_STATE_VISIBLE || state == XR_SESSION_STATE_FOCUSED; }
/// Returns the OpenXR name of a state.
const char* state_name(XrSessionState state);

}  // namespace catena::render::xr
