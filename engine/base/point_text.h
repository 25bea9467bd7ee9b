// SPDX-License-Identifier: MIT
/// Points in the text of an option: "x,y,z", several of them separated by colons.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"

namespace catena {

/// Parses exactly `count` points, at least 1; blanks around a number are allowed. nullopt: another number of points, or a coordinate that
/// is no finite number.
std::optional<std::vector<Vec3>> parse_points(std::string_view text, std::size_t count);

}  // namespace catena
