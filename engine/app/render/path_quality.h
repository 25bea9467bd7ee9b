// SPDX-License-Identifier: MIT
/// Quality `path` of `catena render`: images by path tracing (render/path), with their standard error.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "render/path/path_tracer.h"
#include "render/quality/tiled_render.h"

namespace catena::app {

/// The words of a quality `path`.
struct PathQuality {
  render::PathSettings settings;
  render::PathGoal goal;
};

/// Parses path[,samples=N][,error=E][,seconds=S][,bounces=N][,seed=N]; nullopt: another quality. Without a goal: 64 samples. Error: an
/// unknown word or a number out of range.
Result<std::optional<PathQuality>> parse_path_quality(const std::string& words);

/// Path-traced image.
struct PathPicture {
  render::Band band;
  std::string summary;             ///< samples and standard error, in words
  std::vector<std::string> notes;  ///< what the image does not show
};

/// Traces the packet's scene and draws its overlay over it with `renderer`. `proceed` is called with the completed fraction; false ends the
/// work. Error: the packet has items that cannot be traced, or the overlay could not be drawn (a system failure). nullopt: it was ended.
Result<std::optional<PathPicture>> render_path(render::Renderer& renderer, const render::FramePacket& packet, const PathQuality& quality,
                                               const render::BandChannels& requested, const std::function<bool(double done)>& proceed);

}  // namespace catena::app
