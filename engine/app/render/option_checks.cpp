// SPDX-License-Identifier: MIT
#include "engine/app/render/option_checks.h"

#include <fmt/core.h>

#include "engine/app/cli/command.h"
#include "engine/app/render/outputs.h"
#include "engine/app/render/video_writer.h"
#include "engine/scene/time_steps.h"
#include "render/extract/extract_internal.h"

namespace catena::app {

Result<ImageSize> picture_size(const RenderOptions& o, const scene::Stereo& stereo, const ImageSize& size) {
  if (!o.layout.empty()) {
    if (render::stereo_view_count(stereo) > 1) return Error{"--layout ortho: orthogonal views are not shown in stereo"};
    if (!o.depth.empty() || !o.ids.empty() || o.antialias > 1 || o.tile > 0)
      return Error{"--layout ortho: excludes --depth, --ids, --antialias and --tile, which are for a single view"};
    return ImageSize{2 * size.width, 2 * size.height};
  }
  if (render::stereo_view_count(stereo) < 2) return size;
  const std::string mode = "with " + std::to_string(render::stereo_view_count(stereo)) + " views in one image";
  if (!o.depth.empty() || !o.ids.empty())
    return Error{(o.depth.empty() ? "--ids: " : "--depth: ") + mode +
                 " this image would show one view only; --stereo left or right was expected"};
  if (o.antialias > 1 || o.tile > 0)
    return Error{(o.tile > 0 ? "--tile: " : "--antialias: ") + mode +
                 " the image is rendered in one piece; --stereo left or right was expected"};
  CATENA_CHECK(check_packed_size(stereo, size));
  const auto packed = render::packed_size(render::stereo_packing(stereo), render::stereo_view_count(stereo), size.width, size.height);
  return ImageSize{static_cast<std::uint32_t>(packed.width), static_cast<std::uint32_t>(packed.height)};
}

Outcome check_frames(const RenderOptions& o, const std::vector<int>& steps) {
  const int count = static_cast<int>(steps.size());
  if (count < 2) return Done{};
  if (o.frames < count) return Error{fmt::format("--frames {}: fewer than the {} steps of --steps {}", o.frames, count, o.steps)};
  if (!takes_all_frames(o) && !o.output.starts_with("/dev/"))
    return Error{fmt::format("{}: one image for {} steps; %03d in the name, or a video, was expected", o.output, count)};
  return Done{};
}

Outcome check_shard_outputs(const RenderOptions& o) {
  if (!is_numbered(o.output) || video_kind(o.output))
    return Error{o.output + ": --shard divides the images of a sequence; the name of an image with %03d was expected"};
  return Done{};
}

Outcome check_path_tracing(const RenderOptions& o, const scene::Scene& scene) {
  if (scene.illumination.look == scene::Look::plain) return Error{"--quality path: light is linear radiance there; \"look\": \"lit\" was expected"};
  if (!o.layout.empty() || render::stereo_view_count(scene.stereo) > 1)
    return Error{"--quality path: a single view was expected, without --layout and stereo"};
  if (o.tile > 0 || o.antialias > 0)
    return Error{"--quality path: --tile and --antialias do not apply; samples are spread over each pixel"};
  return Done{};
}

Outcome check_shard_settings(const RenderOptions& o, const scene::Scene& scene, const std::string& quality_name, const Quality& quality) {
  if (quality.goal && quality.goal->kind == render::QualityGoal::Kind::time)
    return Error{"--shard: quality " + quality_name +
                 " is chosen by the time of this machine; --quality error=E, balanced or step=VOXELS was expected"};
  const scene::TuningTargets targets = o.targets.resolve(scene);
  if (!o.probe.empty() && (targets.max_proxy_error || targets.max_tick_us))
    return Error{
        "--shard: max_proxy_error and max_tick_us choose the settings of links by the time of this machine; \"method\" and \"tolerance\" "
        "of the links were expected instead"};
  return Done{};
}

Outcome check_steps(const scene::Scene& scene, const RenderOptions& o, const std::vector<int>& steps) {
  const std::string option = steps.empty() ? fmt::format("--step {}", o.step) : "--steps " + o.steps;
  return check_step(steps.empty() ? o.step : steps.back(), scene::step_count(scene) - 1, option, o.source);
}

}  // namespace catena::app
