/// A vector formula within a box: a sample outside of the box is outside of the domain. So lines of a field that has no end of its own,
/// such as a closed form, end where the picture does. Threads: as the field within it.
#pragma once
#include "engine/field/field.h"

namespace catena::field {

class BoundedVector final : public VectorField {
 public:
  /// `whole` outlives this; `box` in world coordinates. L (Field::length) is the longest edge of the box.
  BoundedVector(const VectorField& whole, const Box& box) : whole_(whole), box_(box) { set_domain(whole.name(), {}, box); }

  VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept override {
    VectorSample s = whole_.sample(world, cursor);
    s.inside = s.inside && box_.contains(world);
    return s;
  }
  Reason why_outside(const Vec3& world, Cursor& cursor) const noexcept override {
    return is_finite(world) && !box_.contains(world) ? Reason::box : whole_.why_outside(world, cursor);
  }

 private:
  const VectorField& whole_;
  Box box_;
};

}  // namespace catena::field
