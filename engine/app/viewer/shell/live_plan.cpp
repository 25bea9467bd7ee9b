#include "engine/app/viewer/shell/live_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/quality/quality.h"

namespace catena::app {
namespace {

/// Up to three digits, so that what is wanted is not missed by a hair.
double rounded_up(double value) {
  if (!(value > 0)) return 1e-30;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::ceil(value / unit * (1 - 1e-12)) * unit;
}

/// The item at a place of the slider, and the place of the first item that is at most `error`.
std::size_t index_at(double place, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(std::lround(place * static_cast<double>(count - 1))));
}
double place_of(const std::vector<double>& errors, double error) {
  const auto found = std::find_if(errors.begin(), errors.end(), [&](double e) { return e <= error * (1 + 1e-9); });
  const auto index = std::min(static_cast<std::size_t>(found - errors.begin()), errors.size() - 1);
  return errors.size() < 2 ? 1 : static_cast<double>(index) / static_cast<double>(errors.size() - 1);
}

}  // namespace

bool LivePlan::follow(const scene::Plan& text) {
  if (text == stated) return false;
  wanted = stated = text;
  if (eye && wanted.of_eye()) eye->want(wanted);
  if (hand && wanted.of_hand()) hand->want(wanted);
  return true;
}

bool LivePlan::drawn(double ms) {
  const int before = eye->now();
  eye_ms = ms;
  eye->drawn(ms);
  return eye->now() != before;
}

std::optional<Quality> LivePlan::quality() const {
  if (!eye || quality_stated) return std::nullopt;
  Quality quality{eye->settings(), {}};
  quality.moving_ms = wanted.time.value_or(std::clamp(eye->expected_ms(), 5.0, 50.0));
  return quality;
}

scene::Plan LivePlan::at(double place) const {
  scene::Plan plan;
  if (eye && !quality_stated) {
    const std::vector<double> errors = eye->stops();
    plan.error = rounded_up(errors[index_at(place, errors.size())]);
  }
  if (hand && !hand->is_empty()) {
    const std::vector<double> errors = hand->stops();
    plan.hand_error = rounded_up(errors[index_at(place, errors.size())]);
  }
  return plan;
}

double LivePlan::place() const {
  if (eye && !quality_stated) return place_of(eye->stops(), wanted.error.value_or(eye->expected_error()));
  if (hand && !hand->is_empty()) return place_of(hand->stops(), wanted.hand_error.value_or(hand->expected_error()));
  return 1;
}

bool LivePlan::is_drawn_by(const NextPicture& next) const {
  return eye && next.scale == 1 && !next.settings.keep && render::describe(next.settings) == render::describe(eye->settings());
}

Outcome measure_hand(LivePlan& live, SceneHost& scene, const HandHost& hand, const plan::Tell& tell) {
  CATENA_TRY(plan::HandPlan made,
             plan::make_hand_plan(scene.scene(), scene.document().text(), live.wanted, hand.hand().settings.rate_hz, hand.fields(), tell));
  if (made.is_empty()) return Done{};
  live.hand = std::move(made);
  return scene.plan_hand(live.hand);
}

Outcome measure_eye(LivePlan& live, Pacing& pacing, render::Renderer& renderer, const render::FramePacket& packet, const SceneHost& scene,
                    const HandHost& hand, const plan::Tell& tell) {
  if (!render::draws_rays(packet)) {
    tell("plan: the picture has no settings: nothing in it is drawn by rays");
    return Done{};
  }
  auto made = plan::make_eye_plan(renderer, packet, live.wanted, {scene.scene(), scene.document().text(), hand.fields()}, tell);
  if (!made) return Error{made.error().message, true};
  live.eye = std::move(*made);
  tell(live.eye->sentence());
  if (const auto quality = live.quality()) pacing = Pacing(*quality);
  return Done{};
}

void want_the_usual(LivePlan& live) {
  if (!live.wanted.of_eye()) live.wanted.error = 2;
  if (!live.wanted.of_hand()) live.wanted.hand_error = 1e-9;
}

Outcome follow_text(LivePlan& live, SceneHost& scene, Pacing& pacing) {
  if (!live.follow(std::as_const(scene).scene().plan)) return Done{};
  const Outcome planned = live.hand && live.wanted.of_hand() ? scene.plan_hand(live.hand) : Outcome(Done{});
  if (const auto quality = live.quality(); quality && live.wanted.of_eye()) pacing = Pacing(*quality);
  scene.take_changed();
  return planned;
}

}  // namespace catena::app
