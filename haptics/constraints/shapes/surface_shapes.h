/// A plane as the rules of surface_side.h see it: height h(x) = n . (x - point), projection x - n h(x). n is unit.
/// World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include <limits>

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

/// A plane. Plain data.
struct PlaneShape {
  Vec3 point, normal;  ///< a place on it; unit, world units
};

/// The Surface of a plane.
class PlaneSurface final : public ContactSurface {
 public:
  /// What it is of.
  using Shape = PlaneShape;
  /// None.
  using Memory = NoMemory;
  /// As ClosedFormConstraint makes it in every tick.
  PlaneSurface(const Shape& shape, Memory&, const SideMemory&) : point_(shape.point), normal_(shape.normal) {}
  /// True.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Above is where the normal points.
  SideValue evaluate_side(const Vec3& at) noexcept override { return {height(at), true, false}; }
  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    // a second projection takes off what rounding left
    Vec3 proxy = probe - normal_ * height(probe);
    proxy = proxy - normal_ * height(proxy);
    return {true, proxy, std::fabs(height(proxy)), LinkStatus::ok};
  }
  SurfaceHold slide(const Vec3& probe) noexcept override { return project_probe(probe); }
  SurfaceHold find_crossing(const Vec3&, const Vec3& probe) noexcept override { return project_probe(probe); }
  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    return std::fabs(height(probe)) <= limit ? project_probe(probe) : SurfaceHold{};
  }
  Vec3 normal() const noexcept override { return normal_; }
  /// L of a scene without fields.
  double domain_length() const noexcept override { return kDefaultDomainLength; }
  /// Itself.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    out = {Primitive::Kind::plane, project_probe(at).proxy, normal_};
    return true;
  }

 private:
  double height(const Vec3& at) const { return dot(normal_, at - point_); }
  Vec3 point_, normal_;
};

/// A sphere as the rules of surface_side.h see it; the model is in shapes.h. World units. Haptic thread: no allocation, lock, throw.
struct SphereShape {
  Vec3 center;    ///< world units
  double radius;  ///< world units
  /// Free above: a thin sphere is not passed within one tick.
  bool prevents_tunneling;  // free above: a thin sphere is not passed within one tick
};

/// The Surface of a sphere.
class SphereSurface final : public ContactSurface {
 public:
  /// What it is of.
  using Shape = SphereShape;
  /// What it remembers.
  struct Memory {
    /// At the point held; against the way in while a thin sphere is held on its near half.
    Vec3 normal;  // at the point held; against the way in while a thin sphere is held on its near half
  };
  /// As ClosedFormConstraint makes it in every tick.
  SphereSurface(const Shape& shape, Memory& memory, const SideMemory& side)
      : center_(shape.center), radius_(shape.radius), prevents_tunneling_(shape.prevents_tunneling), memory_(memory), side_(side) {}

  /// True.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Above is outside.
  SideValue evaluate_side(const Vec3& at) noexcept override { return {height(at), true, false}; }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    const Vec3 n = direction(probe - center_);
    if (max_abs(n) > 0)
      memory_.normal = n;
    else if (!(max_abs(memory_.normal) > 0))
      memory_.normal = Vec3(1, 0, 0);
    normal_ = memory_.normal;
    return on_sphere(center_ + normal_ * radius_);
  }

  SurfaceHold slide(const Vec3& probe) noexcept override {
    return side_.beyond_body && height(probe) > 0 ? near_side(probe) : project_probe(probe);
  }

  SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept override {
    const double before = height(from), after = height(probe);
    if (before <= 0 && after <= 0) return {};
    if (before < 0 || after <= 0 || (before == 0 && !prevents_tunneling_)) return project_probe(probe);

    // both outside: where the segment enters
    const Vec3 u = from - center_, way = direction(probe - from);
    const double middle = -dot(u, way), apart = norm(u + way * middle);
    if (!(apart < radius_)) return {};
    const double s = middle - std::sqrt((radius_ - apart) * (radius_ + apart));
    if (!(s >= -1e-9 * radius_ && s <= norm(probe - from))) return {};
    if (!prevents_tunneling_) return project_probe(probe);
    memory_.normal = -way;
    return near_side(probe);
  }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    return std::fabs(height(probe)) <= limit ? project_probe(probe) : SurfaceHold{};
  }
  Vec3 normal() const noexcept override { return normal_; }
  bool may_tunnel() const noexcept override { return true; }
  /// L: its diameter, or that of a scene without fields.
  double domain_length() const noexcept override { return std::max(kDefaultDomainLength, 2 * radius_); }

  /// J = (R / d) (I - r r^T), r the unit way from the centre, d the probe's distance from it.
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f) const noexcept {
    const Vec3 r = direction(probe - center_);
    return divide_bounded(f - r * dot(r, f), norm(probe - center_) / radius_);
  }
  /// The tangent plane where it holds.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    const SurfaceHold hold = slide(at);
    if (!hold.found) return false;
    out = {Primitive::Kind::plane, hold.proxy, normal_};
    return true;
  }

 private:
  double height(const Vec3& at) const { return norm(at - center_) - radius_; }
  SurfaceHold on_sphere(const Vec3& proxy) const { return {true, proxy, std::fabs(height(proxy)), LinkStatus::ok}; }

  SurfaceHold near_side(const Vec3& probe) noexcept {
    const Vec3 w = probe - center_, q = w - memory_.normal * dot(w, memory_.normal);
    const double apart = norm(q);
    if (!(apart < radius_)) return {};
    const Vec3 proxy = center_ + q + memory_.normal * std::sqrt((radius_ - apart) * (radius_ + apart));
    normal_ = direction(proxy - center_);
    return on_sphere(proxy);
  }

  Vec3 center_;
  double radius_;
  bool prevents_tunneling_;
  Memory& memory_;
  const SideMemory& side_;
  Vec3 normal_{0.0};
};

}  // namespace catena::haptics
