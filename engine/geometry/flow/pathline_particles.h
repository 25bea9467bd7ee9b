// SPDX-License-Identifier: MIT
/// Private to this module: moves many particles through the intervals of a series, or through a formula, on all cores.
#pragma once
#include <functional>
#include <span>

#include "engine/geometry/flow/particle_march.h"

namespace catena::flow {

/// Accuracy of move_particles().
struct MoveOptions {
  double tolerance = 1e-11;                      ///< Limit on the error of one step, times L.
  std::size_t max_knots = 1'000'000;             ///< Maximum number of knots of one path.
  std::size_t max_all_knots = 0;                 ///< Maximum number of knots of all paths together.
  std::function<void(double share)> progress{};  ///< Receives the share of the intervals that is done.
};

/// Moves each particle from its own time to `until`: forward, or all of them backward. Returns L. Error: a step cannot be loaded, or there
/// are too many knots.
Result<double> move_particles(const UnsteadyField& field, std::span<Particle> particles, double until, const MoveOptions& options);

}  // namespace catena::flow
