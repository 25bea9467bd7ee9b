// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/streamline.h"

#include <array>

#include <fmt/format.h>

#include "engine/geometry/flow/flow.h"
#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/streamline/online_streamline.h"
#include "haptics/constraints/streamline/selected_streamline.h"

namespace catena::haptics {
namespace {

constexpr std::array<std::string_view, 7> kMethods{"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"};
constexpr std::array<std::string_view, 2> kFollow{"selected", "online"};

/// Checks that the field has a direction at the seed of an online streamline.
Outcome check_seed(const json::Node& where, const OnlineStreamlineSpec& spec, const std::string& name) {
  field::Cursor cursor;
  Vec3 u;
  switch (flow::seed_direction({spec.field.get(), spec.is_line_field, spec.min_speed}, *spec.seed, cursor, u)) {
    case flow::StopReason::none:
      return Done{};
    case flow::StopReason::outside:
      return json::error_at(
          where, fmt::format("\"seed\" lies outside the domain of field \"{}\"; a position within the domain was expected", name));
    default:
      return json::error_at(
          where, fmt::format("\"seed\" lies where field \"{}\" is zero{}; a position where the field has a direction was expected", name,
                             spec.min_speed > 0 ? " or not faster than \"min_speed\"" : ""));
  }
}

Result<std::shared_ptr<const Constraint>> build_streamline(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "field"));
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "a streamline", context));

  OnlineStreamlineSpec spec;
  spec.field = field;
  CATENA_CHECK(schema::read_value(schema::line_kind_key(), link, spec.is_line_field));
  CATENA_TRY(spec.min_speed, json::get_number(link, "min_speed", 0, json::NumberRange::non_negative));
  // neighboring fibers of noisy data diverge quickly: with these defaults, online and selected agree to 1e-6 L
  const bool cells = spec.is_line_field && field->is_grid();
  CATENA_TRY(spec.tolerance, json::get_number(link, "tolerance", cells ? 1e-13 : 1e-9, json::NumberRange::positive));
  if (!(spec.tolerance < 1))
    return json::error_at(
        *link.find("tolerance"),
        fmt::format("\"tolerance\" is {}; a number > 0 and < 1 was expected (it is times the domain length)", spec.tolerance));
  CATENA_TRY(const int method, json::get_choice(link, "method", static_cast<int>(cells ? flow::Method::dp54 : flow::Method::rkf34),
                                                {kMethods.begin(), kMethods.end()}));
  spec.method = static_cast<flow::Method>(method);
  CATENA_TRY(const int follow, json::get_choice(link, "follow", 0, {kFollow.begin(), kFollow.end()}));
  CATENA_TRY(spec.seed, json::get_optional_vec3(link, "seed"));

  // selected or online
  const json::Node *follow_node = link.find("follow"), *method_node = link.find("method");
  if (follow_node && follow == 0) {
    if (!spec.seed) return json::error_at(*follow_node, "\"follow\": \"selected\" needs a \"seed\" of three numbers");
    if (method_node)
      return json::error_at(*method_node, "\"method\" contradicts \"follow\": \"selected\"; stating a method implies \"online\"");
  }
  if (spec.seed && !method_node && follow == 0) {
    const flow::Flow flow{spec.field.get(), spec.is_line_field, spec.min_speed};
    CATENA_TRY(flow::CurvePtr curve, context.curve(*link.find("seed"), name, flow, *spec.seed));
    return make_selected_streamline(std::move(curve));
  }
  if (spec.seed) CATENA_CHECK(check_seed(*link.find("seed"), spec, name));
  return make_online_streamline(spec);
}

}  // namespace

ConstraintType streamline_constraint() {
  return {"streamline",
          "Holds the proxy on a streamline, traced once or integrated in every tick.",
          "section 4, Eqs. 1-4",
          {vector_field_key("field").required(),
           schema::vec3("seed", "world", "Seed position of the streamline.")
               .with_default("the probe's position when the link is switched on")
               .or_widget()
               .recommended(),
           schema::choice("follow", {kFollow.begin(), kFollow.end()},
                          "`selected`: the streamline is traced once from `seed`; `online`: the streamline is integrated in every tick.")
               .with_default("`selected` with `seed` and without `method`, otherwise `online`"),
           schema::choice("method", {kMethods.begin(), kMethods.end()},
                          "Integrator of `online`; a stated method implies `online`. `linear`: Eqs. 1-2 of the paper as printed.")
               .with_default("`rkf34`; sampled line fields `dp54`"),
           schema::number("tolerance", "L", "Maximum embedded error of one step of `online`.")
               .with_limits({0.0, 1.0, true, true})
               .with_initial_value("1e-4")
               .with_default("1e-9; sampled line fields 1e-13"),
           schema::line_kind_key(),
           schema::number("min_speed", "value", "Speed at or below which the field counts as zero.").non_negative().with_default("0")},
          build_streamline,
          false,
          true,
          "streamlines"};
}

}  // namespace catena::haptics
