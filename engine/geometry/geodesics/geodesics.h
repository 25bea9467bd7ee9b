// SPDX-License-Identifier: MIT
/// Short paths on surfaces, for the ruler: a coarse path is found first, which fixes the side on which it passes obstacles, and is then
/// shortened on the surface itself. The result is a geodesic homotopic to the coarse path. World units. Off the haptic thread; any thread.
#pragma once
#include <functional>
#include <vector>

#include "engine/field/field.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::geodesics {

/// Path along the isosurface s = level between the surface points nearest to `from` and `to`. The coarse path runs through the crossed
/// cells of a sampling grid over the domain (at most 64 cells per axis; Dijkstra); surface sheets inside one cell count as connected. Stays
/// inside the domain. Bounded: 65^3 samples of the grid and at most a few hundred thousand further evaluations.
/// Returns an empty path when an end has no surface near it (Newton's method along the gradient fails) or no path connects them.
std::vector<Vec3> path_on_level(const field::ScalarField& field, double level, const Vec3& from, const Vec3& to);

/// Limit on the vertices that path_on_mesh() visits.
inline constexpr std::size_t kMaxVisitedVertices = 500'000;

/// Path along a mesh between its points nearest to `from` and `to`: first along edges (A*, vertex to vertex), then across the faces.
/// Bounded by kMaxVisitedVertices. Returns an empty path when the two points lie on disconnected parts or too many vertices apart.
std::vector<Vec3> path_on_mesh(const mesh::TriangleMesh& mesh, const Vec3& from, const Vec3& to);

/// Moves a point back onto the surface. Returns false when that fails; the point must not be used then.
using ProjectToSurface = std::function<bool(Vec3&)>;

/// Shortens a polyline on a surface: its ends stay, each inner point moves toward the midpoint of its neighbors and back onto the surface
/// until nothing moves (over-relaxed Gauss-Seidel sweeps with 32, 64 and 128 segments). The result is a geodesic: the shortest path into
/// which the initial path can be deformed. The chord length is below the arc length by a relative (angle of a segment)^2 / 24: 3e-5 for
/// half a circle. Bounded: at most 3 x 400 sweeps. `path` has at least two points; returns 129 points, about evenly spaced.
std::vector<Vec3> shorten_path(std::vector<Vec3> path, const ProjectToSurface& put_on_surface);

/// Length of the polyline, in the units of its points.
double path_length(const std::vector<Vec3>& path);

}  // namespace catena::geodesics
