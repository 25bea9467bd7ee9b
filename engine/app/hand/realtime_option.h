/// "--realtime on|off" and "--cpu N": how hard the servo's thread tries.
#pragma once
#include <CLI/CLI.hpp>

#include "engine/app/hand/open_hand.h"

namespace catena::app {

inline void add_realtime_options(CLI::App& command, RealtimeChoice& choice) {
  command.add_option("--realtime", choice.realtime, "fixed priority and locked memory for the servo, where permitted")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command.add_option("--cpu", choice.cpu, "the core that the servo stays on; default: the last one, with a fixed priority")
      ->check(CLI::Range(0, 4095));
}

}  // namespace catena::app
