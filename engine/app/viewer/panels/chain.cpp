// SPDX-License-Identifier: MIT
// Panel of the chain: the links in their order, with the status and the keys of each link.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <optional>

#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

using schema::Role;
using schema::ValueType;

ImVec4 color_of(LinkStatus status, bool active) {
  if (status == LinkStatus::ok) return active ? ImVec4(0.5f, 0.9f, 0.5f, 1) : ImVec4(0.6f, 0.6f, 0.6f, 1);
  if (status == LinkStatus::free || status == LinkStatus::released) return {0.65f, 0.75f, 0.9f, 1};
  return {1, 0.7f, 0.35f, 1};
}

/// Short text of a status, and its explanation for the tooltip.
struct StatusWords {
  const char *plain, *meaning;
};
StatusWords words_of(LinkStatus status) {
  switch (status) {
    case LinkStatus::ok:
      return {"holds", "the constraint holds"};
    case LinkStatus::free:
      return {"free", "the probe is not in contact, or the link is inactive"};
    case LinkStatus::released:
      return {"released", "the probe has left the feature, or has not snapped to it yet"};
    case LinkStatus::budget:
      return {"searching", "the proxy is the best position found in one tick; the search continues in the next tick"};
    case LinkStatus::critical:
      return {"undefined", "the proxy is at a critical point, or at a point where the constraint is undefined"};
    case LinkStatus::boundary:
      return {"at the boundary", "the proxy is at the boundary of the domain"};
    case LinkStatus::no_surface:
      return {"out of reach", "no surface or line was found near the probe"};
    case LinkStatus::bad_probe:
      return {"bad probe", "the position of the probe is not finite"};
    case LinkStatus::coarse:
      return {"holds, coarse", "the constraint holds on a coarser level of the data, until the full resolution is read"};
  }
  return {"", ""};
}

void draw_live(const LinkReport& link, const std::string& name, double max_n, const std::string& unit_length) {
  const double share = norm(link.force_n);
  ImGui::ProgressBar(static_cast<float>(max_n > 0 ? share / max_n : 0), {-1, 0.8f * ImGui::GetFrameHeight()},
                     fmt::format("{:.2f} N", share).c_str());
  show_tooltip("force of the link " + name + ", as a fraction of the coupling's maximum force");
  ImGui::TextDisabled("gap %.3g%s", link.gap, unit_length.empty() ? "" : (" " + unit_length).c_str());
  show_tooltip(
      fmt::format("distance from the link's proxy to the preceding proxy, or to the probe for the first link; residual {:.2g}, weight "
                  "{:.2f}, stiffness {:.0f} N/m, {} field evaluations in the last tick",
                  link.residual, link.weight, link.stiffness_n_per_m, static_cast<int>(link.evaluations)));
}

/// Characteristic length of the scene, the default base of keys given as a fraction of it.
double length_of(const PanelContext& context) {
  const double edge = context.scene.bounds.longest_edge();
  return edge > 0 ? edge : 4;
}

Vec3 probe_of(const PanelContext& context) {
  const HapticState& haptic_state = context.haptic_session.latest_state();
  return haptic_state.tick > 0 && is_finite(haptic_state.probe) ? haptic_state.probe : context.haptic_session.initial_probe();
}

void draw_name_choice(PanelContext& context, const ChainRow& row, const schema::Key& key, const std::vector<std::string>& words,
                      const std::string& now) {
  std::string chosen = now;
  if (!choose_from_list(key.name.c_str(), words, chosen)) return;
  const bool field = key.role == Role::scalar_field || key.role == Role::vector_field;
  if (field)
    context.edits.set(make_change_field_edits(context.scene.scene(), row, key, chosen, probe_of(context)), key.name);
  else
    context.edits.set(row.pointer(key.name), scene::to_json(chosen), key.name);
}

