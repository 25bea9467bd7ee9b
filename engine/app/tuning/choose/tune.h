// SPDX-License-Identifier: MIT
/// Tuning from targets to settings: takes the curves from the cache or measures them with
/// a progress line, and reports both to the user. `report_message` receives one line per message.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/choose/image_tuning.h"
#include "engine/app/tuning/choose/tick_tuning.h"
#include "render/frame/frame_packet.h"

namespace catena::app::tuning {

using MessageCallback = std::function<void(const std::string& line)>;

/// Returns the text of the scene file; empty for a data file.
Result<std::string> read_scene_text(const scene::Scene& scene);

/// The conditions under which an image is measured.
struct ImageTuningInput {
  const scene::Scene& scene;
  std::string scene_text;                 ///< Text of the scene file; empty for a data file.
  std::vector<std::string> options = {};  ///< Command line options that change the image.
};
/// Returns the image tuning of the packet, from cached curves or measured ones. `store`: the curve cache; null: the user's own. An Error if
/// rendering fails.
Result<ImageTuning> tune_image(render::Renderer& renderer, const render::FramePacket& packet, const scene::TuningTargets& targets,
                               const ImageTuningInput& work, const MessageCallback& report_message, const CurveCache* store = nullptr);

/// Returns the tuning of the scene's streamline links, empty if it has no chain. The scene is left unchanged. `text`: the scene's text;
/// `rate_hz`: rate of the servo; `store`: as above. An Error if the curves cannot be measured.
Result<TickTuning> tune_ticks(scene::Scene& scene, const std::string& text, const scene::TuningTargets& targets, double rate_hz,
                              const std::vector<std::string>& options, const MessageCallback& report_message,
                              const CurveCache* store = nullptr);

/// Tunes the links for a command, applies the result to the scene and reports it. Returns nothing if there is no target max_proxy_error or
/// max_tick_us, or if no link leaves its setting open (which is reported). `text`: the scene's text; without it, the file is read if
/// needed.
Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const std::string& text, const scene::TuningTargets& targets,
                                             double rate_hz, const std::vector<std::string>& options,
                                             const MessageCallback& report_message);
Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const scene::TuningTargets& targets, double rate_hz,
                                             const std::vector<std::string>& options, const MessageCallback& report_message);

}  // namespace catena::app::tuning
