// SPDX-License-Identifier: MIT
/// The decoded chunks that were used last, so that boxes which share a chunk decode it once. One thread.
#pragma once
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace catena::chunks {

using ChunkBytes = std::shared_ptr<const std::vector<std::byte>>;

/// Least recently used chunks beyond kMaxBytes are evicted; one chunk always stays.
class ChunkCache {
 public:
  static constexpr std::size_t kMaxBytes = 64 << 20;

  /// Returns a cached chunk; null: not cached.
  ChunkBytes find(const std::string& key) {
    const auto found = places_.find(key);
    if (found == places_.end()) return nullptr;
    chunks_.splice(chunks_.begin(), chunks_, found->second);
    return found->second->second;
  }

  /// Adds a chunk that is not cached.
  ChunkBytes add(const std::string& key, std::vector<std::byte> bytes) {
    bytes_ += bytes.size();
    chunks_.emplace_front(key, std::make_shared<const std::vector<std::byte>>(std::move(bytes)));
    places_[key] = chunks_.begin();
    while (bytes_ > kMaxBytes && chunks_.size() > 1) {
      bytes_ -= chunks_.back().second->size();
      places_.erase(chunks_.back().first);
      chunks_.pop_back();
    }
    return chunks_.front().second;
  }

 private:
  using Entry = std::pair<std::string, ChunkBytes>;
  std::list<Entry> chunks_;
  std::map<std::string, std::list<Entry>::iterator> places_;
  std::size_t bytes_ = 0;
};

}  // namespace catena::chunks
