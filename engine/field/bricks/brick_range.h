// SPDX-License-Identifier: MIT
/// Range of the values of a brick. Any thread.
#pragma once
#include <cstddef>
#include <span>

#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// Returns the range of the finite values of the first `size` voxels of an array of `stored` voxels, x fastest.
BrickRange find_range(const NumberType& type, std::span<const std::byte> values, const Index3& size, const Index3& stored);

}  // namespace catena::field
