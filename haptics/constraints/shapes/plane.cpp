#include "haptics/constraints/shapes/plane.h"

#include "haptics/constraints/shapes/plane_surface.h"

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
          "section 3",
          {{"point", "array", true, "a point of the plane, world units", kVec3Schema},
           {"normal", "array", true, "its normal, any length but zero", kVec3Schema},
           {"free", "string", false, "the side where the hand moves freely: above is where the normal points to", kFreeSchema}},
          build_plane,
          true};
}

}  // namespace catena::haptics
