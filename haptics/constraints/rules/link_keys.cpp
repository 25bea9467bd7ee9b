#include "haptics/constraints/rules/link_keys.h"

#include "engine/schema/table.h"

namespace catena::haptics {

namespace {

/// What reading needs besides: nothing.
struct Nothing {};
template <class T>
using Table = schema::Table<T, const Nothing>;

const Table<Switch>& switch_table() {
  static const auto table = [] {
    Table<Switch> t;
    t.bind(schema::integer("button", "", "The link is on while this button is held.", 1, 32).without_default(), &Switch::button);
    t.bind(schema::boolean("toggle", "Each press of the button turns the link on or off."), &Switch::toggle);
    t.bind(schema::number("force_above", "N", "Or: it goes on when the last tick's force is above this.").positive().without_default(),
           &Switch::force_above_n);
    t.hand(schema::number("force_below", "N", "And off when the force is at most this.").not_negative().by_default("`force_above`"),
           [](const Nothing&, const json::Node& node, Switch& on) -> Outcome {
             CATENA_TRY(on.force_below_n, json::get_number(node, "force_below", on.force_above_n, json::Range::not_negative));
             if (on.force_below_n <= on.force_above_n) return Done{};
             return json::error_at(*node.find("force_below"), "\"force_below\" is above \"force_above\"; a number up to it was expected");
           });
    return t;
  }();
  return table;
}

const Table<Indication>& indication_table() {
  static const auto table = [] {
    Table<Indication> t;
    t.bind(schema::word("cue", {"none", "detent", "vibration"}, "A detent is one pulse."), &Indication::cue);
    t.bind(schema::number("at", "world", "The gap that counts as leaving.").positive().by_default("where it slips or lets go"),
           &Indication::at);
    t.bind(schema::number("from", "", "A vibration begins at this part of `at`.").within(0, 1), &Indication::from);
    t.bind(schema::number("amplitude", "N", "Force of the cue.").not_negative(), &Indication::amplitude_n);
    t.bind(schema::number("frequency", "Hz", "Of a vibration.").positive(), &Indication::frequency_hz);
    t.bind(schema::number("duration", "s", "Of a detent.").positive(), &Indication::duration_s);
    return t;
  }();
  return table;
}

const Table<Align>& align_table() {
  static const auto table = [] {
    Table<Align> t;
    t.hand(schema::direction("axis", "The axis in the tool's frame.").by_default("[0, 0, 1]"),
           [](const Nothing&, const json::Node& node, Align& align) -> Outcome {
             CATENA_TRY(const Vec3 axis, json::get_vec3(node, "axis", align.tool_axis));
             align.tool_axis = direction(axis);
             if (max_abs(align.tool_axis) > 0) return Done{};
             return json::error_at(*node.find("axis"), "\"axis\" is zero; a vector of the tool's frame, of non-zero length, was expected");
           });
    t.bind(schema::number("stiffness", "N m/rad", "Of the turn.").not_negative().by_default("the coupling's"),
           &Align::stiffness_nm_per_rad);
    t.bind(schema::word("sign", {"either", "same"}, "`either`: the nearer of the axis's two ends; `same`: the direction counts."),
           &Align::sign);
    return t;
  }();
  return table;
}

}  // namespace

schema::Key switch_key() {
  return schema::object("on", switch_table().keys(), "Its switch: either `button` or `force_above`.").by_default("always on");
}

schema::Key indication_key() {
  return schema::object("indicate", indication_table().keys(), "How the hand is told that it leaves the feature.").by_default("no cue");
}

schema::Key align_key() {
  return schema::object("align", align_table().keys(),
                        "Turns the tool's axis onto a surface's normal or a curve's tangent; with `coupling.method` `chain` only.")
      .by_default("none");
}

Result<Switch> read_switch(const json::Node& holder) {
  Switch on;
  const json::Node* node = holder.find("on");
  if (node == nullptr) return on;
  CATENA_CHECK(json::expect_object(*node, "on"));
  CATENA_CHECK(json::only_keys(*node, schema::names_of(switch_table().keys())));
  const bool button = node->find("button") != nullptr, force = node->find("force_above") != nullptr;
  if (button == force)
    return json::error_at(*node, std::string("\"on\" has ") + (button ? "both" : "neither") +
                                     " \"button\" and \"force_above\"; exactly one of them was expected");
  if (const json::Node* other = node->find(button ? "force_below" : "toggle"))
    return json::error_at(*other,
                          button ? "\"force_below\" belongs to \"force_above\", not to \"button\"; only \"toggle\" was expected beside it"
                                 : "\"toggle\" belongs to \"button\", not to \"force_above\"; only \"force_below\" was expected beside it");
  CATENA_CHECK(switch_table().read_known({}, *node, on));
  return on;
}

Result<Indication> read_indication(const json::Node& link) {
  Indication out;
  const json::Node* node = link.find("indicate");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "indicate"));
  CATENA_CHECK(indication_table().read({}, *node, out));
  return out;
}

Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint) {
  Align out;
  const json::Node* node = link.find("align");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "align"));
  CATENA_CHECK(json::only_keys(*node, schema::names_of(align_table().keys())));
  const ConstraintType& type = *find_constraint(link.find("type")->string);
  if (!constraint.has_primitive() || !type.has_axis)
    return json::error_at(
        *node, "a \"" + type.type + "\" link has no axis to align with; a surface (its normal) or a curve (its tangent) was expected");
  if (coupling.method != CouplingMethod::chain)
    return json::error_at(*node, "\"align\" needs a proxy of the link's own; \"method\": \"chain\" was expected in \"coupling\"");
  out.on = true;
  out.stiffness_nm_per_rad = coupling.rotational_stiffness_nm_per_rad;
  CATENA_CHECK(align_table().read_known({}, *node, out));
  return out;
}

}  // namespace catena::haptics
