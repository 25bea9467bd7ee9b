/// A plan from the wishes to the settings: what is wanted ("plan" of a scene, --plan), curves out of the store or measured with a line of
/// progress, and what a person is told of both. `tell`: one line each.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/plan/eye_plan.h"
#include "engine/app/plan/hand_plan.h"
#include "render/frame/frame_packet.h"

namespace catena::app::plan {

using Tell = std::function<void(const std::string& line)>;

/// The scene's wishes; of an eye or a hand that the words of --plan speak of, theirs. An Error: the words are none.
Result<scene::Plan> wanted_plan(const scene::Scene& scene, const std::string& words);
/// Of a command that draws nothing: words that speak of the eye are an Error.
Result<scene::Plan> wanted_hand_plan(const scene::Scene& scene, const std::string& words);

/// The scene file's text; empty of a data file.
Result<std::string> text_of(const scene::Scene& scene);

/// What a picture is measured under.
struct EyeWork {
  const scene::Scene& scene;
  std::string text;                       ///< the scene's
  std::vector<std::string> options = {};  ///< of the command line that change what is drawn
  double share = 1;                       ///< of the whole picture, which `packet` is a tile of: times count so much less
};
/// `store`: null: the user's own.
Result<EyePlan> make_eye_plan(render::Renderer& renderer, const render::FramePacket& packet, const scene::Plan& wanted, const EyeWork& work,
                              const Tell& tell, const CurveStore* store = nullptr);

/// The scene is as it was afterwards. `rate_hz`: of the servo.
Result<HandPlan> make_hand_plan(scene::Scene& scene, const std::string& text, const scene::Plan& wanted, double rate_hz,
                                const std::vector<std::string>& options, const Tell& tell, const CurveStore* store = nullptr);

/// All of it for a command: nothing where no hand_error or hand_time is wanted, or no link leaves its setting open (which is told); else
/// the plan, told, and applied to the scene. `text`: the scene's, where the caller has it; else it is read where it is needed.
Result<std::optional<HandPlan>> plan_links(scene::Scene& scene, const std::string& text, const scene::Plan& wanted, double rate_hz,
                                           const std::vector<std::string>& options, const Tell& tell);
Result<std::optional<HandPlan>> plan_links(scene::Scene& scene, const scene::Plan& wanted, double rate_hz,
                                           const std::vector<std::string>& options, const Tell& tell);

}  // namespace catena::app::plan
