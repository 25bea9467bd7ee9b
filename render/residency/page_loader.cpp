// SPDX-License-Identifier: MIT
#include "render/residency/page_loader.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/threads.h"
#include "engine/field/bricks/with_number_type.h"

namespace catena::render {

namespace {

using field::Brick;
using field::Index3;
template <class Code>
using CodeArray = std::vector<Code>;

constexpr std::size_t kRow = kPageNodes, kPlane = kRow * kPageNodes;
constexpr std::int64_t kRetryNs = 1'000'000'000;  // time after which an unreadable page is tried again
constexpr std::size_t kMaxReady = 64;             // encoded pages that wait to be taken, 0.6 MB each

/// The bricks that a page's nodes come from: itself and those behind it; bit 0 of the index: along x, 1: y, 2: z. Null: the level ends.
using Corner = std::array<std::shared_ptr<const Brick>, 8>;

Result<Corner> read_bricks(const field::PagedGrid& grid, const PageLevel& level, const Index3& brick) {
  Corner bricks;
  for (int c = 0; c < 8; ++c) {
    const Index3 at{brick.x + (c & 1), brick.y + (c >> 1 & 1), brick.z + (c >> 2)};
    if (at.x >= level.counts.x || at.y >= level.counts.y || at.z >= level.counts.z) continue;
    CATENA_TRY(bricks[std::size_t(c)], grid.bricks().read(level.source_level, at));
  }
  return bricks;
}

/// Returns a number from 0 to 1 that depends on the position of a voxel alone: the R3 sequence (M. Roberts, 2018), whose mean over few
/// neighbors, in whatever direction a ray passes, is near 1/2.
float dither_at(int x, int y, int z) {
  constexpr std::uint32_t kX = 0xD1B54A33u, kY = 0xABC98389u, kZ = 0x8CB92BA8u;  // 2^32 / g, / g^2, / g^3; g^4 = g + 1
  return float((std::uint32_t(x) * kX + std::uint32_t(y) * kY + std::uint32_t(z) * kZ) >> 8) * 0x1p-24f;
}

/// Encodes the nodes of a page, of bricks with numbers of type T. `first`: the page's first voxel in its level.
template <class T, class Code>
CodeArray<Code> encode_nodes(const Corner& bricks, const Index3& first, const CodeScale& codes) {
  const auto encode_row = [&codes, encode = codes.encoder<Code>()](const Brick& brick, std::size_t at, const Index3& voxel, int count,
                                                                   Code* out) {
    const std::byte* in = brick.values().data() + at * sizeof(T);
    for (int i = 0; i < count; ++i) {
      T number;
      std::memcpy(&number, in + std::size_t(i) * sizeof(T), sizeof(T));
      const auto value = static_cast<float>(number);
      const float offset = codes.is_dithered ? dither_at(voxel.x + i, voxel.y, voxel.z) : 0.5f;
      out[i] = std::isfinite(value) ? encode(value, offset) : CodeScale::kInvalidCode;
    }
  };
  CodeArray<Code> out(kPlane * kPageNodes);
  const Index3& own = bricks[0]->size();
  const auto clamped = [](int node, int size, bool has_next) { return node < size || (node == kPageEdge && has_next) ? node : size - 1; };
  for (int z = 0; z < kPageNodes; ++z)
    for (int y = 0; y < kPageNodes; ++y) {
      Code* row = &out[std::size_t(z) * kPlane + std::size_t(y) * kRow];
      const int at_z = clamped(z, own.z, bricks[4] != nullptr), at_y = clamped(y, own.y, bricks[2] != nullptr);
      const int side = (at_y == kPageEdge ? 2 : 0) | (at_z == kPageEdge ? 4 : 0);
      const auto encode = [&](const Brick& brick, int x, int count) {
        const Index3& n = brick.size();
        const auto y_in = std::size_t(at_y % kPageEdge), z_in = std::size_t(at_z % kPageEdge);
        encode_row(brick, (z_in * std::size_t(n.y) + y_in) * std::size_t(n.x), {first.x + x, first.y + at_y, first.z + at_z}, count,
                   row + x);
      };
      encode(*bricks[std::size_t(side)], 0, own.x);
      const auto& next = bricks[std::size_t(side | 1)];
      if (next)
        encode(*next, kPageEdge, 1);
      else
        std::fill(row + own.x, row + kRow, row[own.x - 1]);
    }
  return out;
}

/// Returns the range of the codes of each sub-brick.
template <class Code>
PageRanges find_ranges(const CodeArray<Code>& codes, const CodeScale& scale) {
  PageRanges ranges;
  std::size_t at = 0;
  for (int z = 0; z < kPageEdge; z += kBrickSize)
    for (int y = 0; y < kPageEdge; y += kBrickSize)
      for (int x = 0; x < kPageEdge; x += kBrickSize) {
        Code min = std::numeric_limits<Code>::max(), max = 0;
        bool has_unused = false;
        for (int k = z; k <= z + kBrickSize; ++k)
          for (int j = y; j <= y + kBrickSize; ++j) {
            const Code* row = &codes[std::size_t(k) * kPlane + std::size_t(j) * kRow + std::size_t(x)];
            for (int i = 0; i <= kBrickSize; ++i) {
              const bool unused = scale.has_mask && row[i] == CodeScale::kInvalidCode;
              min = std::min(min, unused ? std::numeric_limits<Code>::max() : row[i]);
              max = std::max(max, row[i]);
              has_unused = has_unused || unused;
            }
          }
        ranges[at++] = min > max ? CodeRange{255, 0, true} : scale.range_of(min, max, has_unused);
      }
  return ranges;
}

/// Encodes a channel of a page into every `stride`-th word of `words`.
template <class Code>
PageRanges encode_channel(const field::NumberType& type, const Corner& bricks, const Index3& first, const CodeScale& codes,
                          std::uint16_t* words, std::size_t stride) {
  CodeArray<Code> nodes;
  field::with_number_type(type, [&](auto number) { nodes = encode_nodes<decltype(number), Code>(bricks, first, codes); });
  for (std::size_t line = 0; line < kPlane; ++line) {
    const Code* row = &nodes[line * kRow];
    if constexpr (sizeof(Code) > 1) {
      for (std::size_t x = 0; x < kRow; ++x) words[(line * kRow + x) * stride] = row[x];
    } else {
      for (std::size_t x = 0; x < kPageEdge; ++x) words[(line * kPageEdge + x) * stride] = std::uint16_t(row[x] | row[x + 1] << 8);
    }
  }
  return find_ranges(nodes, codes);
}

}  // namespace

Result<EncodedPage> encode_page(const ChannelGrids& grids, const std::vector<PageLevel>& levels, const PageId& id,
                                const ChannelCodes& codes) {
  const bool is_number = codes.front().max_code > 255;
  const std::size_t stride = texel_words(grids.size());
  EncodedPage page{id, std::vector<std::uint16_t>(stride * page_words(is_number ? PageFormat::numbers : PageFormat::codes)), {}};
  for (std::size_t channel = 0; channel < grids.size(); ++channel) {
    const field::PagedGrid& grid = *grids[channel];
    CATENA_TRY(const Corner bricks, read_bricks(grid, levels[id.level], id.brick));
    const auto encode = is_number ? encode_channel<std::uint16_t> : encode_channel<std::uint8_t>;
    const Index3 first{id.brick.x * kPageEdge, id.brick.y * kPageEdge, id.brick.z * kPageEdge};
    page.ranges.push_back(encode(grid.source().type(), bricks, first, codes[channel], page.words.data() + channel, stride));
  }
  return page;
}

struct PageLoader::Impl {
  ChannelGrids grids;
  std::vector<PageLevel> levels;

