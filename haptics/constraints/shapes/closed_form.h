// SPDX-License-Identifier: MIT
/// A line segment a..b, part of `segment` and `polyline`, and the constraint of shapes whose closest point is a formula.
///   s = d . (x - a);  foot = a where s <= 0, b where s >= |b - a| (both bit for bit), else a + s d
/// Finite for |x| up to 1e300. Lengths in world units. LineSegment: any thread; allocates nothing.
#pragma once
#include "engine/base/vec.h"
#include "haptics/constraints/common/one_sided_contact.h"
#include "haptics/constraints/common/pull_back.h"

namespace catena::haptics {

/// A line segment. Plain data.
struct LineSegment {
  Vec3 a{0.0}, b{0.0};  ///< ends of the segment, world units
  Vec3 d{0.0};          ///< unit direction from a to b
  double length = 0;    ///< |b - a|; finite and > 0, or the segment is not usable

  LineSegment() = default;
  /// Makes the segment between two ends.
  LineSegment(const Vec3& from, const Vec3& to) : a(from), b(to), d(direction(to - from)), length(norm(to - from)) {}
  /// Returns whether the segment has a finite length and a direction.
  bool usable() const noexcept { return length > 0 && std::isfinite(length) && max_abs(d) > 0; }

  /// Returns s of a point: its distance along d from a, world units; may lie beyond the ends.
  double along(const Vec3& x) const noexcept { return dot(d, x - a); }
  /// Returns the end that s is at or beyond: -1: a, 1: b, 0: between.
  int end_of(double s) const noexcept { return s <= 0 ? -1 : s >= length ? 1 : 0; }
  /// Returns the point at s, clamped to the ends.
  Vec3 at(double s) const noexcept { return s <= 0 ? a : s >= length ? b : a + d * s; }
  /// Returns the distance of a point from the infinite line.
  double distance_from_line(const Vec3& p) const noexcept {
    const Vec3 away = p - a;
    return norm(away - d * dot(d, away));
  }
};

inline constexpr double kDefaultDomainLength = 4;  ///< L where no field defines it: the box -2..2

/// Constraint whose closest point is a formula: the rules of common/one_sided_contact.h around a shape that is plain data. No field sample.
///   `ClosedFormConstraint<S>`  S: a ContactSurface made in every tick from (const S::Shape&, S::Memory&, const SideMemory&), with
///                  bool primitive(at, out). S::Memory is kept from tick to tick (plain data, zero at start); static
///                  bool is_sane(shape, memory) validates memory from a file, see Constraint::is_sane.
///   `FeatureSurface<S>`     a ContactSurface without sides and memory: Shape gives closest(probe), primitive(at) and length().
/// `seek` is `start` with the memory kept. There is a primitive on the free side too, but none while the link is released.
/// Haptic thread: no allocation, lock, or throw.
template <class S>
class ClosedFormConstraint final : public Constraint {
 public:
  /// Makes the constraint of a validated shape.
  ClosedFormConstraint(typename S::Shape shape, const SideSpec& rules) : shape_(std::move(shape)), rules_(rules) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    memory_as<Memory>(state) = Memory{};
    seek(probe, state, scratch);
  }
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Memory& memory = memory_as<Memory>(state);
    S surface(shape_, memory.own, memory.side);
    start_on_surface(surface, rules_.rules_at(probe, state, scratch), probe, memory.side, state);
    report_state(surface, memory.side.holding, state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Memory& memory = memory_as<Memory>(state);
    S surface(shape_, memory.own, memory.side);
    advance_on_surface(surface, rules_.rules_at_proxy(state, scratch), probe, memory.side, state);
    report_state(surface, memory.side.holding, state);
  }
  bool primitive(const Vec3& at, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    if (state.released || state.status == LinkStatus::no_surface) return false;
    Memory copy = memory_as<Memory>(state);
    return S(shape_, copy.own, copy.side).primitive(at, out);
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    Memory copy = memory_as<Memory>(state);
    if (!copy.side.holding) return {f};
    S surface(shape_, copy.own, copy.side);
    if constexpr (requires { surface.pull_back(probe, f); }) {
      return surface.pull_back(probe, f);
    } else {
      Primitive primitive;
      return surface.primitive(probe, primitive) ? haptics::pull_back(primitive, f) : PulledBackForce{f};
    }
  }
  bool has_primitive() const noexcept override { return true; }
  bool is_sane(const LinkState& state) const noexcept override {
    const Memory& memory = memory_as<Memory>(state);
    return haptics::is_sane(memory.side) && S::is_sane(shape_, memory.own);
  }
  double domain_length() const noexcept override {
    Memory none{};
    return S(shape_, none.own, none.side).domain_length();
  }

 private:
  static void report_state(const S& surface, [[maybe_unused]] bool holding, LinkState& state) noexcept {
    if constexpr (requires { surface.work(); }) state.other_work += surface.work();
    if constexpr (requires { surface.curve(); }) state.curve_index = holding ? surface.curve() : -1;
  }
  struct Memory {
    SideMemory side;
    typename S::Memory own;
  };
  typename S::Shape shape_;
  SideSpec rules_;
};

/// Memory of a surface that keeps nothing between ticks.
struct NoMemory {};

/// Surface of a ShapeType that is a point or a curve: it has no inside or outside.
template <class ShapeType>
class FeatureSurface final : public ContactSurface {
 public:
  /// Shape that the surface is made of.
  using Shape = ShapeType;
  /// Nothing is kept between ticks.
  using Memory = NoMemory;
  /// Made by ClosedFormConstraint in every tick.
  FeatureSurface(const Shape& shape, Memory&, const SideMemory&) : shape_(shape) {}
  /// Returns true: every shape is valid.
  static bool is_sane(const Shape&, const Memory&) noexcept { return true; }

  /// Returns no known side.
  SideValue evaluate_side(const Vec3&) noexcept override { return {}; }
  SurfaceHold project_probe(const Vec3& probe) noexcept override { return shape_.closest(probe); }
  SurfaceHold slide(const Vec3& probe) noexcept override { return shape_.closest(probe); }
  SurfaceHold find_crossing(const Vec3&, const Vec3&) noexcept override { return {}; }
  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    const SurfaceHold hold = shape_.closest(probe);
    return norm(probe - hold.proxy) <= limit ? hold : SurfaceHold{};
  }
  Vec3 normal() const noexcept override { return Vec3(0.0); }
  /// Returns L of the shape.
  double domain_length() const noexcept override { return shape_.length(); }
  /// Sets `out` to the shape's primitive near `at`.
  bool primitive(const Vec3& at, Primitive& out) const noexcept {
    out = shape_.primitive(at);
    return true;
  }

 private:
  const Shape& shape_;
};

/// Makes the constraint of a shape, for a ConstraintType's `build`. Off the tick.
template <class S>
std::shared_ptr<const Constraint> make_closed_form(typename S::Shape shape, const SideSpec& rules) {
  return std::make_shared<ClosedFormConstraint<S>>(std::move(shape), rules);
}

}  // namespace catena::haptics
