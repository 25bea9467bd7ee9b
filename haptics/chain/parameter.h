/// A haptic transfer function: a parameter of a link (a threshold, a stiffness, a release) that is a number, or follows a
/// field at a place, piecewise linear.
///   of a scalar field: its value, or |grad s|; of a vector field: |v|.
///   normalise: the map's abscissae run 0..1 over the field's range, (s - min) / (max - min), |v| / X or |grad s| / X with X the
///   field's largest magnitude, clamped to 0..1; a field without range gives 0 (safe normalisation, at any scale).
/// Outliers the map's ends their outputs hold. Where the field says nothing (outside, not finite) it is `outside`.
/// One evaluation a call where a field is asked, counted; none where the link's budget is spent (then `outside`).
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>
#include <vector>

#include "engine/field/field.h"

namespace catena::haptics {

/// How a parameter follows a field. Made off the tick, immutable.
struct HapticTransferFunction {
  /// What of the field counts.
  enum class Quantity { value, gradient, magnitude };
  /// An output at a value.
  struct Point {
    double value, output;  ///< the field's unit (0 to 1 with `normalise`); the parameter's own
  };
  field::AnyField field;                ///< the field
  Quantity quantity = Quantity::value;  ///< what of it counts
  bool normalize = false;               ///< over the field's range
  double range_min = 0, range_max = 0;  ///< `normalise` maps them to 0 and 1; where hi > lo does not hold, all is 0
  std::vector<Point> points;            ///< values rising, at least one
  double outside = 0;                   ///< the output where the field says nothing
};

/// A number, or what a field says. Immutable; any thread.
class Parameter {
 public:
  /// Always this number.
  Parameter(double constant = 0) : constant_(constant) {}  // NOLINT(google-explicit-constructor): a number is a parameter
  /// Follows a field.
  explicit Parameter(std::shared_ptr<const HapticTransferFunction> map) : map_(std::move(map)) {}

  /// The parameter at a place; a fetch is added to `evaluations`.
  double at(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
    return map_ ? evaluate_field(world, cursor, evaluations) : constant_;
  }
  /// Its gradient there, by central differences of the length `step`: six fetches, none of a number.
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
  /// Whether it is a number.
  bool is_constant() const { return map_ == nullptr; }
  double min() const;  ///< the smallest and the largest value that it can take
  /// The largest value that it can take.
  double max() const;

 private:
  double evaluate_field(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept;
  double constant_ = 0;
  std::shared_ptr<const HapticTransferFunction> map_;
};

}  // namespace catena::haptics
