// SPDX-License-Identifier: MIT
#include "render/xr/session_state.h"

namespace catena::render::xr {

SessionAction session_action(XrSessionState entered) {
  switch (entered) {
    case XR_SESSION_STATE_READY:
      return SessionAction::begin;
    case XR_SESSION_STATE_STOPPING:
      return SessionAction::end;
    case XR_SESSION_STATE_EXITING:
      return SessionAction::exit;
    case XR_SESSION_STATE_LOSS_PENDING:
      return SessionAction::lost;
    default:
      return SessionAction::none;
  }
}

bool is_valid_transition(XrSessionState from, XrSessionState to) {
  if (from == XR_SESSION_STATE_EXITING || from == XR_SESSION_STATE_LOSS_PENDING) return false;
  if (to == XR_SESSION_STATE_LOSS_PENDING) return from != XR_SESSION_STATE_UNKNOWN;
  switch (from) {
    case XR_SESSION_STATE_UNKNOWN:
      return to == XR_SESSION_STATE_IDLE;
    case XR_SESSION_STATE_IDLE:
      return to == XR_SESSION_STATE_READY || to == XR_SESSION_STATE_EXITING;
    case XR_SESSION_STATE_READY:
      return to == XR_SESSION_STATE_SYNCHRONIZED || to == XR_SESSION_STATE_STOPPING;
    case XR_SESSION_STATE_SYNCHRONIZED:
      return to == XR_SESSION_STATE_VISIBLE || to == XR_SESSION_STATE_STOPPING;
    case XR_SESSION_STATE_VISIBLE:
      return to == XR_SESSION_STATE_FOCUSED || to == XR_SESSION_STATE_SYNCHRONIZED;
    case XR_SESSION_STATE_FOCUSED:
      return to == XR_SESSION_STATE_VISIBLE;
    case XR_SESSION_STATE_STOPPING:
      return to == XR_SESSION_STATE_IDLE;
    default:
      return false;
  }
}

const char* state_name(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_IDLE:
      return "idle";
    case XR_SESSION_STATE_READY:
      return "ready";
    case XR_SESSION_STATE_SYNCHRONIZED:
      return "synchronized";
    case XR_SESSION_STATE_VISIBLE:
      return "visible";
    case XR_SESSION_STATE_FOCUSED:
      return "focused";
    case XR_SESSION_STATE_STOPPING:
      return "stopping";
    case XR_SESSION_STATE_LOSS_PENDING:
      return "loss pending";
    case XR_SESSION_STATE_EXITING:
      return "exiting";
    default:
      return "unknown";
  }
}

}  // namespace catena::render::xr
