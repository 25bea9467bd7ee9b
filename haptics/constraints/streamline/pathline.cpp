// SPDX-License-Identifier: MIT
#include <array>

#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "haptics/constraints/streamline/streamline.h"

namespace catena::haptics {
namespace {

constexpr std::array<std::string_view, 2> kClocks{"free", "proxy"}, kInterpolations{"linear", "cubic"};

schema::Key pathline_times_key() {
  return schema::vector("times", 2, "time", "Release of the particle and end of its path; the end may be first.")
      .with_default("all times, of formulas those of `time`");
}

Result<std::shared_ptr<const Constraint>> build_pathline(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "field"));
  CATENA_TRY(const PathlineSpec spec, read_pathline_spec(link));
  CATENA_CHECK(json::get_choice(link, "clock", 0, {kClocks.begin(), kClocks.end()}));
  if (!context.pathline) return json::error_at(link, "path lines need a scene with time steps; this program has none");
  CATENA_TRY(flow::CurvePtr curve, context.pathline(link, name, spec));
  return make_selected_streamline(std::move(curve));
}

}  // namespace

Result<PathlineSpec> read_pathline_spec(const json::Node& link) {
  CATENA_TRY(const auto seed, json::get_optional_vec3(link, "seed"));
  if (!seed) return json::error_at(link, "\"seed\" is missing; the position of the particle [x, y, z] was expected");
  PathlineSpec spec{*seed, {}, false};
  CATENA_CHECK(schema::read_value(pathline_times_key(), link, spec.times));
  CATENA_TRY(const int interpolation, json::get_choice(link, "time_interpolation", 0, {kInterpolations.begin(), kInterpolations.end()}));
  spec.is_cubic_in_time = interpolation == 1;
  return spec;
}

ConstraintType pathline_constraint() {
  return {
      "pathline",
      "Holds the proxy on the way of a particle through the time steps of a field.",
      "section 4, Eqs. 1-4",
      {vector_field_key("field").required(), schema::vec3("seed", "world", "Position at which the particle is released.").required(),
       pathline_times_key(),
       schema::choice("time_interpolation", {kInterpolations.begin(), kInterpolations.end()}, "Interpolation between time steps.")
           .with_default("`linear`"),
       schema::choice("clock", {kClocks.begin(), kClocks.end()},
                      "`free`: the hand is anywhere on the path; `proxy`: the scene shows the time at which the particle is at the proxy.")
           .with_default("`free`")},
      build_pathline,
      false,
      true,
      "streamlines"};
}

}  // namespace catena::haptics
