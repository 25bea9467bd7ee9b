// SPDX-License-Identifier: MIT
/// Page table of a volume that is larger than the device's memory: which page of which level stands for each part of the finest level.
///   page    one brick of one level (engine/field/bricks/brick_source.h), in a slot of the device's pool
///   entry   one per brick of the finest level: the slot of the finest page in the pool that covers it, or that it is homogeneous
/// The coarsest level stays in the pool, so that every entry has a page. What rays visited in the last image decides which pages are
/// loaded. If the visited pages do not fit, all are taken from a coarser level. No device is needed. Frame thread.
///   word, 32 bits: bits 0..20 the slot (x, y, z, 7 bits each), bits 21..24 the level, or, if bit 31 is set (homogeneous), bits 0..15 the
///   code; bits 25..30 as the distance in HomogeneousMap (brick_map.h), in entries, at most 63
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/field/bricks/brick_source.h"

namespace catena::render {

/// Voxels along the edge of a page, and nodes along the edge of its cells.
inline constexpr int kPageEdge = field::kBrickEdge, kPageNodes = kPageEdge + 1;
inline constexpr std::size_t kMaxPageLevels = 16;        ///< four bits of a word; MAX_PAGE_LEVELS of the shaders
inline constexpr std::uint32_t kMaxPageSlotsAxis = 127;  ///< slots per axis; seven bits of a word

/// Level of which pages are made: a voxel is 2^shift finest voxels wide.
struct PageLevel {
  int source_level = 0;
  field::Index3 shift;           ///< per axis
  field::Index3 size, counts;    ///< voxels and pages per axis
  Vec3 scale{1.0}, offset{0.0};  ///< position in this level = scale * position in the finest level + offset
};

/// Returns the levels of which pages can be made, the finest first: those whose voxels are powers of two of the finest ones, parallel to
/// them.
std::vector<PageLevel> page_levels(const field::BrickSource& source);
/// Returns the number of pages of all levels.
std::uint64_t page_count(const std::vector<PageLevel>& levels);

/// A page: a brick of a level.
struct PageId {
  std::uint32_t level = 0;  ///< index in the levels of the table
  field::Index3 brick;
  bool operator==(const PageId&) const = default;
};

/// Look of a homogeneous part: kind as in CodeAppearance::classify(), not 0, and code.
struct PageLook {
  std::uint16_t kind = 0;  ///< 0: varies, or is not known
  std::uint16_t code = 0;
};

/// What to load for the next image.
struct PagePlan {
  std::vector<PageId> loads;  ///< pages that are missing, those that most of the image sees first
  std::size_t visible = 0;    ///< pages that the image would show
  std::size_t resident = 0;   ///< those of them that are in the pool
  int bias = 0;               ///< > 0: the visited pages do not fit; levels finer than this one are not shown
};

/// Page table with the assignment of pages to slots.
class PageTable {
 public:
  /// `slots`: slots of the pool per axis; they hold at least the pages of the last level and one more.
  PageTable(std::vector<PageLevel> levels, const std::array<std::uint32_t, 3>& slots);

  const std::vector<PageLevel>& levels() const { return levels_; }
  /// Returns the number of entries along each axis.
  const field::Index3& counts() const { return levels_.front().counts; }
  /// Returns the entries' words, x fastest.
  std::span<const std::uint32_t> words() const { return words_; }
  /// Returns whether words have changed since the last call.
  bool take_changed() { return std::exchange(has_changed_, false); }
  /// Returns the pages of the last level, which are always in the pool.
  std::vector<PageId> root_pages() const;

  /// Sets the looks of all entries.
  void set_looks(const std::function<PageLook(const field::Index3& entry)>& look);
  /// Removes all pages.
  void clear();
  /// Plans the loads. `visits`: weight of the rays that visited each entry. `desired_level`: finest level that the image needs for an
  /// entry. `stepwise`: each entry is refined level by level, so that all of the image becomes better at the same time.
  PagePlan plan(std::span<const std::uint32_t> visits, const std::function<int(const field::Index3& entry)>& desired_level, bool stepwise);
  /// Assigns a slot to a page, that of the page which has not been seen for longest. Returns the slot; nullopt: all pages are needed.
  std::optional<std::size_t> place(const PageId& page);
  /// Returns the position of a slot, in slots.
  std::array<std::uint32_t, 3> position(std::size_t slot) const;
  /// Returns whether a page is in the pool.
  bool is_resident(const PageId& page) const { return resident_.contains(key_of(page)); }

 private:
  struct Slot {
    std::optional<PageId> page;
    std::uint64_t last_needed = 0;
    bool is_pinned = false;
  };
  static constexpr std::uint8_t kNone = 255;

  std::uint64_t key_of(const PageId& page) const;
  PageId ancestor(const field::Index3& entry, std::uint32_t level) const;
  void for_each_entry(const PageId& page, const std::function<void(std::size_t)>& body) const;
  void remove(std::size_t slot);
  void write_word(std::size_t entry);

  std::vector<PageLevel> levels_;
  std::array<std::uint32_t, 3> slots_per_axis_;
  std::vector<Slot> slots_;
  std::unordered_map<std::uint64_t, std::size_t> resident_;  ///< slot of each page
  std::vector<std::uint32_t> words_;
  std::vector<std::uint8_t> shown_level_;  ///< per entry; kNone: no page covers it
  std::vector<PageLook> looks_;            ///< per entry
  std::vector<std::uint8_t> distances_;    ///< per entry
  std::uint64_t clock_ = 2;                ///< number of plans, times two
  bool has_changed_ = true;
};

}  // namespace catena::render
