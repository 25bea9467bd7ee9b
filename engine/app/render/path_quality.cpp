// SPDX-License-Identifier: MIT
#include "engine/app/render/path_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/numbers.h"

namespace catena::app {
namespace {

constexpr std::uint32_t kDefaultSamples = 64;

/// Returns the packet's overlay alone, over a transparent background.
render::FramePacket overlay_of(const render::FramePacket& packet) {
  render::FramePacket only;
  only.view = packet.view;
  only.width = packet.width;
  only.height = packet.height;
  only.background = {0, 0, 0, 0};
  only.overlay = packet.overlay;
  only.size_scale = packet.size_scale;
  return only;
}

/// Blends a straight-alpha image over another of the same size.
void blend_over(const std::vector<float>& above, std::vector<float>& image) {
  for (std::size_t i = 0; i < image.size(); i += 4) {
    const float a = above[i + 3], behind = (1 - a) * image[i + 3], alpha = a + behind;
    if (!(a > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) image[i + c] = (a * above[i + c] + behind * image[i + c]) / alpha;
    image[i + 3] = alpha;
  }
}

}  // namespace

Result<std::optional<PathQuality>> parse_path_quality(const std::string& words) {
  if (words != "path" && !words.starts_with("path,")) return std::optional<PathQuality>();
  PathQuality quality;
  std::stringstream parts(words.substr(std::min<std::size_t>(words.size(), 5)));
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const double value = equals == std::string::npos ? NAN : parse_double(std::string_view(part).substr(equals + 1)).value_or(NAN);
    const bool is_whole = value == std::floor(value);
    if (key == "samples" && is_whole && value >= 1 && value <= 1e6)
      quality.goal.samples = std::uint32_t(value);
    else if (key == "error" && std::isfinite(value) && value > 0)
      quality.goal.error = value;
    else if (key == "seconds" && std::isfinite(value) && value > 0)
      quality.goal.seconds = value;
    else if (key == "bounces" && is_whole && value >= 1 && value <= render::PathSettings::kUnlimited)
      quality.settings.bounces = int(value);
    else if (key == "seed" && is_whole && value >= 0 && value <= 0x1p53)
      quality.settings.seed = std::uint64_t(value);
    else
      return Error{
          "--quality " + words + ": " + part +
          " is unknown or out of range; path with ,samples=N (1 to 1e6) ,error=E ,seconds=S ,bounces=N (from 1) ,seed=N was expected"};
  }
  if (quality.goal.samples == 0 && quality.goal.error == 0 && quality.goal.seconds == 0) quality.goal.samples = kDefaultSamples;
  return std::optional(quality);
}

Result<std::optional<PathPicture>> render_path(render::Renderer& renderer, const render::FramePacket& packet, const PathQuality& quality,
                                               const render::BandChannels& requested, const std::function<bool(double done)>& proceed) {
  CATENA_TRY(const render::PathScene scene, render::PathScene::make(packet));
  render::PathImage image(scene, packet, quality.settings);
  if (!image.render(quality.goal, proceed)) return std::optional<PathPicture>();
  PathPicture picture;
  picture.notes = scene.notes();
  const render::PathImage::Error error = image.error();
  picture.summary = fmt::format("{} {} a pixel, standard error {:.2g}/255, {:.2g} % of the light", image.samples(),
                                image.samples() == 1 ? "sample" : "samples", error.standard, 100 * error.relative);
  std::vector<float> pixels = image.display();
  render::RenderSettings settings;
  settings.float_image = true;
  const auto fails = [](const Error& why) { return Error{why.message, true}; };
  if (const Outcome drawn = renderer.draw(overlay_of(packet), settings); !drawn) return fails(drawn.error());
  const Result<render::ImageF32> overlay = renderer.read_back_float();
  if (!overlay) return fails(overlay.error());
  blend_over(overlay->rgba, pixels);
  render::Band& band = picture.band;
  band.width = packet.width;
  band.height = packet.height;
  band.bytes.resize(pixels.size());
  std::ranges::transform(pixels, band.bytes.begin(), [](float x) { return std::uint8_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); });
  if (requested.floats) band.floats = std::move(pixels);
  if (!requested.depth && !requested.ids) return std::optional(std::move(picture));
  if (const Outcome drawn = renderer.draw(packet, render::balanced_settings()); !drawn) return fails(drawn.error());
  const Result<render::DepthImage> depth = renderer.read_depth();
  if (!depth) return fails(depth.error());
  band.depth = depth->depth;
  const Result<render::IdImage> ids = renderer.read_ids();
  if (!ids) return fails(ids.error());
  band.ids = ids->ids;
  return std::optional(std::move(picture));
}

}  // namespace catena::app
