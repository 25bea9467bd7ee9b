// SPDX-License-Identifier: MIT
#include "engine/field/nanovdb/nano_builder.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <cstring>
#include <new>

#include "engine/base/huge_pages.h"
#include "engine/base/result.h"

namespace catena::field {
namespace {

constexpr std::size_t kGridBytes = sizeof(nanovdb::GridData), kTreeBytes = sizeof(nanovdb::TreeData<3>);

template <class T>
constexpr nanovdb::GridType type_of() {
  if constexpr (std::is_same_v<T, float>) return nanovdb::GridType::Float;
  if constexpr (std::is_same_v<T, nanovdb::Vec3f>) return nanovdb::GridType::Vec3f;
  return nanovdb::GridType::Mask;
}

/// Returns true if the values are equal bit by bit: 0 and -0 differ.
template <class Value>
bool same(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

nanovdb::Coord aligned(const nanovdb::Coord& c, std::int32_t edge) { return {c[0] & ~(edge - 1), c[1] & ~(edge - 1), c[2] & ~(edge - 1)}; }

/// Orders origins as the nodes are stored: by upper node, by its entry, by the lower node's entry.
bool before(const nanovdb::Coord& a, const nanovdb::Coord& b) {
  const nanovdb::Coord ua = aligned(a, kUpperEdge), ub = aligned(b, kUpperEdge);
  if (ua != ub) return ua < ub;
  if (upper_entry(a) != upper_entry(b)) return upper_entry(a) < upper_entry(b);
  return lower_entry(a) < lower_entry(b);
}

/// Children of one node, a range of blocks or of lower nodes; a tile if all children are equal tiles.
template <class Value>
struct Run {
  nanovdb::Coord origin;
  std::size_t first, count;
  bool is_tile = false;
  Value value{};
};

/// Groups `items` (each with origin, is_tile, value) by the node of edge length `edge` that contains them.
template <class Value, class Items, class IsTile>
std::vector<Run<Value>> group(const Items& items, std::int32_t edge, std::size_t full, const IsTile& is_tile) {
  std::vector<Run<Value>> runs;
  for (std::size_t i = 0; i < items.size();) {
    Run<Value> run{aligned(items[i].origin, edge), i, 0};
    bool constant = true;
    for (; i < items.size() && aligned(items[i].origin, edge) == run.origin; ++i, ++run.count)
      constant = constant && is_tile(items[i]) && same(items[i].value, items[run.first].value);
    if (constant && run.count == full) {
      run.is_tile = true;
      run.value = items[run.first].value;
    }
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

template <class T>
std::size_t NanoBuilder<T>::leaves_offset() {
  return kGridBytes + kTreeBytes;
}

template <class T>
std::size_t NanoBuilder<T>::bytes(const NanoCounts& c) {
  return leaves_offset() + c.leaves * sizeof(typename Types::Leaf) + c.lowers * sizeof(typename Types::Lower) +
         c.uppers * sizeof(typename Types::Upper) + sizeof(typename Types::Root) + c.entries * sizeof(typename Types::Entry);
}

template <class T>
typename NanoTypes<T>::Leaf& NanoBuilder<T>::leaf_at(std::byte* start, std::uint64_t n) {
  return reinterpret_cast<typename Types::Leaf*>(start + leaves_offset())[n];
}

template <class T>
NanoBuilder<T>::NanoBuilder(std::byte* start, const NanoCounts& c, const typename Types::Value& background)
    : start_(start), background_(background) {
  lowers_ = leaves_offset() + c.leaves * sizeof(typename Types::Leaf);
  uppers_ = lowers_ + c.lowers * sizeof(typename Types::Lower);
  root_ = uppers_ + c.uppers * sizeof(typename Types::Upper);
  // grid header
  auto& grid = *reinterpret_cast<nanovdb::GridData*>(start);
  grid.mMagic = NANOVDB_MAGIC_NUMBER;
  grid.mVersion = nanovdb::Version();
  grid.mGridCount = 1;
  grid.mGridSize = bytes(c);
  grid.mGridType = type_of<T>();
  // tree header: offsets are relative to it
  auto& tree = *reinterpret_cast<nanovdb::TreeData<3>*>(start + kGridBytes);
  tree.mNodeOffset[0] = c.leaves > 0 ? leaves_offset() - kGridBytes : 0;
  tree.mNodeOffset[1] = c.lowers > 0 ? lowers_ - kGridBytes : 0;
  tree.mNodeOffset[2] = c.uppers > 0 ? uppers_ - kGridBytes : 0;
  tree.mNodeOffset[3] = root_ - kGridBytes;
  tree.mNodeCount[0] = static_cast<std::uint32_t>(c.leaves);
  tree.mNodeCount[1] = static_cast<std::uint32_t>(c.lowers);
  tree.mNodeCount[2] = static_cast<std::uint32_t>(c.uppers);
  // root
  root().mTableSize = static_cast<std::uint32_t>(c.entries);
  root().mBackground = root().mMinimum = root().mMaximum = background;
}

template <class T>
typename NanoTypes<T>::Entry& NanoBuilder<T>::root_entry(std::uint64_t n) {
  return *root().tile(static_cast<std::uint32_t>(n));
}

template <class T>
void NanoBuilder<T>::set_root_child(std::uint64_t n, const nanovdb::Coord& origin, std::uint64_t upper_number) {
  using Upper = nanovdb::NanoUpper<T>;
  root_entry(n).setChild(origin, reinterpret_cast<const Upper*>(&upper(upper_number)), &root());
}

template <class T>
void NanoBuilder<T>::set_root_tile(std::uint64_t n, const nanovdb::Coord& origin, const typename Types::Value& value, bool active) {
  root_entry(n).setValue(origin, active, value);
}

template <class T>
NanoMemory reserve_leaves(std::uint64_t leaves) {
  return NanoMemory::reserve(NanoBuilder<T>::leaves_offset() + std::max<std::uint64_t>(leaves, 1) * sizeof(typename NanoTypes<T>::Leaf));
}

template <class T>
Result<NanoMemory> build_from_blocks(NanoMemory memory, std::uint64_t leaves, std::vector<NanoBlock<T>> blocks,
                                     const typename NanoTypes<T>::Value& background) {
  using Value = typename NanoTypes<T>::Value;
  std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return before(a.origin, b.origin); });
  // group the children: a complete node with one value becomes a tile
  const auto is_tile = [](const auto& run) { return run.is_tile; };
  const auto lower_runs =
      group<Value>(blocks, kLowerEdge, kLowerEntries, [](const NanoBlock<T>& b) { return b.leaf == NanoBlock<T>::kTile; });
  const auto upper_runs = group<Value>(lower_runs, kUpperEdge, kUpperEntries, is_tile);
  NanoCounts counts{leaves, 0, 0, upper_runs.size()};
  for (const auto& run : upper_runs) {
    if (run.is_tile) continue;
    ++counts.uppers;
    for (std::size_t i = run.first; i < run.first + run.count; ++i) counts.lowers += lower_runs[i].is_tile ? 0 : 1;
  }
  if (counts.entries > kMaxRootEntries)
    return Error{fmt::format("extends over {} nodes of {}^3 voxels, expected at most {}", counts.entries, kUpperEdge, kMaxRootEntries)};
  // write the nodes from the leaves up
  memory.resize(NanoBuilder<T>::bytes(counts));
  NanoBuilder<T> build(memory.data(), counts, background);
  std::uint64_t lower_number = 0, upper_number = 0;
  for (std::size_t u = 0; u < upper_runs.size(); ++u) {
    const auto& upper_run = upper_runs[u];
    if (upper_run.is_tile) {
      build.set_root_tile(u, upper_run.origin, upper_run.value, true);
      continue;
    }
    build.set_root_child(u, upper_run.origin, upper_number);
    auto& upper = build.begin_upper(upper_number++, upper_run.origin);
    for (std::size_t l = upper_run.first; l < upper_run.first + upper_run.count; ++l) {
      const auto& lower_run = lower_runs[l];
      if (lower_run.is_tile) {
        build.set_tile(upper, upper_entry(lower_run.origin), lower_run.value, true);
        continue;
      }
      auto& lower = build.begin_lower(lower_number++, lower_run.origin);
      build.set_child(upper, upper_entry(lower_run.origin), lower);
      for (std::size_t b = lower_run.first; b < lower_run.first + lower_run.count; ++b) {
        const NanoBlock<T>& block = blocks[b];
        if (block.leaf == NanoBlock<T>::kTile)
          build.set_tile(lower, lower_entry(block.origin), block.value, true);
        else
          build.set_child(lower, lower_entry(block.origin), build.leaf(block.leaf));
      }
    }
  }
  return memory;
}

template class NanoBuilder<float>;
template class NanoBuilder<nanovdb::Vec3f>;
template class NanoBuilder<nanovdb::ValueMask>;
template NanoMemory reserve_leaves<float>(std::uint64_t);
template NanoMemory reserve_leaves<nanovdb::Vec3f>(std::uint64_t);
template NanoMemory reserve_leaves<nanovdb::ValueMask>(std::uint64_t);
template Result<NanoMemory> build_from_blocks<float>(NanoMemory, std::uint64_t, std::vector<NanoBlock<float>>, const float&);
template Result<NanoMemory> build_from_blocks<nanovdb::Vec3f>(NanoMemory, std::uint64_t, std::vector<NanoBlock<nanovdb::Vec3f>>,
                                                              const nanovdb::Vec3f&);
template Result<NanoMemory> build_from_blocks<nanovdb::ValueMask>(NanoMemory, std::uint64_t, std::vector<NanoBlock<nanovdb::ValueMask>>,
                                                                  const bool&);

struct NanoMemory::Region {
  void* start;
  std::size_t bytes;
  MemoryReservation held;
  Region(void* at, std::size_t size, bool counts) : start(at), bytes(size), held(counts ? size : 0) {}
  Region(const Region&) = delete;
  ~Region() { ::munmap(start, bytes); }
};

NanoMemory NanoMemory::from_mapping(void* start, std::size_t bytes, bool is_counted) {
  NanoMemory memory;
  memory.region_ = std::make_shared<Region>(start, bytes, is_counted);
  memory.data_ = static_cast<std::byte*>(start);
  memory.size_ = bytes;
  return memory;
}

NanoMemory NanoMemory::reserve(std::size_t bytes) {
  void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) throw std::bad_alloc();
  prefer_huge_pages(start, bytes);
  return from_mapping(start, bytes, true);
}

NanoMemory NanoMemory::slice(std::size_t offset, std::size_t bytes) const {
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
  // clears the rest of the last page, which may have been written before
  if (bytes < region_->bytes) {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)), remainder = (page - bytes % page) % page;
    std::memset(static_cast<std::byte*>(start) + bytes, 0, remainder);
  }
  region_->start = start;
  region_->bytes = size_ = bytes;
  region_->held = MemoryReservation(bytes);
  data_ = static_cast<std::byte*>(start);
}

}  // namespace catena::field
