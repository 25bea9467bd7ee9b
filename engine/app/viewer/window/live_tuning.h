// SPDX-License-Identifier: MIT
/// Tuning of the scene in a window or browser (engine/app/tuning/plan): targets, the cost curves of image and tick once measured, the
/// measured tracking error, and the slider between fast and exact. The targets stated in the scene's text have precedence; the slider edits
/// its "quality" and "coupling". Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/render/render_options.h"
#include "engine/app/tuning/choose/tracking_error.h"
#include "engine/app/tuning/choose/tune.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/progressive_scheduler.h"

namespace catena::app {

/// State of the tuning; the two tunings are empty until their costs are measured.
struct LiveTuning {
  scene::TuningTargets target;        ///< Current targets: of the command line, until the scene's text states others.
  scene::TuningTargets scene_target;  ///< Targets of the scene's text when last read.
  bool has_fixed_quality = false;     ///< The image has fixed settings (draft, balanced ..); the tuning does not change them.
  std::optional<tuning::ImageTuning> image_tuning;
  std::optional<tuning::TickTuning> tick_tuning;
  std::optional<tuning::TrackingErrorMonitor> observer;
  double tuned_image_ms = 0;             ///< Time of the last frame with the tuned settings; 0: none so far.
  std::optional<double> tracking_error;  ///< Measured, world units.

  /// Adopts the targets stated in the scene's text. Returns true if they differ from the last ones.
  bool update_target(const scene::TuningTargets& text);
  /// Records the time of a refined frame with the tuned settings. Returns true if other settings follow from it.
  bool on_rendered(double ms);

  /// Returns the quality to render with; nothing without an image tuning.
  std::optional<Quality> quality() const;

  /// Returns the targets at a slider position, 0 fast to 1 exact; and the slider position of the current targets.
  scene::TuningTargets target_at(double position) const;
  double slider_position() const;
  /// Returns the edits of the scene's text that state the targets at a slider position.
  std::vector<scene::Document::Edit> edits_at(double position) const;

  /// Returns whether the requested frame uses the tuned settings, with every pixel rendered.
  bool matches(const FrameRequest& next) const;
};

/// Measure the cost curves of tick or image, or take them from the cache, and apply the settings chosen for the targets. An Error means
/// that there is no tick tuning, or a failure of the system. `packet`: of a refined frame; `report_message` receives messages for the user.
Outcome measure_tick_costs(LiveTuning& live, SceneModel& scene, const HapticSession& hand, const tuning::MessageCallback& report_message);
Outcome measure_image_costs(LiveTuning& live, ProgressiveScheduler& pacing, render::Renderer& renderer, const render::FramePacket& packet,
                            const SceneModel& scene, const HapticSession& hand, const tuning::MessageCallback& report_message);
/// Sets default targets (image error 2/255, proxy error 1e-9) where there are none: equivalent to a scene without targets.
void set_default_target(LiveTuning& live);
/// Call after the scene's text was read again: applies the targets it states. An Error leaves the links as they are.
Outcome apply_scene_target(LiveTuning& live, SceneModel& scene, ProgressiveScheduler& pacing);

}  // namespace catena::app
