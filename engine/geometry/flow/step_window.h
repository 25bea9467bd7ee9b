// SPDX-License-Identifier: MIT
/// Private to this module: the steps of a series that are in memory.
#pragma once
#include <array>
#include <utility>

#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/unsteady_field.h"

namespace catena::flow {

/// The steps that are needed between two neighboring steps, and their weights.
class TimeInterval {
 public:
  static constexpr std::size_t kMaxSteps = 4;  ///< Number of steps of the cubic interpolation.

  double begin = 0, end = 0;  ///< Times of the two steps.
  std::size_t count = 0;      ///< Number of steps in use.
  std::size_t first = 0;      ///< Index of the step at `begin` among those in use.

  /// Weights of the steps at a time.
  std::array<double, kMaxSteps> weights(double time) const;

  std::array<double, kMaxSteps> times{};                                    ///< Times of the steps.
  std::array<std::shared_ptr<const field::VectorGrid>, kMaxSteps> grids{};  ///< Grids of the steps.
};

/// The steps of a series that are in memory: those of one interval.
class StepWindow {
 public:
  explicit StepWindow(const UnsteadyField& field) : field_(&field) {}
  /// Loads the steps of interval i, from step i to i + 1, and drops all others. Error: a step cannot be loaded, or has other nodes.
  Result<TimeInterval> enter(std::size_t interval);

 private:
  const UnsteadyField* field_;
  std::vector<std::pair<std::size_t, std::shared_ptr<const field::VectorGrid>>> loaded_;
};

}  // namespace catena::flow
