// SPDX-License-Identifier: MIT
/// Cost curves of the haptics: links with open settings, agreement of a curve with a link's stated keys, and the tick time without these
/// links.
#include <algorithm>
#include <cmath>

#include "engine/app/tuning/choose/interpolation_choice.h"
#include "engine/app/tuning/choose/tick_tuning.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/haptics/streamline.h"

namespace catena::app::tuning {
namespace {

constexpr const char *kRestId = "hand-rest", *kRest = "tick without the tuned links", *kBare = "tick without links";

using tuning::StreamlineSetting;

/// Returns whether the setting agrees with the keys that the link states.
bool agrees(const StreamlineSetting& setting, const json::Node& link) {
  const json::Node *follow = link.find("follow"), *method = link.find("method"), *tolerance = link.find("tolerance");
  if (follow != nullptr && (follow->string == "selected") != setting.is_selected) return false;
  if (method != nullptr && (setting.is_selected || flow::to_string(*setting.method) != method->string)) return false;
  return tolerance == nullptr || !setting.tolerance || std::fabs(*setting.tolerance - tolerance->number) <= 1e-9 * tolerance->number;
}

/// Settings to choose from; empty if there is no choice. A link on the seed of a widget has no line until it is in contact.
std::vector<StreamlineSetting> open_settings(const json::Node& link) {
  std::vector<StreamlineSetting> open = tuning::streamline_settings(link);
  // fixed steps have no tolerance: their error depends on probe speed and path, and a curve is measured for only one motion
  const bool asks_for_method = link.find("method") != nullptr;
  std::erase_if(open, [&](const StreamlineSetting& setting) {
    return !agrees(setting, link) || (!asks_for_method && !setting.is_selected && !setting.tolerance);
  });
  if (open.size() < 2) open.clear();
  return open;
}

/// Keys of the setting that the link does not state.
LinkKeys new_keys(const StreamlineSetting& setting, const json::Node& link) {
  LinkKeys keys = setting.keys;
  std::erase_if(keys, [&](const auto& key) { return link.find(key.first) != nullptr; });
  return keys;
}

std::vector<tuning::NamedLink> open_links(const scene::Scene& scene) {
  std::vector<tuning::NamedLink> links = tuning::find_links(scene, "streamline");
  std::erase_if(links, [](const tuning::NamedLink& link) { return open_settings(link.node).empty(); });
  return links;
}

/// Source of the link's field if its interpolation may become cubic, otherwise nullptr: a line field's axes stay linear.
scene::FieldSource* open_source(scene::Scene& scene, const json::Node& link) {
  const json::Node *name = link.find("field"), *kind = link.find("kind");
  if (name == nullptr || (kind != nullptr && kind->string == "line")) return nullptr;
  const scene::Entity field = scene::find_field(scene, name->string);
  if (!field) return nullptr;
  scene::FieldSource& source = scene.entities.get<scene::FieldSource>(field);
  return is_interpolation_unset(source) ? &source : nullptr;
}

std::string cubic_curve_id(const std::string& link) { return "hand-cubic-streamline-" + link; }

/// Measures the link's curve with cubic interpolation as well: the two are compared only if both discretization errors are known.
void add_cubic(tuning::Workload& subject, const tuning::NamedLink& link, std::vector<Curve>& curves) {
  scene::FieldSource* source = open_source(subject.scene, link.node);
  if (source == nullptr || !(curves.back().discretization_error > 0)) return;
  const scene::FieldSource linear = *source;
  if (!set_cubic_interpolation(*source)) return;
  auto curve = tuning::measure_streamline_link(subject, link);
  *source = linear;
  if (!curve || !(curve->discretization_error > 0)) return;
  curve->id = cubic_curve_id(link.name);
  curve->title += ", cubic cells";
  curves.push_back(std::move(*curve));
}

}  // namespace

Result<std::vector<Curve>> measure_tick_curves(tuning::Workload& subject) {
  std::vector<Curve> curves;
  std::vector<std::string> chosen;
  for (const tuning::NamedLink& link : open_links(subject.scene)) {
    auto curve = tuning::measure_streamline_link(subject, link);
    if (!curve) {
      subject.skipped.push_back(curve.error().message);
      continue;
    }
    curves.push_back(std::move(*curve));
    add_cubic(subject, link, curves);
    chosen.push_back(link.name);
  }
  haptics::HapticProgram bare = tuning::without_widgets(*subject.program), rest = bare;
  std::erase_if(rest.links, [&](const haptics::Link& link) { return std::find(chosen.begin(), chosen.end(), link.name) != chosen.end(); });
  bare.links.clear();
  const std::vector<haptics::ProbeSample> path = subject.motion.samples(subject.rate_hz);
  Curve curve;
  curve.id = kRestId;
  curve.title = kRest;
  curve.time_name = "ns per tick";
  curve.points = {{kRest, "", ""}, {kBare, "", ""}};
  CATENA_CHECK(
      tuning::time_points(curve, {tuning::make_tick_run(rest, path), tuning::make_tick_run(bare, path)}, 0.3 * subject.effort.haptics_s));
  curves.push_back(std::move(curve));
  for (Curve& one : curves) one.category = "hand";
  return curves;
}

std::optional<TickCurves> to_tick_curves(scene::Scene& scene, const std::vector<Curve>& curves, double rate_hz) {
  const std::vector<tuning::NamedLink> links = open_links(scene);
  TickCurves made;
  bool has_rest = false;
  for (const Curve& curve : curves) {
    if (curve.id == kRestId) {
      if (curve.points.size() != 2 || !std::isfinite(curve.points[0].time.median) || !std::isfinite(curve.points[1].time.median))
        return std::nullopt;
      made.base_tick_ns = curve.points[0].time.median;
      made.empty_tick_ns = curve.points[1].time.median;
      has_rest = true;
      continue;
    }
    const auto id_is = [&](const std::string& id) { return id == curve.id; };
    const auto link = std::find_if(links.begin(), links.end(), [&](const auto& l) {
      return id_is(tuning::streamline_curve_id(l.name)) || id_is(cubic_curve_id(l.name));
    });
    if (link == links.end()) return std::nullopt;
    const bool cubic = id_is(cubic_curve_id(link->name));
    if (cubic && open_source(scene, link->node) == nullptr) return std::nullopt;
    const field::AnyField field = tuning::find_link_field(scene, link->node);
    if (!field.vector) return std::nullopt;
    CATENA_ASSERT(link->node.find("field") != nullptr);
    LinkCurve one{link->name, link->node.find("field")->string, cubic, field.vector->domain_length(), 1e-3 * rate_hz, curve, {}};
    one.curve.points.clear();
    const std::vector<StreamlineSetting> open = open_settings(link->node);
    for (const tuning::Point& point : curve.points) {
      if (!point.is_selectable) continue;
      const auto setting = std::find_if(open.begin(), open.end(), [&](const auto& s) { return s.label == point.setting; });
      if (setting == open.end()) continue;
      one.curve.points.push_back(point);
      one.keys.push_back(new_keys(*setting, link->node));
    }
    if (one.curve.points.empty()) return std::nullopt;
    made.links.push_back(std::move(one));
  }
  return has_rest ? std::optional(made) : std::nullopt;
}

}  // namespace catena::app::tuning
