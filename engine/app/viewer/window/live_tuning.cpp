// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/live_tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/numbers.h"
#include "engine/scene/to_json.h"
#include "render/quality/quality.h"

namespace catena::app {
namespace {

/// Rounds up to three digits, so that rounding cannot make a target unreachable.
double rounded_up(double value) {
  if (!(value > 0)) return 1e-30;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::ceil(value / unit * (1 - 1e-12)) * unit;
}

/// Index of the item at a position of the slider, and position of the first item whose error is at most `error`.
std::size_t index_at(double place, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(std::lround(place * static_cast<double>(count - 1))));
}
double place_of(const std::vector<double>& errors, double error) {
  const auto found = std::find_if(errors.begin(), errors.end(), [&](double e) { return e <= error * (1 + 1e-9); });
  const auto index = std::min(static_cast<std::size_t>(found - errors.begin()), errors.size() - 1);
  return errors.size() < 2 ? 1 : static_cast<double>(index) / static_cast<double>(errors.size() - 1);
}

}  // namespace

bool LiveTuning::update_target(const scene::TuningTargets& text) {
  if (text == scene_target) return false;
  target = scene_target = text;
  if (image_tuning && target.has_image_targets()) image_tuning->set_targets(target);
  if (tick_tuning && target.has_haptic_targets()) tick_tuning->set_targets(target);
  return true;
}

bool LiveTuning::on_rendered(double ms) {
  const int before = image_tuning->current();
  tuned_image_ms = ms;
  image_tuning->record_frame_time(ms);
  return image_tuning->current() != before;
}

std::optional<Quality> LiveTuning::quality() const {
  if (!image_tuning || has_fixed_quality) return std::nullopt;
  Quality quality{image_tuning->settings(), {}};
  quality.interactive_ms = target.max_image_ms.value_or(std::clamp(image_tuning->expected_ms(), 5.0, 50.0));
  return quality;
}

scene::TuningTargets LiveTuning::target_at(double position) const {
  scene::TuningTargets targets;
  if (image_tuning && !has_fixed_quality) {
    const std::vector<double> errors = image_tuning->error_breakpoints();
    targets.max_image_error = rounded_up(errors[index_at(position, errors.size())]);
  }
  if (tick_tuning && !tick_tuning->is_empty()) {
    const std::vector<double> errors = tick_tuning->error_breakpoints();
    targets.max_proxy_error = rounded_up(errors[index_at(position, errors.size())]);
  }
  return targets;
}

std::vector<scene::Document::Edit> LiveTuning::edits_at(double position) const {
  const scene::TuningTargets targets = target_at(position);
  std::vector<scene::Document::Edit> edits;
  if (targets.max_image_error) edits.push_back({"/quality", scene::to_json("error=" + to_text(*targets.max_image_error))});
  if (targets.max_proxy_error) {
    edits.push_back({"/coupling/max_tick_us", std::nullopt});
    edits.push_back({"/coupling/max_proxy_error", scene::to_json(*targets.max_proxy_error)});
  }
  return edits;
}

double LiveTuning::slider_position() const {
  if (image_tuning && !has_fixed_quality)
    return place_of(image_tuning->error_breakpoints(), target.max_image_error.value_or(image_tuning->expected_error()));
  if (tick_tuning && !tick_tuning->is_empty())
    return place_of(tick_tuning->error_breakpoints(), target.max_proxy_error.value_or(tick_tuning->expected_error()));
  return 1;
}

bool LiveTuning::matches(const FrameRequest& next) const {
  return image_tuning && next.pixel_stride == 1 && !next.settings.reuse_rays &&
         render::describe(next.settings) == render::describe(image_tuning->settings());
}

Outcome measure_tick_costs(LiveTuning& live, SceneModel& scene, const HapticSession& hand, const tuning::MessageCallback& report_message) {
  CATENA_TRY(tuning::TickTuning made, tuning::tune_ticks(scene.scene(), scene.document().text(), live.target,
                                                         hand.device().settings.rate_hz, hand.field_options(), report_message));
  if (made.is_empty()) return Done{};
  live.tick_tuning = std::move(made);
  return scene.set_tick_tuning(live.tick_tuning);
}

Outcome measure_image_costs(LiveTuning& live, ProgressiveScheduler& pacing, render::Renderer& renderer, const render::FramePacket& packet,
                            const SceneModel& scene, const HapticSession& hand, const tuning::MessageCallback& report_message) {
  if (!render::uses_raycast(packet)) {
    report_message("tuning: the image has no settings to tune, because nothing is rendered by ray casting");
    return Done{};
  }
  auto made =
      tuning::tune_image(renderer, packet, live.target, {scene.scene(), scene.document().text(), hand.field_options()}, report_message);
  if (!made) return Error{made.error().message, true};
  live.image_tuning = std::move(*made);
  report_message(live.image_tuning->summary());
  if (const auto quality = live.quality()) pacing = ProgressiveScheduler(*quality);
  return Done{};
}

void set_default_target(LiveTuning& live) {
  if (!live.target.has_image_targets()) live.target.max_image_error = 2;
  if (!live.target.has_haptic_targets()) live.target.max_proxy_error = 1e-9;
}

Outcome apply_scene_target(LiveTuning& live, SceneModel& scene, ProgressiveScheduler& pacing) {
  if (!live.update_target(std::as_const(scene).scene().tuning)) return Done{};
  const Outcome planned = live.tick_tuning && live.target.has_haptic_targets() ? scene.set_tick_tuning(live.tick_tuning) : Outcome(Done{});
  if (const auto quality = live.quality(); quality && live.target.has_image_targets()) pacing = ProgressiveScheduler(*quality);
  scene.take_changed();
  return planned;
}

}  // namespace catena::app
