// SPDX-License-Identifier: MIT
#include "engine/field/grid/dense.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "engine/field/grid/grid_factory.h"

namespace catena::field {
namespace {

int blocks_of(int voxels) { return voxels / kLeafEdge + (voxels % kLeafEdge != 0 ? 1 : 0); }

double voxels_of(const Index3& size) { return static_cast<double>(size.x) * size.y * size.z; }

/// Grid under construction: leaves and tiles are appended in the order of the slabs.
template <class T>
struct Growing {
  NanoMemory memory;
  std::uint64_t leaves = 0;
  std::vector<NanoBlock<T>> blocks;

  /// Appends a block with a leaf and returns the leaf's index; the caller writes the leaf.
  std::uint32_t add_leaf(const nanovdb::Coord& origin) {
    NanoBlock<T> block{origin, static_cast<std::uint32_t>(leaves++), {}};
    blocks.push_back(block);
    return block.leaf;
  }
  void add_tile(const nanovdb::Coord& origin, const typename NanoTypes<T>::Value& value) {
    blocks.push_back({origin, NanoBlock<T>::kTile, value});
  }
  typename NanoTypes<T>::Leaf& leaf(std::uint32_t n) { return NanoBuilder<T>::leaf_at(memory.data(), n); }
};

constexpr std::uint32_t kNoLeaf = 0xffffffff;

/// Adds the blocks of one slab to the grid.
template <class T>
void add_values(const DenseSlab<T>& slab, Growing<T>& grid) {
  std::vector<std::uint8_t> constant(slab.block_count());
  std::vector<T> value(slab.block_count());
  parallel_for(slab.block_count(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) constant[b] = slab.is_constant(b, value[b]);
  });
  std::vector<std::uint32_t> leaf(slab.block_count(), kNoLeaf);
  for (std::size_t b = 0; b < slab.block_count(); ++b) {
    if (constant[b])
      grid.add_tile(slab.origin(b), value[b]);
    else
      leaf[b] = grid.add_leaf(slab.origin(b));
  }
  parallel_for(slab.block_count(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (leaf[b] == kNoLeaf) continue;
      auto& data = grid.leaf(leaf[b]);
      data.mBBoxMin = slab.origin(b);
      slab.gather(b, data.mValues, data.mValueMask);
    }
  });
}

/// Adds the mask blocks of one slab; blocks without a set bit are omitted. Returns true if a voxel of the box is invalid.
template <class T>
bool add_bits(const DenseSlab<T>& slab, const Index3& size, void (DenseSlab<T>::*gather)(std::size_t, nanovdb::Mask<3>&) const,
              Growing<nanovdb::ValueMask>& mask) {
  bool some_invalid = false;
  for (std::size_t b = 0; b < slab.block_count(); ++b) {
    nanovdb::Mask<3> valid;
    (slab.*gather)(b, valid);
    const nanovdb::Coord origin = slab.origin(b);
    const auto inside = [&](int axis, int extent) { return static_cast<std::uint32_t>(std::min(kLeafEdge, extent - origin[axis])); };
    const std::uint32_t count = valid.countOn();
    if (count != inside(0, size.x) * inside(1, size.y) * inside(2, size.z)) some_invalid = true;
    if (count == 0) continue;
    if (count == 512) {
      mask.add_tile(origin, true);
      continue;
    }
    auto& data = mask.leaf(mask.add_leaf(origin));
    data.mBBoxMin = origin;
    data.mValueMask = valid;
  }
  return some_invalid;
}

}  // namespace

template <class T>
DenseSlab<T>::DenseSlab(const DenseSource& source)
    : source_(source), blocks_x_(blocks_of(source.size.x)), blocks_y_(blocks_of(source.size.y)) {
  const auto voxels = static_cast<std::size_t>(source.size.x) * source.size.y * std::min(kLeafEdge, source.size.z);
  values_.resize(voxels);
  if (source.has_mask) valid_.resize(voxels);
  if (source.read_cells) cells_.resize(voxels);
}

