// SPDX-License-Identifier: MIT
/// Queries of a mask by leaves and by aligned regions of 8^3, 128^3 or 4096^3 voxels. The cost grows with the number of nodes in the
/// region. Private to this module.
#pragma once
#include <cstdint>
#include <span>

#include "engine/field/cell.h"
#include "engine/field/nanovdb/nano_builder.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

/// View of a mask. The mask must outlive it; use one view per thread.
class MaskView {
 public:
  explicit MaskView(const NanoMask& mask) : accessor_(mask), root_(mask.tree().root()) {}

  /// Returns the 64 voxels of slice x (0 to 7) of the block at `origin`, in the bit order of a leaf's mask.
  std::uint64_t word(const nanovdb::Coord& origin, int x) const {
    if (const auto* leaf = accessor_.probeLeaf(origin)) return leaf->valueMask().getWord<std::uint64_t>(x);
    return accessor_.getValue(origin) ? ~std::uint64_t{0} : 0;
  }
  /// Returns true when some voxel of the region is set. `edge`: 8, kLowerEdge or kUpperEdge.
  bool any(const nanovdb::Coord& origin, std::int32_t edge) const { return find<true>(origin, edge); }
  /// Returns the number of voxels of the region that are set.
  std::uint64_t count(const nanovdb::Coord& origin, std::int32_t edge) const {
    const auto* entry = root_.probeTile(origin);
    if (entry == nullptr) return 0;
    if (entry->isValue()) return entry->value ? cube(edge) : 0;
    const auto& upper = *reinterpret_cast<const Upper*>(root_.data()->getChild(entry));
    const std::uint32_t own = upper_entry(origin);
    if (edge == kLowerEdge) return count_in_upper(upper, own);
    if (edge != kUpperEdge) {
      if (!upper.mChildMask.isOn(own)) return upper.mTable[own].value ? cube(edge) : 0;
      return count_in_lower(*reinterpret_cast<const Lower*>(upper.getChild(own)), lower_entry(origin));
    }
    std::uint64_t all = 0;
    for (std::uint32_t n = 0; n < kUpperEntries; ++n) all += count_in_upper(upper, n);
    return all;
  }
  /// Returns true when every voxel of the region is set.
  bool all(const nanovdb::Coord& origin, std::int32_t edge) const { return !find<false>(origin, edge); }

 private:
  using Upper = NanoTypes<nanovdb::ValueMask>::Upper;
  using Lower = NanoTypes<nanovdb::ValueMask>::Lower;
  using Leaf = NanoTypes<nanovdb::ValueMask>::Leaf;

  static std::uint64_t cube(std::int64_t edge) { return static_cast<std::uint64_t>(edge * edge * edge); }
  static std::uint64_t count_in_upper(const Upper& upper, std::uint32_t n) {
    if (!upper.mChildMask.isOn(n)) return upper.mTable[n].value ? cube(kLowerEdge) : 0;
    const auto& lower = *reinterpret_cast<const Lower*>(upper.getChild(n));
    std::uint64_t all = 0;
    for (std::uint32_t m = 0; m < kLowerEntries; ++m) all += count_in_lower(lower, m);
    return all;
  }
  static std::uint64_t count_in_lower(const Lower& lower, std::uint32_t n) {
    if (!lower.mChildMask.isOn(n)) return lower.mTable[n].value ? cube(8) : 0;
    return reinterpret_cast<const Leaf*>(lower.getChild(n))->mValueMask.countOn();
  }

