/// A haptic transfer function: a parameter of a link (a threshold, a stiffness, a release) that is a number, or follows a
/// field at a place, piecewise linear.
///   of a scalar field: its value, or |grad s|; of a vector field: |v|.
///   normalise: the map's abscissae run 0..1 over the field's range, (s - min) / (max - min), |v| / X or |grad s| / X with X the
///   field's largest magnitude, clamped to 0..1; a field without range gives 0 (safe normalisation, at any scale).
/// Beyond the map's ends their outputs hold. Where the field says nothing (outside, not finite) it is `outside`.
/// One evaluation a call where a field is asked, counted; none where the link's budget is spent (then `outside`).
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>
#include <vector>

#include "engine/field/field.h"

namespace catena::haptics {

struct ParameterMap {
  enum class By { value, gradient, magnitude };
  struct Point {
    double value, output;
  };
  field::AnyField field;
  By by = By::value;
  bool normalise = false;
  double lo = 0, hi = 0;      ///< `normalise` maps them to 0 and 1; where hi > lo does not hold, all is 0
  std::vector<Point> points;  ///< values rising, at least one
  double outside = 0;
};

class Parameter {
 public:
  Parameter(double constant = 0) : constant_(constant) {}  // NOLINT(google-explicit-constructor): a number is a parameter
  explicit Parameter(std::shared_ptr<const ParameterMap> map) : map_(std::move(map)) {}

  double at(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
    return map_ ? of_field(world, cursor, evaluations) : constant_;
  }
  bool is_constant() const { return map_ == nullptr; }
  double least() const;  ///< the smallest and the largest value that it can take
  double most() const;

 private:
  double of_field(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept;
  double constant_ = 0;
  std::shared_ptr<const ParameterMap> map_;
};

}  // namespace catena::haptics
