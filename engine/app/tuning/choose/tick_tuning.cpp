// SPDX-License-Identifier: MIT
#include "engine/app/tuning/choose/tick_tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/app/tuning/choose/interpolation_choice.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::app::tuning {
namespace {

constexpr const char* kKeys[] = {"follow", "method", "tolerance"};
constexpr double kFarOff = 10;  ///< factor on the error along the measured path: above it the error anywhere along the line is reported
constexpr std::size_t kFarColumn = 2;  ///< column of a point's extra values (measure/haptics/streamline.cpp)
constexpr double kWorthIt = 0.5;       ///< maximum ratio of cubic to linear discretization error that makes cubic worth its cost

/// Maps the names of the chain's links to their JSON pointers, such as "/chain/2".
Result<std::map<std::string, std::string>> places_of_links(const json::Node& root) {
  std::map<std::string, std::string> places;
  const json::Node* chain = root.find("chain");
  for (std::size_t i = 0; chain != nullptr && i < chain->items.size(); ++i) {
    CATENA_TRY(const std::string name, json::require_string(chain->items[i], "name"));
    places[name] = "/chain/" + std::to_string(i);
  }
  return places;
}

/// Adds a member with the object's file and line, which messages refer to.
void add_member(json::Node& object, const std::string& key, json::Node value) {
  value.file = object.file, value.line = object.line, value.label = key;
  object.members.emplace_back(key, std::move(value));
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Makes the fields that `is_selected` selects cubic if their interpolation is unset; linear if there is not enough memory.
template <class IsSelected>
void make_open_ones_cubic(scene::Scene& scene, const IsSelected& is_selected) {
  scene.entities.each<scene::FieldSource>([&](scene::Entity entity, scene::FieldSource& source) {
    if (!is_interpolation_unset(source) || !is_selected(scene.entities.get<scene::Name>(entity).value)) return;
    if (const Outcome made = set_cubic_interpolation(source); !made) scene.notes.push_back(made.error().message);
  });
}

/// Returns whether the scene states one of the keys that the tuning would set.
bool is_pinned(const json::Node& link, const LinkKeys& keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return link.find(key.first) != nullptr; });
}

}  // namespace

TickTuning::TickTuning(TickCurves curves, const scene::TuningTargets& targets) : curves_(std::move(curves)) { set_targets(targets); }

std::vector<std::string> TickTuning::choose_cubic_fields(double error) const {
  struct Floors {
    double linear = 0, cubic = 0;
    bool both = false;
  };
  std::map<std::string, Floors> fields;
  for (const LinkCurve& link : curves_.links) {
    Floors& floors = fields[link.field];
    double& worst = link.is_cubic ? floors.cubic : floors.linear;
    worst = std::max(worst, tuning::min_resolvable_error(link.curve) * link.length);
    floors.both = floors.both || link.is_cubic;
  }
  std::vector<std::string> cubic;
  for (const auto& [field, floors] : fields)
    if (floors.both && error < floors.linear && floors.cubic < kWorthIt * floors.linear) cubic.push_back(field);
  return cubic;
}

TickTuning::Choice TickTuning::pick(double error) const {
  Choice choice;
  choice.cubic_fields = choose_cubic_fields(error);
  choice.ns = curves_.base_tick_ns;
  for (const LinkCurve& link : curves_.links) {
    if (link.is_cubic != contains(choice.cubic_fields, link.field)) continue;
    const tuning::PickedPoint picked = tuning::pick_point(link.curve, {error / link.length, {}});
    if (picked.point < 0) continue;
    const tuning::Point& point = link.curve.points[static_cast<std::size_t>(picked.point)];
    const double resolvable_error = tuning::min_resolvable_error(link.curve),
                 far = point.extra_values.size() > kFarColumn ? point.extra_values[kFarColumn] : 0;
    choice.links.push_back({link.link, point.setting, link.keys[static_cast<std::size_t>(picked.point)], point.error * link.length,
                            far > kFarOff * std::max(point.error, resolvable_error) ? far * link.length : 0, resolvable_error * link.length,
                            picked.at_floor, picked.meets_target});
    choice.ns += std::max(0.0, point.time.median / link.ticks_per_ms - curves_.empty_tick_ns);
  }
  return choice;
}

void TickTuning::adopt(Choice choice) {
  links_ = std::move(choice.links);
  cubic_fields_ = std::move(choice.cubic_fields);
  tick_ns_ = choice.ns;
}

std::vector<double> TickTuning::error_breakpoints() const {
  std::set<double, std::greater<>> errors;
  for (const LinkCurve& link : curves_.links)
    for (const tuning::Point& point : link.curve.points)
      if (std::isfinite(point.error)) errors.insert(std::max(point.error, tuning::min_resolvable_error(link.curve)) * link.length);
  std::vector<double> stops;
  double last = -1;
  for (const double error : errors) {
    const double ns = pick(error).ns;
    if (ns == last) continue;
    stops.push_back(error);
    last = ns;
  }
  return stops;
}

