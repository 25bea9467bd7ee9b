// SPDX-License-Identifier: MIT
/// Area and volume of triangulated surfaces, and of isosurfaces (isosurface.h) by the connected parts above the level; the table of areas
/// for label surfaces. Not for the haptic tick; any thread.
///   area     sum of |(b - a) x (c - a)| / 2
///   volume   |sum of a . (b x c)| / 6, divergence theorem; only for a closed surface
/// For a smooth field both converge with the square of the voxel edge.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/measure/parts.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

/// Surface of a part.
struct PartSurface {
  double area = 0;              ///< squared world units
  std::uint64_t triangles = 0;  ///< 0: no neighbor of the part is below the level, or no voxel of it above
  bool is_closed = true;        ///< no triangle of the part has an open edge
};

/// Measurements of a surface.
struct SurfaceMeasure {
  double area = 0;               ///< squared world units
  std::uint64_t open_edges = 0;  ///< edges at which the surface ends: at the border of the grid, or at a cell with a voxel that is left out
  std::optional<double> volume;  ///< enclosed volume, cubed world units; empty: the surface is open
  bool encloses_lower = false;   ///< a closed surface encloses values below the level
  std::vector<PartSurface> parts{};  ///< of measure_isosurface(): those of MeasuredParts::parts, then that of all others
};

/// Measures a surface whose outward side has the lower values, as OutwardSide::lower makes it. Memory: 32 bytes per triangle.
CATENA_EXPORT SurfaceMeasure measure_surface(const TriangleSoup& surface);

/// Measures the triangles of extract_isosurface() without storing them: blocks of 8^3 cells run in parallel and are added in ascending
/// order. Each triangle belongs to the part of a voxel above the level that is adjacent to it; with 6 neighbors it may be adjacent to two
/// parts, of which one is chosen. Memory: 24 bytes per edge on the faces of blocks, in one layer of blocks; for
/// noise about 20 bytes per cell of the layer.
/// `parts`: those at or above the same level. `name` begins every message; `progress` is called with the completed fraction, 0 to 1.
/// Error: as of extract_isosurface().
CATENA_EXPORT Result<SurfaceMeasure> measure_isosurface(const field::ScalarGrid& grid, double level, const field::MeasuredParts& parts,
                                                        const std::string& name, const std::function<void(double)>& progress = {});

/// Returns the area of the isosurface at 0.5 in a cell whose corner n is 1 if bit n of the index is set and 0 if not.
CATENA_EXPORT std::array<double, 256> label_cell_areas(const field::Mapping& mapping);

}  // namespace catena::mesh
