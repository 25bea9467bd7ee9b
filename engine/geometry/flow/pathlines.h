// SPDX-License-Identifier: MIT
/// Path lines: the ways of particles in a velocity field that changes with time, dx/dt = v(x, t); and streak lines: the particles that have
/// passed a position, as smoke from a chimney. Both are curves (curve.h) in arc length, whose knots have times.
///   path line    knots at the ends of the integration steps (particle_march.h), on cell faces and on the steps of the series; s = 0 at the
///                seed. Backward in time, s is negative
///   streak line  a knot for each release time; tangents are those of the parabola through three knots, and release times are added until
///                the cubic between two of them is within `tolerance` of a particle released half way. Where particles have left the
///                domain, the line has several pieces. s = 0 at the seed's end: the length from the particle released last
/// Only the steps of one interval of the series are in memory. Results do not depend on the number of threads. Off the haptic thread.
#pragma once
#include <span>

#include "engine/base/export.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/unsteady_field.h"

namespace catena::flow {

/// Times and accuracy of path lines and streak lines.
struct PathlineOptions {
  double start = 0;  ///< Time at which the particle of a path line, or the first one of a streak line, is released.
  double end = 0;    ///< Time at which a path line ends (before `start`: backward in time), or at which a streak line is seen (after it).
  double tolerance = 1e-11;                      ///< Limit on the error of one step, times L.
  double streak_tolerance = 1e-6;                ///< Limit on the error between the knots of a streak line, times L.
  std::size_t max_knots = 1'000'000;             ///< Maximum number of knots of one line.
  std::size_t max_all_knots = 40'000'000;        ///< Maximum number of knots of all lines together; more are an error.
  std::function<void(double share)> progress{};  ///< Receives the share of the work that is done.
};

/// Traces the path line of a particle released at each seed. Error: the field cannot be loaded. Each result: the curve, or why there is
/// none (the seed is outside of the domain at `start`, or the particle does not move).
CATENA_EXPORT Result<std::vector<Result<CurvePtr>>> trace_pathlines(const UnsteadyField& field, std::span<const Vec3> seeds,
                                                                    const PathlineOptions& options);

/// Traces the streak line of each seed: its pieces, the one at the seed first. Errors as above.
CATENA_EXPORT Result<std::vector<Result<std::vector<CurvePtr>>>> trace_streaklines(const UnsteadyField& field, std::span<const Vec3> seeds,
                                                                                   const PathlineOptions& options);

}  // namespace catena::flow
