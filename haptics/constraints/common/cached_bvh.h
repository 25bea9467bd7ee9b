/// One search tree for all links and programs that ask for the same things, while something holds it. Off the tick; any thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace catena::haptics {

/// `version` is unique to what the tree is made of, `part` says of which part of it. `make` gives a shared pointer to a Tree.
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
