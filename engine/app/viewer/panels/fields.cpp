// SPDX-License-Identifier: MIT
// Panel of the fields: description, histogram of the values, and buttons that show the field.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/derived_fields.h"

namespace catena::app {

namespace {

std::string bytes_text(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  return mib >= 1024 ? fmt::format("{:.1f} GiB", mib / 1024)
         : mib >= 1  ? fmt::format("{:.0f} MiB", mib)
                     : fmt::format("{} kB", bytes / 1000);
}

std::string range_text(const field::AnyField& field) {
  if (field.vector && field.vector->grid() == nullptr) return {};
  return (field.vector ? "|v| " : "") + catena::format_range(field::display_range(field));
}

void draw_facts(const scene::FieldSource& source, const field::AnyField& shown) {
  const auto row = [](const char* name, const std::string& text) {
    if (text.empty()) return;
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(110);
    ImGui::TextUnformatted(text.c_str());
  };
  if (source.file) {
    row("file", std::filesystem::path(source.file->path).filename().string());
    show_short_tooltip(source.file->path.c_str());
  } else {
    row(source.analytic.empty() ? "made of" : "formula", scene::source_text(source));
  }
  if (shown.get() == nullptr) return;
  const field::Field& field = *shown.get();
  if (field.is_grid()) {
    const Vec3 size = field.index_box().hi - field.index_box().lo + 1.0;
    row("voxels", fmt::format("{:.0f} x {:.0f} x {:.0f}", size.x, size.y, size.z));
    const Mat3& axes = field.mapping().world_from_index_linear;
    row("spacing", fmt::format("{:.4g}, {:.4g}, {:.4g}", norm(axes[0]), norm(axes[1]), norm(axes[2])));
  }
  row("range", range_text(shown));
  if (field.bytes() > 0) row("memory", bytes_text(field.bytes()));
}

/// Draws the histogram; its space stays reserved while the values are being sorted.
void draw_histogram(const SortedSamples& values, const field::AnyField& shown) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 36};
  ImGui::Dummy(size);
  show_short_tooltip("histogram of the field's values; the counts are logarithmic");
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  if (!values || values->empty()) return;
  const DisplayRange values_range = field::display_range(shown);
  const auto range = make_plot_range(values_range.lo, values_range.hi);
  draw_histogram_bars({at.x, at.y, at.x + size.x, at.y + size.y, range[0], range[1]}, values, ImGui::GetColorU32(ImGuiCol_PlotHistogram));
}

/// Loads the field if needed, then adds the item.
void show_as(PanelContext& context, scene::Entity entity, ShowAs as) {
  scene::Scene& scene = context.scene.scene();
  const auto drawn = scene::resolve_rendered_field(scene, entity, scene.entities.get<scene::FieldSource>(entity).where);
  if (!drawn) return context.state.show_message(drawn.error().message, true);
  const SortedSamples values = context.state.appearance.histograms.find_or_request(scene, entity);
  context.edits.set(make_item_edits(scene, entity, *drawn, as, values ? *values : std::vector<float>()),
                    std::string("new ") + to_string(as));
}

void draw_buttons(PanelContext& context, scene::Entity entity, const field::AnyField& shown) {
  bool first = true;
  for (const ShowAs as : {ShowAs::volume, ShowAs::isosurface, ShowAs::slice, ShowAs::streamlines, ShowAs::glyphs}) {
    if (!can_show(shown, as)) continue;
    if (!first) ImGui::SameLine();
    first = false;
    if (ImGui::SmallButton(fmt::format("+ {}", to_string(as)).c_str())) show_as(context, entity, as);
    show_short_tooltip(fmt::format("show the field as {}{}",
                                   as == ShowAs::streamlines || as == ShowAs::glyphs ? ""
                                   : as == ShowAs::isosurface                        ? "an "
                                                                                     : "a ",
                                   to_string(as))
                           .c_str());
  }
}

void draw_fields(PanelContext& context) {
  scene::Scene& scene = context.scene.scene();
  AppearanceState& look = context.state.appearance;
  look.histograms.prune(scene);
  std::vector<scene::Entity> fields;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) { fields.push_back(e); });
  if (fields.empty()) ImGui::TextDisabled("the scene has no fields");
  for (const scene::Entity e : fields) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(e);
    const field::AnyField shown = source.rendered.get() != nullptr ? source.rendered : source.loaded;
    const std::string name = entity_name(scene, e);
    const char* kind = shown.scalar ? "scalar" : shown.vector ? "vector" : "not loaded";
    ImGui::PushID(name.c_str());
    const bool open = ImGui::TreeNodeEx("##field", fields.size() == 1 ? ImGuiTreeNodeFlags_DefaultOpen : 0, "%s", name.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", kind);
    if (open) {
      draw_facts(source, shown);
      if (shown.get() == nullptr) {
        if (ImGui::SmallButton("load"))
          if (auto loaded = scene::resolve_rendered_field(scene, e, source.where); !loaded)
            context.state.show_message(loaded.error().message, true);
      } else {
        if (shown.get()->is_grid()) draw_histogram(look.histograms.find_or_request(scene, e), shown);
        draw_buttons(context, e, shown);
      }
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
}

}  // namespace

Panel fields_panel() { return {"Fields", true, draw_fields}; }

}  // namespace catena::app
