// SPDX-License-Identifier: MIT
/// Area and volume of triangulated isosurfaces (isosurface.h), as a whole and by the connected parts above the level, and the table of
/// areas for label surfaces. Not for the haptic tick; any thread.
///   area     sum of |(b - a) x (c - a)| / 2
///   volume   |sum of a . (b x c)| / 6, divergence theorem; only for a closed surface
/// For a smooth field both converge with the square of the voxel edge.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/field/measure/parts.h"
#include "engine/geometry/mesh/isosurface.h"

namespace catena::mesh {

/// Measurements of a surface.
struct SurfaceMeasure {
  double area = 0;               ///< squared world units
  std::uint64_t open_edges = 0;  ///< edges at which the surface ends: at the border of the grid, or at a cell with a voxel that is left out
  std::optional<double> volume;  ///< enclosed volume, cubed world units; empty: the surface is open
  bool encloses_lower = false;   ///< a closed surface encloses values below the level
};

/// Surface of a part.
struct PartSurface {
  double area = 0;
  std::uint64_t triangles = 0;  ///< 0: no neighbor of the part is below the level, or no voxel of it above
  bool is_closed = true;
};

/// Memory of both functions below for each triangle, bytes, to be checked against the budget before they are called.
inline constexpr double kMeasureBytesPerTriangle = 4 * sizeof(std::uint64_t) + 1;

/// Measures a surface whose outward side is OutwardSide::lower.
SurfaceMeasure measure_surface(const TriangleSoup& surface);

/// Assigns each triangle to the part of a voxel above the level that is adjacent to it, and measures each part; the last entry is for the
/// other parts. With 6 neighbors a triangle may be adjacent to two parts, of which one is chosen.
std::vector<PartSurface> measure_part_surfaces(const TriangleSoup& surface, const field::Mapping& mapping,
                                               const field::MeasuredParts& parts);

/// Returns the area of the isosurface at 0.5 in a cell whose corner n is 1 if bit n of the index is set and 0 if not.
std::array<double, 256> label_cell_areas(const field::Mapping& mapping);

}  // namespace catena::mesh
