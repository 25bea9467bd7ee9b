// SPDX-License-Identifier: MIT
// Creates grids from buffers and from values in memory (constant blocks become tiles: the background of an image costs no memory).
#include "engine/field/grid/grid_factory.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/result.h"
#include "engine/field/grid/dense.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {
namespace {

Index3 index3(const nanovdb::Coord& c) { return {c[0], c[1], c[2]}; }
Vec3 vec3(const nanovdb::Coord& c) { return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])}; }

/// Returns a DenseSource that reads from arrays in memory.
DenseSource layers_of(const Index3& size, std::span<const float> values, std::span<const std::uint8_t> valid,
                      std::span<const std::uint8_t> cells) {
  CATENA_ASSERT(cells.empty() || (!valid.empty() && cells.size() == valid.size()));
  const std::size_t layer = static_cast<std::size_t>(size.x) * size.y;
  const auto copy = [layer]<class V>(std::span<const V> from, std::size_t components, int z, std::span<V> to) {
    std::copy_n(from.data() + static_cast<std::size_t>(z) * layer * components, to.size(), to.data());
  };
  const std::size_t components = values.size() / (layer * static_cast<std::size_t>(size.z));
  DenseSource source;
  source.size = size;
  source.has_mask = !valid.empty();
  source.read = [=](int z, int, std::span<float> values_out, std::span<std::uint8_t> valid_out) -> Outcome {
    copy(values, components, z, values_out);
    copy(valid, 1, z, valid_out);
    return Done{};
  };
  if (!cells.empty())
    source.read_cells = [=](int z, int, std::span<std::uint8_t> out) -> Outcome {
      copy(cells, 1, z, out);
      return Done{};
    };
  return source;
}

std::size_t voxel_count(const Index3& size) { return static_cast<std::size_t>(size.x) * size.y * size.z; }

}  // namespace

Error index_range_error(const ActiveBox& box) {
  return Error{fmt::format("has voxels from index ({}, {}, {}) to ({}, {}, {}), expected indices within +-{}", box.lo[0], box.lo[1],
                           box.lo[2], box.hi[0], box.hi[1], box.hi[2], kMaxAbsIndex)};
}

template <class Grid>
Result<std::shared_ptr<const Grid>> grid_from_buffers(std::string name, const Mapping& mapping, NanoBuffers buffers) {
  using T = typename GridValue<Grid>::Type;
  // validation and statistics of the buffers
  const auto& values = as_nano_grid<T>(buffers.values);
  const NanoMask* valid = buffers.valid_voxels.size() > 0 ? &as_nano_grid<nanovdb::ValueMask>(buffers.valid_voxels) : nullptr;
  const ActiveBox box = compute_active_box(values);
  if (box.empty()) return Error{"has no active voxels, expected a grid with data"};
  if (!is_within_index_limits(box)) return index_range_error(box);
  const auto [stats, ranged] = compute_stats(values, valid);
  if (!ranged && valid) return Error{"has no valid voxel with a finite value: the mask excludes all finite values"};
  if (!ranged) return Error{"has no finite value in any active voxel"};
  // storage
  auto storage = std::make_unique<typename Grid::Storage>();
  storage->set_box(index3(box.lo), index3(box.hi));
  storage->values = &values;
  if (valid) {
    if (buffers.valid_cells.size() == 0) {
      const bool has_input_mask = buffers.input_cell_mask.size() > 0;
      const NanoMask* own_cells = has_input_mask ? &as_nano_grid<nanovdb::ValueMask>(buffers.input_cell_mask) : nullptr;
      CATENA_TRY(buffers.valid_cells, erode_mask(*valid, box, own_cells, &NanoMemory::reserve,
                                                 [](double bytes) { return check_memory_available("the mask", bytes); }));
      buffers.has_cell_mask = has_input_mask;
    }
    storage->has_cell_mask = buffers.has_cell_mask;
    storage->valid_voxels = valid;
    storage->valid_cells = &as_nano_grid<nanovdb::ValueMask>(buffers.valid_cells);
  }
  storage->data_range = buffers.range;
  storage->values_memory = std::move(buffers.values);
  storage->voxels_memory = std::move(buffers.valid_voxels);
  storage->cells_memory = std::move(buffers.valid_cells);
  storage->has_invalid_cells = valid || stats.nan_count > 0 || !is_finite_value(values.tree().background());
  return std::shared_ptr<const Grid>(
      std::make_shared<Grid>(std::move(name), mapping, Box{vec3(box.lo), vec3(box.hi)}, std::move(storage), stats));
}

template Result<std::shared_ptr<const ScalarGrid>> grid_from_buffers<ScalarGrid>(std::string, const Mapping&, NanoBuffers);
template Result<std::shared_ptr<const VectorGrid>> grid_from_buffers<VectorGrid>(std::string, const Mapping&, NanoBuffers);

std::shared_ptr<const ScalarGrid> make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                   std::span<const float> values, std::span<const std::uint8_t> valid,
                                                   std::span<const std::uint8_t> cells) {
  CATENA_ASSERT(size.x > 0 && size.y > 0 && size.z > 0 && values.size() == voxel_count(size));
  CATENA_ASSERT(valid.empty() || valid.size() == voxel_count(size));
  return make_dense_grid<ScalarGrid>(std::move(name), mapping, layers_of(size, values, valid, cells), {}).value();
}

std::shared_ptr<const VectorGrid> make_vector_grid(std::string name, const Mapping& mapping, const Index3& size, std::span<const float> xyz,
                                                   std::span<const std::uint8_t> valid, std::span<const std::uint8_t> cells) {
  CATENA_ASSERT(size.x > 0 && size.y > 0 && size.z > 0 && xyz.size() == 3 * voxel_count(size));
  CATENA_ASSERT(valid.empty() || valid.size() == voxel_count(size));
  return make_dense_grid<VectorGrid>(std::move(name), mapping, layers_of(size, xyz, valid, cells), {}).value();
}

}  // namespace catena::field
