// SPDX-License-Identifier: MIT
/// Operations on the values of one brick, kBrickEdge^3 voxels of a number type, x fastest, padded behind its voxels. Any thread.
#pragma once
#include <cstddef>
#include <span>

#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// Voxels of a brick, and of a brick at half the resolution.
inline constexpr std::size_t kBrickVoxels = std::size_t{kBrickEdge} * kBrickEdge * kBrickEdge, kHalvedVoxels = kBrickVoxels / 8;

/// Sets every number to `value`, converted to the number type.
void fill_brick(const NumberType& type, double value, std::span<std::byte> values);
/// Returns whether two bricks have the same bytes.
bool is_same_brick(std::span<const std::byte> a, std::span<const std::byte> b);

/// Computes the first `size` voxels at half the resolution. `out`: (kBrickEdge / 2)^3 voxels; those behind the computed ones are unchanged.
///   value = the mean of the finite ones of 2 x 2 x 2 voxels, of those that exist at odd sizes; NaN where none is finite
///   integers: the mean rounded to the nearest, halves up; labels: the first of the voxels
void halve_brick(const NumberType& type, std::span<const std::byte> brick, const Index3& size, bool is_label_map, std::span<std::byte> out);

/// Copies a box of `size` voxels between two arrays of `from_size` and `to_size` voxels, which hold it at `from` and `to`.
void copy_box(std::size_t voxel_bytes, std::span<const std::byte> in, const Index3& from_size, const Index3& from, std::span<std::byte> out,
              const Index3& to_size, const Index3& to, const Index3& size);

}  // namespace catena::field
