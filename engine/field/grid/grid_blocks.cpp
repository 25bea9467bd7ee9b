// SPDX-License-Identifier: MIT
// Reads the values and the validity of boxes of voxels, by the tree's blocks of 8^3.
#include <cmath>
#include <vector>

#include "engine/field/derived/halo.h"
#include "engine/field/grid/grid.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

/// Calls visit(index in the region, value) for every halo sample of the region.
template <class Grid, class Visit>
void for_ghosts(const Grid& ghosts, const Index3& origin, const Index3& size, const Visit& visit) {
  for_blocks(ghosts, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    if (leaf == nullptr) return;
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y)
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const auto n = static_cast<std::uint32_t>((x & 7) * 64 + (y & 7) * 8 + (z & 7));
          if (!leaf->valueMask().isOn(n)) continue;
          visit((static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x + (x - origin.x), leaf->getValue(n));
        }
  });
}

}  // namespace

void ScalarGrid::read_block(const Index3& origin, const Index3& size, std::span<float> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const float* values = leaf ? leaf->data()->mValues : nullptr;
    const float constant = leaf ? 0.f : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = out.data() + (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x)
          row[x - origin.x] = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
      }
  });
  if (halo_) for_ghosts(*halo_->grid, origin, size, [&](std::size_t at, float ghost) { out[at] = ghost; });
}

/// Works block by block: first marks the finite corners, then the cells whose corners are all finite and that the masks declare valid.
void ScalarGrid::read_cell_validity(const Index3& origin, const Index3& size, std::span<std::uint8_t> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  const Storage& s = *storage_;
  const auto in = [](const Index3& n, const Index3& from, std::int32_t x, std::int32_t y, std::int32_t z) {
    return (static_cast<std::size_t>(z - from.z) * n.y + static_cast<std::size_t>(y - from.y)) * n.x + static_cast<std::size_t>(x - from.x);
  };
  const Index3 corners{size.x + s.step.x, size.y + s.step.y, size.z + s.step.z};
  std::vector<std::uint8_t> finite(s.has_invalid_cells ? static_cast<std::size_t>(corners.x) * corners.y * corners.z : 0, 1);
  if (s.has_invalid_cells)
    for_blocks(*s.values, origin, corners, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
      const auto* leaf = accessor.probeLeaf(block);
      if (leaf == nullptr && std::isfinite(accessor.getValue(block))) return;
      for (std::int32_t z = first.z; z < after.z; ++z)
        for (std::int32_t y = first.y; y < after.y; ++y)
          for (std::int32_t x = first.x; x < after.x; ++x)
            finite[in(corners, origin, x, y, z)] =
                leaf != nullptr && std::isfinite(leaf->data()->mValues[(x & 7) * 64 + (y & 7) * 8 + (z & 7)]);
    });
  const std::size_t dx = static_cast<std::size_t>(s.step.x), dy = static_cast<std::size_t>(s.step.y) * corners.x,
                    dz = static_cast<std::size_t>(s.step.z) * corners.x * corners.y;
  std::size_t n = 0;
  for (std::int32_t z = origin.z; z < origin.z + size.z; ++z)
    for (std::int32_t y = origin.y; y < origin.y + size.y; ++y)
      for (std::int32_t x = origin.x; x < origin.x + size.x; ++x, ++n) {
        out[n] = s.is_legal_base({x, y, z}) ? 1 : 0;
        if (!s.has_invalid_cells) continue;
        const std::uint8_t* f = &finite[in(corners, origin, x, y, z)];
        out[n] &= f[0] & f[dx] & f[dy] & f[dx + dy] & f[dz] & f[dx + dz] & f[dy + dz] & f[dx + dy + dz];
      }
  if (s.has_invalid_cells && s.valid_cells != nullptr)
    for_blocks(*s.valid_cells, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
      const auto* leaf = accessor.probeLeaf(block);
      const bool constant = leaf == nullptr && accessor.getValue(block);
      if (constant) return;
      for (std::int32_t z = first.z; z < after.z; ++z)
        for (std::int32_t y = first.y; y < after.y; ++y)
          for (std::int32_t x = first.x; x < after.x; ++x)
            if (leaf == nullptr || !leaf->getValue(static_cast<std::uint32_t>((x & 7) * 64 + (y & 7) * 8 + (z & 7))))
              out[in(size, origin, x, y, z)] = 0;
    });
}

bool ScalarGrid::is_constant_block(const Index3& origin, float& value) const {
  const auto accessor = storage_->values->getAccessor();
  if (accessor.probeLeaf(to_nano_coord(origin))) return false;
  value = accessor.getValue(to_nano_coord(origin));
  return true;
}

void VectorGrid::read_block(const Index3& origin, const Index3& size, std::span<float> xyz_out) const {
  CATENA_ASSERT(xyz_out.size() >= 3 * static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const nanovdb::Vec3f* values = leaf ? leaf->data()->mValues : nullptr;
    const nanovdb::Vec3f constant = leaf ? nanovdb::Vec3f(0.f) : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = xyz_out.data() + 3 * (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const nanovdb::Vec3f& v = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
          for (int c = 0; c < 3; ++c) row[3 * (x - origin.x) + c] = v[c];
        }
      }
  });
  if (!halo_) return;
  for_ghosts(*halo_->grid, origin, size, [&](std::size_t at, const nanovdb::Vec3f& ghost) {
    for (int c = 0; c < 3; ++c) xyz_out[3 * at + static_cast<std::size_t>(c)] = ghost[c];
  });
}

}  // namespace catena::field
