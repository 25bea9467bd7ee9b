/// A vector formula within a box: a sample outside of the box is outside of the domain. So lines of a field that has no end of its own,
/// such as a closed form, end where the picture does. Threads: as the field within it.
#pragma once
#include "engine/field/field.h"

namespace catena::field {

class ClippedVectorField final : public VectorField {
 public:
  /// `whole` outlives this; `box` in world coordinates. L (Field::length) is the longest edge of the box.
  ClippedVectorField(const VectorField& whole, const Box& box) : source_(whole), box_(box) { set_domain(whole.name(), {}, box); }

  VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept override {
    VectorSample s = source_.sample(world, cursor);
    s.inside = s.inside && box_.contains(world);
    return s;
  }
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override {
    return is_finite(world) && !box_.contains(world) ? SampleStatus::outside_box : source_.status_outside(world, cursor);
  }

 private:
  const VectorField& source_;
  Box box_;
};

}  // namespace catena::field
