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
class PlaneSurface final : public Surface {
 public:
  /// What it is of.
  using Shape = PlaneShape;
  /// None.
  using Memory = NoMemory;
  /// As ClosedForm makes it in every tick.
  PlaneSurface(const Shape& shape, Memory&, const SideMemory&) : point_(shape.point), normal_(shape.normal) {}
  /// True.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Above is where the normal points.
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
  /// L of a scene without fields.
  double domain_length() const noexcept override { return kSceneLength; }
  /// Itself.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    out = {Primitive::Kind::plane, place(at).proxy, normal_};
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
  bool catches;  // free above: a thin sphere is not passed within one tick
};

/// The Surface of a sphere.
class SphereSurface final : public Surface {
 public:
  /// What it is of.
  using Shape = SphereShape;
  /// What it remembers.
  struct Memory {
    /// At the point held; against the way in while a thin sphere is held on its near half.
    Vec3 normal;  // at the point held; against the way in while a thin sphere is held on its near half
  };
  /// As ClosedForm makes it in every tick.
  SphereSurface(const Shape& shape, Memory& memory, const SideMemory& side)
      : center_(shape.center), radius_(shape.radius), catches_(shape.catches), memory_(memory), side_(side) {}

  /// True.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Above is outside.
  SideValue side(const Vec3& at) noexcept override { return {height(at), true, false}; }

  Hold place(const Vec3& probe) noexcept override {
    const Vec3 n = direction(probe - center_);
    if (max_abs(n) > 0)
      memory_.normal = n;
    else if (!(max_abs(memory_.normal) > 0))
      memory_.normal = Vec3(1, 0, 0);
    normal_ = memory_.normal;
    return on_sphere(center_ + normal_ * radius_);
  }

  Hold slide(const Vec3& probe) noexcept override { return side_.sheet && height(probe) > 0 ? near_side(probe) : place(probe); }

  Hold cross(const Vec3& from, const Vec3& probe) noexcept override {
    const double before = height(from), after = height(probe);
    if (before <= 0 && after <= 0) return {};
    if (before < 0 || after <= 0 || (before == 0 && !catches_)) return place(probe);

    // both outside: where the segment enters
    const Vec3 u = from - center_, way = direction(probe - from);
    const double middle = -dot(u, way), apart = norm(u + way * middle);
    if (!(apart < radius_)) return {};
    const double s = middle - std::sqrt((radius_ - apart) * (radius_ + apart));
    if (!(s >= -1e-9 * radius_ && s <= norm(probe - from))) return {};
    if (!catches_) return place(probe);
    memory_.normal = -way;
    return near_side(probe);
  }

  Hold near_by(const Vec3& probe, double limit) noexcept override { return std::fabs(height(probe)) <= limit ? place(probe) : Hold{}; }
  Vec3 normal() const noexcept override { return normal_; }
  bool may_be_thin() const noexcept override { return true; }
  /// L: its diameter, or that of a scene without fields.
  double domain_length() const noexcept override { return std::max(kSceneLength, 2 * radius_); }

  /// J = (R / d) (I - r r^T), r the unit way from the centre, d the probe's distance from it.
  PulledBack pull_back(const Vec3& probe, const Vec3& f) const noexcept {
    const Vec3 r = direction(probe - center_);
    return divided(f - r * dot(r, f), norm(probe - center_) / radius_);
  }
  /// The tangent plane where it holds.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    const Hold hold = slide(at);
    if (!hold.found) return false;
    out = {Primitive::Kind::plane, hold.proxy, normal_};
    return true;
  }

 private:
  double height(const Vec3& at) const { return norm(at - center_) - radius_; }
  Hold on_sphere(const Vec3& proxy) const { return {true, proxy, std::fabs(height(proxy)), Status::ok}; }

  Hold near_side(const Vec3& probe) noexcept {
    const Vec3 w = probe - center_, q = w - memory_.normal * dot(w, memory_.normal);
    const double apart = norm(q);
    if (!(apart < radius_)) return {};
    const Vec3 proxy = center_ + q + memory_.normal * std::sqrt((radius_ - apart) * (radius_ + apart));
    normal_ = direction(proxy - center_);
    return on_sphere(proxy);
  }

  Vec3 center_;
  double radius_;
  bool catches_;
  Memory& memory_;
  const SideMemory& side_;
  Vec3 normal_{0.0};
};

}  // namespace catena::haptics
