// SPDX-License-Identifier: MIT
/// Rendering of an image of any size in bands of whole rows, from the top: tile by tile (render/frame/tiles.h), supersampled if requested,
/// so that memory is bounded by one row of tiles.
///   antialias N: a pixel is the mean of its N x N samples, premultiplied display values (a box filter)
///   stereo composition: in one piece and one band, without antialiasing, depth or ids
///   depth: the nearest of the samples; id: that of the nearest sample
/// Frame thread.
#pragma once
#include <functional>

#include "render/frame/tiles.h"
#include "render/passes/renderer.h"

namespace catena::render {

/// Channels of the bands.
struct BandChannels {
  bool bytes = true;    ///< 8 bits per value
  bool floats = false;  ///< display values before rounding
  /// Depth and ids of the nearest opaque surface.
  bool depth = false, ids = false;
};

/// `height` rows from row `y` on. Straight alpha. Channels that were not requested are empty.
struct Band {
  std::uint32_t width = 0, y = 0, height = 0;
  std::vector<std::uint8_t> bytes;  ///< RGBA
  std::vector<float> floats;        ///< RGBA
  std::vector<float> depth;         ///< distance along the view axis, world units; infinite where there is no opaque surface
  std::vector<std::uint32_t> ids;   ///< 0: no opaque object
};

/// Milliseconds of rendering all tiles, without read-back.
struct RenderTimes {
  double wall_ms = 0;    ///< from start to fence
  double render_ms = 0;  ///< time measured by RenderTimer
};

/// Renders the complete image (RenderSettings::waits_for_pages) and passes it to `on_band` band by band. An Error is the renderer's or the
/// one returned by `on_band`, which is also called with a band of height 0 after every tile: returning an Error ends the work. Without
/// `on_band` nothing is read back.
Result<RenderTimes> render_tiled(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings, const TilePlan& plan,
                                 const BandChannels& requested, const std::function<Outcome(const Band&)>& on_band);

}  // namespace catena::render
