// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include "haptics/constraints/shapes/surface_shapes.h"

namespace catena::haptics {
namespace {

Result<std::shared_ptr<const Constraint>> build_plane(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 point, json::require_vec3(link, "point"));
  CATENA_TRY(const Vec3 given, json::require_vec3(link, "normal"));
  const Vec3 normal = direction(given);
  if (!(max_abs(normal) > 0)) return json::error_at(*link.find("normal"), "\"normal\" is zero; expected a vector of non-zero length");
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return make_closed_form<PlaneSurface>({point, normal}, rules);
}

}  // namespace

ConstraintType plane_constraint() {
  return {"plane",
          "Holds the proxy on a plane, or on one side of it.",
          "section 3",
          {schema::vec3("point", "world", "Point on the plane.").required(),
           schema::direction("normal", "Normal of the plane, of any length.").with_initial_value("[0, 0, 1]").required(),
           free_key("the side to which the normal points")},
          build_plane,
          true,
          true,
          "slices"};
}

}  // namespace catena::haptics
