#include "haptics/constraints/streamline/streamline.h"

#include <fmt/format.h>

#include "engine/flow/flow.h"
#include "haptics/constraints/rules/read_field.h"
#include "haptics/constraints/streamline/online.h"
#include "haptics/constraints/streamline/selected.h"

namespace catena::haptics {
namespace {

constexpr std::string_view kMethodSchema = R"("enum": ["linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"])";
constexpr std::string_view kFollowSchema = R"("enum": ["selected", "online"])";
constexpr std::string_view kKindSchema = R"("enum": ["vector", "line"])";
constexpr std::string_view kToleranceSchema = R"("exclusiveMinimum": 0, "exclusiveMaximum": 1)";

/// An online line needs a direction at its seed before the first tick.
Outcome check_seed(const json::Node& where, const OnlineSpec& spec, const std::string& name) {
  field::Cursor cursor;
  Vec3 u;
  switch (flow::seed_direction({spec.field.get(), spec.line, spec.min_speed}, *spec.seed, cursor, u)) {
    case flow::Stop::none:
      return Done{};
    case flow::Stop::outside:
      return json::error_at(where, fmt::format("\"seed\" lies outside the domain of field \"{}\"; a place within it was expected", name));
    default:
      return json::error_at(where, fmt::format("\"seed\" lies where field \"{}\" is zero{}; a place with a direction was expected", name,
                                               spec.min_speed > 0 ? " or not faster than \"min_speed\"" : ""));
  }
}

Result<std::shared_ptr<const Constraint>> build_streamline(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "field"));
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "a streamline", context));

  // keys
  OnlineSpec spec;
  spec.field = field;
  CATENA_TRY(const int kind, json::get_choice(link, "kind", 0, {"vector", "line"}));
  spec.line = kind == 1;
  CATENA_TRY(spec.min_speed, json::get_number(link, "min_speed", 0, json::Range::not_negative));
  // neighbouring fibres of noisy data part quickly: what is not stated is chosen so that online and selected agree to 1e-6 L
  const bool cells = spec.line && field->is_grid();
  CATENA_TRY(spec.tolerance, json::get_number(link, "tolerance", cells ? 1e-13 : 1e-9, json::Range::positive));
  if (!(spec.tolerance < 1))
    return json::error_at(
        *link.find("tolerance"),
        fmt::format("\"tolerance\" is {}; a number > 0 and < 1 was expected (it is times the domain length)", spec.tolerance));
  CATENA_TRY(const int method, json::get_choice(link, "method", static_cast<int>(cells ? flow::Method::dp54 : flow::Method::rkf34),
                                                {"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"}));
  spec.method = static_cast<flow::Method>(method);
  CATENA_TRY(const int follow, json::get_choice(link, "follow", 0, {"selected", "online"}));
  CATENA_TRY(spec.seed, json::get_optional_vec3(link, "seed"));

  // selected or online
  const json::Node *follow_node = link.find("follow"), *method_node = link.find("method");
  if (follow_node && follow == 0) {
    if (!spec.seed) return json::error_at(*follow_node, "\"follow\": \"selected\" needs a \"seed\" of three numbers");
    if (method_node)
      return json::error_at(*method_node, "\"method\" contradicts \"follow\": \"selected\"; stating a method implies \"online\"");
  }
  if (spec.seed && !method_node && follow == 0) {
    const flow::Flow flow{spec.field.get(), spec.line, spec.min_speed};
    CATENA_TRY(flow::CurvePtr curve, context.curve(*link.find("seed"), name, flow, *spec.seed));
    return make_selected_streamline(std::move(curve));
  }
  if (spec.seed) CATENA_CHECK(check_seed(*link.find("seed"), spec, name));
  return make_online_streamline(spec);
}

}  // namespace

ConstraintType streamline_constraint() {
  return {
      "streamline",
      "section 4, Eqs. 1-4",
      {{"field", "vector_field", true, "a vector field of the scene"},
       {"seed", "array", false, "a place on the line, world units; without it the probe where the link is switched on", kVec3Schema, true},
       {"follow", "string", false, "selected: on the traced curve (default with a seed); online: integrated every tick", kFollowSchema},
       {"method", "string", false,
        "of online following, which it implies; default rkf34, of sampled line fields dp54; linear is Eqs. 1-2 as printed", kMethodSchema},
       {"tolerance", "number", false,
        "of the embedded error of one online step, times the domain length; default 1e-9, of sampled line fields 1e-13", kToleranceSchema},
       {"kind", "string", false, "line: v and -v are the same, as for fibres", kKindSchema},
       {"min_speed", "number", false, "speeds up to this count as zero", kNotNegativeSchema}},
      build_streamline};
}

}  // namespace catena::haptics
