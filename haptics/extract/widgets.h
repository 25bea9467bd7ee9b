/// The scene's widgets -> the program's, and links that follow a widget. Off the tick.
#pragma once
#include <functional>

#include "engine/scene/scene.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// An item of the chain with {"widget": NAME} replaced by where that widget is now: "seed" by a seed's place, "level" by an isolevel's
/// value. Others are copied. The error names the line.
Result<json::Node> with_widget_values(scene::Scene& scene, const json::Node& item);

/// Adds all widgets of the scene as they are now (pose, revision), and their links behind the scene's. `links_of`: the indices that a
/// name of the chain stands for, or none.
Outcome add_widgets(scene::Scene& scene, const std::function<const std::vector<int>*(const std::string&)>& links_of, Program& program);

}  // namespace catena::haptics
