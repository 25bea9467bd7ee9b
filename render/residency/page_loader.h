// SPDX-License-Identifier: MIT
/// Threads that read pages of paged grids and encode them for rays. Frames do not wait for them. A page that cannot be read is tried again
/// after a second. Several grids with the same pages are the channels of one: their words follow each other.
///   codes   kPageNodes^3 nodes of a page: its own voxels and the first ones of the pages behind it along each axis; at the end of the
///           level the last voxel again
///   words   codes: as in PackedAtlas, code of a node | code of its neighbor along x << 8; kPageEdge x kPageNodes x kPageNodes of them
///           numbers: 16-bit code of a node; kPageNodes^3 of them
/// Any thread may call the functions.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/field/bricks/paged_grid.h"
#include "render/residency/page_table.h"
#include "render/residency/resident_grid.h"
#include "render/residency/voxel_block.h"

namespace catena::render {

/// Sub-bricks of kBrickSize^3 cells along the edge of a page.
inline constexpr int kPageBricks = kPageEdge / kBrickSize;

/// What a page stores of a node.
enum class PageFormat {
  codes,   ///< an 8-bit code, and that of a neighbor
  numbers  ///< a 16-bit code
};
/// Returns the number of words along x; kPageNodes of them along y and z.
constexpr int page_width(PageFormat format) { return format == PageFormat::codes ? kPageEdge : kPageNodes; }
/// Returns the number of words of a channel.
constexpr std::size_t page_words(PageFormat format) { return std::size_t(page_width(format)) * kPageNodes * kPageNodes; }
inline constexpr std::size_t kMaxChannels = 4;
/// Returns the words per texel that hold a number of channels.
constexpr std::size_t texel_words(std::size_t channels) { return channels == 3 ? 4 : channels; }

/// Ranges of the sub-bricks' nodes (CodeScale::range_of), x fastest.
using PageRanges = std::array<CodeRange, std::size_t(kPageBricks) * kPageBricks * kPageBricks>;

/// A page as it is stored in the pool.
struct EncodedPage {
  PageId id;
  std::vector<std::uint16_t> words;  ///< texel_words() for each node; x fastest
  std::vector<PageRanges> ranges;    ///< of each channel
};

/// Grids with equal levels, the channels of one volume, and what their codes mean.
using ChannelGrids = std::vector<std::shared_ptr<const field::PagedGrid>>;
using ChannelCodes = std::vector<CodeScale>;

/// Reads a page and encodes it, as numbers if the codes have 16 bits. Blocks. The Error is a complete message.
Result<EncodedPage> encode_page(const ChannelGrids& grids, const std::vector<PageLevel>& levels, const PageId& id,
                                const ChannelCodes& codes);

/// Called while an image waits for pages, with the number that have been read, of all that it waits for; the last time both are equal.
using PageProgress = std::function<void(std::size_t done, std::size_t of)>;
/// Sets the callback; before the first image.
void set_page_progress(PageProgress progress);

/// Reader threads of one volume.
class PageLoader {
 public:
  static constexpr int kThreads = 2;

  /// Starts the threads. An Error if a thread cannot be created.
  static Result<std::unique_ptr<PageLoader>> start(ChannelGrids grids, std::vector<PageLevel> levels);
  ~PageLoader();
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;

  /// Sets the pages to read, the most urgent first, and the codes. Pages that were read with other codes are dropped.
  void set_wanted(std::vector<PageId> wanted, const ChannelCodes& codes);
  /// Returns at most `max_pages` pages that have been read.
  std::vector<EncodedPage> take(std::size_t max_pages);
  /// Returns whether pages can be taken.
  bool has_arrived() const;
  /// Waits until a page has been read or no wanted page is left to read. Returns whether there is a page.
  bool wait();
  /// Returns, once, whether the bricks of the finest level for which nothing is stored have been found. `waits`: until they have.
  bool take_found_empty(bool waits);

 private:
  struct Impl;
  explicit PageLoader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::render
