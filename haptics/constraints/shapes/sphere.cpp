// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include "haptics/constraints/shapes/surface_shapes.h"

namespace catena::haptics {
namespace {

Result<std::shared_ptr<const Constraint>> build_sphere(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 center, json::require_vec3(link, "center"));
  CATENA_TRY(const double radius, json::require_number(link, "radius", json::NumberRange::positive));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return make_closed_form<SphereSurface>({center, radius, rules.free == FreeSide::above}, rules);
}

}  // namespace

ConstraintType sphere_constraint() {
  return {
      "sphere",
      "Holds the proxy on a sphere, or on one side of it.",
      "section 3",
      {schema::vec3("center", "world", "Centre of the sphere.").required(),
       schema::number("radius", "world", "Radius of the sphere.").positive().with_initial_value("0.1 L").required(), free_key("outside")},
      build_sphere,
      true};
}

}  // namespace catena::haptics
