#include "haptics/constraints/plane.h"

#include "haptics/constraints/closed_form.h"

namespace catena::haptics {
namespace {

struct PlaneShape {
  Vec3 point, normal;
};

class PlaneSurface final : public Surface {
 public:
  using Shape = PlaneShape;
  using Memory = NoMemory;
  PlaneSurface(const Shape& shape, Memory&, const SideMemory&) : point_(shape.point), normal_(shape.normal) {}
  SideValue side(const Vec3& at) noexcept override { return {height(at), true, false}; }
  Hold place(const Vec3& probe) noexcept override {
    // a second projection takes off what rounding left
    Vec3 proxy = probe - normal_ * height(probe);
    proxy = proxy - normal_ * height(proxy);
    return {true, proxy, std::fabs(height(proxy)), Status::ok};
  }
  Hold slide(const Vec3& probe) noexcept override { return place(probe); }
  Hold cross(const Vec3&, const Vec3& probe) noexcept override { return place(probe); }
  Hold near_by(const Vec3& probe, double limit) noexcept override { return std::fabs(height(probe)) <= limit ? place(probe) : Hold{}; }
  Vec3 normal() const noexcept override { return normal_; }
  double domain_length() const noexcept override { return kSceneLength; }
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    out = {Primitive::Kind::plane, place(at).proxy, normal_};
    return true;
  }

 private:
  double height(const Vec3& at) const { return dot(normal_, at - point_); }
  Vec3 point_, normal_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
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
          build,
          true};
}

}  // namespace catena::haptics
