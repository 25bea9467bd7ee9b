// SPDX-License-Identifier: MIT
// Panel of the timings: recent frame times against their budget, histograms of frames and ticks on logarithmic scales.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"

namespace catena::app {

namespace {

constexpr ImU32 kBar = IM_COL32(105, 165, 230, 255), kBack = IM_COL32(35, 35, 40, 255), kLine = IM_COL32(120, 120, 125, 255),
                kBudget = IM_COL32(240, 150, 70, 255);

struct PlotArea {
  ImVec2 from, to;
  float width() const { return to.x - from.x; }
  float height() const { return to.y - from.y; }
};

PlotArea take_area(float height) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const PlotArea area{from, {from.x + ImGui::GetContentRegionAvail().x, from.y + height}};
  ImGui::GetWindowDrawList()->AddRectFilled(area.from, area.to, kBack);
  ImGui::Dummy({area.width(), height});
  return area;
}

std::string time_text(double us) {
  return us < 1000 ? fmt::format("{:g} us", us) : us < 1e6 ? fmt::format("{:g} ms", 1e-3 * us) : fmt::format("{:g} s", 1e-6 * us);
}

/// Draws a histogram with logarithmic axes, so that one long frame in ten thousand is visible; a mark at every power of ten.
void draw_histogram(const char* name, const char* what, const haptics::HistogramSummary& f) {
  const auto number = [](double us) { return us < 1000 ? fmt::format("{:.0f} us", us) : fmt::format("{:.3g} ms", 1e-3 * us); };
  ImGui::Text("%s  %s, p99 %s", name, number(f.p50_us).c_str(), number(f.p99_us).c_str());
  show_tooltip(fmt::format("{}: median and 99th percentile; maximum {}", what, number(f.max_us)));
  if (f.bins.empty()) return;
  const PlotArea area = take_area(40);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double lo = std::floor(std::log10(std::max(f.bins.front().from_us, 1e-2))),
               hi = std::max(lo + 1, std::ceil(std::log10(std::max(f.max_us, 2e-2))));
  const auto x_of = [&](double us) {
    return area.from.x + area.width() * static_cast<float>(std::clamp((std::log10(std::max(us, 1e-3)) - lo) / (hi - lo), 0.0, 1.0));
  };
  double maximum = 1;
  for (const auto& bin : f.bins) maximum = std::max(maximum, static_cast<double>(bin.count));
  for (const auto& bin : f.bins) {
    const double share = std::log1p(static_cast<double>(bin.count)) / std::log1p(maximum);
    const float left = x_of(bin.from_us), right = std::max(left + 1.5f, x_of(bin.from_us * 1.09) - 0.5f);
    list.AddRectFilled({left, area.to.y - static_cast<float>(share) * (area.height() - 2)}, {right, area.to.y}, kBar);
  }
  float last = -1e9f;
  for (double decade = lo; decade <= hi; decade += 1) {
    const float x = x_of(std::pow(10.0, decade));
    list.AddLine({x, area.to.y}, {x, area.to.y + 4}, kLine);
    const std::string text = time_text(std::pow(10.0, decade));
    const float w = ImGui::CalcTextSize(text.c_str()).x, at = std::clamp(x - 0.5f * w, area.from.x, area.to.x - w);
    if (at < last + 4) continue;  // too dense to be legible
    list.AddText({at, area.to.y + 4}, kLine, text.c_str());
    last = at + w;
  }
  ImGui::Dummy({1, ImGui::GetTextLineHeight() + 2});
}

/// Draws the most recent frame times, the latest at the right; the line is the budget of interactive frames.
void draw_recent_frames(const FrameTimes& times, double budget_ms) {
  const auto& ring = times.recent();
  float maximum = static_cast<float>(1.5 * budget_ms);
  for (const float ms : ring) maximum = std::max(maximum, ms);
  const PlotArea area = take_area(56);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float step = area.width() / static_cast<float>(FrameTimes::kRecent);
  for (std::size_t i = 0; i < FrameTimes::kRecent; ++i) {
    const float ms = ring[(times.recent_begin() + i) % FrameTimes::kRecent];
    if (ms <= 0) continue;
    const float x = area.from.x + step * static_cast<float>(i);
    list.AddRectFilled({x, area.to.y - ms / maximum * (area.height() - 1)}, {x + std::max(1.0f, step - 0.3f), area.to.y},
                       static_cast<double>(ms) > budget_ms ? kBudget : kBar);
  }
  const float y = area.to.y - static_cast<float>(budget_ms) / maximum * (area.height() - 1);
  list.AddLine({area.from.x, y}, {area.to.x, y}, kBudget);
  list.AddText({area.from.x + 2, area.from.y}, kLine, fmt::format("{:.0f} ms", maximum).c_str());
  show_tooltip(fmt::format("render times of the latest {} images; line: {:g} ms, the time allowed while something moves",
                           FrameTimes::kRecent, budget_ms));
}

void draw_times(PanelContext& context) {
  const FrameTimes& times = context.frame_times;
  draw_recent_frames(times, context.scheduler.budget_ms());
  draw_histogram("Images", "time to render an image", times.draw_times());
  draw_histogram("Interface", "time to draw the interface over the image", times.interface_times());
  const haptics::ServoStats servo = context.haptic_session.servo().stats();
  draw_histogram("Ticks", "time to compute a tick of the servo", servo.compute);
  draw_histogram("Period", "time from the beginning of a tick to the beginning of the next", servo.period);
  ImGui::Text("%llu ticks, %llu deadlines missed", static_cast<unsigned long long>(servo.ticks),
              static_cast<unsigned long long>(servo.missed_deadlines));
}

}  // namespace

Panel times_panel() { return {"Times", false, draw_times}; }

}  // namespace catena::app
