// SPDX-License-Identifier: MIT
// Panel of the quality: image quality, frame time, GPU memory.
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"

namespace catena::app {

namespace {

using Goal = render::QualityGoal;

/// The requested quality as an argument of --quality.
std::string words_of(const Quality& q) {
  if (q.goal) return fmt::format("{}={:.3g}", q.goal->kind == Goal::Kind::time ? "time" : "error", q.goal->value);
  for (const char* word : {"draft", "balanced", "reference"})
    if (const auto named = parse_quality(word); named && render::describe(named->settings) == render::describe(q.settings)) return word;
  return render::describe(q.settings);
}

void draw_goal(PanelContext& context) {
  const Quality& now = context.scheduler.quality();
  const bool time = now.goal && now.goal->kind == Goal::Kind::time, error = now.goal && now.goal->kind == Goal::Kind::error;
  const auto ask = [&](const std::string& words) {
    if (auto quality = parse_quality(words)) context.push_command(SetQuality{*quality});
  };
  if (ImGui::RadioButton("time", time)) ask("time=50");
  show_tooltip("best image within this time, in milliseconds; the image is refined while nothing moves");
  ImGui::SameLine();
  if (ImGui::RadioButton("error", error)) ask("error=1");
  show_tooltip("refine the still image until its estimated error is below this value (root mean square, in 1/255)");
  const std::string words = words_of(now);
  for (const char* word : {"draft", "balanced", "reference"}) {
    if (word[0] != 'd') ImGui::SameLine();
    if (ImGui::RadioButton(word, words == word)) ask(word);
  }
  // a goal is applied when the slider is released: each change restarts the search
  static double held = 0;
  static bool sliding = false;
  if (!time && !error) return;
  double value = sliding ? held : now.goal->value;
  const double lo = time ? 5 : 0.1, hi = time ? 2000 : 20;
  ImGui::SliderScalar("##goal", ImGuiDataType_Double, &value, &lo, &hi, time ? "%.0f ms" : "%.2f /255",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat);
  held = value;
  sliding = ImGui::IsItemActive();
  if (ImGui::IsItemDeactivatedAfterEdit()) ask(fmt::format("{}={:.3g}", time ? "time" : "error", value));
}

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(bytes)); }

void draw_memory(const render::RenderStats& stats) {
  const double share = stats.gpu_budget > 0 ? static_cast<double>(stats.gpu_bytes) / static_cast<double>(stats.gpu_budget) : 0;
  const std::string text = megabytes(stats.gpu_bytes) + " of " + megabytes(stats.gpu_budget);
  ImGui::ProgressBar(static_cast<float>(share), {-1, 0}, text.c_str());
  show_tooltip("memory used on " + stats.device + ", of the maximum (--gpu-memory)");
  if (const std::string bricks = stats.paging.message(); !bricks.empty()) ImGui::TextWrapped("%s", bricks.c_str());
  for (const render::GridDownsampling& coarser : stats.downsampled_grids) ImGui::TextWrapped("%s", coarser.message().c_str());
  for (const std::string& note : stats.warnings) ImGui::TextWrapped("%s", note.c_str());
}

void draw_quality(PanelContext& context) {
  draw_goal(context);
  ImGui::TextWrapped("%s", context.scheduler.status_text().c_str());
  if (const auto rmse = context.scheduler.rmse())
    ImGui::Text("estimated error %.2f / 255", *rmse);
  else
    ImGui::TextDisabled("error: measured at rest");
  show_tooltip("root mean square error against an image of converged rays, over all pixels");
  context.push_command(EstimateImageError{});
  ImGui::Separator();
  draw_memory(context.presenter.renderer().stats());
}

}  // namespace

Panel quality_panel() { return {"Quality", false, draw_quality}; }

}  // namespace catena::app
