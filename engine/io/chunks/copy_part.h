// SPDX-License-Identifier: MIT
/// Copies the part of a decoded chunk that lies in a box of voxels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {

/// A decoded chunk, or a part of one. Strides of 0 give every voxel the same value.
struct ChunkView {
  const std::byte* first = nullptr;      ///< The voxel at box.lo.
  std::ptrdiff_t stride[3] = {0, 0, 0};  ///< Bytes from one voxel to the next along x, y, z.
  field::StoreBox box;                   ///< Voxels of the level that the chunk contains.
};

/// Copies the voxels of `chunk` in `box` to `values`, the voxels of the box, x fastest. `bytes`: of a number, 1, 2, 4 or 8.
void copy_part(const ChunkView& chunk, const field::StoreBox& box, std::size_t bytes, std::span<std::byte> values);

/// Reverses the bytes of each number.
void swap_bytes(std::span<std::byte> values, std::size_t bytes);

}  // namespace catena::chunks
