// SPDX-License-Identifier: MIT
// Panel of measuring: length of a ruler, angle to another one, the profile of a field along it, and the labels of a label map. Rulers are
// dragged in the views and saved with the scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/app/viewer/edit/ruler_angle.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/app/viewer/panels/measure.h"
#include "engine/field/measure/moments.h"
#include "engine/field/measure/profile.h"
#include "engine/scene/units.h"

namespace catena::app {

namespace {

constexpr std::size_t kSamples = 256;
constexpr float kPlotHeight = 90;

struct Ruler {
  std::string name;
  std::array<Vec3, 2> ends{};
};

std::vector<Ruler> rulers_of(const scene::Scene& scene) {
  std::vector<Ruler> rulers;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    const auto& points = widget.report.pose.points;
    if (widget.spec.kind == widget::Kind::ruler) rulers.push_back({entity_name(scene, e), {points[0], points[1]}});
  });
  return rulers;
}

/// Fields that are loaded, by name.
std::vector<std::string> loaded_fields(const scene::Scene& scene) {
  std::vector<std::string> names;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.loaded.get() != nullptr) names.push_back(entity_name(scene, e));
  });
  return names;
}

/// Value of a sample; the magnitude of a vector; NaN where there is none.
double value_of(const field::PointValue& sample, bool is_vector) {
  return !sample.value ? NAN : is_vector ? norm(*sample.value) : sample.value->x;
}

/// Draws the values over the length of the line, with the numbers under the pointer.
void draw_plot(const std::vector<field::PointValue>& samples, const std::vector<double>& values, double lo, double hi,
               const std::string& length_unit, const std::string& value_unit) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, kPlotHeight};
  ImGui::InvisibleButton("##profile", size);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  const double span = hi > lo ? hi - lo : 1;
  const auto place = [&](std::size_t i) {
    return ImVec2(at.x + size.x * static_cast<float>(i) / static_cast<float>(values.size() - 1),
                  at.y + size.y * (0.95f - 0.9f * static_cast<float>((values[i] - lo) / span)));
  };
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::isfinite(values[i - 1]) && std::isfinite(values[i]))
      list->AddLine(place(i - 1), place(i), ImGui::GetColorU32(ImGuiCol_PlotLines), 1.5f);
  if (!ImGui::IsItemHovered()) return;
  const float share = std::clamp((ImGui::GetIO().MousePos.x - at.x) / size.x, 0.0f, 1.0f);
  const auto i = static_cast<std::size_t>(std::lround(share * static_cast<float>(values.size() - 1)));
  const Vec3& p = samples[i].position;
  ImGui::SetTooltip("%s", fmt::format("{:.5g}{}: {}{}\n{:.5g}, {:.5g}, {:.5g}", samples[i].length, length_unit,
                                      std::isfinite(values[i]) ? fmt::format("{:.6g}", values[i]) : "no value",
                                      std::isfinite(values[i]) ? value_unit : "", p.x, p.y, p.z)
                              .c_str());
}

std::string to_csv(const std::vector<field::PointValue>& samples, const std::vector<double>& values) {
  std::string text = "length,x,y,z,value\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3& p = samples[i].position;
    text += fmt::format("{},{},{},{},{}\n", samples[i].length, p.x, p.y, p.z, std::isfinite(values[i]) ? fmt::format("{}", values[i]) : "");
  }
  return text;
}

void draw_profile(PanelContext& context, const Ruler& ruler, const std::string& field) {
  const scene::Scene& scene = context.scene.scene();
  const scene::Entity entity = scene::find_field(scene, field);
  const field::AnyField& any = scene.entities.get<scene::FieldSource>(entity).loaded;
  const std::string unit = scene::unit_suffix(scene::unit_of(scene, entity));
  const std::string length_unit = scene::unit_suffix(context.state.unit_length);
  const std::vector<field::PointValue> samples = field::sample_line(any, ruler.ends[0], ruler.ends[1], kSamples);
  std::vector<double> values;
  field::Moments moments;
  for (const field::PointValue& sample : samples) {
    values.push_back(value_of(sample, any.vector != nullptr));
    if (std::isfinite(values.back())) moments.add(values.back());
  }
  if (moments.count() == 0) {
    ImGui::TextDisabled("the ruler is outside of the field");
    return;
  }
  draw_plot(samples, values, moments.min(), moments.max(), length_unit, unit);
  ImGui::TextWrapped("%s", fmt::format("from {:.5g} to {:.5g}{}, mean {:.5g}, deviation {:.3g}", moments.min(), moments.max(), unit,
                                       moments.mean(), moments.deviation())
                               .c_str());
  if (ImGui::Button("Copy as CSV")) {
    ImGui::SetClipboardText(to_csv(samples, values).c_str());
    context.state.show_message(fmt::format("copied {} values along {}", kSamples, ruler.name));
  }
  show_tooltip("length, position and value of each sample; catena measure --line writes the same to a file");
}

/// Draws the length of the chosen ruler, and its angle to another one.
void draw_rulers(PanelContext& context, const std::vector<Ruler>& rulers) {
  AppearanceState::Measure& chosen = context.state.appearance.measure;
  std::vector<std::string> names;
  for (const Ruler& ruler : rulers) names.push_back(ruler.name);
  if (std::ranges::find(names, chosen.ruler) == names.end()) chosen.ruler = names.front();
  if (names.size() > 1) choose_from_list("along", names, chosen.ruler);
  const Ruler& ruler = *std::ranges::find(rulers, chosen.ruler, &Ruler::name);
  ImGui::Text("length %.6g%s", norm(ruler.ends[1] - ruler.ends[0]), scene::unit_suffix(context.state.unit_length).c_str());
  if (names.size() < 2) {
    ImGui::TextDisabled("a second ruler shows an angle");
    return;
  }
  std::erase(names, chosen.ruler);
  if (std::ranges::find(names, chosen.second_ruler) == names.end()) chosen.second_ruler = names.front();
  choose_from_list("angle to", names, chosen.second_ruler);
  const auto angle = angle_between(ruler.ends, std::ranges::find(rulers, chosen.second_ruler, &Ruler::name)->ends);
  if (!angle)
    ImGui::TextDisabled("a ruler has no length");
  else
    ImGui::Text("angle %.4g degrees %s", angle->degrees, angle->has_shared_end ? "at the shared end" : "between the lines");
  show_tooltip(
      "place an end of one ruler on an end of the other for the angle at this point, up to 180 degrees; otherwise the lines have an "
      "angle of at most 90 degrees");
}

void draw_measure(PanelContext& context) {
  const scene::Scene& scene = context.scene.scene();
  const std::vector<Ruler> rulers = rulers_of(scene);
  const std::vector<std::string> fields = loaded_fields(scene);
  AppearanceState::Measure& chosen = context.state.appearance.measure;
  if (rulers.empty()) {
    ImGui::TextWrapped("+ ruler, in Widgets, adds a line to measure along.");
  } else {
    draw_rulers(context, rulers);
    if (std::ranges::find(fields, chosen.field) == fields.end()) chosen.field = fields.empty() ? "" : fields.front();
    if (fields.empty()) {
      ImGui::TextDisabled("no field is loaded");
    } else {
      choose_from_list("field", fields, chosen.field);
      draw_profile(context, *std::ranges::find(rulers, chosen.ruler, &Ruler::name), chosen.field);
    }
  }
  if (has_label_map(scene)) draw_label_statistics(context);
}

}  // namespace

Panel measure_panel() { return {"Measure", false, draw_measure, has_any<scene::FieldSource>}; }

}  // namespace catena::app