/// Draws one key that the link states.
void draw_stated(PanelContext& context, const ChainRow& row, const schema::Key& key, const json::Node& value, double length) {
  const std::string pointer = row.pointer(key.name);
  const bool number = value.kind == json::Kind::number, word = value.kind == json::Kind::string;
  const double speed = key.name == "stiffness" ? 2 : key.name == "level" ? 0 : 0.001 * length;
  if (key.value_type == ValueType::number && number) {
    NumberItem item{key.name.c_str(), pointer, value.number, 0, 0, speed};
    if (key.limits.lo == 0.0) item.hi = 1e9;
    if (key.name == "level") item.coupled_pointers = find_coupled_levels(context.scene.scene(), row);
    edit_number(context.edits, item);
  } else if (key.value_type == ValueType::vector && key.count == 3 && value.items.size() == 3) {
    if (const auto v = json::as_vec3(value, key.name)) {
      edit_vector(context.edits, key.name.c_str(), pointer, *v, speed);
      const bool place = (key.unit == "world" && !key.initial_value.ends_with(" L")) || key.initial_value.starts_with("hand");
      if (place && ImGui::SmallButton(("to the probe##" + key.name).c_str()))
        context.edits.set(pointer, scene::to_json(probe_of(context)), key.name);
    }
  } else if (key.value_type == ValueType::choice && word) {
    draw_name_choice(context, row, key, key.options, value.string);
  } else if (key.value_type == ValueType::boolean && value.kind == json::Kind::boolean) {
    bool on = value.boolean;
    if (ImGui::Checkbox(key.name.c_str(), &on)) context.edits.set(pointer, on ? "true" : "false", key.name);
  } else if ((key.role == Role::scalar_field || key.role == Role::vector_field) && word) {
    draw_name_choice(context, row, key, list_field_names(context.scene.scene(), key.role == Role::vector_field), value.string);
  } else if (key.role == Role::mesh && word) {
    draw_name_choice(context, row, key, list_mesh_names(context.scene.scene()), value.string);
  } else if (key.role == Role::curves && word) {
    draw_name_choice(context, row, key, list_curve_names(context.scene.scene()), value.string);
  } else if (key.role == Role::points && word) {
    draw_name_choice(context, row, key, list_point_set_names(context.scene.scene()), value.string);
  } else {
    ImGui::TextDisabled("%s: edit in the file", key.name.c_str());
  }
}

void draw_keys(PanelContext& context, const ChainRow& row) {
  const double length = length_of(context);
  schema::Keys absent;
  for (const schema::Key& key : link_type_keys(row.type)) {
    const json::Node* value = row.node.find(key.name);
    if (value == nullptr) {
      absent.push_back(key);
      continue;
    }
    draw_stated(context, row, key, *value, length);
    show_tooltip(key.help);
    if (key.is_required) continue;
    ImGui::SameLine();
    if (ImGui::SmallButton(("x##" + key.name).c_str())) context.edits.remove(row.pointer(key.name), "remove " + key.name);
    show_tooltip("reset to the default");
  }
  if (absent.empty() || !ImGui::BeginCombo("##key", "add a key", ImGuiComboFlags_HeightLarge)) return;
  for (const schema::Key& key : absent) {
    if (ImGui::Selectable(key.name.c_str())) {
      const auto edits = make_add_key_edits(context.scene.scene(), row, key, probe_of(context), length);
      if (edits.empty())
        context.state.show_message("\"" + key.name + "\" has no initial value in this scene; write the key into the scene file", true);
      else
        context.edits.set(edits, key.name);
    }
    show_tooltip(key.help);
  }
  ImGui::EndCombo();
}

/// A change of the list, carried out after the list has been drawn.
struct Move {
  std::size_t row;
  int by;  ///< -1 or 1: move up or down; 0: remove
};

