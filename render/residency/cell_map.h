// SPDX-License-Identifier: MIT
/// Map of the cells of a grid that contain a level, one bit each: a ray fetches the corners of no other cell. One texel of 16 bits per
/// block of 2^3 cells, x fastest:
///   bits 0..7: the block's cells, bit x + 2 y + 4 z
///   bits 8..15: 0 if the brick of 4^3 cells around the block has such a cell, else the maximum coordinate difference, in bricks and
///   at most 255, to the nearest brick that has one
/// A cell contains the level if it is valid and its corners, as decoded from the resident grid's texels, lie on both sides (value >= level
/// is above); for a cubic grid, if its control points do (cubic_cells.h). For texels in scaled half floats the test is slightly wider than
/// their rounding. Rebuilt for another level. Read by shaders/lib/surface.glsl. Local positions as in resident_grid.h.
#pragma once
#include "engine/field/grid/grid.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// Cells of a grid that contain a level.
struct CellMap {
  std::array<std::int32_t, 3> blocks{};  ///< blocks per axis
  std::vector<std::uint16_t> texels;
  std::uint64_t cell_count = 0;  ///< number of cells that contain the level
  Vec3 lo{0.0}, hi{0.0};         ///< local bounds of all these cells; lo == hi: there is none

  std::size_t block_index(int x, int y, int z) const { return (std::size_t(z) * blocks[1] + y) * blocks[0] + x; }
};

/// Builds the map; `resident` was made from `grid`. If it would exceed `max_texels` texels, it has none, and lo, hi are the domain.
CellMap make_cell_map(const field::ScalarGrid& grid, const ResidentGrid& resident, float level, std::uint64_t max_texels = 32 << 20);

/// Uploads the texels as an R16_UINT image.
Result<vk::Image> upload_cell_map(vk::Device& device, const CellMap& map);

}  // namespace catena::render
