// One slider between fast and exact, with what is expected of it and what was observed.
#include <fmt/format.h>
#include <imgui.h>

#include "engine/app/viewer/panels/edit_items.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/scene/write_values.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

void draw_numbers(const char* what, const std::string& expected, const std::string& observed) {
  ImGui::TextDisabled("%s", what);
  ImGui::Text("expected  %s", expected.c_str());
  ImGui::Text("observed  %s", observed.c_str());
}

void draw_eye(PanelContext& context) {
  const LivePlan& live = context.plan;
  const plan::EyePlan& eye = *live.eye;
  ImGui::TextWrapped("%s", render::describe(eye.settings()).c_str());
  const auto error = context.pacing.rmse();
  draw_numbers("the picture", fmt::format("{:.2g}/255, {:.3g} ms", eye.expected_error(), eye.expected_ms()),
               fmt::format("{}, {}", error ? fmt::format("{:.2g}/255", *error) : "once it rests",
                           live.eye_ms > 0 ? fmt::format("{:.3g} ms", live.eye_ms) : "not yet"));
  tip("root mean square over the covered pixels against converged rays; milliseconds of drawing");
  context.ask(EstimateError{});
}

void draw_hand(PanelContext& context) {
  const LivePlan& live = context.plan;
  for (const plan::PlannedLink& link : live.hand->links()) ImGui::TextWrapped("%s: %s", link.link.c_str(), link.setting.c_str());
  const double us = context.hand.servo().report().compute.p50_us;
  draw_numbers("the hand", fmt::format("{:.2g}, {:.3g} us", live.hand->expected_error(), live.hand->expected_us()),
               fmt::format("{}, {:.3g} us", live.hand_error ? fmt::format("{:.2g}", *live.hand_error) : "not yet", us));
  tip("how far proxies are off their lines at most, world units; microseconds a tick");
  context.ask(ObserveHand{});
}

void draw_plan(PanelContext& context) {
  const LivePlan& live = context.plan;
  const bool eye = live.eye && !live.quality_stated, hand = live.hand && !live.hand->is_empty();
  if (!eye && !hand) {
    ImGui::TextWrapped("What a setting costs and what it buys is not measured yet; the picture stands still for some seconds.");
    if (ImGui::Button("Measure")) context.ask(MeasurePlan{});
    return;
  }
  // it takes hold when it is let go: the hand's settings are new ones from then on
  static double held = 0;
  static bool sliding = false;
  double place = sliding ? held : live.place();
  const double lo = 0, hi = 1;
  ImGui::SliderScalar("fast - exact", ImGuiDataType_Double, &place, &lo, &hi, "");
  held = place;
  sliding = ImGui::IsItemActive();
  if (sliding) {
    const scene::Plan wanted = live.at(place);
    ImGui::TextDisabled("%s", scene::text_of(wanted).c_str());
  }
  if (ImGui::IsItemDeactivatedAfterEdit()) context.edits.set("/plan", scene::text_of(live.at(place)), "plan");
  if (eye) draw_eye(context);
  if (hand) draw_hand(context);
  if (live.quality_stated) ImGui::TextDisabled("the picture's quality is stated");
}

}  // namespace

Panel plan_panel() { return {"Plan", false, draw_plan}; }

}  // namespace catena::app
