// SPDX-License-Identifier: MIT
/// Checks of the options of `catena render` that concern several of them. An Error names the option and what was expected. Main thread.
#pragma once
#include <string>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/scene/scene.h"

namespace catena::app {

/// Size of the finished image. Stereo views in one image are rendered without tiles.
Result<ImageSize> picture_size(const RenderOptions& o, const scene::Stereo& stereo, const ImageSize& size);
/// Checks that every step of --steps has a frame and an output to store it.
Outcome check_frames(const RenderOptions& o, const std::vector<int>& steps);
/// Checks that the outputs of a shard are one file per frame.
Outcome check_shard_outputs(const RenderOptions& o);
/// Checks that a scene and the options suit path tracing.
Outcome check_path_tracing(const RenderOptions& options, const scene::Scene& scene);
/// Rejects what is chosen by times measured on one machine, which would differ between shards.
Outcome check_shard_settings(const RenderOptions& o, const scene::Scene& scene, const std::string& quality_name, const Quality& quality);
/// Rejects steps beyond the last one of the longest field. Steps inside data files are known only after the fields are loaded.
Outcome check_steps(const scene::Scene& scene, const RenderOptions& o, const std::vector<int>& steps);

}  // namespace catena::app
