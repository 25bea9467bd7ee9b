// SPDX-License-Identifier: MIT
/// Memory budget of the device: grids that do not fit are rendered at 1/2, 1/4 or 1/8 of their resolution.
#include <fmt/format.h>

#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {

Result<std::vector<Curve>> measure_memory_budget(Workload& subject) {
  RenderWorkload& eye = *subject.rendering;
  if (!draws_grids(eye.packet)) {
    subject.skipped.emplace_back("Memory budget: no grid is rendered.");
    return std::vector<Curve>{};
  }
  Curve curve =
      make_rendering_curve(subject, "budget", "Memory limit of the graphics device",
                           "The same image (exact rays, steps of half a voxel) with decreasing limits on GPU memory: grids that do "
                           "not fit are rendered at a lower resolution.");
  curve.bytes_name = "bytes on the device";
  curve.cost = CostKind::bytes;
  curve.extra_columns.emplace_back("divisor of the resolution");
  const render::RenderSettings settings = render::exact_level(0.5);
  CATENA_CHECK(eye.renderer->draw(eye.packet, settings));
  const double whole = static_cast<double>(eye.renderer->device().counters().allocated_bytes);
  std::vector<std::unique_ptr<render::Renderer>> renderers;
  std::vector<TimedRun> repeats;
  for (const double share : {0.0, 0.8, 0.6, 0.4, 0.25, 0.15, 0.08}) {
    render::vk::DeviceOptions options;
    options.memory_budget_bytes = static_cast<std::uint64_t>(share * whole);
    auto renderer = render::Renderer::create(options);
    if (!renderer) break;
    auto picture = render_image(**renderer, eye.packet, settings);
    if (!picture) break;  // smaller grids do not fit either
    const render::RenderStats stats = (*renderer)->stats();
    const double factor = stats.downsampled_grids.empty() ? 1 : stats.downsampled_grids.front().factor;
    if (!curve.points.empty() && factor == curve.points.back().extra_values.back()) continue;  // the same image
    const render::ImageError error = render::measure_error(*picture, eye.reference);
    const std::string budget = fmt::format("{:.3g} MB", 1e-6 * static_cast<double>(stats.gpu_budget));
    const CandidateSetting tried{share > 0 ? budget : "no limit",
                                 share > 0 ? fmt::format("--gpu-memory {:.3g}", 1e-6 * static_cast<double>(stats.gpu_budget)) : "", "",
                                 settings};
    curve.points.push_back(make_point(tried, error, stats));
    curve.points.back().extra_values.push_back(factor);
    repeats.push_back(make_render_run(**renderer, eye.packet, settings));
    renderers.push_back(std::move(*renderer));
  }
  curve.current = curve.points.empty() ? -1 : 0;
  CATENA_CHECK(time_points(curve, repeats, 0.3 * subject.effort.rendering_s, 9));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
