/// Short ways on surfaces, for the ruler: a coarse way is found first, so that the way round the right side is taken, and is then pulled
/// tight on the surface itself. What comes out is a geodesic of the kind of that coarse way. World units. Off the tick, any thread.
#pragma once
#include <functional>
#include <vector>

#include "engine/field/field.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::geodesics {

/// A way along an isosurface: between the places of the level set s = level at two points, through the crossed cells of a lattice over
/// the domain (at most 64 an axis; Dijkstra). Sheets that one lattice cell holds both of count as joined. CellFinder the domain only.
/// Bounded: 65^3 lattice samples and a few hundred thousand fetches at the very most.
/// Empty where an end has no surface near it (Newton's steps along the gradient do not reach the level), or no way joins them.
std::vector<Vec3> path_on_level(const field::ScalarField& field, double level, const Vec3& from, const Vec3& to);

inline constexpr std::size_t kMaxVisitedVertices = 500'000;

/// A way along a mesh between its points nearest to two places: along edges first (A*, from vertex to vertex), then over the faces.
/// Bounded: at most kMaxVisitedVertices vertices are looked at. Empty where the two lie on pieces that do not hang together, or are too
/// many vertices apart.
std::vector<Vec3> path_on_mesh(const mesh::TriangleMesh& mesh, const Vec3& from, const Vec3& to);

/// Puts a point back onto the surface; false, and the point unused, where that cannot be done.
using ProjectToSurface = std::function<bool(Vec3&)>;

/// Pulls a polyline on a surface tight: its ends stay, the points between them go to the middle of their neighbours and back onto the
/// surface, until nothing moves (over-relaxed Gauss-Seidel sweeps on 32, 64 and 128 segments). What is left is a geodesic of the kind of
/// the path at the start: the shortest among the paths that it can be pulled into. The length of its chords falls short of the curve's by
/// (angle of a segment)^2 / 24: 3e-5 for half a circle. Bounded: at most 3 x 400 sweeps.
/// At least two points; answers 129 of them, about evenly spaced.
std::vector<Vec3> shorten_path(std::vector<Vec3> path, const ProjectToSurface& put_on_surface);

double path_length(const std::vector<Vec3>& path);

}  // namespace catena::geodesics
