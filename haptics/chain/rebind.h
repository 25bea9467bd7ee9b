/// A new program takes over: links of the same name and the same recipe (or constraint object) keep their state, all others start anew
/// in the next tick. Widgets: widgets.h. Haptic thread: no allocation.
#pragma once
#include "haptics/chain/tick.h"

namespace catena::haptics {

void rebind(const Program& from, const Program& to, ChainState& state, ChainScratch& scratch) noexcept;

}  // namespace catena::haptics
