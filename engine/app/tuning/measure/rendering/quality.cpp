// SPDX-License-Identifier: MIT
/// The values of --quality: draft, balanced, a step, a stated error, reference; with the flicker during a slow rotation.
#include <fmt/format.h>

#include "engine/app/render/render_options.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/frame/camera.h"
#include "render/quality/quality.h"

namespace catena::app::tuning {
namespace {

constexpr double kTurn_deg = 0.2;
constexpr int kFrames = 3;

/// Copies of the packet with the camera rotated about the target.
std::vector<render::FramePacket> slow_turn(const Workload& subject) {
  std::vector<render::FramePacket> frames;
  for (int k = 0; k < kFrames; ++k) {
    render::FramePacket packet = subject.rendering->packet;
    packet.view = render::orbit_view(packet.view, k * kTurn_deg, 0);
    frames.push_back(std::move(packet));
  }
  return frames;
}

Result<std::vector<render::Image8>> pictures_of(RenderWorkload& eye, const std::vector<render::FramePacket>& frames,
                                                const render::RenderSettings& settings) {
  std::vector<render::Image8> pictures;
  for (const render::FramePacket& frame : frames) {
    CATENA_TRY(render::Image8 picture, render_image(*eye.renderer, frame, settings));
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace

Result<std::vector<Curve>> measure_quality(Workload& subject) {
  RenderWorkload& eye = *subject.rendering;
  if (!eye.has_raycast) {
    subject.skipped.emplace_back("Quality: nothing in the image is sampled along rays, so that --quality has no effect.");
    return std::vector<Curve>{};
  }
  Curve curve = make_rendering_curve(
      subject, "quality", "Image quality: --quality",
      fmt::format(
          "Values of --quality, or of \"quality\" in the scene, which set steps, pixels and rays together. Flicker is measured over "
          "three images {:g} degrees apart.",
          kTurn_deg));
  std::vector<CandidateSetting> tried;
  const auto add = [&](const std::string& words, const render::RenderSettings& settings) {
    tried.push_back({words, "--quality " + words,
                     words.starts_with("error")  ? "error=E"
                     : words.starts_with("step") ? "step=VOXELS"
                                                 : words,
                     settings});
  };
  add("draft", render::draft_settings());
  for (const double e : {8.0, 4.0, 2.0, 1.0}) {
    CATENA_TRY(const render::QualityChoice choice,
               render::choose_quality(*eye.renderer, eye.packet, {render::QualityGoal::Kind::error, e}));
    if (e == 2)
      add("balanced", choice.settings);
    else if (choice.goal_reached)
      add(fmt::format("error={:g}", e), choice.settings);
  }
  for (const double step : {2.0, 1.0, 0.5}) {
    CATENA_TRY(const Quality quality, parse_quality(fmt::format("step={:g}", step)));
    add(fmt::format("step={:g}", step), quality.settings);
  }
  add("reference", render::reference_settings());
  CATENA_CHECK(measure_candidates(subject, tried, curve));
  const std::string now = subject.scene.quality.empty() ? "balanced" : subject.scene.quality;
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    if (curve.points[i].setting == now) curve.current = static_cast<int>(i);

  curve.extra_columns.emplace_back("flicker, 1/255");
  const std::vector<render::FramePacket> frames = slow_turn(subject);
  render::RenderSettings converged = render::reference_settings();
  converged.step_voxels = std::max(0.125, eye.reference_step);
  CATENA_TRY(const std::vector<render::Image8> truth, pictures_of(eye, frames, converged));
  std::size_t at = 0;
  for (Point& p : curve.points) {
    while (at < tried.size() && tried[at].setting != p.setting) ++at;
    CATENA_TRY(const std::vector<render::Image8> pictures, pictures_of(eye, frames, tried[at].settings));
    p.extra_values.push_back(render::measure_flicker(pictures, truth));
  }
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
