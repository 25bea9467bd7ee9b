// SPDX-License-Identifier: MIT
/// Memory of a NanoVDB buffer: anonymous memory, zero when reserved (pages that are never touched take no memory), or a slice of a mapped
/// file, which stays mapped as long as it is used. Aligned to pages, except for slices; copies share the memory. Private to this module and
/// to engine/io/vdb.
#pragma once
#include <nanovdb/NanoVDB.h>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/base/memory_limit.h"

namespace catena::field {

/// Shared, contiguous memory of a buffer; unmapped with its last copy.
class NanoMemory {
 public:
  NanoMemory() = default;
  /// Reserves zeroed memory, counted in the memory budget. Throws std::bad_alloc.
  static NanoMemory reserve(std::size_t bytes);
  /// Takes ownership of a mapping made by mmap. `held`: its bytes count in the memory budget.
  static NanoMemory from_mapping(void* start, std::size_t bytes, bool held);
  /// Returns a part of the memory, which it keeps alive.
  NanoMemory slice(std::size_t offset, std::size_t bytes) const;
  /// Resizes reserved memory that is not shared: memory beyond the new end is freed, new memory is zero. It may move. Throws
  /// std::bad_alloc.
  void resize(std::size_t bytes);

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  struct Region;
  std::shared_ptr<Region> region_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Provides zeroed memory to a builder: heap of this process, or a file that another process will map.
using NanoAllocator = std::function<NanoMemory(std::size_t bytes)>;

/// Builder of NanoVDB buffers in place. A buffer has its exact size from the start; leaves are written at their final position, by any
/// number of threads; the nodes that point to them are added afterwards.
///   layout: grid, tree, leaves, lower nodes, upper nodes, root, its entries; children are in the order of their parents' entries
/// A buffer contains values and states only: its statistics, boxes, map and checksum stay empty. Private to this module and to
/// engine/io/vdb.
///
/// NanoTypes: NanoVDB's node types for the value type T.
template <class T>
struct NanoTypes {
  using Grid = nanovdb::NanoGrid<T>;
  using Leaf = typename nanovdb::NanoLeaf<T>::DataType;
  using Lower = typename nanovdb::NanoLower<T>::DataType;
  using Upper = typename nanovdb::NanoUpper<T>::DataType;
  using Root = typename nanovdb::NanoRoot<T>::DataType;
  using Entry = typename Root::Tile;
  using Value = typename Root::ValueT;
};

/// Edges of nodes in voxels, and numbers of entries of internal nodes.
inline constexpr std::int32_t kLeafEdge = 8, kLowerEdge = 128, kUpperEdge = 4096;
inline constexpr std::uint32_t kLowerEntries = 4096, kUpperEntries = 32768;
/// Maximum number of root entries; a fetch outside of all nodes compares with each of them.
inline constexpr std::uint64_t kMaxRootEntries = 1024;

/// Returns the index of the entry of a lower (upper) node that contains a voxel, z fastest.
inline std::uint32_t lower_entry(const nanovdb::Coord& c) {
  return static_cast<std::uint32_t>((c[0] >> 3 & 15) << 8 | (c[1] >> 3 & 15) << 4 | (c[2] >> 3 & 15));
}
inline std::uint32_t upper_entry(const nanovdb::Coord& c) {
  return static_cast<std::uint32_t>((c[0] >> 7 & 31) << 10 | (c[1] >> 7 & 31) << 5 | (c[2] >> 7 & 31));
}

/// Numbers of nodes in a buffer, and of root entries.
struct NanoCounts {
  std::uint64_t leaves = 0, lowers = 0, uppers = 0, entries = 0;
};

/// Writes the nodes of one buffer.
template <class T>
class NanoBuilder {
 public:
  using Types = NanoTypes<T>;
  /// Returns the byte offset of the first leaf.
  static std::size_t leaves_offset();
  /// Returns the size of a buffer in bytes.
  static std::size_t bytes(const NanoCounts& counts);
  /// Writes the headers. `start`: zeroed memory of bytes(counts) bytes, whose leaves may already be written.
  NanoBuilder(std::byte* start, const NanoCounts& counts, const typename Types::Value& background);

  static typename Types::Leaf& leaf_at(std::byte* start, std::uint64_t n);
  typename Types::Leaf& leaf(std::uint64_t n) { return leaf_at(start_, n); }
  typename Types::Lower& lower(std::uint64_t n) { return reinterpret_cast<typename Types::Lower*>(start_ + lowers_)[n]; }
  typename Types::Upper& upper(std::uint64_t n) { return reinterpret_cast<typename Types::Upper*>(start_ + uppers_)[n]; }
  typename Types::Entry& root_entry(std::uint64_t n);
  /// Initializes a node: its origin, and the background in all its entries.
  typename Types::Lower& begin_lower(std::uint64_t n, const nanovdb::Coord& origin) { return begin(lower(n), origin, kLowerEntries); }
  typename Types::Upper& begin_upper(std::uint64_t n, const nanovdb::Coord& origin) { return begin(upper(n), origin, kUpperEntries); }
  /// Makes root entry n point to an upper node, or hold a tile.
  void set_root_child(std::uint64_t n, const nanovdb::Coord& origin, std::uint64_t upper_number);
  void set_root_tile(std::uint64_t n, const nanovdb::Coord& origin, const typename Types::Value& value, bool active);

  /// Makes an entry of an internal node a tile.
  template <class Node, class Value>
  static void set_tile(Node& node, std::uint32_t entry, const Value& value, bool active) {
    node.mTable[entry].value = value;
    if (active) node.mValueMask.setOn(entry);
  }
  /// Makes an entry of an internal node point to a child.
  template <class Node, class Child>
  static void set_child(Node& node, std::uint32_t entry, const Child& child) {
    node.mChildMask.setOn(entry);
    node.mTable[entry].child = reinterpret_cast<const std::byte*>(&child) - reinterpret_cast<const std::byte*>(&node);
  }

 private:
  template <class Node>
  Node& begin(Node& node, const nanovdb::Coord& origin, std::uint32_t entries) {
    node.mBBox[0] = origin;
    for (std::uint32_t n = 0; n < entries; ++n) node.mTable[n].value = background_;
    return node;
  }
  typename Types::Root& root() { return *reinterpret_cast<typename Types::Root*>(start_ + root_); }

  std::byte* start_;
  std::size_t lowers_, uppers_, root_;
  typename Types::Value background_;
};

extern template class NanoBuilder<float>;
extern template class NanoBuilder<nanovdb::Vec3f>;
extern template class NanoBuilder<nanovdb::ValueMask>;

/// Block of 8^3 voxels: a leaf that is already in the buffer, or a tile of one value.
template <class T>
struct NanoBlock {
  static constexpr std::uint32_t kTile = 0xffffffff;
  nanovdb::Coord origin;
  std::uint32_t leaf = kTile;
  typename NanoTypes<T>::Value value{};  ///< active value of a tile
};

/// Reserves memory for at most `leaves` leaves.
template <class T>
NanoMemory reserve_leaves(std::uint64_t leaves);
/// Completes a buffer whose first `leaves` leaves are written, and returns it. Nodes of one active value become tiles; the background is
/// everywhere else. Error: the blocks are too far apart (more than kMaxRootEntries root entries).
template <class T>
Result<NanoMemory> build_from_blocks(NanoMemory memory, std::uint64_t leaves, std::vector<NanoBlock<T>> blocks,
                                     const typename NanoTypes<T>::Value& background);

}  // namespace catena::field
