// SPDX-License-Identifier: MIT
/// Plane and sphere as surfaces for the contact rules of common/one_sided_contact.h. World units.
/// Haptic thread: no allocation, lock, throw.
#pragma once
#include <limits>

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

/// A plane: height h(x) = n . (x - point), projection x - n h(x), n the unit normal. Plain data.
struct PlaneShape {
  Vec3 point, normal;  ///< point of the plane, world units; unit normal
};

/// The surface of a plane.
class PlaneSurface final : public ContactSurface {
 public:
  /// Shape that the surface is made of.
  using Shape = PlaneShape;
  /// Nothing is kept between ticks.
  using Memory = NoMemory;
  /// Made by ClosedFormConstraint in every tick.
  PlaneSurface(const Shape& shape, Memory&, const SideMemory&) : point_(shape.point), normal_(shape.normal) {}
  /// Returns true: every shape is valid.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Returns the signed distance; above is the side that the normal points to.
  SideValue evaluate_side(const Vec3& at) noexcept override { return {height(at), true, false}; }
  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    // a second projection removes the rounding error of the first
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
  /// Sets `out` to the plane itself, with its origin at the projection of `at`.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    out = {Primitive::Kind::plane, project_probe(at).proxy, normal_};
    return true;
  }

 private:
  double height(const Vec3& at) const { return dot(normal_, at - point_); }
  Vec3 point_, normal_;
};

/// A sphere; the model is in shapes.h. Plain data.
struct SphereShape {
  Vec3 center;    ///< world units
  double radius;  ///< world units
  /// True with free above: no tunneling through a thin sphere within one tick.
  bool prevents_tunneling;
};

/// The surface of a sphere.
class SphereSurface final : public ContactSurface {
 public:
  /// Shape that the surface is made of.
  using Shape = SphereShape;
  /// State between ticks.
  struct Memory {
    /// Unit outward normal at the point held; opposite to the direction of entry while a thin sphere is held on its near half.
    Vec3 normal;
  };
  /// Made by ClosedFormConstraint in every tick.
  SphereSurface(const Shape& shape, Memory& memory, const SideMemory& side)
      : center_(shape.center), radius_(shape.radius), prevents_tunneling_(shape.prevents_tunneling), memory_(memory), side_(side) {}

  /// Returns true: every shape is valid.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }
  /// Returns the signed distance; above is outside.
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

    // both outside: the point where the segment enters
    const Vec3 u = from - center_, travel_direction = direction(probe - from);
    const double middle = -dot(u, travel_direction), distance_to_axis = norm(u + travel_direction * middle);
    if (!(distance_to_axis < radius_)) return {};
    const double s = middle - std::sqrt((radius_ - distance_to_axis) * (radius_ + distance_to_axis));
    if (!(s >= -1e-9 * radius_ && s <= norm(probe - from))) return {};
    if (!prevents_tunneling_) return project_probe(probe);
    memory_.normal = -travel_direction;
    return near_side(probe);
  }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    return std::fabs(height(probe)) <= limit ? project_probe(probe) : SurfaceHold{};
  }
  Vec3 normal() const noexcept override { return normal_; }
  bool may_tunnel() const noexcept override { return true; }
  /// L: the diameter, but at least that of a scene without fields.
  double domain_length() const noexcept override { return std::max(kDefaultDomainLength, 2 * radius_); }

  /// Returns J^T f with J = (R / d) (I - r r^T), r the unit direction from the center, d the probe's distance from it.
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f) const noexcept {
    const Vec3 r = direction(probe - center_);
    return divide_bounded(f - r * dot(r, f), norm(probe - center_) / radius_);
  }
  /// Sets `out` to the tangent plane at the point held; false: the sphere holds no point for `at`.
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
    const double distance_to_axis = norm(q);
    if (!(distance_to_axis < radius_)) return {};
    const Vec3 proxy = center_ + q + memory_.normal * std::sqrt((radius_ - distance_to_axis) * (radius_ + distance_to_axis));
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
