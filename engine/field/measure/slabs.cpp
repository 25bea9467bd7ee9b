// SPDX-License-Identifier: MIT
#include "engine/field/measure/slabs.h"

#include <cmath>
#include <limits>
#include <optional>

#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {

void read_counted(const ScalarGrid& grid, const Index3& origin, const Index3& size, std::span<const float> values,
                  std::span<std::uint8_t> counted) {
  const ScalarGrid::Storage& storage = grid.storage();
  std::optional<MaskView> valid;
  if (storage.valid_voxels) valid.emplace(*storage.valid_voxels);
  for_blocks(*storage.values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const std::uint64_t tile = leaf == nullptr && accessor.isActive(block) ? ~std::uint64_t{0} : 0;
    std::uint64_t words[8];
    for (int x = 0; x < 8; ++x) {
      words[x] = leaf ? leaf->valueMask().template getWord<std::uint64_t>(x) : tile;
      if (valid) words[x] &= valid->word(block, x);
    }
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        const std::size_t row = (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const std::size_t at = row + static_cast<std::size_t>(x - origin.x);
          counted[at] = (words[x & 7] >> (8 * (y & 7) + (z & 7)) & 1) != 0 && std::isfinite(values[at]) ? 1 : 0;
        }
      }
  });
}

VoxelSlab SlabReader::read(int z, int layers) const {
  VoxelSlab slab{{box_.lo.x, box_.lo.y, box_.lo.z + z}, {box_.size.x, box_.size.y, layers}, {}, {}, {}};
  const std::size_t count = static_cast<std::size_t>(slab.size.x) * slab.size.y * layers;
  slab.voxels.resize(count);
  slab.counted.resize(count);
  grid_.read_block(slab.origin, slab.size, slab.voxels);
  read_counted(grid_, slab.origin, slab.size, slab.voxels, slab.counted);
  if (values_ == nullptr) return slab;
  slab.values.assign(count, std::numeric_limits<double>::quiet_NaN());
  if (same_) {
    std::vector<float> values(count);
    std::vector<std::uint8_t> valid(count);
    values_->grid()->read_block(slab.origin, slab.size, values);
    read_counted(*values_->grid(), slab.origin, slab.size, values, valid);
    for (std::size_t i = 0; i < count; ++i)
      if (valid[i] != 0) slab.values[i] = values[i];
    return slab;
  }
  Cursor cursor;
  std::size_t at = 0;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < slab.size.y; ++j)
      for (int i = 0; i < slab.size.x; ++i, ++at) {
        if (slab.counted[at] == 0) continue;
        const Vec3 index(slab.origin.x + i, slab.origin.y + j, slab.origin.z + k);
        const ScalarSample sample = values_->sample(grid_.mapping().world_from_index(index), cursor);
        if (sample.inside && std::isfinite(sample.value)) slab.values[at] = sample.value;
      }
  return slab;
}

}  // namespace catena::field
