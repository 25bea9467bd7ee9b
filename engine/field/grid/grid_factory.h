// SPDX-License-Identifier: MIT
/// Makes a grid from NanoVDB buffers and checks what a field requires. Private to this module.
#pragma once
#include <array>
#include <optional>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

/// Value type that a grid stores.
template <class Grid>
struct GridValue;
template <>
struct GridValue<ScalarGrid> {
  using Type = float;
};
template <>
struct GridValue<VectorGrid> {
  using Type = nanovdb::Vec3f;
};

/// Buffers of a grid: values; valid voxels and valid cells, both empty when there is no mask. Valid cells that are missing are computed
/// from the valid voxels and `input_cell_mask`, an additional mask of cells (empty: there is none).
struct NanoBuffers {
  NanoMemory values, valid_voxels, valid_cells, input_cell_mask;
  bool has_cell_mask = false;           ///< `valid_cells` is given and includes a mask of cells
  std::optional<DisplayRange> range{};  ///< display range of the original data, when the values were resampled
};

/// Makes a grid. Error (a message fragment: "has no active voxels, ..."): no voxel is active, valid or finite, or indices are too large.
template <class Grid>
Result<std::shared_ptr<const Grid>> grid_from_buffers(std::string name, const Mapping& mapping, NanoBuffers buffers);

/// Returns the grid in a buffer.
template <class T>
const nanovdb::NanoGrid<T>& as_nano_grid(const NanoMemory& memory) {
  return *reinterpret_cast<const nanovdb::NanoGrid<T>*>(memory.data());
}

/// Returns an Error (a message fragment) for indices that are too large.
Error index_range_error(const ActiveBox& box);

}  // namespace catena::field
