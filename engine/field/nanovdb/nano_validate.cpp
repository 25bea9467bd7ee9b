// SPDX-License-Identifier: MIT
#include "engine/field/nanovdb/nano_statistics.h"

#include <fmt/format.h>

#include <cstring>
#include <set>

#include "engine/base/threads.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {
namespace {

using nanovdb::Coord;
constexpr std::size_t kTreeAt = sizeof(nanovdb::GridData), kLeavesAt = kTreeAt + sizeof(nanovdb::TreeData<3>);

Error invalid(std::string_view what) { return Error{fmt::format("{} is invalid", what)}; }

/// Reads a number at an offset that the caller has checked; never used for bool or enumerations, whose bytes may be invalid.
template <class N>
N number_at(std::span<const std::byte> bytes, std::size_t at) {
  N n;
  std::memcpy(&n, bytes.data() + at, sizeof n);
  return n;
}

bool is_bool(const bool& b) {
  std::uint8_t byte;
  std::memcpy(&byte, &b, 1);
  return byte <= 1;
}

/// Returns true if a tile is valid. A mask's tile stores its bit twice; both must be equal.
template <class Value>
bool is_valid_tile(const Value&, bool) {
  return true;
}
template <>
bool is_valid_tile<bool>(const bool& value, bool active) {
  return is_bool(value) && value == active;
}

/// Node counts of the header, and the offsets at which the arrays must begin.
template <class T>
struct Layout {
  NanoCounts counts;
  std::size_t lowers, uppers, root;
};

template <class T>
Result<Layout<T>> layout_of(std::span<const std::byte> bytes) {
  using Types = NanoTypes<T>;
  using Grid = nanovdb::GridData;
  using Tree = nanovdb::TreeData<3>;
  using Root = typename Types::Root;
  // grid header
  if (bytes.size() < kLeavesAt + sizeof(Root)) return invalid("the buffer size");
  if (number_at<std::uint64_t>(bytes, offsetof(Grid, mMagic)) != NANOVDB_MAGIC_NUMBER) return invalid("the magic number");
  if (number_at<std::uint32_t>(bytes, offsetof(Grid, mVersion)) != nanovdb::Version().id()) return invalid("the version");
  if (number_at<std::uint64_t>(bytes, offsetof(Grid, mGridSize)) != bytes.size()) return invalid("the size of the grid");
  constexpr auto type = std::is_same_v<T, float>            ? nanovdb::GridType::Float
                        : std::is_same_v<T, nanovdb::Vec3f> ? nanovdb::GridType::Vec3f
                                                            : nanovdb::GridType::Mask;
  if (number_at<std::uint32_t>(bytes, offsetof(Grid, mGridType)) != static_cast<std::uint32_t>(type))
    return invalid("the type of the grid");
  // tree header: none of the sums can overflow, as a count has 32 bits and a node is smaller than 2^20 bytes
  Layout<T> l;
  const auto count = [&](int level) { return number_at<std::uint32_t>(bytes, kTreeAt + offsetof(Tree, mNodeCount) + 4 * level); };
  l.counts = {count(0), count(1), count(2), 0};
  l.lowers = kLeavesAt + l.counts.leaves * sizeof(typename Types::Leaf);
  l.uppers = l.lowers + l.counts.lowers * sizeof(typename Types::Lower);
  l.root = l.uppers + l.counts.uppers * sizeof(typename Types::Upper);
  if (l.root > bytes.size() - sizeof(Root)) return invalid("the number of nodes");
  const std::uint64_t offsets[] = {l.counts.leaves > 0 ? kLeavesAt - kTreeAt : 0, l.counts.lowers > 0 ? l.lowers - kTreeAt : 0,
                                   l.counts.uppers > 0 ? l.uppers - kTreeAt : 0, l.root - kTreeAt};
  for (int level = 0; level < 4; ++level)
    if (number_at<std::uint64_t>(bytes, kTreeAt + offsetof(Tree, mNodeOffset) + 8 * level) != offsets[level])
      return invalid("the offset of the nodes");
  // root
  l.counts.entries = number_at<std::uint32_t>(bytes, l.root + offsetof(Root, mTableSize));
  if (l.counts.entries > kMaxRootEntries) return invalid("the number of root entries");
  if (NanoBuilder<T>::bytes(l.counts) != bytes.size()) return invalid("the size of the grid");
  return l;
}

std::int64_t distance(const void* to, const void* from) { return static_cast<const std::byte*>(to) - static_cast<const std::byte*>(from); }

/// Returns true if the children of an internal node follow each other in their array from `first` on, each with the position of its entry.
template <class Node, class Children, class PlaceOf>
bool is_valid_node(const Node& node, const Children& children, std::uint64_t first, std::uint32_t entries, const PlaceOf& position_of) {
  for (std::uint32_t n = 0; n < entries; ++n) {
    if (!node.mChildMask.isOn(n)) {
      if (!is_valid_tile(node.mTable[n].value, node.mValueMask.isOn(n))) return false;
      continue;
    }
    if (first >= children.size()) return false;
    const auto& child = children[first++];
    if (node.mValueMask.isOn(n) || node.mTable[n].child != distance(&child, &node) || position_of(child) != position_of(node, n))
      return false;
  }
  return true;
}

struct PlaceInUpper {
  template <class Lower>
  Coord operator()(const Lower& lower) const {
    return lower.mBBox[0];
  }
  template <class Upper>
  Coord operator()(const Upper& upper, std::uint32_t n) const {
    return upper_coord(upper.mBBox[0], n);
  }
};

struct PlaceInLower {
  template <class Leaf>
  Coord operator()(const Leaf& leaf) const {
    return leaf.mBBoxMin;
  }
  template <class Lower>
  Coord operator()(const Lower& lower, std::uint32_t n) const {
    return lower_coord(lower.mBBox[0], n);
  }
};

/// Returns true if all nodes of an array are valid and their children use up the next array exactly.
template <class Nodes, class Children, class PlaceOf>
bool are_valid_nodes(const Nodes& nodes, const Children& children, std::uint32_t entries, const PlaceOf& position_of) {
  std::vector<std::uint64_t> first(nodes.size());
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    first[n] = sum;
    sum += nodes[n].mChildMask.countOn();
  }
  if (sum != children.size()) return false;
  std::vector<std::uint8_t> valid(nodes.size());
  parallel_for(nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) valid[n] = is_valid_node(nodes[n], children, first[n], entries, position_of);
  });
  return std::all_of(valid.begin(), valid.end(), [](std::uint8_t s) { return s != 0; });
}

}  // namespace

