/// The cursor of a still picture: where the hand is after a probe path, or at the probe that the scene's cursor names.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"

namespace catena::app {

/// Runs the chain along `probe_csv` (or, if empty, rests at the scene's own cursor, if it has one) and writes the last tick
/// into the cursor. Without either the cursor stays hidden.
Outcome place_cursor(scene::Scene& scene, const haptics::Program& program, const std::string& probe_csv);

}  // namespace catena::app
