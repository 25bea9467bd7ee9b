/// The states of a session, as OpenXR draws them, and what the program does on entering one:
///   unknown -> IDLE -> READY -(begin)-> SYNCHRONIZED <-> VISIBLE <-> FOCUSED
///   SYNCHRONIZED -> STOPPING -(end)-> IDLE -> EXITING;  READY -> STOPPING (a runtime that changes its mind);  any -> LOSS_PENDING
/// Frames are made from the beginning to the end, pictures from VISIBLE on, hands are taken in FOCUSED. Pure functions, any thread.
#pragma once
#include "render/xr/xr_loader.h"

namespace catena::render::xr {

enum class SessionAction {
  none,
  begin,  ///< xrBeginSession
  end,    ///< xrEndSession
  exit,   ///< the session is to be destroyed, and not made again by itself: the person has left
  lost    ///< the session is to be destroyed, and may be made again
};
SessionAction session_action(XrSessionState entered);

/// Whether the drawing above has this edge. A runtime that takes another one is followed all the same.
bool is_valid_transition(XrSessionState from, XrSessionState to);

inline bool is_visible(XrSessionState state) { return state == XR_SESSION_STATE_VISIBLE || state == XR_SESSION_STATE_FOCUSED; }
const char* state_name(XrSessionState state);

}  // namespace catena::render::xr
