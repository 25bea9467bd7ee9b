// How long pictures and ticks take: the newest pictures as bars, histograms on a logarithmic scale.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/panel.h"

namespace catena::app {

namespace {

void draw_histogram(const char* name, const haptics::HistogramFigures& f) {
  ImGui::Text("%s: %.0f us median, %.0f p99, %.0f longest", name, f.p50_us, f.p99_us, f.max_us);
  if (f.bins.empty()) return;
  // bars by the logarithm of the count: one long picture in ten thousand must be seen
  std::vector<float> bars;
  for (const auto& bin : f.bins) bars.push_back(std::log10(1.0f + static_cast<float>(bin.count)));
  ImGui::PushID(name);
  ImGui::PlotHistogram("##bins", bars.data(), static_cast<int>(bars.size()), 0, nullptr, 0,
                       1.05f * *std::max_element(bars.begin(), bars.end()), {-1, 48});
  ImGui::PopID();
  ImGui::TextDisabled("%.3g us", f.bins.front().from_us);
  ImGui::SameLine(ImGui::GetContentRegionAvail().x - 60);
  ImGui::TextDisabled("%.3g us", f.bins.back().from_us);
}

}  // namespace

void draw_times(PanelContext& context) {
  const FrameTimes& times = context.times;
  ImGui::PlotLines("##recent", times.recent().data(), static_cast<int>(FrameTimes::kRecent), static_cast<int>(times.recent_first()),
                   "ms a picture", 0, 3.4e38f, {-1, 48});
  draw_histogram("pictures", times.draw());
  draw_histogram("interface", times.interface());
  const haptics::ServoReport servo = context.hand.servo().report();
  draw_histogram("ticks", servo.compute);
  draw_histogram("tick to tick", servo.period);
  ImGui::Text("%llu ticks, %llu deadlines missed", static_cast<unsigned long long>(servo.ticks),
              static_cast<unsigned long long>(servo.missed_deadlines));
}

}  // namespace catena::app
