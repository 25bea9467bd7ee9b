// SPDX-License-Identifier: MIT
#include "haptics/constraints/common/link_schema.h"

#include <fmt/format.h>

#include "engine/base/numbers.h"
#include "engine/field/derived/magnitude.h"
#include "engine/field/field_display_range.h"
#include "engine/schema/struct_schema.h"

namespace catena::haptics {
namespace {

Result<field::AnyField> require_field(const json::Node& link, std::string_view key, std::string_view link_type, bool vector,
                                      const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, key));
  CATENA_TRY(field::AnyField field, context.field(*link.find(key), name));
  if ((field.vector != nullptr) != vector)
    return json::error_at(*link.find(key), fmt::format("field \"{}\" is a {} field; {} needs a {} field", name,
                                                       vector ? "scalar" : "vector", link_type, vector ? "vector" : "scalar"));
  return field;
}

}  // namespace

Result<field::ScalarFieldPtr> require_scalar_field(const json::Node& link, std::string_view key, std::string_view link_type,
                                                   const BuildContext& context) {
  CATENA_TRY(const field::AnyField field, require_field(link, key, link_type, false, context));
  return field.scalar;
}

Result<field::VectorFieldPtr> require_vector_field(const json::Node& link, std::string_view key, std::string_view link_type,
                                                   const BuildContext& context) {
  CATENA_TRY(const field::AnyField field, require_field(link, key, link_type, true, context));
  return field.vector;
}

Result<double> require_level(const json::Node& link, std::string_view key, const field::ScalarField& field) {
  if (const std::string why = field::no_surface_hint(field, link.find(key)->string); !why.empty())
    return json::error_at(*link.find(key), why);
  CATENA_TRY(const double level, json::require_number(link, "level"));
  if (field.cells() != nullptr && field.grid() == nullptr) return level;  // the range of its finest level is not known
  const double minimum = field.min_value(), maximum = field.max_value();
  if (!(level >= minimum && level <= maximum))
    return json::error_at(*link.find("level"),
                          fmt::format("level {} is not attained by field \"{}\"; expected a value within {} .. {}", level,
                                      link.find(key)->string, format_readable(minimum), format_readable(maximum)));
  return level;
}

namespace {

/// Sets the field values that `normalise` maps to 0 and 1.
Outcome set_scale(const json::Node& node, const std::string& name, HapticTransferFunction& map) {
  if (map.quantity == HapticTransferFunction::Quantity::value) {
    const DisplayRange range = field::display_range(*map.field.scalar);
    map.range_min = range.lo;
    map.range_max = range.hi;
    if (!std::isfinite(map.range_min) || !std::isfinite(map.range_max))
      return json::error_at(*node.find("normalise"),
                            fmt::format("field \"{}\" has no finite range to normalise by; \"map\" over its values, "
                                        "without \"normalise\", was expected",
                                        name));
    return Done{};
  }
  map.range_max = map.field.scalar ? field::compute_max_gradient(*map.field.scalar) : field::compute_max_magnitude(*map.field.vector);
  return Done{};
}

Result<Parameter> read_map(const json::Node& node, std::string_view key, json::NumberRange range, const BuildContext& context) {
  CATENA_CHECK(json::check_known_keys(node, {"field", "map", "quantity", "normalise", "outside"}));
  auto map = std::make_shared<HapticTransferFunction>();
  CATENA_TRY(const std::string name, json::require_string(node, "field"));
  CATENA_TRY(map->field, context.field(*node.find("field"), name));

  // quantity of the field that is mapped
  const bool vector = map->field.vector != nullptr;
  CATENA_TRY(const int of, json::get_choice(node, "quantity", vector ? 2 : 0, {"value", "gradient", "magnitude"}));
  map->quantity = static_cast<HapticTransferFunction::Quantity>(of);
  if (vector != (map->quantity == HapticTransferFunction::Quantity::magnitude))
    return json::error_at(*node.find("quantity"),
                          fmt::format("\"{}\" is a {} field; \"quantity\": {} was expected", name, vector ? "vector" : "scalar",
                                      vector ? "\"magnitude\"" : "\"value\" or \"gradient\""));
  CATENA_TRY(map->normalize, json::get_boolean(node, "normalise", false));
  if (map->normalize) CATENA_CHECK(set_scale(node, name, *map));

  // control points of the map
  const json::Node* points = node.find("map");
  if (points == nullptr) return json::error_at(node, fmt::format("\"{}\" has no \"map\"; [[value, output], ...] was expected", key));
  CATENA_TRY(const auto rows, json::as_rows(*points, "map", 2));
  if (rows.empty()) return json::error_at(*points, "\"map\" is empty; [[value, output], ...] was expected");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const json::Node& item = points->items[i];
    CATENA_TRY(const double output, json::as_number(item.items[1], key, range));
    if (i > 0 && !(rows[i][0] > rows[i - 1][0]))
      return json::error_at(item, fmt::format("the values of \"map\" do not increase; a value > {} was expected", rows[i - 1][0]));
    map->points.push_back({rows[i][0], output});
  }
  CATENA_TRY(map->outside, json::get_number(node, "outside", map->points.front().output, range));
  return Parameter(std::shared_ptr<const HapticTransferFunction>(std::move(map)));
}

}  // namespace

