// SPDX-License-Identifier: MIT
/// Threads that read pages of a paged grid and encode them for the fast raycast. Frames do not wait for them. A page that cannot be read
/// is tried again after a second.
///   codes   kPageNodes^3 nodes of a page: its own voxels and the first ones of the pages behind it along each axis; at the end of the
///           level the last voxel again
///   words   as in PackedAtlas: code of a node | code of its neighbor along x << 8; kPageEdge x kPageNodes x kPageNodes of them
/// Any thread may call the functions.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/field/bricks/paged_grid.h"
#include "render/residency/page_table.h"
#include "render/residency/resident_grid.h"
#include "render/residency/voxel_block.h"

namespace catena::render {

/// Sub-bricks of kBrickSize^3 cells along the edge of a page.
inline constexpr int kPageBricks = kPageEdge / kBrickSize;
inline constexpr std::size_t kPageWords = std::size_t(kPageEdge) * kPageNodes * kPageNodes;

/// Ranges of the sub-bricks' nodes, x fastest.
using PageRanges = std::array<CodeRange, std::size_t(kPageBricks) * kPageBricks * kPageBricks>;

/// A page as it is stored in the pool.
struct EncodedPage {
  PageId id;
  std::vector<std::uint16_t> words;  ///< x fastest
  PageRanges ranges;
};

/// Reads a page and encodes it. Blocks. The Error is a complete message.
Result<EncodedPage> encode_page(const field::PagedGrid& grid, const std::vector<PageLevel>& levels, const PageId& id,
                                const CodeScale& codes);

/// Reader threads of one grid.
class PageLoader {
 public:
  static constexpr int kThreads = 2;

  /// Starts the threads. An Error if a thread cannot be created.
  static Result<std::unique_ptr<PageLoader>> start(std::shared_ptr<const field::PagedGrid> grid, std::vector<PageLevel> levels);
  ~PageLoader();
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;

  /// Sets the pages to read, the most urgent first, and the codes. Pages that were read with other codes are dropped.
  void set_wanted(std::vector<PageId> wanted, const CodeScale& codes);
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
