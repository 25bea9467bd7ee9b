#include "haptics/constraints/plane.h"

#include "haptics/constraints/surface_side.h"

namespace catena::haptics {
namespace {

class PlaneSurface final : public Surface {
 public:
  PlaneSurface(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal) {}
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
  double domain_length() const noexcept override { return 4; }

 private:
  double height(const Vec3& at) const { return dot(normal_, at - point_); }
  Vec3 point_, normal_;
};

class Plane final : public Constraint {
 public:
  Plane(const Vec3& point, const Vec3& normal, const SideSpec& rules) : point_(point), normal_(normal), rules_(rules) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    PlaneSurface surface(point_, normal_);
    start_on(surface, rules_.at(probe, state, scratch), probe, memory_of<SideMemory>(state), state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    PlaneSurface surface(point_, normal_);
    advance_on(surface, rules_.now(state, scratch), probe, memory_of<SideMemory>(state), state);
  }
  bool has_primitive() const noexcept override { return true; }
  bool primitive(const Vec3&, LinkState&, LinkScratch&, Primitive& out) const noexcept override {
    out = {Primitive::Kind::plane, point_, normal_};
    return true;
  }

 private:
  Vec3 point_, normal_;
  SideSpec rules_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 point, json::require_vec3(link, "point"));
  CATENA_TRY(const Vec3 given, json::require_vec3(link, "normal"));
  const Vec3 normal = direction(given);
  if (!(max_abs(normal) > 0)) return json::error_at(*link.find("normal"), "\"normal\" is zero; expected a vector of non-zero length");
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Plane>(point, normal, rules));
}

}  // namespace

ConstraintType plane_constraint() {
  return {"plane",
          "section 3",
          {{"point", "array", true, "a point of the plane, world units", kVec3Schema},
           {"normal", "array", true, "its normal, any length but zero", kVec3Schema},
           {"free", "string", false, "the side where the hand moves freely: above is where the normal points to", kFreeSchema},
           {"release", "parameter", false, "lets go at this depth, world units", kPositiveSchema}},
          build};
}

}  // namespace catena::haptics
