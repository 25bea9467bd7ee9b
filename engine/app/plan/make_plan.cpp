#include "engine/app/plan/make_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/command.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "render/extract/extract.h"

namespace catena::app::plan {
namespace {

/// Only a note: what cannot be kept is measured the next time again.
void keep(const CurveStore& store, const std::string& key, const std::string& source, const std::vector<Curve>& curves, const Tell& tell) {
  if (const Outcome kept = store.keep(key, source, curves); !kept) tell("plan: the curves are not kept: " + kept.error().message);
}

const CurveStore& store_of(const CurveStore* given) {
  static const CurveStore own;
  return given != nullptr ? *given : own;
}

scene::Plan with(scene::Plan wanted, const scene::Plan& said) {
  if (said.of_eye()) wanted.error = said.error, wanted.time = said.time;
  if (said.of_hand()) wanted.hand_error = said.hand_error, wanted.hand_time = said.hand_time;
  return wanted;
}

}  // namespace

Result<scene::Plan> wanted_plan(const scene::Scene& scene, const std::string& words) {
  if (words.empty()) return scene.plan;
  CATENA_TRY(const scene::Plan said, scene::parse_plan(words));
  return with(scene.plan, said);
}

Result<scene::Plan> wanted_hand_plan(const scene::Scene& scene, const std::string& words) {
  if (words.empty()) return scene.plan;
  CATENA_TRY(const scene::Plan said, scene::parse_plan(words));
  if (said.of_eye()) return Error{one_line("--plan " + words + ": nothing is drawn here; hand_error=E or hand_time=US was expected")};
  return with(scene.plan, said);
}

Result<std::string> text_of(const scene::Scene& scene) {
  if (!is_scene_file(scene.path)) return std::string();
  return read_text(scene.path, "a scene file (JSON)", kMaxJsonBytes);
}

Result<EyePlan> make_eye_plan(render::Renderer& renderer, const render::FramePacket& packet, const scene::Plan& wanted, const EyeWork& work,
                              const Tell& tell, const CurveStore* given) {
  const CurveStore& store = store_of(given);
  CurveKey key("eye");
  key.add(work.scene, work.text).add(renderer.device().info().name).add(renderer.stats().driver);
  for (const std::string& option : work.options) key.add(option);
  key.add(packet.width).add(packet.height).add(static_cast<double>(packet.eyes.size()));
  const render::View& v = packet.eyes.empty() ? packet.view : packet.eyes.front();
  for (const Vec3& p : {v.position, v.target, v.up}) key.add(p.x).add(p.y).add(p.z);
  key.add(v.fovy_deg).add(v.orthographic ? v.height : 0);
  CATENA_TRY(const render::LadderKind kind, kind_of(renderer, packet));
  std::optional<EyeCurve> curve;
  std::string told;
  store.find(
      key.text(),
      [&](const std::vector<Curve>& curves) {
        if (curves.size() == 1) curve = eye_curve(curves.front(), kind);
        return curve.has_value();
      },
      told);
  if (!told.empty()) tell(told);
  if (!curve) {
    Progress progress("plan: measuring the picture", 1);
    CATENA_TRY(curve, measure_eye(renderer, packet, kind, [&](double done) { progress.at(done); }));
    keep(store, key.text(), work.scene.path, {curve->curve}, tell);
  }
  // of the whole picture
  for (tradeoff::Point& point : curve->curve.points) {
    point.time.low /= work.share, point.time.median /= work.share, point.time.high /= work.share;
  }
  return EyePlan(std::move(*curve), wanted);
}

Result<HandPlan> make_hand_plan(scene::Scene& scene, const std::string& text, const scene::Plan& wanted, double rate_hz,
                                const std::vector<std::string>& options, const Tell& tell, const CurveStore* given) {
  if (scene.world.count<scene::Link>() == 0) return HandPlan();
  const CurveStore& store = store_of(given);
  CurveKey key("hand");
  key.add(scene, text).add(rate_hz);
  for (const std::string& option : options) key.add(option);
  std::optional<HandCurves> curves;
  std::string told;
  const auto fits = [&](const std::vector<Curve>& found) {
    curves = hand_curves(scene, found, rate_hz);
    return curves.has_value();
  };
  store.find(key.text(), fits, told);
  if (!told.empty()) tell(told);
  if (!curves) {
    const scene::Workspace workspace = scene.workspace;
    const std::optional<double> ramp = scene.coupling.ramp_s;
    CATENA_CHECK(scene::prepare(scene));
    Progress progress("plan: measuring the hand", 1);
    tradeoff::Subject subject{std::move(scene), tradeoff::effort(true, false), {}, {}, rate_hz, {}, {}};
    Result<std::vector<Curve>> measured = Error{};
    const Outcome ready = tradeoff::add_hand(subject, {});
    subject.rate_hz = rate_hz;
    if (ready) measured = measure_hand(subject);
    scene = std::move(subject.scene);
    scene.workspace = workspace;
    scene.coupling.ramp_s = ramp;
    CATENA_CHECK(ready);
    CATENA_CHECK(measured);
    for (const std::string& sentence : subject.left_out) tell("plan: as it is: " + sentence);
    if (!fits(*measured)) return Error{scene.path + ": the hand's curves could not be measured"};
    keep(store, key.text(), scene.path, *measured, tell);
  }
  return HandPlan(std::move(*curves), wanted);
}

Result<std::optional<HandPlan>> plan_links(scene::Scene& scene, const std::string& text, const scene::Plan& wanted, double rate_hz,
                                           const std::vector<std::string>& options, const Tell& tell) {
  if (!wanted.of_hand()) return std::optional<HandPlan>();
  CATENA_TRY(HandPlan plan, make_hand_plan(scene, text, wanted, rate_hz, options, tell));
  if (plan.is_empty()) {
    tell("plan: the hand stays as it is: no streamline link leaves its setting open");
    return std::optional<HandPlan>();
  }
  tell(plan.sentence());
  plan.apply(scene);
  return std::optional(std::move(plan));
}

Result<std::optional<HandPlan>> plan_links(scene::Scene& scene, const scene::Plan& wanted, double rate_hz,
                                           const std::vector<std::string>& options, const Tell& tell) {
  if (!wanted.of_hand()) return std::optional<HandPlan>();
  CATENA_TRY(const std::string text, text_of(scene));
  return plan_links(scene, text, wanted, rate_hz, options, tell);
}

}  // namespace catena::app::plan
