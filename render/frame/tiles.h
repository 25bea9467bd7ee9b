/// A large or supersampled picture as tiles: parts of one view, each drawn as a picture of its own (View::window). Sizes in samples:
/// pixels times `antialias`. Tiles begin at multiples of kTileAlignment, so that every lattice of rays that a raycast interpolates on falls
/// on the same places in a tile as in the whole; `margin` samples around a tile are drawn and dropped. Pure functions, any thread.
#pragma once
#include <cstdint>
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

inline constexpr std::uint32_t kTileAlignment = 8;
/// What interpolation and refinement on lattices of 4 and 2 look at, and a little more.
inline constexpr std::uint32_t kRayGridMargin = 40;
/// Pictures of up to so many samples, and of sides that the device can hold, are drawn in one piece.
inline constexpr std::uint64_t kMaxUntiledSamples = std::uint64_t(4) << 20;

/// A rectangle of samples: kept, and drawn around it.
struct TileArea {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
  std::uint32_t render_x = 0, render_y = 0, render_width = 0, render_height = 0;
};

struct TilePlan {
  std::uint32_t width = 0, height = 0;  ///< of the picture, pixels
  std::uint32_t antialias = 1;          ///< samples a pixel, each way
  /// Of a tile, in samples; multiples of kTileAlignment and of antialias where there is more than one.
  std::uint32_t tile_width = 0, tile_height = 0;
  std::uint32_t margin = 0;

  std::uint32_t samples_x() const { return width * antialias; }
  std::uint32_t samples_y() const { return height * antialias; }
  std::uint32_t columns() const { return (samples_x() + tile_width - 1) / tile_width; }
  std::uint32_t rows() const { return (samples_y() + tile_height - 1) / tile_height; }
  std::uint32_t count() const { return columns() * rows(); }
  TileArea area(std::uint32_t column, std::uint32_t row) const;
};

/// `tile`: the side that was asked for, in samples (0: chosen here). `most`: the longest side of an image on the device.
TilePlan plan_tiles(std::uint32_t width, std::uint32_t height, std::uint32_t antialias, std::uint32_t tile, bool lattices,
                    std::uint32_t most);

/// The packet of one tile: its size, its window and the place of what lies in pixels of the picture (Overlay::frame). `packet` is that of
/// the whole picture.
FramePacket make_tile_packet(const FramePacket& packet, const TilePlan& plan, const TileArea& area);

}  // namespace catena::render
