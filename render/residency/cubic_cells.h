/// The cells of a brick in which a cubic (engine/field/cubic.h) may take a value: those whose control points (the tensor product's
/// Bernstein coefficients, between the least and greatest of which the cubic stays) lie on both sides of it.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "render/residency/resident_grid.h"

namespace catena::render {

inline constexpr int kCubicSamples = kBrickSize + 3;  ///< samples an axis that the cubics of a brick of 8^3 cells ask

/// `samples`: kCubicSamples^3, x fastest, from the one before the brick's first. Eight bits a row of cells, y + 8 z; `slack` widens the
/// value.
std::array<std::uint8_t, kBrickSize * kBrickSize> find_cubic_cells(std::span<const float> samples, float value, float slack);

}  // namespace catena::render
