// SPDX-License-Identifier: MIT
// Panel of the tuning: one slider between fast and exact, with predicted and measured error and cost.
#include <fmt/format.h>
#include <imgui.h>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

void draw_numbers(const char* what, const std::string& expected, const std::string& observed) {
  ImGui::TextDisabled("%s", what);
  ImGui::Text("expected  %s", expected.c_str());
  ImGui::Text("observed  %s", observed.c_str());
}

void draw_eye(PanelContext& context) {
  const LiveTuning& live = context.tuning;
  const tuning::ImageTuning& eye = *live.image_tuning;
  ImGui::TextWrapped("%s", render::describe(eye.settings()).c_str());
  const auto error = context.scheduler.rmse();
  draw_numbers("image", fmt::format("{:.2g}/255, {:.3g} ms", eye.expected_error(), eye.expected_ms()),
               fmt::format("{}, {}", error ? fmt::format("{:.2g}/255", *error) : "measured at rest",
                           live.tuned_image_ms > 0 ? fmt::format("{:.3g} ms", live.tuned_image_ms) : "not measured"));
  show_tooltip("root mean square error of the covered pixels against an image of converged rays; render time");
  context.push_command(EstimateImageError{});
}

void draw_hand(PanelContext& context) {
  const LiveTuning& live = context.tuning;
  for (const tuning::TunedLink& link : live.tick_tuning->links()) ImGui::TextWrapped("%s: %s", link.link.c_str(), link.setting.c_str());
  const double us = context.haptic_session.servo().stats().compute.p50_us;
  draw_numbers("links", fmt::format("{:.2g}, {:.3g} us", live.tick_tuning->expected_error(), live.tick_tuning->expected_us()),
               fmt::format("{}, {:.3g} us", live.tracking_error ? fmt::format("{:.2g}", *live.tracking_error) : "not measured", us));
  show_tooltip("maximum distance of a proxy from its converged streamline, world units; compute time of a tick");
  context.push_command(ObserveTrackingError{});
}

void draw_tuning(PanelContext& context) {
  const LiveTuning& live = context.tuning;
  const bool eye = live.image_tuning && !live.has_fixed_quality, hand = live.tick_tuning && !live.tick_tuning->is_empty();
  if (!eye && !hand) {
    ImGui::TextWrapped("The cost and accuracy of the settings are not measured. Measuring stops the image for some seconds.");
    if (ImGui::Button("Measure")) context.push_command(MeasureCosts{});
    return;
  }
  // applied when the slider is released: it replaces the haptic settings
  static double held = 0;
  static bool sliding = false;
  double place = sliding ? held : live.slider_position();
  const double lo = 0, hi = 1;
  ImGui::SliderScalar("fast - exact", ImGuiDataType_Double, &place, &lo, &hi, "");
  held = place;
  sliding = ImGui::IsItemActive();
  if (sliding) {
    for (const scene::Document::Edit& edit : live.edits_at(place))
      if (edit.value) ImGui::TextDisabled("%s: %s", edit.pointer.c_str(), edit.value->c_str());
  }
  if (ImGui::IsItemDeactivatedAfterEdit()) context.edits.set(live.edits_at(place), "accuracy");
  if (eye) draw_eye(context);
  if (hand) draw_hand(context);
  if (live.has_fixed_quality) ImGui::TextDisabled("the scene states a fixed image quality");
}

}  // namespace

Panel tuning_panel() { return {"Accuracy", false, draw_tuning}; }

}  // namespace catena::app
