/// What every link may say beside its constraint: its switch ("on"), the cue when it is left ("indicate"), the tool's axis ("align"). The
/// structs and their models are in haptics/chain/program.h.
#pragma once
#include "engine/schema/key.h"
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

schema::Key switch_key();
schema::Key indication_key();
schema::Key align_key();

/// The "on" of a link or a mode; without it, always on.
Result<Switch> read_switch(const json::Node& holder);
Result<Indication> read_indication(const json::Node& link);
/// The constraint is asked for an axis: a point has none, and friction and forces have no primitive at all.
Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint);

}  // namespace catena::haptics
