// SPDX-License-Identifier: MIT
/// Tiled rendering of a large or supersampled image: parts of one view, each rendered as an image of its own (View::window). Sizes are in
/// samples: pixels times `antialias`. Tiles begin at multiples of kTileAlignment, so that every ray grid on which a raycast interpolates
/// has the same positions in a tile as in the whole image; `margin` samples around a tile are rendered and dropped. Pure functions, any
/// thread.
#pragma once
#include <cstdint>
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

/// Alignment of tile origins, samples.
inline constexpr std::uint32_t kTileAlignment = 8;
/// Margin that covers what interpolation and refinement on ray grids of spacing 4 and 2 read, with some reserve, samples.
inline constexpr std::uint32_t kRayGridMargin = 40;
/// Images of at most this many samples, whose sides the device supports, are rendered in one piece.
inline constexpr std::uint64_t kMaxUntiledSamples = std::uint64_t(4) << 20;

/// Rectangle of samples that a tile contributes (x, y, width, height) and the larger rectangle that is rendered for it (render_*).
struct TileArea {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
  std::uint32_t render_x = 0, render_y = 0, render_width = 0, render_height = 0;
};

/// Division of an image into tiles.
struct TilePlan {
  std::uint32_t width = 0, height = 0;  ///< size of the image, pixels
  std::uint32_t antialias = 1;          ///< samples per pixel in each direction
  /// Tile size in samples; with more than one tile, a multiple of kTileAlignment and of `antialias`.
  std::uint32_t tile_width = 0, tile_height = 0;
  std::uint32_t margin = 0;  ///< width of the border that is rendered around a tile and dropped, samples

  std::uint32_t samples_x() const { return width * antialias; }
  std::uint32_t samples_y() const { return height * antialias; }
  std::uint32_t columns() const { return (samples_x() + tile_width - 1) / tile_width; }
  std::uint32_t rows() const { return (samples_y() + tile_height - 1) / tile_height; }
  std::uint32_t count() const { return columns() * rows(); }
  /// Returns the rectangles of the tile, clipped to the image.
  TileArea area(std::uint32_t column, std::uint32_t row) const;
};

/// Plans the tiles of an image of width x height pixels. `tile`: requested tile side in samples (0: chosen here). `needs_ray_grids`:
/// whether rays are interpolated on ray grids, which needs a margin. `max_side`: longest image side of the device, samples, at least 2048.
TilePlan plan_tiles(std::uint32_t width, std::uint32_t height, std::uint32_t antialias, std::uint32_t tile, bool needs_ray_grids,
                    std::uint32_t max_side);

/// Returns the packet of one tile: its size, its window, and the position of the tile for overlay items that are placed in pixels of the
/// whole image (Overlay::frame). `packet` is that of the whole image.
FramePacket make_tile_packet(const FramePacket& packet, const TilePlan& plan, const TileArea& area);

}  // namespace catena::render
