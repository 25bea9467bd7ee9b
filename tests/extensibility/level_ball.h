// SPDX-License-Identifier: MIT
/// A constraint of the tests: a ball whose radius is the level of a field. Registered by a test program, and built as a plug-in.
#pragma once
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/registry.h"
#include "haptics/constraints/shapes/closed_form.h"
#include "haptics/constraints/shapes/surface_shapes.h"

namespace extension_points_test {

using namespace catena;
using namespace catena::haptics;

inline Result<std::shared_ptr<const Constraint>> build_level_ball(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::ScalarFieldPtr field, require_scalar_field(link, "field", "shell", context));
  CATENA_TRY(const double level, require_level(link, "field", *field));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return make_closed_form<SphereSurface>({Vec3(0.0), level, rules.free == FreeSide::above}, rules);
}

inline ConstraintType level_ball_constraint() {
  return {"shell",
          "Holds the proxy on a ball that is as large as a level.",
          "of no paper",
          {scalar_field_key("field").required(), level_key("The ball's radius.").required(),
           schema::number("glow", "candela", "Of no effect.").positive().with_default("1"), free_key("outside")},
          build_level_ball,
          true};
}

}  // namespace extension_points_test
