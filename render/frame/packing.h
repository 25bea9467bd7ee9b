// SPDX-License-Identifier: MIT
/// Stereo composition: how the images of several views are packed into one. Every view is rendered at the packet's width and height W x H;
/// with n views:
///   single             the first view                                W x H
///   side_by_side       from left to right                            n W x H
///   side_by_side_half  the same, n pixels of a row averaged to one   n (W / n) x H      (pixels beyond n (W / n) are dropped)
///   top_bottom         the first view on top                         W x n H
///   top_bottom_half    n pixels of a column averaged to one          W x n (H / n)
///   anaglyph           two views; red from the first eye, cyan from the second, by Dubois' matrices for LCD screens, in linear light
///   anaglyph_gray      the same of the luminance
///   grid               four views: the second, the first, the third, the fourth, in two rows              2 W x 2 H
///   rows, columns, checkerboard   pixel (x, y) is taken from view y, x or x + y, modulo n
#pragma once
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// Packed layouts of the views; see the table above.
enum class Packing {
  single,
  side_by_side,
  side_by_side_half,
  top_bottom,
  top_bottom_half,
  grid,
  anaglyph,
  anaglyph_gray,
  rows,
  columns,
  checkerboard
};

/// Image size.
struct PackedSize {
  std::uint64_t width = 0, height = 0;  ///< pixels
};

/// Returns the size of the packed image of `views` views of width x height; 0 in a direction in which a view has fewer pixels than there
/// are views.
inline PackedSize packed_size(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height) {
  CATENA_ASSERT(views > 0);
  PackedSize size{width, height};
  switch (packing) {
    case Packing::side_by_side:
      size.width *= views;
      break;
    case Packing::side_by_side_half:
      size.width = views * (width / views);
      break;
    case Packing::top_bottom:
      size.height *= views;
      break;
    case Packing::grid:
      size.width *= 2;
      size.height *= 2;
      break;
    case Packing::top_bottom_half:
      size.height = views * (height / views);
      break;
    default:
      break;
  }
  return size;
}

/// Inverse of packed_size(): returns the size of each view, at least 1 x 1, so that the packed image fills width x height.
inline PackedSize view_size(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height) {
  PackedSize size{width, height};
  if (packing == Packing::side_by_side) size.width = std::max<std::uint64_t>(1, width / views);
  if (packing == Packing::top_bottom) size.height = std::max<std::uint64_t>(1, height / views);
  if (packing == Packing::grid) size = {std::max(1u, width / 2), std::max(1u, height / 2)};
  return size;
}

/// Returns whether each view has its own part of the packed image.
inline bool has_separate_views(Packing packing) { return packing >= Packing::side_by_side && packing <= Packing::grid; }

/// Returns whether the packed image must be displayed without scaling, pixel by pixel.
inline bool is_interlaced(Packing packing) {
  return packing == Packing::rows || packing == Packing::columns || packing == Packing::checkerboard;
}

/// Copy-on-write list: copies share one vector until one of them changes, so that frame packets and passes hold long lists only once.
/// Elements are read-only; a list changes only by assignment or push_back(). Concurrent reading is safe on any thread.
template <class T>
class SharedList {
 public:
  /// Element type.
  using value_type = T;
  SharedList() = default;
  /// Constructs the list from these items.
  SharedList(std::initializer_list<T> items) : SharedList(std::vector<T>(items)) {}
  /// Constructs the list from these items, without a copy if they are moved in.
  SharedList(std::vector<T> items) : items_(items.empty() ? nullptr : std::make_shared<std::vector<T>>(std::move(items))) {}

  /// Returns the items.
  const std::vector<T>& list() const {
    static const std::vector<T> none;
    return items_ ? *items_ : none;
  }
  /// As in std::vector.
  auto begin() const { return list().begin(); }
  /// As in std::vector.
  auto end() const { return list().end(); }
  /// As in std::vector.
  std::size_t size() const { return list().size(); }
  /// As in std::vector.
  bool empty() const { return list().empty(); }
  /// As in std::vector; `i` must be less than size().
  const T& operator[](std::size_t i) const { return list()[i]; }
  /// As in std::vector; the list must not be empty.
  const T& front() const { return list().front(); }
  /// As in std::vector; the list must not be empty.
  const T& back() const { return list().back(); }
  /// Appends an item; a shared list is copied first.
  void push_back(const T& item) { mutable_list().push_back(item); }
  /// Returns whether both lists share one vector in memory, which makes a comparison of the items unnecessary.
  bool shares_storage(const SharedList& other) const { return items_ == other.items_; }
  friend bool operator==(const SharedList& a, const SharedList& b) { return a.shares_storage(b) || a.list() == b.list(); }

 private:
  std::vector<T>& mutable_list() {
    if (!items_ || items_.use_count() > 1) items_ = std::make_shared<std::vector<T>>(list());
    return *items_;
  }
  std::shared_ptr<std::vector<T>> items_;
};

}  // namespace catena::render
