// SPDX-License-Identifier: MIT
/// Parameter of a link (a threshold, a stiffness, a release distance): a constant, or a haptic transfer function, which maps a field's
/// quantity at a point to an output, piecewise linearly.
///   quantity: of a scalar field its value or |grad s|; of a vector field |v|
///   normalize: the values of the map run 0..1 over the field's range: (s - min) / (max - min), |v| / X or |grad s| / X with X the field's
///   largest magnitude, clamped to 0..1; a field without range gives 0 (safe normalization, at any scale)
/// Beyond the first and last point of the map their outputs hold. Where the field has no value (outside, not finite) the output is
/// `outside`. Each evaluation of a field costs one counted field sample; if the link is out of budget, none is made and the output is
/// `outside`. Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/field.h"

namespace catena::haptics {

/// Map from a field's quantity to the output of a parameter. Created off the tick, immutable.
struct HapticTransferFunction {
  /// Quantity of the field: value or |grad s| of a scalar field; of a vector field always the magnitude |v|.
  enum class Quantity { value, gradient, magnitude };
  /// Point of the piecewise linear map.
  struct Point {
    double value, output;  ///< quantity in the field's unit (0..1 with `normalize`); output in the parameter's unit
  };
  field::AnyField field;                ///< field that is sampled
  Quantity quantity = Quantity::value;  ///< quantity that is mapped
  bool normalize = false;               ///< the quantity is normalized to 0..1 over the range
  double range_min = 0, range_max = 0;  ///< quantities that `normalize` maps to 0 and 1; unless max > min the result is 0
  std::vector<Point> points;            ///< points with increasing values, at least one
  double outside = 0;                   ///< output where the field has no value
};

/// Constant, or haptic transfer function of a field. Immutable; any thread.
class CATENA_EXPORT Parameter {
 public:
  /// Creates a constant parameter.
  Parameter(double constant = 0) : constant_(constant) {}  // NOLINT(google-explicit-constructor): a number is a parameter
  /// Creates a parameter that follows a field.
  explicit Parameter(std::shared_ptr<const HapticTransferFunction> map) : map_(std::move(map)) {}

  /// Returns the parameter at a point in world coordinates; a field sample is added to `evaluations`.
  double at(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
    return map_ ? evaluate_field(world, cursor, evaluations) : constant_;
  }
  /// Returns the gradient of the parameter at a point by central differences of step `step`, world units: six field samples, or none and
  /// zero for a constant.
  Vec3 gradient(const Vec3& world, double step, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
    Vec3 out(0.0);
    for (int a = 0; a < 3 && map_; ++a) {
      Vec3 ahead = world, behind = world;
      ahead[a] += step;
      behind[a] -= step;
      out[a] = (evaluate_field(ahead, cursor, evaluations) - evaluate_field(behind, cursor, evaluations)) / (2 * step);
    }
    return out;
  }
  /// Returns whether the parameter is a constant.
  bool is_constant() const { return map_ == nullptr; }
  /// Returns the smallest value that the parameter can take.
  double min() const;
  /// Returns the largest value that the parameter can take.
  double max() const;

 private:
  double evaluate_field(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept;
  double constant_ = 0;
  std::shared_ptr<const HapticTransferFunction> map_;
};

}  // namespace catena::haptics
