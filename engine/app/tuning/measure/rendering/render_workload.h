// SPDX-License-Identifier: MIT
/// The rendered image of a workload and the measurement of its settings. Errors are those of render/image/image_error.h: over the covered
/// pixels, in 1/255, against the reference image. Frame thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/measure/timing.h"
#include "engine/app/tuning/measure/workload.h"
#include "render/image/image_error.h"

namespace catena::app::tuning {

/// Creates the renderer, the packet and the reference image, and estimates the discretization error. An Error is a fault of the scene (exit
/// code 2). If there is no GPU, nothing to render, or rendering fails, Workload::rendering stays null and Workload::skipped gets a
/// sentence.
Outcome add_rendering(Workload& subject);

/// Renders the packet with these settings and reads the image back. An Error if the GPU fails.
Result<render::Image8> render_image(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// Returns a timed run of rendering, in milliseconds: processor time if the driver renders on the processor, else wall time. `renderer` and
/// `packet` must outlive it.
TimedRun make_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings);

/// The last frame of a renderer that alternates between settings.
struct LastRendered {
  std::optional<render::RenderSettings> settings;  ///< None: nothing rendered so far.
  std::uint32_t width = 0, height = 0;
};
/// Returns whether a frame needs other voxels, render targets or another ray casting method on the GPU than the last one.
bool needs_warmup(const LastRendered& last, const render::FramePacket& packet, const render::RenderSettings& settings);

/// Returns a timed run like make_render_run() for runs interleaved on one renderer, which share `last`: a frame that needs a warm-up is
/// first rendered once without being timed.
TimedRun make_interleaved_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                                     std::shared_ptr<LastRendered> last);

/// Discretization error of an image: rendered from every 2nd and every 4th voxel of the data and extrapolated, with rays stepping by the
/// same length in world units.
struct ImageDiscretizationError {
  double error = kNotMeasured;  ///< RMSE, 1/255
  std::string method;
  bool is_converged = true;  ///< False: `error` is a lower bound.
};
/// Estimates it. `error` is kNotMeasured if no grid is rendered or a grid cannot be subsampled; `method` states why. An Error if the GPU
/// fails.
Result<ImageDiscretizationError> estimate_image_discretization_error(render::Renderer& renderer, const render::FramePacket& packet);

/// Returns whether the packet has volumes, isosurfaces or slices.
bool draws_grids(const render::FramePacket& packet);

/// A setting to measure.
/// Label, text for the scene file, and series, as in Point.
struct CandidateSetting {
  std::string setting, config_text, series;
  render::RenderSettings settings;
};

/// Returns the point of a setting without its time; its extra_values are those named by make_rendering_curve().
Point make_point(const CandidateSetting& tried, const render::ImageError& error, const render::RenderStats& stats);

/// Renders the settings, the cheapest first, measures each against the reference image, and times them interleaved. If a single frame takes
/// more than a fifth of the curve's time, all later settings of its series are skipped.
Outcome measure_candidates(Workload& subject, const std::vector<CandidateSetting>& tried, Curve& curve);

/// Returns a curve without points, with what all rendering curves share: names, reference and discretization error.
Curve make_rendering_curve(const Workload& subject, const std::string& id, const std::string& title, const std::string& what);

}  // namespace catena::app::tuning
