/// Private to this room and to engine/vdb: from valid voxels to valid cells.
///   bit at ijk: the voxels ijk + (0 or 1, 0 or 1, 0 or 1) are all valid and within the box of the grid that is masked
/// Along an axis of one layer a cell has no thickness. Work and memory grow with the surface of large tiles, not with what they hold.
#pragma once
#include "engine/field/nano_stats.h"

namespace catena::field {

/// Memory comes from `allocate`, in one piece of the exact size; before, `ask` is told the bytes and may refuse.
Result<NanoMemory> erode(const NanoMask& valid, const ActiveBox& box, const NanoAllocator& allocate,
                         const std::function<Outcome(double bytes)>& ask);

}  // namespace catena::field
