// SPDX-License-Identifier: MIT
/// Finds the cells of a brick in which a cubic interpolant (engine/field/cubic.h) may take a value: those whose control points (Bernstein
/// coefficients of the tensor product, whose minimum and maximum bound the cubic) lie on both sides of it.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "render/residency/resident_grid.h"

namespace catena::render {

inline constexpr int kCubicSamples = kBrickSize + 3;  ///< samples per axis that the cubics of a brick of 8^3 cells depend on

/// Returns 8 bits per row of cells, at index y + 8 z. `samples`: kCubicSamples^3, x fastest, from the voxel before the brick's first one
/// on; `slack`: tolerance of the value.
std::array<std::uint8_t, kBrickSize * kBrickSize> find_cubic_cells(std::span<const float> samples, float value, float slack);

}  // namespace catena::render