template <class T>
double DenseSlab<T>::bytes(const Index3& size, bool masked) {
  return static_cast<double>(size.x) * size.y * std::min(kLeafEdge, size.z) * (sizeof(T) + (masked ? 1 : 0));
}

template <class T>
Outcome DenseSlab<T>::read(int z) {
  z_ = z;
  layers_ = std::min(kLeafEdge, source_.size.z - z);
  const std::size_t voxels = static_cast<std::size_t>(source_.size.x) * source_.size.y * layers_;
  constexpr std::size_t components = sizeof(T) / sizeof(float);
  CATENA_CHECK(source_.read(z, layers_, {reinterpret_cast<float*>(values_.data()), voxels * components},
                            {valid_.data(), source_.has_mask ? voxels : 0}));
  return source_.read_cells ? source_.read_cells(z, layers_, {cells_.data(), voxels}) : Outcome(Done{});
}

template <class T>
nanovdb::Coord DenseSlab<T>::origin(std::size_t block) const {
  return {static_cast<int>(block % blocks_x_) * kLeafEdge, static_cast<int>(block / blocks_x_) * kLeafEdge, z_};
}

/// Calls visit(index in the leaf, index in the slab) for the voxels of a block until it returns false.
template <class T>
template <class Visit>
void DenseSlab<T>::for_voxels(std::size_t block, const Visit& visit) const {
  const nanovdb::Coord o = origin(block);
  const int nx = std::min(kLeafEdge, source_.size.x - o[0]), ny = std::min(kLeafEdge, source_.size.y - o[1]);
  for (int z = 0; z < layers_; ++z)
    for (int y = 0; y < ny; ++y) {
      const std::size_t row = (static_cast<std::size_t>(z) * source_.size.y + (o[1] + y)) * source_.size.x + o[0];
      for (int x = 0; x < nx; ++x)
        if (!visit(static_cast<std::uint32_t>(x * 64 + y * 8 + z), row + x)) return;
    }
}

template <class T>
bool DenseSlab<T>::is_constant(std::size_t block, T& value) const {
  const nanovdb::Coord o = origin(block);
  if (source_.size.x - o[0] < kLeafEdge || source_.size.y - o[1] < kLeafEdge || layers_ < kLeafEdge) return false;
  value = values_[static_cast<std::size_t>(o[1]) * source_.size.x + o[0]];
  if (!is_finite_value(value)) return false;
  bool same = true;
  for_voxels(block, [&](std::uint32_t, std::size_t at) {
    same = std::memcmp(&values_[at], &value, sizeof value) == 0;
    return same;
  });
  return same;
}

template <class T>
void DenseSlab<T>::gather(std::size_t block, T* values, nanovdb::Mask<3>& active) const {
  const nanovdb::Coord o = origin(block);
  const bool is_complete = source_.size.x - o[0] >= kLeafEdge && source_.size.y - o[1] >= kLeafEdge && layers_ == kLeafEdge;
  active.set(is_complete);
  for_voxels(block, [&](std::uint32_t n, std::size_t at) {
    values[n] = values_[at];
    if (!is_complete) active.setOn(n);
    return true;
  });
}

template <class T>
void DenseSlab<T>::gather_bits(std::size_t block, const std::vector<std::uint8_t>& bytes, nanovdb::Mask<3>& bits) const {
  bits.setOff();
  for_voxels(block, [&](std::uint32_t n, std::size_t at) {
    if (bytes[at] != 0) bits.setOn(n);
    return true;
  });
}

