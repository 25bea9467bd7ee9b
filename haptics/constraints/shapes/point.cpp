// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {
namespace {

struct PointShape {
  Vec3 position;
  SurfaceHold closest(const Vec3&) const noexcept { return {true, position, 0, LinkStatus::ok}; }
  Primitive primitive(const Vec3&) const noexcept { return {Primitive::Kind::point, position, Vec3(0.0)}; }
  double length() const noexcept { return kDefaultDomainLength; }
};

Result<std::shared_ptr<const Constraint>> build_point(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 position, json::require_vec3(link, "position"));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  return make_closed_form<FeatureSurface<PointShape>>({position}, rules);
}

}  // namespace

ConstraintType point_constraint() {
  return {"point",     "Holds the proxy at a point.",
          "section 3", {schema::vec3("position", "world", "Position of the point.").required()},
          build_point, true,
          false};
}

}  // namespace catena::haptics
