// SPDX-License-Identifier: MIT
/// Converts OpenVDB trees to NanoVDB buffers: values and active states are preserved at every tree level; numbers become floats.
/// Only the buffer is allocated, nothing per node; leaves are filled in parallel.
#pragma once
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstring>

#include "engine/base/threads.h"
#include "engine/field/nanovdb/nano_builder.h"

namespace catena::vdb {

inline nanovdb::Coord to_nano_coord(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

/// Converts a value of the tree to the value type of the buffer.
template <class T, class V>
typename field::NanoTypes<T>::Value to_nano_value(const V& v) {
  if constexpr (std::is_same_v<T, nanovdb::Vec3f>)
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  else
    return static_cast<typename field::NanoTypes<T>::Value>(v);
}

/// Active state in the buffer; for masks: active and (in a bool tree) true.
template <class T>
bool is_nano_active(bool active, const typename field::NanoTypes<T>::Value& value) {
  if constexpr (std::is_same_v<T, nanovdb::ValueMask>) return active && value;
  return active;
}

template <class Leaf>
void fill_leaf(const Leaf& from, field::NanoTypes<nanovdb::ValueMask>::Leaf& to) {
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n)
    if (from.isValueOn(n) && from.getValue(n)) to.mValueMask.setOn(n);
}

template <class Leaf, class NanoLeaf>
void fill_leaf(const Leaf& from, NanoLeaf& to) {
  to.mValueMask = from.valueMask();
  using V = typename Leaf::ValueType;
  const V* values = from.buffer().data();
  if constexpr (std::is_same_v<V, float> || std::is_same_v<V, openvdb::Vec3f>) {
    std::memcpy(static_cast<void*>(to.mValues), values, sizeof to.mValues);
  } else {
    using T = typename NanoLeaf::BuildType;
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) to.mValues[n] = to_nano_value<T>(values[n]);
  }
}

/// Converts the tree to a NanoVDB buffer of T (float, nanovdb::Vec3f or nanovdb::ValueMask). Returns an Error that begins with `what` when
/// more than `allowed` bytes are needed, or the tree extends over too many root entries.
template <class T, class Tree>
Result<field::NanoMemory> to_nano(const Tree& tree, const std::string& what, std::uint64_t allowed, const field::NanoAllocator& allocate) {
  using Root = typename Tree::RootNodeType;
  using Upper = typename Root::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  using Leaf = typename Lower::ChildNodeType;
  using V = typename Tree::ValueType;
  // the nodes, in the order of their parents' child tables
  std::vector<const Upper*> uppers;
  std::vector<const Lower*> lowers;
  std::vector<const Leaf*> leaves;
  std::vector<std::size_t> first_lower, first_leaf;
  for (auto upper = tree.root().cbeginChildOn(); upper; ++upper) {
    uppers.push_back(&*upper);
    first_lower.push_back(lowers.size());
    for (auto lower = upper->cbeginChildOn(); lower; ++lower) {
      lowers.push_back(&*lower);
      first_leaf.push_back(leaves.size());
      for (auto leaf = lower->cbeginChildOn(); leaf; ++leaf) leaves.push_back(&*leaf);
    }
  }
  const field::NanoCounts counts{leaves.size(), lowers.size(), uppers.size(), tree.root().getTableSize()};
  if (counts.entries > field::kMaxRootEntries)
    return Error{what + " extends over " + std::to_string(counts.entries) + " nodes of 4096^3 voxels, expected at most " +
                 std::to_string(field::kMaxRootEntries)};
  const std::size_t bytes = field::NanoBuilder<T>::bytes(counts);
  CATENA_CHECK(check_memory_available(what, static_cast<double>(bytes), allowed));
  field::NanoMemory memory = allocate(bytes);
  // the root's entries, then each level
  field::NanoBuilder<T> build(memory.data(), counts, to_nano_value<T>(tree.background()));
  std::uint64_t entry = 0, upper_number = 0;
  for (auto it = tree.root().cbeginChildAll(); it; ++it, ++entry) {
    V value = openvdb::zeroVal<V>();
    const nanovdb::Coord origin = to_nano_coord(it.getCoord());
    if (it.probeChild(value)) {
      build.set_root_child(entry, origin, upper_number++);
    } else {
      const auto nano = to_nano_value<T>(value);
      const bool active = is_nano_active<T>(it.isValueOn(), nano);
      build.set_root_tile(entry, origin, std::is_same_v<T, nanovdb::ValueMask> ? static_cast<decltype(nano)>(active) : nano, active);
    }
  }
  const auto fill_node = [&](const auto& from, auto& to, const auto& child_at) {
    std::size_t child = 0;
    for (auto it = from.cbeginChildAll(); it; ++it) {
      V value = openvdb::zeroVal<V>();
      if (it.probeChild(value)) {
        build.set_child(to, it.pos(), child_at(child++));
      } else {
        const auto nano = to_nano_value<T>(value);
        const bool active = is_nano_active<T>(it.isValueOn(), nano);
        build.set_tile(to, it.pos(), std::is_same_v<T, nanovdb::ValueMask> ? static_cast<decltype(nano)>(active) : nano, active);
      }
    }
  };
  parallel_for(uppers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      fill_node(
          *uppers[n], build.begin_upper(n, to_nano_coord(uppers[n]->origin())), [&](std::size_t child) -> auto& {
            return build.lower(first_lower[n] + child);
          });
  });
  parallel_for(lowers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      fill_node(
          *lowers[n], build.begin_lower(n, to_nano_coord(lowers[n]->origin())), [&](std::size_t child) -> auto& {
            return build.leaf(first_leaf[n] + child);
          });
  });
  parallel_for(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      auto& leaf = build.leaf(n);
      leaf.mBBoxMin = to_nano_coord(leaves[n]->origin());
      fill_leaf(*leaves[n], leaf);
    }
  });
  return memory;
}

}  // namespace catena::vdb
