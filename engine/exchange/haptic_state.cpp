#include "engine/exchange/haptic_state.h"

#include "engine/base/result.h"

namespace catena::exchange {

const char* mode_word(WidgetMode mode) {
  switch (mode) {
    case WidgetMode::away:
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

const char* status_word(Status status) {
  constexpr const char* words[] = {"OK", "FREE", "RELEASED", "BUDGET", "CRITICAL", "BOUNDARY", "NO_SURFACE", "BAD_PROBE"};
  return words[static_cast<int>(status)];
}

const char* condition_word(Condition condition) {
  constexpr const char* words[] = {"NORMAL", "LATE", "NO_DEVICE", "WATCHDOG"};
  return words[static_cast<int>(condition)];
}

const char* force_state_word(ForceState state) {
  constexpr const char* words[] = {"ON", "OFF", "RAMPING_IN", "HELD", "RAMPING_OUT", "STOPPED"};
  return words[static_cast<int>(state)];
}

}  // namespace catena::exchange
