/// How far a ray may leap: for every brick of a grid, x fastest, the largest coordinate difference, in bricks and at most 255, to the
/// nearest brick of another kind. 0: a brick that is never leapt over. Outside the grid nothing is of another kind.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace catena::render {

/// `kind`: 0 varies; equal numbers are alike.
std::vector<std::uint8_t> plain_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint16_t>& kind);

/// Two kinds: active ones, which are never leapt over, and the others.
std::vector<std::uint8_t> brick_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active);

}  // namespace catena::render
