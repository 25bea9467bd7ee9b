// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {
namespace {

struct LineShape {
  Vec3 point, axis;  // axis: unit vector

  SurfaceHold closest(const Vec3& probe) const noexcept {
    const double s = dot(axis, probe - point);
    const Vec3 proxy = point + axis * s, away = proxy - point;
    return {true, proxy, norm(away - axis * dot(axis, away)), LinkStatus::ok};
  }
  Primitive primitive(const Vec3& at) const noexcept { return {Primitive::Kind::line, closest(at).proxy, axis}; }
  double length() const noexcept { return kDefaultDomainLength; }
};

Result<std::shared_ptr<const Constraint>> build_line(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 point, json::require_vec3(link, "point"));
  CATENA_TRY(const Vec3 given, json::require_vec3(link, "direction"));
  const Vec3 axis = direction(given);
  if (!(max_abs(axis) > 0))
    return json::error_at(*link.find("direction"), "\"direction\" is zero; a vector of non-zero length was expected");
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  return make_closed_form<FeatureSurface<LineShape>>({point, axis}, rules);
}

}  // namespace

ConstraintType line_constraint() {
  return {"line",
          "Holds the proxy on an infinite line.",
          "section 3",
          {schema::vec3("point", "world", "Point on the line.").required(),
           schema::direction("direction", "Direction of the line, of any length.").with_initial_value("[1, 0, 0]").required()},
          build_line,
          true};
}

}  // namespace catena::haptics
