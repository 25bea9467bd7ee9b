/// The door from the scene to the hand: links of the scene -> a program for the tick. Off the tick.
#pragma once
#include <memory>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// Builds the program of all link entities in order, loading only the fields that they name. `limits`: what the device allows.
Result<std::shared_ptr<const Program>> extract_program(scene::Scene& scene, const Limits& limits = {});

}  // namespace catena::haptics
