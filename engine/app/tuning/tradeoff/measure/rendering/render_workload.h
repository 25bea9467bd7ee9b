/// The eye's picture and its measure. Errors are of render/image/image_error.h: over covered pixels, in 1/255, against the converged
/// picture. Frame thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/timing.h"
#include "engine/app/tuning/tradeoff/measure/workload.h"
#include "render/image/image_error.h"

namespace catena::app::tradeoff {

/// Makes the renderer, the packet, the converged picture and the floor. An Error is the scene's (exit code 2). Where there is no device,
/// or nothing to draw, there is no eye, and a sentence in left_out.
Outcome add_rendering(Workload& subject);

/// A picture as it is drawn with these settings.
Result<render::Image8> render_image(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// Milliseconds of drawing: of a processor's time where the driver draws with it, else of wall time.
TimedRun make_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// What a renderer drew last, of pictures that it draws in turns.
struct LastRendered {
  std::optional<render::RenderSettings> settings;  ///< none: nothing yet
  std::uint32_t width = 0, height = 0;
};
/// Whether a picture needs other voxels, targets or another way of marching on the device than the last.
bool needs_warmup(const LastRendered& last, const render::FramePacket& packet, const render::RenderSettings& settings);

/// The same in turns with others on one renderer, which share `last`: a picture that needs others than the last is drawn once before,
/// which does not count.
TimedRun make_interleaved_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                                     std::shared_ptr<LastRendered> last);

/// The data's own error in a picture: that of the same data with every 2nd and every 4th voxel, extrapolated. Steps of one length in the
/// world.
struct ImageDiscretizationError {
  double error = kNotMeasured;  ///< RMSE, 1/255
  std::string method;
  bool is_converged = true;  ///< false: it is the least that it can be
};
Result<ImageDiscretizationError> estimate_image_discretization_error(render::Renderer& renderer, const render::FramePacket& packet);

bool draws_grids(const render::FramePacket& packet);

/// A setting to try.
struct CandidateSetting {
  std::string setting, config_text, series;
  render::RenderSettings settings;
};

/// What was measured of it, but for the time; `more` as eye_curve names it.
Point make_point(const CandidateSetting& tried, const render::ImageError& error, const render::RenderStats& stats);

/// Draws them, the cheapest first, measures each against the converged picture, and times them in turns. What one picture alone would take
/// more than a fifth of the curve's time for is left out, with all that follows it in its series.
Outcome measure_candidates(Workload& subject, const std::vector<CandidateSetting>& tried, Curve& curve);

/// What all curves of the eye have: names, reference, floor.
Curve make_rendering_curve(const Workload& subject, const std::string& id, const std::string& title, const std::string& what);

}  // namespace catena::app::tradeoff
