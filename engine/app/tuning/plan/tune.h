/// A plan from the wishes to the settings: what is wanted ("plan" of a scene, --plan), curves out of the store or measured with a line of
/// progress, and what a person is told of both. `tell`: one line each.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/plan/image_tuning.h"
#include "engine/app/tuning/plan/tick_tuning.h"
#include "render/frame/frame_packet.h"

namespace catena::app::plan {

using MessageCallback = std::function<void(const std::string& line)>;

/// The scene's wishes; of an eye or a hand that the words of --plan speak of, theirs. An Error: the words are none.
Result<scene::TuningTargets> resolve_targets(const scene::Scene& scene, const std::string& words);
/// Of a command that draws nothing: words that speak of the eye are an Error.
Result<scene::TuningTargets> resolve_tick_targets(const scene::Scene& scene, const std::string& words);

/// The scene file's text; empty of a data file.
Result<std::string> read_scene_text(const scene::Scene& scene);

/// What a picture is measured under.
struct ImageTuningInput {
  const scene::Scene& scene;
  std::string scene_text;                 ///< the scene's
  std::vector<std::string> options = {};  ///< of the command line that change what is drawn
  double image_share = 1;                 ///< of the whole picture, which `packet` is a tile of: times count so much less
};
/// `store`: null: the user's own.
Result<ImageTuning> tune_image(render::Renderer& renderer, const render::FramePacket& packet, const scene::TuningTargets& wanted,
                               const ImageTuningInput& work, const MessageCallback& tell, const CurveCache* store = nullptr);

/// The scene is as it was afterwards. `rate_hz`: of the servo.
Result<TickTuning> tune_ticks(scene::Scene& scene, const std::string& text, const scene::TuningTargets& wanted, double rate_hz,
                              const std::vector<std::string>& options, const MessageCallback& tell, const CurveCache* store = nullptr);

/// All of it for a command: nothing where no hand_error or max_tick_us is wanted, or no link leaves its setting open (which is told); else
/// the plan, told, and applied to the scene. `text`: the scene's, where the caller has it; else it is read where it is needed.
Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const std::string& text, const scene::TuningTargets& wanted,
                                             double rate_hz, const std::vector<std::string>& options, const MessageCallback& tell);
Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const scene::TuningTargets& wanted, double rate_hz,
                                             const std::vector<std::string>& options, const MessageCallback& tell);

}  // namespace catena::app::plan