Result<Parameter> get_parameter(const json::Node& link, std::string_view key, const Parameter& fallback, json::NumberRange range,
                                const BuildContext& context) {
  const json::Node* node = link.find(key);
  if (node == nullptr) return fallback;
  if (node->kind == json::Kind::object) return read_map(*node, key, range, context);
  CATENA_TRY(const double value, json::as_number(*node, key, range));
  return Parameter(value);
}

Result<Parameter> require_parameter(const json::Node& link, std::string_view key, json::NumberRange range, const BuildContext& context) {
  if (link.find(key) == nullptr) {
    CATENA_CHECK(json::require_number(link, key, range));
  }
  return get_parameter(link, key, 0.0, range, context);
}

namespace {

/// Empty schema context: these schemas need none.
struct Nothing {};
template <class T>
using Table = schema::StructSchema<T, const Nothing>;

const Table<ActivationSwitch>& switch_table() {
  static const auto table = [] {
    Table<ActivationSwitch> t;
    t.bind(schema::integer("button", "",
                           "Button of the switch, which is on while the button is held (see `toggle`); in place of `force_above`.", 1, 32)
               .without_default(),
           &ActivationSwitch::button);
    t.bind(schema::boolean("toggle", "Each press of the button inverts the switch."), &ActivationSwitch::toggle);
    t.bind(schema::number("force_above", "N", "Force of the last tick above which the switch goes on; in place of `button`.")
               .positive()
               .without_default(),
           &ActivationSwitch::force_above_n);
    t.custom(schema::number("force_below", "N", "Force of the last tick at or below which the switch goes off.")
                 .non_negative()
                 .with_default("`force_above`"),
             [](const Nothing&, const json::Node& node, ActivationSwitch& on) -> Outcome {
               CATENA_TRY(on.force_below_n, json::get_number(node, "force_below", on.force_above_n, json::NumberRange::non_negative));
               if (on.force_below_n <= on.force_above_n) return Done{};
               return json::error_at(*node.find("force_below"),
                                     "\"force_below\" is above \"force_above\"; a number up to \"force_above\" was expected");
             });
    return t;
  }();
  return table;
}

const Table<ReleaseCue>& release_cue_table() {
  static const auto table = [] {
    Table<ReleaseCue> t;
    t.bind(schema::choice(
               "type", {"none", "detent", "vibration"},
               "Kind of cue; `detent`: a pulse when the probe leaves the feature or returns; `vibration`: a vibration near release."),
           &ReleaseCue::type);
    t.bind(schema::number("distance", "world", "Distance between probe and proxy at which the probe has left the feature.")
               .positive()
               .with_default("the distance at which the link slips or releases"),
           &ReleaseCue::distance);
    t.bind(schema::number("onset", "", "Fraction of `distance` from which a vibration acts.").within(0, 1), &ReleaseCue::onset);
    t.bind(schema::number("amplitude", "N", "Amplitude of the force.").non_negative(), &ReleaseCue::amplitude_n);
    t.bind(schema::number("frequency", "Hz", "Frequency of a vibration.").positive(), &ReleaseCue::frequency_hz);
    t.bind(schema::number("duration", "s", "Duration of a detent.").positive(), &ReleaseCue::duration_s);
    return t;
  }();
  return table;
}

const Table<Align>& align_table() {
  static const auto table = [] {
    Table<Align> t;
    t.custom(schema::direction("axis", "Axis of the tool that is aligned, in the tool's frame.").with_default("[0, 0, 1]"),
             [](const Nothing&, const json::Node& node, Align& align) -> Outcome {
               CATENA_TRY(const Vec3 axis, json::get_vec3(node, "axis", align.tool_axis));
               align.tool_axis = direction(axis);
               if (max_abs(align.tool_axis) > 0) return Done{};
               return json::error_at(*node.find("axis"),
                                     "\"axis\" is zero; a vector of the tool's frame, of non-zero length, was expected");
             });
    t.bind(schema::number("stiffness", "N m/rad", "Rotational stiffness of the alignment.")
               .non_negative()
               .with_default("`coupling.rotational_stiffness`"),
           &Align::stiffness_nm_per_rad);
    t.bind(schema::choice("sign", {"either", "same"},
                          "Direction of the normal or tangent; `either`: both directions are equivalent; `same`: the direction matters."),
           &Align::sign);
    return t;
  }();
  return table;
}

}  // namespace

