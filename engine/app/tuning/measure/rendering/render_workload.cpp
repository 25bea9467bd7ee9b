// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/rendering/render_workload.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/format_number.h"
#include "engine/base/clock.h"
#include "render/extract/extract.h"
#include "render/quality/quality.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {
namespace {

constexpr double kSettled = 0.3;  // 1/255: the step is short enough if halving it changes less

render::RenderSettings converged_settings(double step) {
  render::RenderSettings s = render::converged_level(step);
  s.texel_format = render::TexelFormat::r32f;
  return s;
}

/// Renders the reference image: halves the step until the image converges or the time is over.
Outcome find_truth(RenderWorkload& eye, double seconds) {
  const std::int64_t start = now_ns();
  double step = eye.has_raycast ? 0.5 : 1;
  CATENA_TRY(eye.reference, render_image(*eye.renderer, eye.packet, converged_settings(step)));
  while (eye.has_raycast) {
    const std::int64_t begin = now_ns();
    CATENA_TRY(render::Image8 finer, render_image(*eye.renderer, eye.packet, converged_settings(step / 2)));
    eye.reference_error = render::measure_error(eye.reference, finer).rmse;
    eye.reference = std::move(finer);
    step /= 2;
    if (eye.reference_error < kSettled || step < 0.04 || 1e-3 * (ms_since(start) + 2 * ms_since(begin)) > seconds) break;
  }
  eye.reference_step = step;
  if (!eye.has_raycast) return Done{};
  // surfaces and layers are intersected exactly, whatever the step
  render::RenderSettings coarse = render::exact_level(4);
  coarse.jitter = true;
  CATENA_TRY(const render::Image8 picture, render_image(*eye.renderer, eye.packet, coarse));
  eye.has_raycast = !eye.packet.volumes.empty() || eye.reference_error > 0 || render::measure_error(picture, eye.reference).rmse > 0;
  if (!eye.has_raycast) eye.reference_error = kNotMeasured;
  return Done{};
}

/// Replaces the packet's grids by coarser ones; false if one of them cannot be subsampled.
bool on_level(render::FramePacket& packet, std::map<const field::ScalarGrid*, ResolutionLevels<field::ScalarGrid>>& levels, int level) {
  const auto put = [&](std::shared_ptr<const field::ScalarGrid>& grid) {
    if (!grid) return true;
    auto found = levels.find(grid.get());
    if (found == levels.end()) {
      if (grid->interpolation() != field::Interpolation::linear) return false;
      const auto made = make_resolution_levels(*grid);
      if (!made) return false;
      found = levels.emplace(grid.get(), *made).first;
    }
    grid = found->second.grids[level];
    return true;
  };
  bool all = true;
  for (render::VolumeItem& item : packet.volumes) all = put(item.grid) && (!item.color_by || put(item.color_by->grid)) && all;
  for (render::IsosurfaceItem& item : packet.isosurfaces) all = put(item.grid) && (!item.color_by || put(item.color_by->grid)) && all;
  for (render::SliceItem& item : packet.slices) all = put(item.grid) && all;
  return all;
}

}  // namespace

Result<ImageDiscretizationError> estimate_image_discretization_error(render::Renderer& renderer, const render::FramePacket& packet) {
  if (!draws_grids(packet)) return ImageDiscretizationError{kNotMeasured, "No grid is rendered: there is no discretization error."};
  std::map<const field::ScalarGrid*, ResolutionLevels<field::ScalarGrid>> levels;
  render::Image8 pictures[3];
  for (int level = 0; level < 3; ++level) {
    render::FramePacket coarse = packet;
    if (!on_level(coarse, levels, level))
      return ImageDiscretizationError{kNotMeasured,
                                      "The discretization error is not known: a grid has fewer than nine voxels along an axis, too many "
                                      "for a copy, or is a label map."};
    CATENA_TRY(pictures[level], render_image(renderer, coarse, converged_settings(0.5 / (1 << level))));
  }
  const double at_2h = render::measure_error(pictures[1], pictures[0]).rmse, at_4h = render::measure_error(pictures[2], pictures[0]).rmse;
  const ExtrapolatedError e = extrapolate_from_differences(at_2h, at_4h);
  return ImageDiscretizationError{e.error,
                                  fmt::format("from the images of every 2nd voxel (difference {}) and every 4th ({}); {}",
                                              format_number(at_2h, 3), format_number(at_4h, 3), describe_order(e)),
                                  e.is_converged};
}

bool draws_grids(const render::FramePacket& packet) {
  return !packet.volumes.empty() || !packet.isosurfaces.empty() || !packet.slices.empty();
}

Point make_point(const CandidateSetting& t, const render::ImageError& error, const render::RenderStats& stats) {
  return {t.setting,
          t.config_text,
          t.series,
          error.rmse,
          kNotMeasured,
          {},
          static_cast<double>(stats.gpu_bytes),
          {error.p999, 100 * error.thin_retained, 100 * error.min_thin_retained}};
}

Result<render::Image8> render_image(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings) {
  CATENA_CHECK(renderer.draw(packet, settings));
  return renderer.read_back();
}

TimedRun make_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings) {
  return [&renderer, &packet, settings]() -> Result<double> {
    const auto now = renderer.device().info().is_cpu() ? process_cpu_ns : now_ns;
    const std::int64_t start = now();
    CATENA_CHECK(renderer.draw(packet, settings));
    return 1e-6 * static_cast<double>(now() - start);
  };
}