  mutable std::mutex mutex;
  std::condition_variable planned, finished;
  ChannelCodes codes;
  std::deque<PageId> wanted;
  std::vector<PageId> reading;
  std::deque<EncodedPage> ready;
  std::vector<std::pair<PageId, std::int64_t>> unreadable;  ///< with the time of the last attempt
  bool is_listing = true, has_listed = false, stop = false, has_complained = false;
  std::vector<std::thread> threads;

  void list();
  void read();
  bool has_failed_lately(const PageId& id) const {
    return std::ranges::any_of(unreadable, [&](const auto& failed) { return failed.first == id && now_ns() - failed.second < kRetryNs; });
  }
};

/// Finds the bricks that the store does not have. What it cannot list is read.
void PageLoader::Impl::list() {
  const bool done = std::ranges::all_of(grids, [](const auto& grid) { return bool(grid->source().find_empty_bricks(0)); });
  const std::scoped_lock lock(mutex);
  is_listing = false;
  has_listed = done;
  finished.notify_all();
}

/// Loop of a thread.
void PageLoader::Impl::read() {
  std::unique_lock lock(mutex);
  for (;;) {
    planned.wait(lock, [&] { return stop || (!wanted.empty() && ready.size() < kMaxReady); });
    if (stop) return;
    const PageId id = wanted.front();
    wanted.pop_front();
    reading.push_back(id);
    const ChannelCodes used = codes;
    lock.unlock();
    auto page = encode_page(grids, levels, id, used);
    lock.lock();
    std::erase(reading, id);
    std::erase_if(unreadable, [&](const auto& failed) { return failed.first == id; });
    if (!page) {
      unreadable.emplace_back(id, now_ns());
      if (!std::exchange(has_complained, true)) print_message("note: " + page.error().message + "; a coarser level is shown there");
    } else if (used == codes) {
      ready.push_back(std::move(*page));
    }
    finished.notify_all();
  }
}

PageLoader::PageLoader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<PageLoader>> PageLoader::start(ChannelGrids grids, std::vector<PageLevel> levels) {
  std::unique_ptr<PageLoader> loader(new PageLoader(std::make_unique<Impl>()));
  Impl* impl = loader->impl_.get();
  impl->grids = std::move(grids);
  impl->levels = std::move(levels);
  for (int i = 0; i < kThreads; ++i) {
    CATENA_TRY(std::thread reader, start_thread("a reader of pages", [impl, i] {
                 if (i == 0) impl->list();
                 impl->read();
               }));
    impl->threads.push_back(std::move(reader));
  }
  return loader;
}

PageLoader::~PageLoader() {
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->planned.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
}

void PageLoader::set_wanted(std::vector<PageId> wanted, const ChannelCodes& codes) {
  const std::scoped_lock lock(impl_->mutex);
  if (!(codes == impl_->codes)) impl_->ready.clear();
  impl_->codes = codes;
  const auto is_known = [&](const PageId& id) {
    return std::ranges::find(impl_->reading, id) != impl_->reading.end() || impl_->has_failed_lately(id) ||
           std::ranges::any_of(impl_->ready, [&](const EncodedPage& page) { return page.id == id; });
  };
  std::erase_if(wanted, is_known);
  impl_->wanted.assign(wanted.begin(), wanted.end());
  impl_->planned.notify_all();
}

std::vector<EncodedPage> PageLoader::take(std::size_t max_pages) {
  const std::scoped_lock lock(impl_->mutex);
  std::vector<EncodedPage> pages;
  while (!impl_->ready.empty() && pages.size() < max_pages) {
    pages.push_back(std::move(impl_->ready.front()));
    impl_->ready.pop_front();
  }
  impl_->planned.notify_all();
  return pages;
}

bool PageLoader::has_arrived() const {
  const std::scoped_lock lock(impl_->mutex);
  return !impl_->ready.empty();
}

bool PageLoader::wait() {
  std::unique_lock lock(impl_->mutex);
  impl_->finished.wait(lock, [&] { return !impl_->ready.empty() || (impl_->wanted.empty() && impl_->reading.empty()); });
  return !impl_->ready.empty();
}

bool PageLoader::take_found_empty(bool waits) {
  std::unique_lock lock(impl_->mutex);
  if (waits) impl_->finished.wait(lock, [&] { return !impl_->is_listing; });
  return !impl_->is_listing && std::exchange(impl_->has_listed, false);
}

}  // namespace catena::render