std::optional<Move> draw_row(PanelContext& context, const ChainRow& row, std::size_t count, double max_n) {
  std::optional<Move> move;
  const HapticState& haptic_state = context.haptic_session.latest_state();
  ImGui::PushID(row.name.c_str());
  bool enabled = row.enabled;
  if (ImGui::Checkbox("##on", &enabled)) {
    if (enabled)
      context.edits.remove(row.pointer("enabled"), row.name + " on");
    else
      context.edits.set(row.pointer("enabled"), "false", row.name + " off");
  }
  show_tooltip("switches the link on or off; the other links are not changed");
  ImGui::SameLine();
  const bool open = ImGui::TreeNodeEx("##keys", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", row.name.c_str());
  show_tooltip("keys of the link " + row.name + " of type " + row.type);
  for (const std::size_t link : row.links) {
    if (link >= static_cast<std::size_t>(haptic_state.link_count)) continue;
    const LinkReport& report = haptic_state.links[link];
    const StatusWords words = words_of(report.status);
    const char* word = row.enabled ? words.plain : "off";
    if (row.links.size() == 1) {
      ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(word).x);
    } else {
      ImGui::TextDisabled("%s", context.haptic_session.link_names()[link].c_str());
      ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(word).x);
    }
    ImGui::TextColored(row.enabled ? color_of(report.status, report.active) : ImVec4(0.6f, 0.6f, 0.6f, 1), "%s", word);
    show_tooltip(row.enabled ? std::string(words.meaning) + " (" + to_string(report.status) + ")"
                             : "the link is switched off by the checkbox beside its name");
    draw_live(report, context.haptic_session.link_names()[link], max_n, context.state.unit_length);
  }
  if (open) {
    if (ImGui::ArrowButton("##up", ImGuiDir_Up) && row.index > 0) move = Move{row.index, -1};
    show_tooltip("move the link up in the chain");
    ImGui::SameLine();
    if (ImGui::ArrowButton("##down", ImGuiDir_Down) && row.index + 1 < count) move = Move{row.index, 1};
    show_tooltip("move the link down in the chain");
    ImGui::SameLine();
    if (ImGui::Button("Remove")) move = Move{row.index, 0};
    ImGui::SameLine();
    ImGui::TextDisabled("%s", row.type.c_str());
    draw_keys(context, row);
    ImGui::TreePop();
  }
  ImGui::PopID();
  ImGui::Separator();
  return move;
}

void draw_sum(const PanelContext& context, double max_n) {
  const HapticState& haptic_state = context.haptic_session.latest_state();
  Vec3 sum(0.0);
  for (int i = 0; i < haptic_state.link_count; ++i) sum += haptic_state.links[static_cast<std::size_t>(i)].force_n;
  ImGui::Text("Force %.2f N, links %.2f N", norm(haptic_state.force_n), norm(sum));
  show_tooltip(
      fmt::format("force on the hand after damping, ramp and limits, at most {:g} N; sum of the forces of the links before them", max_n));
  if (haptic_state.force_state == ForceState::on) return;
  ImGui::SameLine();
  ImGui::TextDisabled("%s", to_string(haptic_state.force_state));
}

void draw_add(PanelContext& context) {
  if (!ImGui::BeginCombo("##add", "Add a link", ImGuiComboFlags_HeightLarge)) return;
  for (const std::string& type : link_types()) {
    if (!ImGui::Selectable(type.c_str())) continue;
    const auto link = make_link_json(context.scene.scene(), type, probe_of(context), length_of(context));
    if (link)
      context.edits.set("/chain/-", *link, "add " + type);
    else
      context.state.show_message(link.error().message, true);
  }
  ImGui::EndCombo();
}

void draw_coupling(PanelContext& context) {
  const scene::Coupling c = context.scene.scene().coupling;
  ImGui::TextUnformatted("Coupling");
  edit_number(context.edits, {"stiffness", "/coupling/stiffness", c.stiffness_n_per_m, 0, 5000, 2, "%.4g N/m"});
  show_tooltip("stiffness of links that do not state one; the device may limit it");
  edit_number(context.edits, {"damping", "/coupling/damping", c.damping_ns_per_m, 0, 100, 0.02, "%.3g N s/m"});
  edit_number(context.edits, {"maximum force", "/coupling/max_force", c.max_force_n, 0, 40, 0.02, "%.3g N"});
}

void draw_chain(PanelContext& context) {
  const double max_n = context.scene.scene().coupling.max_force_n;
  const std::vector<ChainRow> rows = make_chain_rows(context.scene.scene(), context.haptic_session.link_names());
  if (rows.empty()) {
    ImGui::TextWrapped("The chain is empty: click Feel beside an object, or point at the object in the image and press H.");
  } else {
    draw_sum(context, max_n);
  }
  ImGui::Separator();
  std::optional<Move> move;
  for (const ChainRow& row : rows)
    if (const auto asked = draw_row(context, row, rows.size(), max_n)) move = asked;
  draw_add(context);
  draw_coupling(context);
  if (!move) return;
  const ChainRow& row = rows[move->row];
  if (move->by == 0) {
    context.edits.remove(row.pointer(), "remove " + row.name);
    return;
  }
  const ChainRow& other = rows[move->row + static_cast<std::size_t>(move->by)];
  context.edits.set(make_swap_edits(row, other), "move " + row.name);
}

}  // namespace

Panel chain_panel() { return {"Chain", false, draw_chain}; }

}  // namespace catena::app