template <class T>
Outcome validate_nano(std::span<const std::byte> bytes) {
  CATENA_TRY(const Layout<T> layout, layout_of<T>(bytes));
  const auto& grid = *reinterpret_cast<const nanovdb::NanoGrid<T>*>(bytes.data());
  const NanoNodes<T> nodes = view_nodes(grid);
  const auto& root = *reinterpret_cast<const typename NanoTypes<T>::Root*>(bytes.data() + layout.root);
  if constexpr (std::is_same_v<T, nanovdb::ValueMask>)
    if (!is_bool(root.mBackground) || root.mBackground) return invalid("the background");
  // entries of the root
  std::set<std::uint64_t> keys;
  std::uint64_t uppers = 0;
  for (const auto& entry : nodes.entries) {
    const Coord origin = entry.origin();
    if (entry.key != NanoTypes<T>::Root::CoordToKey(origin) || !keys.insert(entry.key).second)
      return invalid("the position of a root entry");
    if (entry.child == 0) {
      if (entry.state > 1 || !is_valid_tile(entry.value, entry.state != 0)) return invalid("a tile of the root");
      continue;
    }
    if (uppers >= nodes.uppers.size()) return invalid("the number of nodes");
    const auto& upper = nodes.uppers[uppers++];
    if (entry.child != distance(&upper, &root) || upper.mBBox[0] != origin) return invalid("the position of a node");
    if constexpr (std::is_same_v<T, nanovdb::ValueMask>)
      if (!is_bool(entry.value)) return invalid("a tile of the root");
  }
  if (uppers != nodes.uppers.size()) return invalid("the number of nodes");
  // nodes below the root
  if (!are_valid_nodes(nodes.uppers, nodes.lowers, kUpperEntries, PlaceInUpper{})) return invalid("the position of a node");
  if (!are_valid_nodes(nodes.lowers, nodes.leaves, kLowerEntries, PlaceInLower{})) return invalid("the position of a leaf");
  return Done{};
}

template Outcome validate_nano<float>(std::span<const std::byte>);
template Outcome validate_nano<nanovdb::Vec3f>(std::span<const std::byte>);
template Outcome validate_nano<nanovdb::ValueMask>(std::span<const std::byte>);

}  // namespace catena::field
