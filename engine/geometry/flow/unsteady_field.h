// SPDX-License-Identifier: MIT
/// A velocity field that changes with time: the steps of a series of grids, interpolated between them, or a formula of position and time.
///   linear in time   v(x, t) = (1 - w) v_i(x) + w v_i+1(x),  w = (t - t_i) / (t_i+1 - t_i)
///   cubic in time    the cubic Hermite of v_i and v_i+1, whose slopes are those of the parabola through three steps
/// Off the haptic thread.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/bounds.h"
#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::flow {

/// A velocity as a function of position and time, for one thread.
class CATENA_EXPORT UnsteadyFormula {
 public:
  virtual ~UnsteadyFormula() = default;
  /// Velocity at a position (world units) and time; not finite where it has none.
  virtual Vec3 velocity(const Vec3& world, double time) = 0;
};

/// A velocity field that changes with time: `load` or `make_formula` is set.
struct CATENA_EXPORT UnsteadyField {
  std::string name;           ///< Name of the field, for messages.
  std::vector<double> times;  ///< Times of the steps, rising; of a formula: the first and the last time.
  /// Loads the grid of a step; all have the same nodes. Called from one thread.
  std::function<Result<field::VectorFieldPtr>(std::size_t step)> load;
  std::function<std::unique_ptr<UnsteadyFormula>()> make_formula;  ///< Makes the formula for one thread; may be called from any thread.
  Bounds box;                                                      ///< Domain of the formula, world units.
  bool is_cubic_in_time = false;                                   ///< Interpolation between steps.
};

}  // namespace catena::flow
