// SPDX-License-Identifier: MIT
#include "engine/base/haptic_state.h"

#include "engine/base/result.h"

namespace catena {

const char* to_string(WidgetMode mode) {
  switch (mode) {
    case WidgetMode::idle:
      return "away";
    case WidgetMode::explore:
      return "explore";
    case WidgetMode::translate:
      return "translate";
    case WidgetMode::rotate:
      return "rotate";
    case WidgetMode::turn:
      return "turn";
    case WidgetMode::hover:
      return "hover";
    case WidgetMode::drag:
      return "drag";
  }
  CATENA_ASSERT(false);
  return "";
}

const char* to_string(LinkStatus status) {
  constexpr const char* words[] = {"OK", "FREE", "RELEASED", "BUDGET", "CRITICAL", "BOUNDARY", "NO_SURFACE", "BAD_PROBE", "COARSE"};
  return words[static_cast<int>(status)];
}

const char* to_string(TickCondition condition) {
  constexpr const char* words[] = {"NORMAL", "LATE", "NO_DEVICE", "WATCHDOG"};
  return words[static_cast<int>(condition)];
}

const char* to_string(ForceState state) {
  constexpr const char* words[] = {"ON", "OFF", "RAMPING_IN", "HELD", "RAMPING_OUT", "STOPPED"};
  return words[static_cast<int>(state)];
}

}  // namespace catena
