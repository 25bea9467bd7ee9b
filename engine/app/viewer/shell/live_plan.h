/// The plan of a scene that is open in a window or a browser (engine/app/plan): what is wanted, the curves of eye and hand once they are
/// measured, what was observed, and the slider between fast and exact. The scene's text has the last word on what is wanted: the slider
/// edits its "plan". Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/plan/make_plan.h"
#include "engine/app/plan/observe.h"
#include "engine/app/render/options.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/pacing.h"
#include "engine/app/viewer/shell/scene_host.h"

namespace catena::app {

struct LivePlan {
  scene::Plan wanted;           ///< of the command line, until the scene's text says otherwise
  scene::Plan stated;           ///< what the text said when it was looked at last
  bool quality_stated = false;  ///< of the picture: the plan leaves it alone
  std::optional<plan::EyePlan> eye;
  std::optional<plan::HandPlan> hand;
  std::optional<plan::HandObserver> observer;
  double eye_ms = 0;                 ///< of the last picture with the plan's settings; 0: none yet
  std::optional<double> hand_error;  ///< observed, world units

  /// The text has come to say something else: true, and it is wanted.
  bool follow(const scene::Plan& text);
  /// A picture at rest with the plan's settings took so long: true where another setting follows.
  bool drawn(double ms);

  /// What the picture is to be drawn with; nothing without a plan of the eye.
  std::optional<Quality> quality() const;

  /// What a place of the slider wants, 0 fast to 1 exact; and the place of what is wanted now.
  scene::Plan at(double place) const;
  double place() const;

  /// That picture is drawn with the plan's settings, every pixel of it.
  bool is_drawn_by(const NextPicture& next) const;
};

/// The curves of eye or hand, measured or out of the store, and what is wanted by them. An Error is of the hand's plan, which is not there
/// then, or of the machine. `packet`: of a picture at rest.
Outcome measure_hand(LivePlan& live, SceneHost& scene, const HandHost& hand, const plan::Tell& tell);
Outcome measure_eye(LivePlan& live, Pacing& pacing, render::Renderer& renderer, const render::FramePacket& packet, const SceneHost& scene,
                    const HandHost& hand, const plan::Tell& tell);
/// Nothing was wanted, and the curves are asked for: as good as what a scene without a plan has.
void want_the_usual(LivePlan& live);
/// The scene's text was read again: what it wants now is what is felt and drawn.
Outcome follow_text(LivePlan& live, SceneHost& scene, Pacing& pacing);

}  // namespace catena::app
