/// The surface s(x) = level of a grid as triangles, cell by cell:
///   vertices   where the level is attained on the edges of cells: v0 + t (v1 - v0) = level, as the trilinear cell has it; rarely, where
///              a loop of cuts crosses a face twice, one more within a cell
///   faces      of a cell with four cuts are joined as the bilinear function on them is (the asymptotic decider of Nielson and Hamann,
///              "The asymptotic decider", Proc. Visualization 1991, 83-91), so that neighbouring cells agree and no holes are left
///   normals    the mean of the cells' gradients at a vertex: of central differences, interpolated along the edge
/// CellCache that are not valid have no triangles: the surface has open edges there, and where it leaves the grid. Off the tick.
#pragma once
#include <functional>

#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

/// Where the normals point, and seen from where the corners of a triangle run counter-clockwise.
enum class OutwardSide { lower, higher };

struct Isosurface : TriangleSoup {
  std::vector<Vec3> normals;  ///< unit, by vertex; zero where the gradient is
};

/// `name` begins every message: a level without a surface, a grid of one layer, more than the memory that is allowed. `progress` is told
/// now and then which part is done.
Result<Isosurface> extract_isosurface(const field::ScalarGrid& grid, double level, OutwardSide outside, const std::string& name,
                                      const std::function<void(double)>& progress = {});

}  // namespace catena::mesh
