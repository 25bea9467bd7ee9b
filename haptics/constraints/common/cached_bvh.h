// SPDX-License-Identifier: MIT
/// Process-wide cache of search trees, shared by all links and programs built from the same data; a tree lives while something holds it.
/// Off the tick; any thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace catena::haptics {

/// Returns the cached tree of key (`version`, `part`), or the result of `make()` if there is none. `version` is unique to the data that the
/// tree is built from; `part` selects a subset of that data. `make` returns a std::shared_ptr<const Tree>.
template <class Tree, class Make>
std::shared_ptr<const Tree> cached_bvh(std::uint64_t version, std::size_t part, Make&& make) {
  static std::mutex mutex;
  static std::map<std::pair<std::uint64_t, std::size_t>, std::weak_ptr<const Tree>> trees;
  const std::lock_guard lock(mutex);
  std::erase_if(trees, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<const Tree>& known = trees[{version, part}];
  std::shared_ptr<const Tree> tree = known.lock();
  if (!tree) known = tree = make();
  return tree;
}

}  // namespace catena::haptics
