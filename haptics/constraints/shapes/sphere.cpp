#include "haptics/constraints/shapes/sphere.h"

#include "haptics/constraints/shapes/sphere_surface.h"

namespace catena::haptics {
namespace {

Result<std::shared_ptr<const Constraint>> build_sphere(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 center, json::require_vec3(link, "center"));
  CATENA_TRY(const double radius, json::require_number(link, "radius", json::Range::positive));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return make_closed_form<SphereSurface>({center, radius, rules.free == FreeSide::above}, rules);
}

}  // namespace

ConstraintType sphere_constraint() {
  return {"sphere",
          "section 3",
          {{"center", "array", true, "world units", kVec3Schema},
           {"radius", "number", true, "world units", kPositiveSchema},
           {"free", "string", false, "the side where the hand moves freely: above is outside", kFreeSchema}},
          build_sphere,
          true};
}

}  // namespace catena::haptics