  template <bool kOn>
  bool find(const nanovdb::Coord& origin, std::int32_t edge) const {
    const auto* entry = root_.probeTile(origin);
    if (entry == nullptr) return !kOn;
    if (entry->isValue()) return entry->value == kOn;
    const auto& upper = *reinterpret_cast<const Upper*>(root_.data()->getChild(entry));
    if (edge == kLowerEdge) return in_upper<kOn>(upper, upper_entry(origin));
    if (edge == kUpperEdge) {
      for (std::uint32_t n = 0; n < kUpperEntries; ++n)
        if (in_upper<kOn>(upper, n)) return true;
      return false;
    }
    const std::uint32_t n = upper_entry(origin);
    if (!upper.mChildMask.isOn(n)) return upper.mTable[n].value == kOn;
    return in_lower<kOn>(*reinterpret_cast<const Lower*>(upper.getChild(n)), lower_entry(origin));
  }
  template <bool kOn>
  static bool in_upper(const Upper& upper, std::uint32_t n) {
    if (!upper.mChildMask.isOn(n)) return upper.mTable[n].value == kOn;
    const auto& lower = *reinterpret_cast<const Lower*>(upper.getChild(n));
    for (std::uint32_t m = 0; m < kLowerEntries; ++m)
      if (in_lower<kOn>(lower, m)) return true;
    return false;
  }
  template <bool kOn>
  static bool in_lower(const Lower& lower, std::uint32_t n) {
    if (!lower.mChildMask.isOn(n)) return lower.mTable[n].value == kOn;
    const auto& mask = reinterpret_cast<const Leaf*>(lower.getChild(n))->mValueMask;
    return kOn ? !mask.isOff() : !mask.isOn();
  }

  nanovdb::ReadAccessor<nanovdb::ValueMask, 0, 1, 2> accessor_;
  const nanovdb::NanoRoot<nanovdb::ValueMask>& root_;
};

/// Nodes of a buffer made by NanoBuilder, as arrays. Private to this module and to engine/io/vdb.
template <class T>
struct NanoNodes {
  std::span<const typename NanoTypes<T>::Leaf> leaves;
  std::span<const typename NanoTypes<T>::Lower> lowers;
  std::span<const typename NanoTypes<T>::Upper> uppers;
  std::span<const typename NanoTypes<T>::Entry> entries;
};

/// Returns the nodes of a grid. The grid must outlive them.
template <class T>
NanoNodes<T> view_nodes(const nanovdb::NanoGrid<T>& grid) {
  const auto& tree = *grid.tree().data();
  const auto array = [&]<class Node>(const Node*, int level) {
    const auto* first = reinterpret_cast<const Node*>(reinterpret_cast<const std::byte*>(&tree) + tree.mNodeOffset[level]);
    return std::span<const Node>(first, tree.mNodeCount[level]);
  };
  using Types = NanoTypes<T>;
  const auto& root = *reinterpret_cast<const typename Types::Root*>(reinterpret_cast<const std::byte*>(&tree) + tree.mNodeOffset[3]);
  return {array(static_cast<const typename Types::Leaf*>(nullptr), 0), array(static_cast<const typename Types::Lower*>(nullptr), 1),
          array(static_cast<const typename Types::Upper*>(nullptr), 2),
          std::span<const typename Types::Entry>(reinterpret_cast<const typename Types::Entry*>(&root + 1), root.mTableSize)};
}

/// Returns the first voxel of an entry of a lower (upper) node at `origin`.
inline nanovdb::Coord lower_coord(const nanovdb::Coord& origin, std::uint32_t entry) {
  return origin.offsetBy(static_cast<std::int32_t>(entry >> 8) * kLeafEdge, static_cast<std::int32_t>(entry >> 4 & 15) * kLeafEdge,
                         static_cast<std::int32_t>(entry & 15) * kLeafEdge);
}
inline nanovdb::Coord upper_coord(const nanovdb::Coord& origin, std::uint32_t entry) {
  return origin.offsetBy(static_cast<std::int32_t>(entry >> 10) * kLowerEdge, static_cast<std::int32_t>(entry >> 5 & 31) * kLowerEdge,
                         static_cast<std::int32_t>(entry & 31) * kLowerEdge);
}

/// Calls visit(origin, edge, value) for every active tile of an internal node.
template <class Node, class Visit>
void for_active_tiles(const Node& node, const Visit& visit) {
  constexpr bool lower = sizeof(node.mTable) == kLowerEntries * sizeof(node.mTable[0]);
  for (auto it = node.mValueMask.beginOn(); it; ++it) {
    if (node.mChildMask.isOn(*it)) continue;
    const nanovdb::Coord origin = lower ? lower_coord(node.mBBox[0], *it) : upper_coord(node.mBBox[0], *it);
    visit(origin, lower ? kLeafEdge : kLowerEdge, node.mTable[*it].value);
  }
}

}  // namespace catena::field
