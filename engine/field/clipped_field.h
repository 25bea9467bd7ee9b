// SPDX-License-Identifier: MIT
/// Vector field restricted to a box: a sample outside of the box is outside of the domain. Lines of an unbounded field, such as a closed
/// form, then end at the box. Thread-safety as for the underlying field.
#pragma once
#include "engine/field/field.h"

namespace catena::field {

/// View of a vector field that reports samples outside of a box as not inside.
class ClippedVectorField final : public VectorField {
 public:
  /// `source` must outlive this object; `box` is in world coordinates. The domain length L (Field::domain_length) is the longest edge of
  /// the box.
  ClippedVectorField(const VectorField& source, const Box& box) : source_(source), box_(box) { set_domain(source.name(), {}, box); }

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
