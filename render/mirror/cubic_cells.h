/// The cells of a brick in which a cubic (engine/field/cubic.h) may take a value: those whose control points (the tensor product's
/// Bernstein coefficients, between the least and greatest of which the cubic stays) lie on both sides of it.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "render/mirror/grid_mirror.h"

namespace catena::render {

inline constexpr int kCubicReach = kBrick + 3;  ///< samples an axis that the cubics of a brick of 8^3 cells ask

/// `samples`: kCubicReach^3, x fastest, from the one before the brick's first. Eight bits a row of cells, y + 8 z; `slack` widens the
/// value.
std::array<std::uint8_t, kBrick * kBrick> cubic_cells_with(std::span<const float> samples, float value, float slack);

}  // namespace catena::render
