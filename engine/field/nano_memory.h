/// Private to this room and to engine/vdb: the bytes of a NanoVDB buffer. They are anonymous memory, zero when reserved (memory that
/// is never touched costs nothing), or a part of a mapped file, which they keep mapped. Aligned to pages; shared by copies.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

#include "engine/base/memory_limit.h"

namespace catena::field {

class NanoMemory {
 public:
  NanoMemory() = default;
  /// Throws std::bad_alloc.
  static NanoMemory reserve(std::size_t bytes);
  /// Takes over a mapping of mmap; `held`: it counts as memory that data holds.
  static NanoMemory mapped(void* start, std::size_t bytes, bool held);
  NanoMemory part(std::size_t offset, std::size_t bytes) const;
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

}  // namespace catena::field
