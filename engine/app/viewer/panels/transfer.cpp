// SPDX-License-Identifier: MIT
// Panel of the volumes and their transfer functions: opacity points over the histogram, colors in a bar below, edited with the pointer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

constexpr float kPlotHeight = 120, kBarHeight = 16, kHandle = 4.5f, kReach = 9, kOff = 36;  // pixels
constexpr double kFine = 0.1, kAlphaSteps = 1000;

using Writer = TextEdits (*)(const scene::Volume&, TransferEdit);
using Select = std::optional<std::size_t> AppearanceState::TransferEditor::*;

struct Editor {
  PanelContext& context;
  Edits& edits;
  const scene::Volume& volume;
  AppearanceState::TransferEditor& state;
  TransferEdit edit;  ///< the transfer function of the scene
  SortedSamples values;
  PlotTransform plot, bar;  ///< plot transforms, both over the same range of values
};

// ---- display ----

/// Range that contains all points, and the values without their rarest tails.
std::array<double, 2> shown_range(const Editor& editor, const field::ScalarField& field) {
  if (editor.state.show_full_range) return plottable_range(editor.edit, field.min_value(), field.max_value());
  auto range = *value_range(editor.edit.colors, editor.edit.opacities);
  if (editor.values && !editor.values->empty()) {
    const DisplayRange all = field::display_range(field);
    range[0] = std::min(range[0], std::max(all.lo, quantile_of_sorted(*editor.values, 0.002)));
    range[1] = std::max(range[1], std::min(all.hi, quantile_of_sorted(*editor.values, 0.998)));
  }
  return plottable_range(editor.edit, range[0], range[1]);
}

void draw_curve(const Editor& editor) {
  const PlotTransform& plot = editor.plot;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 lo{static_cast<float>(plot.left), static_cast<float>(plot.top)},
      hi{static_cast<float>(plot.right), static_cast<float>(plot.bottom)};
  list->AddRectFilled(lo, hi, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  list->PushClipRect({lo.x - kHandle, lo.y - kHandle}, {hi.x + kHandle, hi.y + kHandle}, true);
  draw_histogram_bars(plot, editor.values, ImGui::GetColorU32(ImGuiCol_Text, 0.25f));
  for (const double alpha : {0.1, 0.5}) {
    const auto y = static_cast<float>(plot.to_y(alpha));
    list->AddLine({lo.x, y}, {hi.x, y}, ImGui::GetColorU32(ImGuiCol_Text, 0.12f));
    list->AddText({lo.x + 3, y - ImGui::GetTextLineHeight()}, ImGui::GetColorU32(ImGuiCol_Text, 0.4f), fmt::format("{}", alpha).c_str());
  }
  // the area under the curve in the colors of the transfer function
  constexpr float kStep = 1;
  ImVec2 last;
  for (float x = lo.x; x <= hi.x; x += kStep) {
    const double value = plot.value_at(x);
    const auto y = static_cast<float>(plot.to_y(evaluate_alpha(editor.edit.opacities, value, editor.edit.linear_below)));
    list->AddRectFilled({x, y}, {x + kStep, hi.y},
                        to_imgui_color(evaluate_color(editor.edit.colors, value, editor.edit.linear_below), 0.55f));
    if (x > lo.x) list->AddLine(last, {x, y}, ImGui::GetColorU32(ImGuiCol_Text), 1.5f);
    last = {x, y};
  }
  for (std::size_t i = 0; i < editor.edit.opacities.size(); ++i) {
    const auto& p = editor.edit.opacities[i];
    const ImVec2 at{static_cast<float>(plot.to_x(p.value)), static_cast<float>(plot.to_y(p.alpha))};
    list->AddCircleFilled(at, kHandle, ImGui::GetColorU32(editor.state.selected_opacity == i ? ImGuiCol_CheckMark : ImGuiCol_Text));
    list->AddCircle(at, kHandle, IM_COL32(0, 0, 0, 200), 0, 1.5f);
  }
  list->PopClipRect();
}

void draw_bar(const Editor& editor, bool handles) {
  const PlotTransform& bar = editor.bar;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto top = static_cast<float>(bar.top), bottom = static_cast<float>(bar.bottom);
  for (auto x = static_cast<float>(bar.left); x < static_cast<float>(bar.right); x += 2)
    list->AddRectFilled({x, top}, {std::min(x + 2, static_cast<float>(bar.right)), bottom},
                        to_imgui_color(evaluate_color(editor.edit.colors, bar.value_at(x + 1), editor.edit.linear_below)));
  if (!handles) return;
  for (std::size_t i = 0; i < editor.edit.colors.size(); ++i) {
    const auto x = static_cast<float>(bar.to_x(editor.edit.colors[i].value));
    if (x < bar.left - 1 || x > bar.right + 1) continue;
    const ImU32 edge = editor.state.selected_color == i ? ImGui::GetColorU32(ImGuiCol_CheckMark) : IM_COL32(230, 230, 230, 255);
    list->AddRectFilled({x - 4, top - 2}, {x + 4, bottom + 2}, IM_COL32(0, 0, 0, 200), 2);
    list->AddRectFilled({x - 3, top - 1}, {x + 3, bottom + 1}, edge, 2);
    list->AddRectFilled({x - 1.5f, top + 1}, {x + 1.5f, bottom - 1}, to_imgui_color(editor.edit.colors[i].color));
  }
}

// ---- pointer input ----

/// Applies the drag to the points as they were at its start.
template <class Points, class Move>
void dragged(Editor& editor, Points TransferEdit::*points, Select selected, const PlotTransform& frame, Move&& move, Writer writes,
             const char* what) {
  AppearanceState& look = editor.context.state.appearance;
  if (!editor.state.before_drag || !(editor.state.*selected) || *(editor.state.*selected) >= ((*editor.state.before_drag).*points).size())
    return;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDelta.x == 0 && io.MouseDelta.y == 0) return;
  const double factor = io.KeyCtrl ? kFine : 1;
  look.handle_x += factor * io.MouseDelta.x;
  look.handle_y += factor * io.MouseDelta.y;
  TransferEdit now = *editor.state.before_drag;
  const bool off = io.MousePos.y < frame.top - kOff || io.MousePos.y > frame.bottom + kOff;
  if (!off || !remove_point(now.*points, *(editor.state.*selected)))
    move(now.*points, *(editor.state.*selected), frame.rounded_value_at(look.handle_x));
  editor.edits.drag(writes(editor.volume, now), what);
}

