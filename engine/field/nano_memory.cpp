#include "engine/field/nano_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <new>

#include "engine/base/assert.h"

namespace catena::field {

struct NanoMemory::Region {
  void* start;
  std::size_t bytes;
  HeldMemory held;
  Region(void* at, std::size_t size, bool counts) : start(at), bytes(size), held(counts ? size : 0) {}
  Region(const Region&) = delete;
  ~Region() { ::munmap(start, bytes); }
};

NanoMemory NanoMemory::mapped(void* start, std::size_t bytes, bool held) {
  NanoMemory memory;
  memory.region_ = std::make_shared<Region>(start, bytes, held);
  memory.data_ = static_cast<std::byte*>(start);
  memory.size_ = bytes;
  return memory;
}

NanoMemory NanoMemory::reserve(std::size_t bytes) {
  void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) throw std::bad_alloc();
  return mapped(start, bytes, true);
}

NanoMemory NanoMemory::part(std::size_t offset, std::size_t bytes) const {
  CATENA_ASSERT(offset <= size_ && bytes <= size_ - offset);
  NanoMemory part = *this;
  part.data_ += offset;
  part.size_ = bytes;
  return part;
}

void NanoMemory::resize(std::size_t bytes) {
  CATENA_ASSERT(bytes > 0 && region_ && data_ == region_->start && region_.use_count() == 1);
  void* start = ::mremap(region_->start, region_->bytes, bytes, MREMAP_MAYMOVE);
  if (start == MAP_FAILED) throw std::bad_alloc();
  // of the last page that is kept, what is behind the end may have been written
  if (bytes < region_->bytes) {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)), rest = (page - bytes % page) % page;
    std::memset(static_cast<std::byte*>(start) + bytes, 0, rest);
  }
  region_->start = start;
  region_->bytes = size_ = bytes;
  region_->held = HeldMemory(bytes);
  data_ = static_cast<std::byte*>(start);
}

}  // namespace catena::field
