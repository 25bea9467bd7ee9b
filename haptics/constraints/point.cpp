#include "haptics/constraints/point.h"

#include "haptics/constraints/surface_side.h"

namespace catena::haptics {
namespace {

class PointSurface final : public Surface {
 public:
  explicit PointSurface(const Vec3& position) : position_(position) {}
  SideValue side(const Vec3&) noexcept override { return {}; }
  Hold place(const Vec3&) noexcept override { return {true, position_, 0, Status::ok}; }
  Hold slide(const Vec3& probe) noexcept override { return place(probe); }
  Hold cross(const Vec3&, const Vec3&) noexcept override { return {}; }
  Hold near_by(const Vec3& probe, double limit) noexcept override { return norm(probe - position_) <= limit ? place(probe) : Hold{}; }
  Vec3 normal() const noexcept override { return Vec3(0.0); }
  double domain_length() const noexcept override { return 4; }

 private:
  Vec3 position_;
};

class Point final : public Constraint {
 public:
  Point(const Vec3& position, const SideSpec& rules) : position_(position), rules_(rules) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    PointSurface surface(position_);
    start_on(surface, rules_.at(probe, state, scratch), probe, memory_of<SideMemory>(state), state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    PointSurface surface(position_);
    advance_on(surface, rules_.now(state, scratch), probe, memory_of<SideMemory>(state), state);
  }
  bool has_primitive() const noexcept override { return true; }
  bool primitive(const Vec3&, LinkState&, LinkScratch&, Primitive& out) const noexcept override {
    out = {Primitive::Kind::point, position_, Vec3(0.0)};
    return true;
  }

 private:
  Vec3 position_;
  SideSpec rules_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 position, json::require_vec3(link, "position"));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Point>(position, rules));
}

}  // namespace

ConstraintType point_constraint() {
  return {"point",
          "section 3",
          {{"position", "array", true, "the point, world units", kVec3Schema},
           {"release", "parameter", false, "lets go at this distance, world units", kPositiveSchema}},
          build};
}

}  // namespace catena::haptics
