// SPDX-License-Identifier: MIT
#include "engine/app/tuning/choose/tune.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/cli/command.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "render/extract/extract.h"

namespace catena::app::tuning {
namespace {

/// Stores the curves in the cache. A failure is only reported: the curves are then measured in the next run.
void keep(const CurveCache& store, const std::string& key, const std::string& source, const std::vector<Curve>& curves,
          const MessageCallback& report_message) {
  if (const Outcome kept = store.store(key, source, curves); !kept)
    report_message("tuning: the cost curves cannot be stored: " + kept.error().message);
}

const CurveCache& store_of(const CurveCache* given) {
  static const CurveCache own;
  return given != nullptr ? *given : own;
}

}  // namespace

Result<std::string> read_scene_text(const scene::Scene& scene) {
  if (!is_scene_file(scene.path)) return std::string();
  return read_text_file(scene.path, "a scene file (JSON)", kMaxJsonBytes);
}

Result<ImageTuning> tune_image(render::Renderer& renderer, const render::FramePacket& packet, const scene::TuningTargets& targets,
                               const ImageTuningInput& work, const MessageCallback& report_message, const CurveCache* given) {
  const CurveCache& store = store_of(given);
  CurveKey key("eye");
  key.add(work.scene, work.scene_text).add(renderer.device().info().name).add(renderer.stats().driver);
  for (const std::string& option : work.options) key.add(option);
  key.add(packet.width).add(packet.height).add(static_cast<double>(packet.eyes.size()));
  const render::View& v = packet.eyes.empty() ? packet.view : packet.eyes.front();
  for (const Vec3& p : {v.position, v.target, v.up}) key.add(p.x).add(p.y).add(p.z);
  key.add(v.fovy_deg).add(v.orthographic ? v.height : 0);
  CATENA_TRY(const render::QualityLevelOptions kind, detect_quality_level_options(renderer, packet));
  std::optional<ImageCurve> curve;
  std::string cache_message;
  store.find(
      key.text(),
      [&](const std::vector<Curve>& curves) {
        if (curves.size() == 1) curve = to_image_curve(curves.front(), kind);
        return curve.has_value();
      },
      cache_message);
  if (!cache_message.empty()) report_message(cache_message);
  if (!curve) {
    ProgressLine progress("tuning: measuring the image", 1);
    CATENA_TRY(curve, measure_image_curve(renderer, packet, kind, [&](double done) { progress.update(done); }));
    keep(store, key.text(), work.scene.path, {curve->curve}, report_message);
  }
  return ImageTuning(std::move(*curve), targets);
}

Result<TickTuning> tune_ticks(scene::Scene& scene, const std::string& text, const scene::TuningTargets& targets, double rate_hz,
                              const std::vector<std::string>& options, const MessageCallback& report_message, const CurveCache* given) {
  if (scene.entities.count<scene::Link>() == 0) return TickTuning();
  const CurveCache& store = store_of(given);
  CurveKey key("hand");
  key.add(scene, text).add(rate_hz);
  for (const std::string& option : options) key.add(option);
  std::optional<TickCurves> curves;
  std::string cache_message;
  const auto fits = [&](const std::vector<Curve>& found) {
    curves = to_tick_curves(scene, found, rate_hz);
    return curves.has_value();
  };
  store.find(key.text(), fits, cache_message);
  if (!cache_message.empty()) report_message(cache_message);
  if (!curves) {
    const scene::Workspace workspace = scene.workspace;
    const std::optional<double> ramp = scene.coupling.ramp_s;
    CATENA_CHECK(scene::prepare(scene));
    ProgressLine progress("tuning: measuring the links", 1);
    tuning::Workload subject{std::move(scene), tuning::select_effort("quick"), {}, {}, rate_hz, {}, {}};
    Result<std::vector<Curve>> measured = Error{};
    const Outcome ready = tuning::add_haptics(subject, {});
    subject.rate_hz = rate_hz;
    if (ready) measured = measure_tick_curves(subject);
    scene = std::move(subject.scene);
    scene.workspace = workspace;
    scene.coupling.ramp_s = ramp;
    CATENA_CHECK(ready);
    CATENA_CHECK(measured);
    for (const std::string& sentence : subject.skipped) report_message("tuning: not changed: " + sentence);
    if (!fits(*measured)) return Error{scene.path + ": the cost curves of the links could not be measured"};
    keep(store, key.text(), scene.path, *measured, report_message);
  }
  return TickTuning(std::move(*curves), targets);
}

Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const std::string& text, const scene::TuningTargets& targets,
                                             double rate_hz, const std::vector<std::string>& options,
                                             const MessageCallback& report_message) {
  if (!targets.has_haptic_targets()) return std::optional<TickTuning>();
  CATENA_TRY(TickTuning plan, tune_ticks(scene, text, targets, rate_hz, options, report_message));
  if (plan.is_empty()) {
    report_message("tuning: all streamline links state their settings, which are not changed");
    return std::optional<TickTuning>();
  }
  report_message(plan.summary());
  plan.apply(scene);
  return std::optional(std::move(plan));
}

Result<std::optional<TickTuning>> tune_links(scene::Scene& scene, const scene::TuningTargets& targets, double rate_hz,
                                             const std::vector<std::string>& options, const MessageCallback& report_message) {
  if (!targets.has_haptic_targets()) return std::optional<TickTuning>();
  CATENA_TRY(const std::string text, read_scene_text(scene));
  return tune_links(scene, text, targets, rate_hz, options, report_message);
}

}  // namespace catena::app::tuning
