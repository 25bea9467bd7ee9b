// SPDX-License-Identifier: MIT
#include "engine/app/server/server_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/base/json_text.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/visibility.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

constexpr int kBars = 64;

/// JSON range of a slider with finite ends, or empty text.
std::string range_words(const std::array<double, 2>& range, const SortedSamples& values, double linear_below = 0) {
  std::string bars = "[]";
  if (values)
    bars = json_list(histogram_bars(*values, range[0], range[1], kBars, linear_below),
                     [](float height) { return fmt::format("{:.3f}", height); });
  return fmt::format(R"("lo": {}, "hi": {}, "bars": {})", json_number(range[0]), json_number(range[1]), bars);
}

std::string surfaces_words(scene::Scene& scene, HistogramCache& values) {
  std::string text;
  scene.entities.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(surface.field);
    const field::AnyField& field = source.rendered.get() != nullptr ? source.rendered : source.loaded;
    const json::Node* stated = surface.where.find("level");
    const bool is_number = stated != nullptr && stated->kind == json::Kind::number;
    if (is_hidden(scene.entities, e) || !field.scalar || !is_number || item_pointer(surface.where).empty()) return;
    const DisplayRange shown = field::display_range(field);
    text += fmt::format(R"({}{{"item": {}, "name": {}, "level": {}, {}}})", text.empty() ? "" : ", ", json_string(surface.where.label),
                        json_string(entity_name(scene, surface.field)), json_number(surface.level),
                        range_words(make_plot_range(shown.lo, shown.hi), values.find_or_request(scene, surface.field)));
  });
  return "[" + text + "]";
}

std::string volumes_words(scene::Scene& scene, HistogramCache& values) {
  std::string text;
  scene.entities.each<scene::Volume>([&](scene::Entity e, const scene::Volume& volume) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(volume.field);
    if (is_hidden(scene.entities, e) || !source.rendered.scalar || item_pointer(volume.where).empty()) return;
    const auto edit = make_transfer_edit(volume, source.rendered.scalar->mapping().min_voxel_edge());
    if (!edit || edit->opacities.size() > 64 || edit->colors.size() > 512) return;
    const DisplayRange shown = field::display_range(source.rendered);
    const auto point = [](const auto& p) { return fmt::format("[{}, {}]", json_number(p.value), json_number(p.alpha)); };
    const auto color = [](const auto& p) {
      return fmt::format("[{}, {:.3f}, {:.3f}, {:.3f}]", json_number(p.value), p.color.r, p.color.g, p.color.b);
    };
    text += fmt::format(
        R"({}{{"item": {}, "name": {}, "map": {}, "opacity": {}, "color": {}, "below": {}, {}}})", text.empty() ? "" : ", ",
        json_string(volume.where.label), json_string(entity_name(scene, volume.field)), json_string(edit->color_map),
        json_list(edit->opacities, point), json_list(edit->colors, color), json_number(edit->linear_below),
        range_words(plottable_range(*edit, shown.lo, shown.hi), values.find_or_request(scene, volume.field), edit->linear_below));
  });
  return "[" + text + "]";
}

void put(std::string& bytes, std::uint32_t number, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>((number >> (8 * i)) & 255);
}

}  // namespace

std::string role_message(const std::string& control, std::size_t viewers) {
  return fmt::format(R"({{"role": {{"control": {}, "viewers": {}}}}})", json_string(control), viewers);
}

std::string scene_message(SceneModel& host, HistogramCache& values) {
  scene::Scene& scene = host.scene();
  const std::string name = std::filesystem::path(host.document().path()).filename().string();
  const auto word = [](std::string_view map) { return json_string(std::string(map)); };
  return fmt::format(R"({{"scene": {{"name": {}, "isosurfaces": {}, "volumes": {}, "maps": {}}}}})", json_string(name),
                     surfaces_words(scene, values), volumes_words(scene, values), json_list(scene::color_map_names(), word));
}

namespace {

std::string step_words(const scene::Scene& scene, bool plays) {
  const auto time = scene::current_step_time(scene);
  const int count = scene::step_count(scene);
  return fmt::format(R"({{"now": {}, "count": {}, "time": {}, "plays": {}}})", std::min(scene.time.step, count - 1), count,
                     time ? json_string(scene::format_time(scene)) : "null", plays);
}

std::string recording_words(const Recording& recording, const std::string& recorded) {
  return fmt::format(R"({{"on": {}, "seconds": {:.0f}, "mb": {:.1f}, "file": {}}})", recording.is_recording(), recording.seconds(),
                     1e-6 * static_cast<double>(recording.status().bytes), json_string(recorded));
}

std::string plan_words(const LiveTuning& live) {
  const bool eye = live.image_tuning && !live.has_fixed_quality, hand = live.tick_tuning && !live.tick_tuning->is_empty();
  if (!eye && !hand) return "null";
  std::string links;
  if (hand)
    for (const tuning::TunedLink& link : live.tick_tuning->links()) links += (links.empty() ? "" : ", ") + link.link + ": " + link.setting;
  return fmt::format(
      R"({{"position": {:.3f}, "image": {}, "haptics": {}}})", live.slider_position(),
      json_string(eye ? fmt::format("{}: {:.2g}/255, {:.3g} ms", render::describe(live.image_tuning->settings()),
                                    live.image_tuning->expected_error(), live.image_tuning->expected_ms())
                      : ""),
      json_string(hand ? fmt::format("{}: {:.2g}, {:.3g} us", links, live.tick_tuning->expected_error(), live.tick_tuning->expected_us())
                       : ""));
}

}  // namespace

std::string state_message(const HapticSession& hand, const SceneModel& scene, const SessionState& more) {
  const HapticState& haptic_state = hand.latest_state();
  std::string links;
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(haptic_state.link_count), hand.link_names().size()); ++i)
    links += fmt::format(R"({}{{"name": {}, "status": "{}"}})", links.empty() ? "" : ", ", json_string(hand.link_names()[i]),
                         to_string(haptic_state.links[i].status));
  const scene::Document& document = scene.document();
  return fmt::format(
      R"({{"state": {{"force": {:.3f}, "max_force": {}, "links": [{}], "probe": {}, "picture": {}, "step": {}, "undo": {}, "redo": {}, )"
      R"("recording": {}, "tuning": {}}}}})",
      norm(haptic_state.force_n), json_number(scene.scene().coupling.max_force_n), links, more.probe_mode,
      json_string(more.image_description), step_words(scene.scene(), more.is_playing), json_string(document.undo_label()),
      json_string(document.redo_label()), recording_words(hand.recording(), more.recording_name), plan_words(more.tuning));
}

std::string note_message(const std::string& line) { return fmt::format(R"({{"note": {}}})", json_string(line)); }

std::string frame_message(const FrameHeader& head, const std::string& file) {
  std::string bytes;
  bytes.reserve(16 + file.size());
  put(bytes, head.number, 4);
  put(bytes, head.input_number, 4);
  put(bytes, head.width, 2);
  put(bytes, head.height, 2);
  put(bytes, head.is_lossless ? 2 : 1, 1);
  put(bytes, 0, 1);
  put(bytes, static_cast<std::uint32_t>(std::clamp(head.elapsed_ms, 0.0, 65535.0)), 2);
  return bytes + file;
}

}  // namespace catena::app
