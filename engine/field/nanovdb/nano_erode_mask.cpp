// SPDX-License-Identifier: MIT
#include "engine/field/nanovdb/nano_statistics.h"

#include <array>
#include <bit>

#include "engine/base/threads.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {
namespace {

using nanovdb::Coord;
using Mask = nanovdb::ValueMask;
enum class Fill : std::uint8_t { none, some, all };

/// Mask clipped to the box, queried by voxels, by blocks and by regions of 128^3.
class Clipped {
 public:
  Clipped(const NanoMask& mask, const ActiveBox& box) : accessor_(mask), root_(mask.tree().root()), box_(box) {}

  Fill region(const Coord& origin) const {
    const Fill inside = in_box(origin, kLowerEdge);
    if (inside == Fill::none) return Fill::none;
    const auto* tile = root_.probeTile(origin);
    if (tile == nullptr) return Fill::none;
    bool value = tile->value;
    if (tile->isChild()) {
      const auto& upper = *reinterpret_cast<const NanoTypes<Mask>::Upper*>(root_.data()->getChild(tile));
      const std::uint32_t n = upper_entry(origin);
      if (upper.mChildMask.isOn(n)) return Fill::some;
      value = upper.mTable[n].value;
    }
    return value ? inside : Fill::none;
  }

  Fill block(const Coord& origin) const {
    const Fill inside = in_box(origin, kLeafEdge);
    if (inside == Fill::none) return Fill::none;
    if (const auto* leaf = accessor_.probeLeaf(origin)) {
      if (leaf->valueMask().isOff()) return Fill::none;
      return leaf->valueMask().isOn() ? inside : Fill::some;
    }
    return accessor_.getValue(origin) ? inside : Fill::none;
  }

  bool voxel(const Coord& c) const {
    for (int a = 0; a < 3; ++a)
      if (c[a] < box_.lo[a] || c[a] > box_.hi[a]) return false;
    return accessor_.getValue(c);
  }

 private:
  Fill in_box(const Coord& origin, std::int32_t edge) const {
    Fill fill = Fill::all;
    for (int a = 0; a < 3; ++a) {
      const std::int64_t first = origin[a], last = first + edge - 1;
      if (last < box_.lo[a] || first > box_.hi[a]) return Fill::none;
      if (first < box_.lo[a] || last > box_.hi[a]) fill = Fill::some;
    }
    return fill;
  }

  nanovdb::ReadAccessor<Mask, 0, 1, 2> accessor_;
  const nanovdb::NanoRoot<Mask>& root_;
  ActiveBox box_;
};

/// Result for a region of 128^3: one tile, or a node with its blocks.
struct Region {
  Coord origin;
  Fill fill = Fill::some;
  std::array<std::uint64_t, 64> full{}, partial{};  ///< one bit for each block
  std::uint64_t leaves = 0;
};

class Eroder {
 public:
  Eroder(const NanoMask& valid, const ActiveBox& box, const NanoMask* cells) : valid_(valid), cells_(cells), box_(box) {
    for (int a = 0; a < 3; ++a) step_[a] = box.voxels(a) > 1 ? 1 : 0;
  }

  /// Returns the origins of all regions in which a voxel may be valid, in the order of the nodes.
  std::vector<Coord> candidates() const {
    const Clipped mask(valid_, box_);
    std::vector<Coord> found;
    for (const auto& entry : view_nodes(valid_).entries) {
      if (!entry.isChild() && !entry.value) continue;
      const Coord origin = entry.origin();
      for (std::uint32_t n = 0; n < kUpperEntries; ++n)
        if (const Coord region = upper_coord(origin, n); mask.region(region) != Fill::none) found.push_back(region);
    }
    return found;
  }

  void look_at(Region& region) const {
    const Clipped mask(valid_, box_), cells(cells_ != nullptr ? *cells_ : valid_, box_);
    const Fill cell_fill = cells_ != nullptr ? cells.region(region.origin) : Fill::all;
    if (cell_fill == Fill::none) return;
    if (cell_fill == Fill::all && surrounded(region.origin, kLowerEdge, [&](const Coord& c) { return mask.region(c); })) {
      region.fill = Fill::all;
      return;
    }
    const auto state = [&](const Coord& c) { return mask.block(c); };
    for (std::uint32_t n = 0; n < kLowerEntries; ++n) {
      const Coord block = lower_coord(region.origin, n);
      const Fill fill = mask.block(block);
      const Fill block_fill = cells_ != nullptr ? cells.block(block) : Fill::all;
      if (fill == Fill::none || block_fill == Fill::none) continue;
      const std::uint64_t bit = std::uint64_t{1} << (n & 63);
      if (fill == Fill::all && block_fill == Fill::all && surrounded(block, kLeafEdge, state)) {
        region.full[n >> 6] |= bit;
      } else {
        region.partial[n >> 6] |= bit;
        ++region.leaves;
      }
    }
  }

