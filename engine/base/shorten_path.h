/// Pulls a polyline on a surface tight: its ends stay, the points between them go to the middle of their neighbours and back onto the
/// surface, until nothing moves (over-relaxed Gauss-Seidel sweeps on 32, 64 and 128 segments). What is left is a geodesic of the kind of
/// the path at the start: the shortest among the paths that it can be pulled into. The length of its chords falls short of the curve's by
/// (angle of a segment)^2 / 24: 3e-5 for half a circle. Bounded: at most 3 x 400 sweeps. Off the tick, any thread.
#pragma once
#include <functional>
#include <vector>

#include "engine/base/vec.h"

namespace catena {

/// Puts a point back onto the surface; false, and the point unused, where that cannot be done.
using PutOnSurface = std::function<bool(Vec3&)>;

/// At least two points; answers 129 of them, about evenly spaced.
std::vector<Vec3> shorten_path(std::vector<Vec3> path, const PutOnSurface& put_on_surface);

double length_of(const std::vector<Vec3>& path);

}  // namespace catena
