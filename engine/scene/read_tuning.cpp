/// Reads "plan": the user's tuning targets for error and time, of the image and of the haptics.
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

const Table<TuningTargets>& plan_table() {
  static const auto table = [] {
    Table<TuningTargets> t;
    t.bind(
        schema::number("error", "1/255", "Of the picture: root mean square over the covered pixels, against the converged one.").positive(),
        &TuningTargets::max_image_error);
    t.bind(schema::number("time", "ms", "Of a picture; without `error`.").positive(), &TuningTargets::max_image_ms);
    t.bind(schema::number("hand_error", "world", "The farthest that a link's proxy may be off its line.").positive(),
           &TuningTargets::max_proxy_error);
    t.bind(schema::number("hand_time", "us", "Of a tick; without `hand_error`.").positive(), &TuningTargets::max_tick_us);
    return t;
  }();
  return table;
}

/// Message if the combination of keys is invalid; empty if it is valid.
std::string fault_of(const TuningTargets& plan) {
  if (plan.max_image_error && plan.max_image_ms) return "\"error\" and \"time\" exclude each other; one of them was expected";
  if (plan.max_proxy_error && plan.max_tick_us) return "\"hand_error\" and \"hand_time\" exclude each other; one of them was expected";
  if (!plan.has_image_targets() && !plan.has_haptic_targets())
    return "a plan is empty; an error, a time, a hand_error or a hand_time was expected";
  return {};
}

Outcome read_plan(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "plan"));
  CATENA_CHECK(plan_table().read(scene, node, scene.tuning));
  if (const std::string fault = fault_of(scene.tuning); !fault.empty()) return json::error_at(node, fault);
  return Done{};
}

}  // namespace

Result<TuningTargets> parse_tuning_targets(std::string_view words) {
  const std::string begin = "--plan " + std::string(words) + ": ";
  TuningTargets plan;
  for (std::string_view rest = words; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    const std::string_view key = part.substr(0, part.find('='));
    std::optional<double>* const at = key == "error"        ? &plan.max_image_error
                                      : key == "time"       ? &plan.max_image_ms
                                      : key == "hand_error" ? &plan.max_proxy_error
                                      : key == "hand_time"  ? &plan.max_tick_us
                                                            : nullptr;
    const auto value = key.size() < part.size() ? parse_double(part.substr(key.size() + 1)) : std::nullopt;
    if (at == nullptr) return Error{begin + in_quotes(key) + " is not known; error, time, hand_error or hand_time was expected"};
    if (*at) return Error{begin + in_quotes(key) + " is there twice; once was expected"};
    if (!value || !std::isfinite(*value) || !(*value > 0))
      return Error{begin + in_quotes(key) + ": expected " + std::string(key) + "=NUMBER, above 0"};
    *at = value.value_or(0);
  }
  if (const std::string fault = fault_of(plan); !fault.empty()) return Error{begin + fault};
  return plan;
}

std::string to_json(const TuningTargets& plan) { return plan_table().write({}, plan); }

Part tuning_part() {
  return {{"plan", "What error or what time is wanted; the settings follow from curves that are measured on this machine.",
           schema::Section::Layout::object, plan_table().keys()},
          read_plan};
}

}  // namespace catena::scene
