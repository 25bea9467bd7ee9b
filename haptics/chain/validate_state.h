/// A state that comes from a file (a log that begins in mid-run) may hold any bytes, and ticks index with them. This says whether they
/// may: every count, index, bool and enumerator is one that ticks of `program` can leave; what a constraint remembers, the constraint
/// itself looks at (Constraint::is_valid_state). NumberArray are not judged: a tick is safe with any double, and replay compares them.
/// Off the tick. Call it before the first tick of such a state, and again after `rebind`, for the file also says which links keep theirs.
#pragma once
#include "engine/base/result.h"
#include "haptics/chain/tick.h"

namespace catena::haptics {

/// The error names the part, without file or tick: `the state of link "surface" ...`.
Outcome validate_state(const HapticProgram& program, const ChainState& state);

}  // namespace catena::haptics
