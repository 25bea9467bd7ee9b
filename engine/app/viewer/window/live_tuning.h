/// The plan of a scene that is open in a window or a browser (engine/app/tuning/plan): what is wanted, the curves of eye and hand once they
/// are measured, what was observed, and the slider between fast and exact. The scene's text has the last word on what is wanted: the slider
/// edits its "plan". Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/render/render_options.h"
#include "engine/app/tuning/plan/tracking_error.h"
#include "engine/app/tuning/plan/tune.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/progressive_scheduler.h"

namespace catena::app {

struct LiveTuning {
  scene::TuningTargets target;        ///< of the command line, until the scene's text says otherwise
  scene::TuningTargets scene_target;  ///< what the text said when it was looked at last
  bool has_explicit_quality = false;  ///< of the picture: the plan leaves it alone
  std::optional<plan::ImageTuning> image_tuning;
  std::optional<plan::TickTuning> tick_tuning;
  std::optional<plan::TrackingErrorMonitor> observer;
  double tuned_image_ms = 0;             ///< of the last picture with the plan's settings; 0: none yet
  std::optional<double> tracking_error;  ///< observed, world units

  /// The text has come to say something else: true, and it is wanted.
  bool update_target(const scene::TuningTargets& text);
  /// A picture at rest with the plan's settings took so long: true where another setting follows.
  bool on_rendered(double ms);

  /// What the picture is to be drawn with; nothing without a plan of the eye.
  std::optional<Quality> quality() const;

  /// What a place of the slider wants, 0 fast to 1 exact; and the place of what is wanted now.
  scene::TuningTargets target_at(double place) const;
  double slider_position() const;

  /// That picture is drawn with the plan's settings, every pixel of it.
  bool matches(const FrameRequest& next) const;
};

/// The curves of eye or hand, measured or out of the store, and what is wanted by them. An Error is of the hand's plan, which is not there
/// then, or of the machine. `packet`: of a picture at rest.
Outcome measure_tick_costs(LiveTuning& live, SceneModel& scene, const HapticSession& hand, const plan::MessageCallback& tell);
Outcome measure_image_costs(LiveTuning& live, ProgressiveScheduler& pacing, render::Renderer& renderer, const render::FramePacket& packet,
                            const SceneModel& scene, const HapticSession& hand, const plan::MessageCallback& tell);
/// Nothing was wanted, and the curves are asked for: as good as what a scene without a plan has.
void set_default_target(LiveTuning& live);
/// The scene's text was read again: what it wants now is what is felt and drawn.
Outcome apply_scene_target(LiveTuning& live, SceneModel& scene, ProgressiveScheduler& pacing);

}  // namespace catena::app
