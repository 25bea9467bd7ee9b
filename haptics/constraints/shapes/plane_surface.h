/// A plane as the rules of surface_side.h see it: height h(x) = n . (x - point), projection x - n h(x). n is unit.
/// World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

struct PlaneShape {
  Vec3 point, normal;
};

class PlaneSurface final : public Surface {
 public:
  using Shape = PlaneShape;
  using Memory = NoMemory;
  PlaneSurface(const Shape& shape, Memory&, const SideMemory&) : point_(shape.point), normal_(shape.normal) {}
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
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

}  // namespace catena::haptics
