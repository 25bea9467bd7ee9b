/// A short way along a mesh between its points nearest to two places: along edges first (A*, from vertex to vertex), then pulled tight over
/// the faces (engine/base/shorten_path.h). World units. Bounded: at most kMostVisited vertices are looked at. Off the tick, any thread.
#pragma once
#include <vector>

#include "engine/mesh/mesh.h"

namespace catena::mesh {

inline constexpr std::size_t kMostVisited = 500'000;

/// Empty where the two lie on pieces that do not hang together, or are too many vertices apart.
std::vector<Vec3> path_on_mesh(const TriangleMesh& mesh, const Vec3& from, const Vec3& to);

}  // namespace catena::mesh