Outcome check_dense_memory(const std::string& what, const Index3& size, int components, bool masked) {
  const double blocks = static_cast<double>(blocks_of(size.x)) * blocks_of(size.y) * blocks_of(size.z);
  constexpr double kMaxBlocks = 4e9;
  if (blocks > kMaxBlocks)
    return Error{fmt::format("{} needs {:.0f} blocks of 8^3 voxels; a smaller grid, of at most {:.0f} blocks, was expected", what, blocks,
                             kMaxBlocks)};
  const bool vector = components == 3;
  const double leaf = vector ? sizeof(NanoTypes<nanovdb::Vec3f>::Leaf) + sizeof(NanoBlock<nanovdb::Vec3f>)
                             : sizeof(NanoTypes<float>::Leaf) + sizeof(NanoBlock<float>);
  const double mask = masked ? 2 * sizeof(NanoTypes<nanovdb::ValueMask>::Leaf) + sizeof(NanoBlock<nanovdb::ValueMask>) : 0;
  const double slab = vector ? DenseSlab<nanovdb::Vec3f>::bytes(size, masked) : DenseSlab<float>::bytes(size, masked);
  return check_memory_available(what, blocks * (leaf + mask) + slab);
}

template <class Grid>
Result<std::shared_ptr<const Grid>> make_dense_grid(std::string name, const Mapping& mapping, const DenseSource& source,
                                                    const std::string& prefix, bool drop_full_mask) {
  using T = typename GridValue<Grid>::Type;
  const Index3& size = source.size;
  CATENA_ASSERT(size.x > 0 && size.y > 0 && size.z > 0);
  const std::uint64_t blocks = static_cast<std::uint64_t>(blocks_of(size.x)) * blocks_of(size.y) * blocks_of(size.z);
  CATENA_ASSERT(voxels_of(size) > 0 && blocks < kNoLeaf);
  Growing<T> grid{reserve_leaves<T>(blocks), 0, {}};
  Growing<nanovdb::ValueMask> mask, cells;
  CATENA_ASSERT(source.has_mask || !source.read_cells);
  if (source.has_mask) mask.memory = reserve_leaves<nanovdb::ValueMask>(blocks);
  if (source.read_cells) cells.memory = reserve_leaves<nanovdb::ValueMask>(blocks);
  bool some_invalid = !drop_full_mask, some_cell_invalid = false;
  {
    DenseSlab<T> slab(source);
    for (int z = 0; z < size.z; z += kLeafEdge) {
      CATENA_CHECK(slab.read(z));
      add_values(slab, grid);
      if (source.has_mask && add_bits(slab, size, &DenseSlab<T>::gather_valid, mask)) some_invalid = true;
      if (source.read_cells && add_bits(slab, size, &DenseSlab<T>::gather_cells, cells)) some_cell_invalid = true;
    }
  }
  const auto with_prefix = [&](const Error& e) { return Error{prefix + e.message}; };
  NanoBuffers buffers;
  auto values = build_from_blocks<T>(std::move(grid.memory), grid.leaves, std::move(grid.blocks), T(0.f));
  if (!values) return with_prefix(values.error());
  buffers.values = std::move(*values);
  buffers.range = source.range;
  if (some_cell_invalid) {
    auto all = build_from_blocks<nanovdb::ValueMask>(std::move(cells.memory), cells.leaves, std::move(cells.blocks), false);
    if (!all) return with_prefix(all.error());
    buffers.input_cell_mask = std::move(*all);
  }
  if (source.has_mask && (some_invalid || some_cell_invalid)) {
    auto voxels = build_from_blocks<nanovdb::ValueMask>(std::move(mask.memory), mask.leaves, std::move(mask.blocks), false);
    if (!voxels) return with_prefix(voxels.error());
    buffers.valid_voxels = std::move(*voxels);
  }
  auto result = grid_from_buffers<Grid>(std::move(name), mapping, std::move(buffers));
  if (!result) return with_prefix(result.error());
  return result;
}

template class DenseSlab<float>;
template class DenseSlab<nanovdb::Vec3f>;
template Result<std::shared_ptr<const ScalarGrid>> make_dense_grid<ScalarGrid>(std::string, const Mapping&, const DenseSource&,
                                                                               const std::string&, bool);
template Result<std::shared_ptr<const VectorGrid>> make_dense_grid<VectorGrid>(std::string, const Mapping&, const DenseSource&,
                                                                               const std::string&, bool);

}  // namespace catena::field
