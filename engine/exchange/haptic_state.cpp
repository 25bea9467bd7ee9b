#include "engine/exchange/haptic_state.h"

namespace catena::exchange {

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