/// Handles a press: selects the handle at that position, or creates one.
template <class Points>
void pressed(Editor& editor, Points TransferEdit::*points, Select selected, std::optional<std::size_t> there,
             const std::function<std::optional<std::size_t>(Points&)>& add, Writer writes, const char* what) {
  editor.state.before_drag = editor.edit;
  editor.state.*selected = there;
  if (there) return;
  editor.state.*selected = add((*editor.state.before_drag).*points);
  if (editor.state.*selected) editor.edits.drag(writes(editor.volume, *editor.state.before_drag), what);
}

template <class Points>
void remove_at(Editor& editor, Points TransferEdit::*points, Select selected, std::optional<std::size_t> there, Writer writes,
               const char* what) {
  TransferEdit now = editor.edit;
  if (!there || !remove_point(now.*points, *there)) return;
  (editor.state.*selected).reset();
  editor.state.before_drag.reset();
  editor.edits.drag(writes(editor.volume, now), what);
}

double rounded_alpha(double alpha) {
  // small opacities need more digits
  return alpha < 0.02 ? std::round(alpha * 20 * kAlphaSteps) / (20 * kAlphaSteps) : std::round(alpha * kAlphaSteps) / kAlphaSteps;
}

void move_opacities(Editor& editor) {
  const ImGuiIO& io = ImGui::GetIO();
  const PlotTransform& plot = editor.plot;
  AppearanceState& look = editor.context.state.appearance;
  const auto there = find_point(editor.edit.opacities, plot, io.MousePos.x, io.MousePos.y, kReach);
  if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    pressed<OpacityPoints>(
        editor, &TransferEdit::opacities, &AppearanceState::TransferEditor::selected_opacity, there,
        [&](OpacityPoints& points) {
          return add_point(points, plot, plot.rounded_value_at(io.MousePos.x), rounded_alpha(plot.alpha_at(io.MousePos.y)));
        },
        make_opacity_edits, "opacity");
    look.handle_x = there ? plot.to_x(editor.edit.opacities[*there].value) : io.MousePos.x;
    look.handle_y = there ? plot.to_y(editor.edit.opacities[*there].alpha) : io.MousePos.y;
  } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    dragged(
        editor, &TransferEdit::opacities, &AppearanceState::TransferEditor::selected_opacity, plot,
        [&](OpacityPoints& points, std::size_t i, double value) {
          move_point(points, plot, i, value, rounded_alpha(plot.alpha_at(look.handle_y)));
        },
        make_opacity_edits, "opacity");
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
    remove_at(editor, &TransferEdit::opacities, &AppearanceState::TransferEditor::selected_opacity, there, make_opacity_edits, "opacity");
  if (!ImGui::IsItemHovered() || ImGui::IsItemActive()) return;
  if (there)
    ImGui::SetTooltip("%.6g: %.3g", editor.edit.opacities[*there].value, editor.edit.opacities[*there].alpha);
  else
    ImGui::SetTooltip("%.5g\nclick: add a point, right click: remove a point", plot.value_at(io.MousePos.x));
}

