/// The eye's picture and its measure. Errors are of render/image/measure.h: over covered pixels, in 1/255, against the converged
/// picture. Frame thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tradeoff/measure/subject.h"
#include "engine/app/tradeoff/measure/timing.h"
#include "render/image/measure.h"

namespace catena::app::tradeoff {

/// Makes the renderer, the packet, the converged picture and the floor. An Error is the scene's (exit code 2). Where there is no device,
/// or nothing to draw, there is no eye, and a sentence in left_out.
Outcome open_eye(Subject& subject);

/// A picture as it is drawn with these settings.
Result<render::Picture> picture_of(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// Milliseconds of drawing: of a processor's time where the driver draws with it, else of wall time.
Repeat drawing_of(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// What a renderer drew last, of pictures that it draws in turns.
struct LastDrawn {
  std::optional<render::RenderSettings> settings;  ///< none: nothing yet
  std::uint32_t width = 0, height = 0;
};
/// Whether a picture needs other voxels, targets or another way of marching on the device than the last.
bool needs_others(const LastDrawn& last, const render::FramePacket& packet, const render::RenderSettings& settings);

/// The same in turns with others on one renderer, which share `last`: a picture that needs others than the last is drawn once before,
/// which does not count.
Repeat drawing_in_turns(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                        std::shared_ptr<LastDrawn> last);

/// The data's own error in a picture: that of the same data with every 2nd and every 4th voxel, extrapolated. Steps of one length in the
/// world.
struct PictureFloor {
  double error = kNotMeasured;  ///< RMSE, 1/255
  std::string from;
  bool settled = true;  ///< false: it is the least that it can be
};
Result<PictureFloor> picture_floor(render::Renderer& renderer, const render::FramePacket& packet);

bool draws_grids(const render::FramePacket& packet);

/// A setting to try.
struct Tried {
  std::string setting, write, series;
  render::RenderSettings settings;
};

/// What was measured of it, but for the time; `more` as eye_curve names it.
Point point_of(const Tried& tried, const render::PictureError& error, const render::RenderStats& stats);

/// Draws them, the cheapest first, measures each against the converged picture, and times them in turns. What one picture alone would take
/// more than a fifth of the curve's time for is left out, with all that follows it in its series.
Outcome measure_settings(Subject& subject, const std::vector<Tried>& tried, Curve& curve);

/// What all curves of the eye have: names, reference, floor.
Curve eye_curve(const Subject& subject, const std::string& id, const std::string& title, const std::string& what);

}  // namespace catena::app::tradeoff
