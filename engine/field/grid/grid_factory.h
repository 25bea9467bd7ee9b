/// Private to this room: a grid from its buffers, checked for what a field must hold.
#pragma once
#include <array>
#include <optional>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

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

/// Values; the valid voxels and the valid cells, both empty where there is no mask. CellCache that are missing are made, of the voxels and
/// of `input_cell_mask`, a mask of cells beside that of voxels (empty: there is none).
struct NanoBuffers {
  NanoMemory values, valid_voxels, valid_cells, input_cell_mask;
  bool has_cell_mask = false;           ///< where `cells` are there: a mask of cells is in them
  std::optional<DisplayRange> range{};  ///< of the data that were resampled
};

/// An error (one phrase: "has no active voxels, ...") where no voxel is active, valid or finite, or where indices are too large.
template <class Grid>
Result<std::shared_ptr<const Grid>> grid_from_buffers(std::string name, const Mapping& mapping, NanoBuffers buffers);

/// The grid in a buffer.
template <class T>
const nanovdb::NanoGrid<T>& as_nano_grid(const NanoMemory& memory) {
  return *reinterpret_cast<const nanovdb::NanoGrid<T>*>(memory.data());
}

/// One phrase on indices that are too large.
Error index_range_error(const ActiveBox& box);

}  // namespace catena::field