  void fill(const Coord& origin, NanoTypes<Mask>::Leaf& leaf) const {
    const Clipped mask(valid_, box_), cells(cells_ != nullptr ? *cells_ : valid_, box_);
    // the voxels of the block and one more layer toward higher indices: a cell needs its eight corners
    bool window[9][9][9];
    for (int x = 0; x < 9; ++x)
      for (int y = 0; y < 9; ++y)
        for (int z = 0; z < 9; ++z) window[x][y][z] = mask.voxel(origin.offsetBy(x, y, z));
    leaf.mBBoxMin = origin;
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y)
        for (int z = 0; z < 8; ++z) {
          bool all = cells_ == nullptr || cells.voxel(origin.offsetBy(x, y, z));
          for (int c = 0; c < 8; ++c) all = all && window[x + (c & 1) * step_[0]][y + (c >> 1 & 1) * step_[1]][z + (c >> 2) * step_[2]];
          if (all) leaf.mValueMask.setOn(static_cast<std::uint32_t>(x * 64 + y * 8 + z));
        }
  }

 private:
  /// Returns true if a block or region and its seven neighbors toward higher indices are completely valid.
  template <class State>
  bool surrounded(const Coord& origin, std::int32_t edge, const State& state) const {
    for (int c = 0; c < 8; ++c)
      if (state(origin.offsetBy((c & 1) * step_[0] * edge, (c >> 1 & 1) * step_[1] * edge, (c >> 2) * step_[2] * edge)) != Fill::all)
        return false;
    return true;
  }

  const NanoMask& valid_;
  const NanoMask* cells_;  ///< null: no cell mask
  ActiveBox box_;
  std::array<std::int32_t, 3> step_{};
};

/// Calls visit(index of the block) for every set bit.
template <class Visit>
void for_bits(const std::array<std::uint64_t, 64>& bits, const Visit& visit) {
  for (std::uint32_t w = 0; w < 64; ++w)
    for (std::uint64_t remaining = bits[w]; remaining != 0; remaining &= remaining - 1)
      visit(64 * w + static_cast<std::uint32_t>(std::countr_zero(remaining)));
}

}  // namespace

Result<NanoMemory> erode_mask(const NanoMask& valid, const ActiveBox& box, const NanoMask* cells, const NanoAllocator& allocate,
                              const std::function<Outcome(double bytes)>& check_memory) {
  const Eroder eroder(valid, box, cells);
  // classify each region
  const std::vector<Coord> origins = eroder.candidates();
  CATENA_CHECK(check_memory(static_cast<double>(origins.size()) * sizeof(Region)));
  std::vector<Region> regions(origins.size());
  parallel_for(regions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      regions[n].origin = origins[n];
      eroder.look_at(regions[n]);
    }
  });
  // count the nodes and check the memory budget
  const auto upper_of = [](const Coord& c) { return Coord(c[0] & ~(kUpperEdge - 1), c[1] & ~(kUpperEdge - 1), c[2] & ~(kUpperEdge - 1)); };
  NanoCounts counts;
  std::vector<std::uint64_t> first_leaf(regions.size());
  for (std::size_t n = 0; n < regions.size(); ++n) {
    first_leaf[n] = counts.leaves;
    counts.leaves += regions[n].leaves;
    counts.lowers += regions[n].fill == Fill::all ? 0 : 1;
    if (n == 0 || upper_of(regions[n].origin) != upper_of(regions[n - 1].origin)) ++counts.uppers;
  }
  counts.entries = counts.uppers;
  CATENA_CHECK(check_memory(static_cast<double>(NanoBuilder<Mask>::bytes(counts))));
  NanoMemory memory = allocate(NanoBuilder<Mask>::bytes(counts));
  // write the nodes
  NanoBuilder<Mask> build(memory.data(), counts, false);
  std::uint64_t lowers = 0, uppers = 0;
  NanoTypes<Mask>::Upper* upper = nullptr;
  for (std::size_t n = 0; n < regions.size(); ++n) {
    const Region& region = regions[n];
    if (n == 0 || upper_of(region.origin) != upper_of(regions[n - 1].origin)) {
      build.set_root_child(uppers, upper_of(region.origin), uppers);
      upper = &build.begin_upper(uppers++, upper_of(region.origin));
    }
    if (region.fill == Fill::all) {
      build.set_tile(*upper, upper_entry(region.origin), true, true);
      continue;
    }
    auto& lower = build.begin_lower(lowers++, region.origin);
    build.set_child(*upper, upper_entry(region.origin), lower);
    for_bits(region.full, [&](std::uint32_t b) { build.set_tile(lower, b, true, true); });
    std::uint64_t leaf = first_leaf[n];
    for_bits(region.partial, [&](std::uint32_t b) { build.set_child(lower, b, build.leaf(leaf++)); });
  }
  parallel_for(regions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::uint64_t leaf = first_leaf[n];
      for_bits(regions[n].partial, [&](std::uint32_t b) { eroder.fill(lower_coord(regions[n].origin, b), build.leaf(leaf++)); });
    }
  });
  return memory;
}

}  // namespace catena::field
