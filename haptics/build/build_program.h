/// One item of the scene's chain -> one link of the program: its keys, its switch, its indication, its constraint. Off the tick.
#pragma once
#include <functional>
#include <memory>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// `coupling` gives the default stiffness, and says whether a baseline needs the link's linear primitive.
Result<Link> build_link(const json::Node& from, const Coupling& coupling, const BuildContext& context);

/// The scene's widgets -> the program's, and links that follow a widget. Off the tick.

/// An item of the chain with {"widget": NAME} replaced by where that widget is now: "seed" by a seed's place, "level" by an isolevel's
/// value. Others are copied. The error names the line.
Result<json::Node> resolve_widget_values(scene::Scene& scene, const json::Node& item);

/// Adds all widgets of the scene as they are now (pose, revision), and their links behind the scene's. `links_of`: the indices that a
/// name of the chain stands for, or none.
Outcome add_widgets(scene::Scene& scene, const std::function<const std::vector<int>*(const std::string&)>& links_of,
                    HapticProgram& program);

/// The door from the scene to the hand: links of the scene -> a program for the tick. Off the tick.

/// Builds the program of all link entities in order, loading only the fields that they name. `limits`: what the device allows.
Result<std::shared_ptr<const HapticProgram>> build_program(scene::Scene& scene, const DeviceLimits& limits = {});

}  // namespace catena::haptics
