// SPDX-License-Identifier: MIT
/// Check of a state that was read from a file (a log that begins in mid-run). Its bytes may be anything, and ticks use them as indices.
/// Every count, index, bool and enumerator must be one that a tick of `program` can leave; the memory of a constraint is checked by the
/// constraint (Constraint::is_sane). Other numbers are not checked, since a tick is safe with any double and a replay compares them; only
/// last_probe and chain_force_n must be finite. Off the tick.
/// Call it before the first tick that runs from such a state, and after each rebind_program(), since the file also determines which links
/// keep their state.
#pragma once
#include "engine/base/result.h"
#include "haptics/chain/tick.h"

namespace catena::haptics {

/// Returns an Error if the state is invalid for the program. It names the invalid part, without file or tick:
/// `the state of link "surface" ...`.
Outcome validate_state(const HapticProgram& program, const ChainState& state);

}  // namespace catena::haptics