void move_colors(Editor& editor) {
  const ImGuiIO& io = ImGui::GetIO();
  const PlotTransform& bar = editor.bar;
  AppearanceState& look = editor.context.state.appearance;
  if (!editor.edit.color_map.empty()) return show_short_tooltip("named colour map; the button \"points\" converts it into editable points");
  const auto there = find_point(editor.edit.colors, bar, io.MousePos.x, kReach);
  if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    pressed<ColorPoints>(
        editor, &TransferEdit::colors, &AppearanceState::TransferEditor::selected_color, there,
        [&](ColorPoints& points) { return add_point(points, bar, bar.rounded_value_at(io.MousePos.x)); }, make_color_edits, "colours");
    look.handle_x = there ? bar.to_x(editor.edit.colors[*there].value) : io.MousePos.x;
  } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    dragged(
        editor, &TransferEdit::colors, &AppearanceState::TransferEditor::selected_color, bar,
        [&](ColorPoints& points, std::size_t i, double value) { move_point(points, bar, i, value); }, make_color_edits, "colours");
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
    remove_at(editor, &TransferEdit::colors, &AppearanceState::TransferEditor::selected_color, there, make_color_edits, "colours");
  if (!ImGui::IsItemActive()) show_short_tooltip("click: add a colour, drag: move a colour, right click: remove a colour");
}

// ---- typed values and selections ----

/// Draws the values of the selected point. The line also takes space without a selection, so that the layout does not move.
void draw_opacity_line(Editor& editor, bool mine) {
  const auto selected = editor.state.selected_opacity;
  const bool has = mine && selected && *selected < editor.edit.opacities.size();
  auto point = has ? editor.edit.opacities[*selected] : scene::TransferFunction::OpacityPoint{0, 0};
  ImGui::BeginDisabled(!has);
  ImGui::SetNextItemWidth(78);
  bool typed = input_number("##value", point.value, "value of the selected point; Enter applies");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(78);
  typed = input_number("opacity", point.alpha, "opacity of the selected point along the length `unit`, below 1; Enter applies") || typed;
  ImGui::EndDisabled();
  if (!typed || !has) return;
  TransferEdit now = editor.edit;
  move_point(now.opacities, editor.plot, *selected, point.value, point.alpha);
  editor.edits.drag(make_opacity_edits(editor.volume, now), "opacity");
}

void draw_color_line(Editor& editor, bool mine) {
  const auto selected = editor.state.selected_color;
  const bool has = mine && editor.edit.color_map.empty() && selected && *selected < editor.edit.colors.size();
  auto point = has ? editor.edit.colors[*selected] : scene::TransferFunction::ColorPoint{0, {0.3f, 0.3f, 0.3f}};
  ImGui::BeginDisabled(!has);
  ImGui::SetNextItemWidth(78);
  bool changed = input_number("##color value", point.value, "value of the selected colour; Enter applies");
  ImGui::SameLine();
  float rgb[3] = {point.color.r, point.color.g, point.color.b};
  changed = ImGui::ColorEdit3("colour", rgb, ImGuiColorEditFlags_NoInputs) || changed;
  ImGui::EndDisabled();
  if (!changed || !has) return;
  TransferEdit now = editor.edit;
  move_point(now.colors, editor.bar, *selected, point.value);
  now.colors[*selected].color = {rgb[0], rgb[1], rgb[2]};
  editor.edits.drag(make_color_edits(editor.volume, now), "colours");
}