schema::Key switch_key() {
  return schema::object("active_when", switch_table().keys(), "Switch of the link, with either `button` or `force_above`.")
      .with_default("always on");
}

schema::Key release_cue_key() {
  return schema::object("release_cue", release_cue_table().keys(),
                        "Haptic cue when the probe leaves the feature of the link, is about to leave it, or returns.")
      .with_default("no cue");
}

schema::Key align_key() {
  return schema::object("align", align_table().keys(),
                        "Alignment of an axis of the tool with a surface's normal or a curve's tangent; only with `\"method\": \"chain\"` "
                        "of `coupling`.")
      .with_default("none");
}

Result<ActivationSwitch> read_switch(const json::Node& holder) {
  ActivationSwitch on;
  const json::Node* node = holder.find("active_when");
  if (node == nullptr) return on;
  CATENA_CHECK(json::expect_object(*node, "active_when"));
  CATENA_CHECK(json::check_known_keys(*node, schema::key_names(switch_table().keys())));
  const bool button = node->find("button") != nullptr, force = node->find("force_above") != nullptr;
  if (button == force)
    return json::error_at(*node, std::string("\"active_when\" has ") + (button ? "both" : "neither") +
                                     " \"button\" and \"force_above\"; exactly one of them was expected");
  if (const json::Node* other = node->find(button ? "force_below" : "toggle"))
    return json::error_at(*other,
                          button ? "\"force_below\" belongs to \"force_above\", not to \"button\"; only \"toggle\" was expected beside it"
                                 : "\"toggle\" belongs to \"button\", not to \"force_above\"; only \"force_below\" was expected beside it");
  CATENA_CHECK(switch_table().read_own_keys({}, *node, on));
  return on;
}

Result<ReleaseCue> read_release_cue(const json::Node& link) {
  ReleaseCue out;
  const json::Node* node = link.find("release_cue");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "release_cue"));
  CATENA_CHECK(release_cue_table().read({}, *node, out));
  return out;
}

Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint) {
  Align out;
  const json::Node* node = link.find("align");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "align"));
  CATENA_CHECK(json::check_known_keys(*node, schema::key_names(align_table().keys())));
  const ConstraintType& type = *find_constraint_type(link.find("type")->string);
  if (!constraint.has_primitive() || !type.has_axis)
    return json::error_at(
        *node, "a \"" + type.type + "\" link has no axis to align with; a surface (its normal) or a curve (its tangent) was expected");
  if (coupling.method != CouplingMethod::chain)
    return json::error_at(*node, "\"align\" needs a separate proxy for the link; \"method\": \"chain\" was expected in \"coupling\"");
  out.enabled = true;
  out.stiffness_nm_per_rad = coupling.rotational_stiffness_nm_per_rad;
  CATENA_CHECK(align_table().read_own_keys({}, *node, out));
  return out;
}

}  // namespace catena::haptics
