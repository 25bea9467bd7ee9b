/// "plan": what a person wants of error and time, of the eye and of the hand.
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/write_values.h"

namespace catena::scene {
namespace {

const Table<Plan>& plan_table() {
  static const auto table = [] {
    Table<Plan> t;
    t.bind(
        schema::number("error", "1/255", "Of the picture: root mean square over the covered pixels, against the converged one.").positive(),
        &Plan::error);
    t.bind(schema::number("time", "ms", "Of a picture; without `error`.").positive(), &Plan::time);
    t.bind(schema::number("hand_error", "world", "The farthest that a link's proxy may be off its line.").positive(), &Plan::hand_error);
    t.bind(schema::number("hand_time", "us", "Of a tick; without `hand_error`.").positive(), &Plan::hand_time);
    return t;
  }();
  return table;
}

/// What is wrong with the keys together; empty: nothing.
std::string fault_of(const Plan& plan) {
  if (plan.error && plan.time) return "\"error\" and \"time\" exclude each other; one of them was expected";
  if (plan.hand_error && plan.hand_time) return "\"hand_error\" and \"hand_time\" exclude each other; one of them was expected";
  if (!plan.of_eye() && !plan.of_hand()) return "a plan is empty; an error, a time, a hand_error or a hand_time was expected";
  return {};
}

Outcome read_plan(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "plan"));
  CATENA_CHECK(plan_table().read(scene, node, scene.plan));
  if (const std::string fault = fault_of(scene.plan); !fault.empty()) return json::error_at(node, fault);
  return Done{};
}

}  // namespace

Result<Plan> parse_plan(std::string_view words) {
  const std::string begin = "--plan " + std::string(words) + ": ";
  Plan plan;
  for (std::string_view rest = words; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    const std::string_view key = part.substr(0, part.find('='));
    std::optional<double>* const at = key == "error"        ? &plan.error
                                      : key == "time"       ? &plan.time
                                      : key == "hand_error" ? &plan.hand_error
                                      : key == "hand_time"  ? &plan.hand_time
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

std::string text_of(const Plan& plan) { return plan_table().write({}, plan); }

Part plan_part() {
  return {{"plan", "What error or what time is wanted; the settings follow from curves that are measured on this machine.",
           schema::Component::Shape::object, plan_table().keys()},
          read_plan};
}

}  // namespace catena::scene