void draw_choices(Editor& editor) {
  if (const auto map = choose_color_map(editor.edit.color_map, "points"))
    editor.edits.drag(make_color_map_edits(editor.volume, editor.edit, *map), "colours");
  if (!editor.edit.color_map.empty()) {
    ImGui::SameLine();
    if (ImGui::SmallButton("points")) editor.edits.drag(make_color_edits(editor.volume, editor.edit), "colours");
    show_short_tooltip("convert the named colour map into points that can be edited");
  }
  if (const auto mapping = choose_mapping(editor.edit.mapping, editor.edit.linear_below)) {
    const auto writes = make_mapping_edits(editor.volume, editor.edit, *mapping);
    if (writes.empty())
      editor.context.state.show_message("a logarithmic mapping needs points above 0; choose symlog for values of 0 or below", true);
    else
      editor.edits.set(writes, "mapping");
  }
  auto reach = *value_range(editor.edit.colors, editor.edit.opacities);
  ImGui::SetNextItemWidth(78);
  bool typed = input_number("##from", reach[0], "minimum value of the points; a change rescales all points; Enter applies");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(78);
  typed = input_number("range", reach[1], "maximum value of the points; a change rescales all points; Enter applies") || typed;
  if (typed) {
    const auto writes = make_range_edits(editor.volume, editor.edit, reach[0], reach[1]);
    if (writes.empty())
      editor.context.state.show_message("the points do not fit into this range; two increasing numbers were expected", true);
    else
      editor.edits.drag(writes, "range");
  }
  ImGui::SameLine();
  ImGui::Checkbox("all", &editor.state.show_full_range);
  show_short_tooltip("plot the full range of the field, including rare values");

  auto unit = static_cast<float>(editor.edit.opacity_unit);
  ImGui::SetNextItemWidth(78);
  const float speed = 0.01f * unit;
  if (ImGui::DragFloat("unit", &unit, speed, 1e-30f, 1e30f, "%.4g", ImGuiSliderFlags_AlwaysClamp) && unit > 0) {
    TransferEdit now = editor.edit;
    now.opacity_unit = round_within(unit, 0, unit, 500);
    editor.edits.drag(make_unit_edits(editor.volume, now), "opacity unit");
  }
  show_short_tooltip(
      "length of the ray segment to which the opacities refer, world units; a longer unit makes the volume more transparent");
  ImGui::SameLine();
  edit_boolean(editor.edits, "shade", editor.volume.shaded, item_pointer(editor.volume.where) + "/shade");
  const scene::NamedColors& named = editor.volume.transfer.named;
  ImGui::SameLine();
  edit_threshold(editor.edits, item_pointer(editor.volume.where) + "/threshold", named.threshold,
                 first_threshold(scene::rendered_field(editor.context.scene.scene(), editor.volume.field)));
  if (!editor.volume.transfer.gradient_factors.empty()) ImGui::TextDisabled("gradient opacity: edit in the file");
}

void draw_editor(PanelContext& context, Edits& edits, const scene::Volume& volume) {
  scene::Scene& scene = context.scene.scene();
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(volume.field);
  AppearanceState::TransferEditor& state = context.state.appearance.transfer_editor;
  const auto edit = source.rendered.scalar ? make_transfer_edit(volume, source.rendered.scalar->mapping().min_voxel_edge()) : std::nullopt;
  if (!edit) {
    ImGui::TextDisabled("the field is not loaded: show the volume first");
    return;
  }
  if (const std::string pointer = item_pointer(volume.where); state.volume != pointer) {
    // a different volume: its selection is cleared, but a press on it counts
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && state.before_drag) return;
  }
  Editor editor{context, edits, volume, state, *edit, context.state.appearance.histograms.find_or_request(scene, volume.field), {}, {}};

  // the plot's transform stays fixed during a drag
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x - kHandle;
  const bool mine = state.volume == item_pointer(volume.where);
  const auto range = shown_range(editor, *source.rendered.scalar);
  editor.plot = {at.x + kHandle, at.y + kHandle, at.x + width, at.y + kPlotHeight, range[0], range[1], edit->linear_below};
  if (mine && state.before_drag && state.drag_frame) editor.plot.lo = state.drag_frame->lo, editor.plot.hi = state.drag_frame->hi;
  ImGui::InvisibleButton("##plot", {width + kHandle, kPlotHeight + 4});
  const auto claim = [&] {
    if (!ImGui::IsItemActivated() && !(ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))) return;
    if (!mine) state.selected_opacity.reset(), state.selected_color.reset(), state.before_drag.reset();
    state.volume = item_pointer(volume.where);
    state.drag_frame = editor.plot;
  };
  claim();
  move_opacities(editor);
  draw_curve(editor);

  const ImVec2 below = ImGui::GetCursorScreenPos();
  editor.bar = {editor.plot.left, below.y, editor.plot.right, below.y + kBarHeight, editor.plot.lo, editor.plot.hi, edit->linear_below};
  ImGui::InvisibleButton("##bar", {width + kHandle, kBarHeight + 2});
  claim();
  move_colors(editor);
  draw_bar(editor, editor.edit.color_map.empty());
  ImGui::TextDisabled("%.5g", editor.plot.lo);
  const std::string hi = fmt::format("{:.5g}", editor.plot.hi);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(hi.c_str()).x - kHandle);
  ImGui::TextDisabled("%s", hi.c_str());
  draw_opacity_line(editor, mine);
  draw_color_line(editor, mine);
  draw_choices(editor);
}

void draw_transfer(PanelContext& context) {
  Edits& edits = context.edits;
  AppearanceState::TransferEditor& state = context.state.appearance.transfer_editor;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) state.before_drag.reset();
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::Volume>([&](scene::Entity e, const scene::Volume& volume) {
    if (!begin_item(edits, volume.where, !is_hidden(scene.entities, e), "volume", entity_name(scene, volume.field))) return;
    draw_editor(context, edits, volume);
    end_item();
  });
}

}  // namespace

Panel volumes_panel() { return {"Volumes", true, draw_transfer, has_any<scene::Volume>}; }

}  // namespace catena::app
