#include "engine/exchange/haptic_state.h"

namespace catena::exchange {

const char* status_word(Status status) {
  constexpr const char* words[] = {"OK", "FREE", "RELEASED", "BUDGET", "CRITICAL", "BOUNDARY", "NO_SURFACE", "BAD_PROBE"};
  return words[static_cast<int>(status)];
}

}  // namespace catena::exchange
