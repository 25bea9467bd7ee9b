// SPDX-License-Identifier: MIT
/// Builds the haptic program from the scene: the links of the chain, the modes and the widgets. Off the tick.
#pragma once
#include <functional>
#include <memory>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// Builds one link from an element of the scene's chain: its keys, switch, release cue, alignment and constraint. `coupling` gives the
/// default stiffness and the method; a baseline needs the link's linear primitive and takes over its `release`. The Error names the line.
CATENA_EXPORT Result<Link> build_link(const json::Node& from, const Coupling& coupling, const BuildContext& context);

/// Returns a copy of an element of the chain with {"widget": NAME} replaced by the present value of that widget: "seed" by the position of
/// a seed, "level" by the value of an isolevel. The Error names the line.
CATENA_EXPORT Result<json::Node> resolve_widget_values(scene::Scene& scene, const json::Node& item);

/// Appends all widgets of the scene with their present pose and revision, and their links after the scene's. `links_of` returns the link
/// indices for a name in the chain; null: no such name. An Error if there are too many widgets, a baseline is used, or a name is unknown
/// or taken.
CATENA_EXPORT Outcome add_widgets(scene::Scene& scene, const std::function<const std::vector<int>*(const std::string&)>& links_of,
                                  HapticProgram& program);

/// Builds the program from all link, mode and widget entities of the scene in order, loading only the data that they name. `limits`: limits
/// of the device. Each program gets a new epoch. The Error names the line in the scene.
CATENA_EXPORT Result<std::shared_ptr<const HapticProgram>> build_program(scene::Scene& scene, const DeviceLimits& limits = {});

}  // namespace catena::haptics
