/// How the pictures of several views make one. Every view is drawn with the packet's width and height W x H; with n views:
///   single             the first view                                W x H
///   side_by_side       from left to right                            n W x H
///   side_by_side_half  the same, n pixels of a row averaged to one   n (W / n) x H      (pixels beyond n (W / n) are dropped)
///   top_bottom         the first view on top                         W x n H
///   top_bottom_half    n pixels of a column averaged to one          W x n (H / n)
///   anaglyph           two views; red from the first eye, cyan from the second, by Dubois' matrices for LCD screens, in linear light
///   anaglyph_gray      the same of the luminance
///   rows, columns, checkerboard   pixel (x, y) from view y, x, x + y modulo n
#pragma once
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// The ways to pack.
enum class Packing {
  single,
  side_by_side,
  side_by_side_half,
  top_bottom,
  top_bottom_half,
  anaglyph,
  anaglyph_gray,
  rows,
  columns,
  checkerboard
};

/// Pixels of a picture.
struct PackedSize {
  std::uint64_t width = 0, height = 0;  ///< pixels
};

/// Of the finished picture; 0 where a view has fewer pixels than there are views.
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
    case Packing::top_bottom_half:
      size.height = views * (height / views);
      break;
    default:
      break;
  }
  return size;
}

/// Of each view, so that the packed picture fills W x H: the inverse, at least 1 x 1.
inline PackedSize view_size(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height) {
  PackedSize size{width, height};
  if (packing == Packing::side_by_side) size.width = std::max<std::uint64_t>(1, width / views);
  if (packing == Packing::top_bottom) size.height = std::max<std::uint64_t>(1, height / views);
  return size;
}

/// Each eye has a part of the picture for itself.
inline bool has_separate_views(Packing packing) { return packing >= Packing::side_by_side && packing <= Packing::top_bottom_half; }

/// Whether a finished picture has to be shown pixel by pixel.
inline bool is_interlaced(Packing packing) {
  return packing == Packing::rows || packing == Packing::columns || packing == Packing::checkerboard;
}

/// A list that copies share until one of them changes it: frame packets and passes keep long lines without holding them twice. Elements are
/// read only; a list changes by being assigned, or grown by its one owner. Reading is safe on any thread.
template <class T>
class SharedList {
 public:
  /// What it holds.
  using value_type = T;
  SharedList() = default;
  /// Of these items.
  SharedList(std::initializer_list<T> items) : SharedList(std::vector<T>(items)) {}
  /// Of these items, without a copy.
  SharedList(std::vector<T> items) : items_(items.empty() ? nullptr : std::make_shared<std::vector<T>>(std::move(items))) {}

  /// The items.
  const std::vector<T>& list() const {
    static const std::vector<T> none;
    return items_ ? *items_ : none;
  }
  /// As std::vector has it.
  auto begin() const { return list().begin(); }
  /// As std::vector has it.
  auto end() const { return list().end(); }
  /// As std::vector has it.
  std::size_t size() const { return list().size(); }
  /// As std::vector has it.
  bool empty() const { return list().empty(); }
  /// As std::vector has it; `i` below size().
  const T& operator[](std::size_t i) const { return list()[i]; }
  /// As std::vector has it; the list is not empty.
  const T& front() const { return list().front(); }
  /// As std::vector has it; the list is not empty.
  const T& back() const { return list().back(); }
  /// Appends; a list that is shared is copied first.
  void push_back(const T& item) { mutable_list().push_back(item); }
  /// One list in memory: nothing has to be compared.
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
