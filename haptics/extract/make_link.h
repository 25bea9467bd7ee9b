/// One item of the scene's chain -> one link of the program: its keys, its switch, its indication, its constraint. Off the tick.
#pragma once
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// `coupling` gives the default stiffness, and says whether a baseline needs the link's linear primitive.
Result<Link> make_link(const json::Node& from, const Coupling& coupling, const BuildContext& context);

}  // namespace catena::haptics
