/// Private to this room and to engine/io/vdb: the bytes of a NanoVDB buffer. They are anonymous memory, zero when reserved (memory that
/// is never touched costs nothing), or a part of a mapped file, which they keep mapped. Aligned to pages; shared by copies.
#pragma once
#include <nanovdb/NanoVDB.h>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/base/memory_limit.h"

namespace catena::field {

class NanoMemory {
 public:
  NanoMemory() = default;
  /// Throws std::bad_alloc.
  static NanoMemory reserve(std::size_t bytes);
  /// Takes over a mapping of mmap; `held`: it counts as memory that data holds.
  static NanoMemory from_mapping(void* start, std::size_t bytes, bool held);
  NanoMemory slice(std::size_t offset, std::size_t bytes) const;
  /// Of reserved memory that nobody shares: what is behind the end goes back, what is new is zero. It may move. Throws std::bad_alloc.
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

/// Where a builder gets its zeroed memory: the heap of this process, or a file that another process will map.
using NanoAllocator = std::function<NanoMemory(std::size_t bytes)>;

/// Private to this room and to engine/io/vdb: NanoVDB buffers made in place. One buffer has its exact size from the start; leaves are
/// written where they stay, by any number of threads; what points to them comes after.
///   layout: grid, tree, leaves, lower nodes, upper nodes, root, its entries; children lie in the order of their parents' entries
/// Values and states are all that a buffer holds: its own statistics, boxes, map and checksum are left empty.
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

/// Insets of nodes in voxels, and entries of internal nodes an axis.
inline constexpr std::int32_t kLeafEdge = 8, kLowerEdge = 128, kUpperEdge = 4096;
inline constexpr std::uint32_t kLowerEntries = 4096, kUpperEntries = 32768;
/// A fetch outside of all nodes looks at every entry of the root.
inline constexpr std::uint64_t kMaxRootEntries = 1024;

/// The number of the entry that holds a voxel, z fastest.
inline std::uint32_t lower_entry(const nanovdb::Coord& c) {
  return static_cast<std::uint32_t>((c[0] >> 3 & 15) << 8 | (c[1] >> 3 & 15) << 4 | (c[2] >> 3 & 15));
}
inline std::uint32_t upper_entry(const nanovdb::Coord& c) {
  return static_cast<std::uint32_t>((c[0] >> 7 & 31) << 10 | (c[1] >> 7 & 31) << 5 | (c[2] >> 7 & 31));
}

struct NanoCounts {
  std::uint64_t leaves = 0, lowers = 0, uppers = 0, entries = 0;
};

template <class T>
class NanoBuilder {
 public:
  using Types = NanoTypes<T>;
  static std::size_t leaves_offset();
  static std::size_t bytes(const NanoCounts& counts);
  /// `start`: zeroed bytes(counts) bytes, but for the leaves, which may be there already.
  NanoBuilder(std::byte* start, const NanoCounts& counts, const typename Types::Value& background);

  static typename Types::Leaf& leaf_at(std::byte* start, std::uint64_t n);
  typename Types::Leaf& leaf(std::uint64_t n) { return leaf_at(start_, n); }
  typename Types::Lower& lower(std::uint64_t n) { return reinterpret_cast<typename Types::Lower*>(start_ + lowers_)[n]; }
  typename Types::Upper& upper(std::uint64_t n) { return reinterpret_cast<typename Types::Upper*>(start_ + uppers_)[n]; }
  typename Types::Entry& root_entry(std::uint64_t n);
  /// Begin a node: its place, and the background in all its entries.
  typename Types::Lower& begin_lower(std::uint64_t n, const nanovdb::Coord& origin) { return begin(lower(n), origin, kLowerEntries); }
  typename Types::Upper& begin_upper(std::uint64_t n, const nanovdb::Coord& origin) { return begin(upper(n), origin, kUpperEntries); }
  void set_root_child(std::uint64_t n, const nanovdb::Coord& origin, std::uint64_t upper_number);
  void set_root_tile(std::uint64_t n, const nanovdb::Coord& origin, const typename Types::Value& value, bool active);

  template <class Node, class Value>
  static void set_tile(Node& node, std::uint32_t entry, const Value& value, bool active) {
    node.mTable[entry].value = value;
    if (active) node.mValueMask.setOn(entry);
  }
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

/// A block of 8^3 voxels: a leaf that is in the buffer already, or one value.
template <class T>
struct NanoBlock {
  static constexpr std::uint32_t kTile = 0xffffffff;
  nanovdb::Coord origin;
  std::uint32_t leaf = kTile;
  typename NanoTypes<T>::Value value{};  ///< of a tile, active
};

/// Reserved memory for at most so many leaves.
template <class T>
NanoMemory reserve_leaves(std::uint64_t leaves);
/// Completes a buffer of which the first `leaves` leaves are written: nodes of one active value become tiles. Elsewhere: the background.
/// An error only where the blocks are too far apart.
template <class T>
Result<NanoMemory> build_from_blocks(NanoMemory memory, std::uint64_t leaves, std::vector<NanoBlock<T>> blocks,
                                     const typename NanoTypes<T>::Value& background);

}  // namespace catena::field
