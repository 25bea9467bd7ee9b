/// Private to this room: a NanoVDB buffer that somebody else wrote is looked at as hostile before it is used. Every byte that a fetch or
/// a walk over the nodes would follow is compared with what NanoBuilder would have written there; values may be any.
///   sizes and counts fit the buffer to the byte; the nodes' arrays lie where they must; each child is the next of its array and lies
///   where its parent's entry does; root entries are aligned, near, and each there once; a mask's tiles are 0 or 1 as their states
#pragma once
#include <cstddef>
#include <span>

#include "engine/base/result.h"

namespace catena::field {

/// An error is a phrase. T: float, nanovdb::Vec3f or nanovdb::ValueMask. The bytes are aligned to 32.
template <class T>
Outcome check_nano(std::span<const std::byte> bytes);

}  // namespace catena::field
