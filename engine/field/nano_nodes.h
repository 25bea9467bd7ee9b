/// Private to this room and to engine/vdb: the nodes of a buffer made by NanoBuilder, as arrays.
#pragma once
#include <cstdint>
#include <span>

#include "engine/field/cell.h"
#include "engine/field/nano_build.h"

namespace catena::field {

template <class T>
struct NanoNodes {
  std::span<const typename NanoTypes<T>::Leaf> leaves;
  std::span<const typename NanoTypes<T>::Lower> lowers;
  std::span<const typename NanoTypes<T>::Upper> uppers;
  std::span<const typename NanoTypes<T>::Entry> entries;
};

template <class T>
NanoNodes<T> nodes_of(const nanovdb::NanoGrid<T>& grid) {
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

/// The voxel at an entry of an internal node.
inline nanovdb::Coord lower_coord(const nanovdb::Coord& origin, std::uint32_t entry) {
  return origin.offsetBy(static_cast<std::int32_t>(entry >> 8) * kLeafEdge, static_cast<std::int32_t>(entry >> 4 & 15) * kLeafEdge,
                         static_cast<std::int32_t>(entry & 15) * kLeafEdge);
}
inline nanovdb::Coord upper_coord(const nanovdb::Coord& origin, std::uint32_t entry) {
  return origin.offsetBy(static_cast<std::int32_t>(entry >> 10) * kLowerEdge, static_cast<std::int32_t>(entry >> 5 & 31) * kLowerEdge,
                         static_cast<std::int32_t>(entry & 31) * kLowerEdge);
}

/// Calls visit(origin, edge, value) for every active tile of one internal node.
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
