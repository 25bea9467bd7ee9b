/// A picture of any size as bands of whole rows, from the top: tile by tile (render/frame/tiles.h), supersampled if asked, so that
/// memory is bounded by one row of tiles.
///   antialias N: a pixel is the mean of its N x N samples, premultiplied display values (a box filter)
///   several eyes that are packed into one picture: in one piece and one band, without antialiasing, depth or ids
///   depth: the nearest of the samples; id: that of the nearest sample
/// Frame thread.
#pragma once
#include <functional>

#include "render/frame/tiles.h"
#include "render/passes/renderer.h"

namespace catena::render {

/// What the bands hold.
struct BandChannels {
  bool bytes = true;    ///< 8 bits a value
  bool floats = false;  ///< display values before rounding
  bool depth = false, ids = false;
};

/// `height` rows from row `y` on. LineSegment alpha.
struct Band {
  std::uint32_t width = 0, y = 0, height = 0;
  std::vector<std::uint8_t> bytes;  ///< RGBA
  std::vector<float> floats;        ///< RGBA
  std::vector<float> depth;         ///< along the view axis, world units; infinite where nothing opaque is seen
  std::vector<std::uint32_t> ids;   ///< 0: nothing opaque
};

/// Milliseconds of drawing all of them, without read-back.
struct RenderTimes {
  double wall_ms = 0;    ///< start to fence
  double render_ms = 0;  ///< as RenderTimer counts
};

/// An error is the renderer's, or the one that `take` returned; `take`
/// is also asked, with a band of height 0, after every tile: an error ends the work. Without `take`
/// nothing is read back.
Result<RenderTimes> render_tiled(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings, const TilePlan& plan,
                                 const BandChannels& wants, const std::function<Outcome(const Band&)>& take);

}  // namespace catena::render
