// SPDX-License-Identifier: MIT
/// Extracts the isosurface s(x) = level of a grid as triangles, cell by cell:
///   vertices   lie on cell edges, where the trilinear interpolation attains the level: v0 + t (v1 - v0) = level; rarely, where a loop of
///              cuts crosses a face twice, there is one more inside the cell
///   faces      with four cuts are connected as the bilinear function on them demands (Nielson and Hamann, "The asymptotic decider",
///              Proc. Visualization 1991, 83-91), so that neighboring cells agree and there are no holes
///   normals    mean over the adjacent cells of the gradient at a vertex (central differences, interpolated along the edge)
/// Invalid cells have no triangles: the surface has open edges there and at the boundary of the grid. Off the haptic thread.
#pragma once
#include <functional>

#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

/// Side of the level to which the normals point; the corners of a triangle are counter-clockwise when seen from that side.
enum class OutwardSide { lower, higher };

/// Triangles of the isosurface, with normals.
struct Isosurface : TriangleSoup {
  std::vector<Vec3> normals;  ///< Unit normal per vertex; zero where the gradient is zero.
};

/// Extracts the isosurface. `name` begins every message; `progress` is called from time to time with the completed fraction, 0 to 1.
/// Returns an Error when the level has no surface, the grid has only one slice of voxels, or the memory budget is too small.
Result<Isosurface> extract_isosurface(const field::ScalarGrid& grid, double level, OutwardSide outside, const std::string& name,
                                      const std::function<void(double)>& progress = {});

}  // namespace catena::mesh