bool needs_warmup(const LastRendered& last, const render::FramePacket& packet, const render::RenderSettings& settings) {
  if (!last.settings || last.width != packet.width || last.height != packet.height) return true;
  const render::RenderSettings& before = *last.settings;
  if (settings.texel_format != before.texel_format || settings.layout != before.layout ||
      settings.fast.has_value() != before.fast.has_value())
    return true;
  return settings.fast && (settings.fast->smooth_gradients != before.fast->smooth_gradients ||
                           settings.fast->spacing != before.fast->spacing || settings.fast->max_bytes != before.fast->max_bytes);
}

TimedRun make_interleaved_render_run(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                                     std::shared_ptr<LastRendered> last) {
  return [draw = make_render_run(renderer, packet, settings), &packet, settings, last = std::move(last)]() -> Result<double> {
    if (needs_warmup(*last, packet, settings)) CATENA_CHECK(draw());
    *last = {settings, packet.width, packet.height};
    return draw();
  };
}

Outcome add_rendering(Workload& subject) {
  const Effort& effort = subject.effort;
  CATENA_TRY(render::FramePacket packet, render::make_frame(subject.scene, effort.width, effort.height));
  packet = packet.first_view();
  packet.overlay = {};
  packet.cursors.clear();
  packet.background[3] = 0;
  if (!draws_grids(packet) && packet.meshes.empty() && packet.tubes.empty() && packet.spheres.empty() && packet.glyphs.empty()) {
    subject.skipped.emplace_back("Rendering: the scene has no visible items.");
    return Done{};
  }
  auto eye = std::make_unique<RenderWorkload>();
  auto renderer = render::Renderer::create({});
  if (!renderer) {
    subject.skipped.push_back("Rendering: " + renderer.error().message + ".");
    return Done{};
  }
  eye->renderer = std::move(*renderer);
  eye->packet = std::move(packet);
  eye->has_raycast = render::uses_raycast(eye->packet);
  const auto work = [&]() -> Outcome {
    CATENA_CHECK(find_truth(*eye, effort.rendering_s));
    CATENA_TRY(const ImageDiscretizationError floor, estimate_image_discretization_error(*eye->renderer, eye->packet));
    eye->discretization_error = floor.error;
    eye->discretization_error_method = floor.method;
    eye->discretization_error_converged = floor.is_converged;
    CATENA_CHECK(eye->renderer->draw(eye->packet, render::balanced_settings()));
    return Done{};
  };
  if (const Outcome done = work(); !done) {
    subject.skipped.push_back("Rendering: " + done.error().message + ".");
    return Done{};
  }
  eye->supports_fast_raycast = eye->renderer->can_draw_fast(eye->packet);
  subject.rendering = std::move(eye);
  return Done{};
}

Outcome measure_candidates(Workload& subject, const std::vector<CandidateSetting>& tried, Curve& curve) {
  RenderWorkload& eye = *subject.rendering;
  std::vector<TimedRun> repeats;
  std::set<std::string> too_long;
  const auto last = std::make_shared<LastRendered>();
  for (const CandidateSetting& t : tried) {
    if (too_long.contains(t.series)) continue;
    const TimedRun draw = make_render_run(*eye.renderer, eye.packet, t.settings);
    const std::int64_t start = now_ns();
    CATENA_CHECK(draw());
    const double seconds = 1e-3 * ms_since(start);
    CATENA_TRY(const render::Image8 picture, eye.renderer->read_back());
    const render::ImageError error = render::measure_error(picture, eye.reference);
    curve.points.push_back(make_point(t, error, eye.renderer->stats()));
    repeats.push_back(make_interleaved_render_run(*eye.renderer, eye.packet, t.settings, last));
    if (seconds > 0.2 * subject.effort.rendering_s) too_long.insert(t.series);
  }
  return time_points(curve, repeats, subject.effort.rendering_s, 15);
}

Curve make_rendering_curve(const Workload& subject, const std::string& id, const std::string& title, const std::string& what) {
  RenderWorkload& eye = *subject.rendering;
  Curve curve;
  curve.id = "eye-" + id;
  curve.title = title;
  curve.description = what;
  curve.error_name = "error of the image (RMSE, 1/255)";
  curve.time_name = eye.renderer->device().info().is_cpu() ? "ms of processor time per image" : "ms per image";
  curve.extra_columns = {"99.9 %, 1/255", "thin parts kept, %", "worst of the thin parts, %"};
  const bool by_rounding = !(eye.reference_error > render::kMinReportedRmse);
  curve.reference_error = by_rounding ? render::kMinReportedRmse : eye.reference_error;
  if (by_rounding) curve.reference_error_name = "the rounding error of 8 bits";
  const std::string minimum = fmt::format("errors below {}/255{} cannot be resolved", format_number(curve.reference_error),
                                          by_rounding ? ", the rounding error of 8 bits," : "");
  curve.reference = eye.has_raycast
                        ? fmt::format(
                              "the image of exact rays with steps of {:g} voxel and 32-bit texels; it differs from one with steps of "
                              "{:g} voxel by {}/255; {}",
                              eye.reference_step, 2 * eye.reference_step, format_number(eye.reference_error), minimum)
                        : "the image itself, because nothing in it is sampled along rays; " + minimum;
  curve.discretization_error = eye.discretization_error;
  if (!eye.discretization_error_converged) curve.discretization_error_name += ", at least";
  curve.discretization_error_method = eye.discretization_error_method;
  return curve;
}

}  // namespace catena::app::tuning
