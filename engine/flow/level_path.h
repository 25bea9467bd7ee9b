/// A short way along an isosurface: between the places of the level set s = level at two points, through the crossed cells of a lattice
/// over the domain (at most 64 an axis; Dijkstra, so that the way round the right side is found), then pulled tight on the surface itself
/// (engine/base/shorten_path.h). Sheets that one lattice cell holds both of count as joined. Within the domain only.
/// Bounded: 65^3 lattice samples and a few hundred thousand fetches at the very most. Off the tick, any thread.
#pragma once
#include <vector>

#include "engine/field/field.h"

namespace catena::flow {

/// Empty where an end has no surface near it (Newton's steps along the gradient do not reach the level), or no way joins them.
std::vector<Vec3> path_on_level(const field::ScalarField& field, double level, const Vec3& from, const Vec3& to);

}  // namespace catena::flow