void TickTuning::set_targets(const scene::TuningTargets& targets) {
  targets_ = targets;
  meets_target_ = true;
  if (curves_.links.empty()) {
    tick_ns_ = curves_.base_tick_ns;
    return;
  }
  if (targets.max_proxy_error) {
    adopt(pick(*targets.max_proxy_error));
    for (const TunedLink& link : links_) meets_target_ = meets_target_ && link.meets_target;
    return;
  }
  // the least error at which the tick is fast enough; if there is none, the fastest tick
  const std::vector<double> errors = error_breakpoints();
  const double maximum = 1e3 * targets.max_tick_us.value_or(0);
  double quickest = 0, minimum = -1;
  for (const double error : errors) {
    Choice choice = pick(error);
    if (choice.ns <= maximum) minimum = error;  // errors are in descending order
    if (quickest == 0 || choice.ns < quickest) quickest = choice.ns, adopt(std::move(choice));
  }
  meets_target_ = minimum >= 0;
  if (meets_target_) adopt(pick(minimum));
}

double TickTuning::expected_error() const {
  double maximum = 0;
  for (const TunedLink& link : links_) maximum = std::max(maximum, link.error);
  return maximum;
}

double TickTuning::error_anywhere() const {
  double maximum = expected_error();
  for (const TunedLink& link : links_) maximum = std::max(maximum, link.error_anywhere);
  return maximum;
}

void TickTuning::apply(scene::Scene& scene) const {
  for (const TunedLink& planned : links_)
    scene.entities.each<scene::Link>([&](scene::Entity, scene::Link& link) {
      if (link.name != planned.link || is_pinned(link.node, planned.keys)) return;
      for (const auto& [key, text] : planned.keys)
        if (auto value = json::parse(text, scene.path)) add_member(link.node, key, std::move(*value));
    });
  make_open_ones_cubic(scene, [&](const std::string& field) { return contains(cubic_fields_, field); });
}

Result<std::string> TickTuning::apply(const std::string& text, const std::string& file) const {
  if (links_.empty()) return text;
  CATENA_TRY(const json::Node root, json::parse(text, file));
  CATENA_TRY(const auto places, places_of_links(root));
  std::string out = text;
  for (const TunedLink& link : links_) {
    const auto place = places.find(link.link);
    if (place == places.end() || is_pinned(*json::find_value(root, place->second), link.keys)) continue;
    for (const auto& [key, value] : link.keys) {
      CATENA_TRY(out, json::set_value(out, file, place->second + "/" + key, value));
    }
  }
  for (const std::string& field : cubic_fields_) {
    const json::Node* stated = json::find_value(root, field_pointer(field));
    if (stated == nullptr || stated->find(kInterpolationKey) != nullptr) continue;
    CATENA_TRY(out, json::set_value(out, file, field_pointer(field) + "/" + kInterpolationKey, "\"cubic\""));
  }
  return out;
}

std::string TickTuning::summary() const {
  std::string text = fmt::format("{} {}:", targets_.max_proxy_error ? "max_proxy_error" : "max_tick_us",
                                 to_text(targets_.max_proxy_error ? *targets_.max_proxy_error : targets_.max_tick_us.value_or(0)));
  for (const TunedLink& link : links_) text += fmt::format("{} {} {}", &link == links_.data() ? "" : ",", link.link, link.setting);
  for (const std::string& field : cubic_fields_) text += fmt::format(", field {} cubic", field);
  text += fmt::format("; expected: error {:.2g} in {:.3g} us per tick", expected_error(), expected_us());
  for (const TunedLink& link : links_)
    if (targets_.max_proxy_error && link.at_floor)
      text += fmt::format(" (link {}: limited to the resolvable error of {:.2g})", link.link, link.discretization_error);
  for (const TunedLink& link : links_)
    if (link.error_anywhere > 0)
      text += fmt::format(" (link {}: the error grows along the line, up to {:.2g} far from the seed{})", link.link, link.error_anywhere,
                          targets_.max_proxy_error && link.error_anywhere > *targets_.max_proxy_error
                              ? ", so that max_proxy_error holds near the seed only"
                              : "");
  if (!meets_target_)
    text +=
        targets_.max_proxy_error ? " (the target is not reached: most accurate setting)" : " (the target is not reached: fastest setting)";
  return text;
}

Outcome apply_recorded_settings(const std::string& recorded_text, scene::Scene& scene) {
  CATENA_TRY(const json::Node root, json::parse(recorded_text, "the recorded scene"));
  CATENA_TRY(const auto places, places_of_links(root));
  for (const auto& [name, place] : places) {
    const json::Node* from = json::find_value(root, place);
    scene.entities.each<scene::Link>([&, &name = name](scene::Entity, scene::Link& link) {
      if (link.name != name) return;
      const bool stated = std::any_of(std::begin(kKeys), std::end(kKeys), [&](const char* key) { return link.node.find(key) != nullptr; });
      if (stated) return;
      for (const char* key : kKeys)
        if (const json::Node* value = from->find(key)) add_member(link.node, key, *value);
    });
  }
  make_open_ones_cubic(scene, [&](const std::string& name) {
    const json::Node* field = json::find_value(root, field_pointer(name));
    const json::Node* cells = field != nullptr ? field->find(kInterpolationKey) : nullptr;
    return cells != nullptr && cells->string == "cubic";
  });
  return Done{};
}

}  // namespace catena::app::tuning
