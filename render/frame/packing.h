/// How the pictures of several views make one. Every view is drawn with the packet's width and height W x H; with n views:
///   single             the first view                                W x H
///   side_by_side       from left to right                            n W x H
///   side_by_side_half  the same, n pixels of a row averaged to one   n (W / n) x H      (pixels beyond n (W / n) are dropped)
///   top_bottom         the first view on top                         W x n H
///   top_bottom_half    n pixels of a column averaged to one          W x n (H / n)
///   anaglyph           two views; red from the first eye, cyan from the second, by Dubois' matrices for LCD screens, in linear light
///   anaglyph_grey      the same of the luminance
///   rows, columns, checkerboard   pixel (x, y) from view y, x, x + y modulo n
#pragma once
#include <algorithm>
#include <cstdint>

#include "engine/base/assert.h"

namespace catena::render {

enum class Packing {
  single,
  side_by_side,
  side_by_side_half,
  top_bottom,
  top_bottom_half,
  anaglyph,
  anaglyph_grey,
  rows,
  columns,
  checkerboard
};

struct PackedSize {
  std::uint64_t width = 0, height = 0;
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

/// Whether a finished picture has to be shown pixel by pixel.
inline bool is_interlaced(Packing packing) {
  return packing == Packing::rows || packing == Packing::columns || packing == Packing::checkerboard;
}

}  // namespace catena::render
