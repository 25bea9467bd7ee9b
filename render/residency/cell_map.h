/// The cells of a grid that hold a level, one bit each: a ray fetches the corners of no other cell. One texel of 16 bits a block of
/// 2^3 cells, x fastest:
///   bits 0..7: the block's cells, bit x + 2 y + 4 z
///   bits 8..15: 0 where the brick of 4^3 cells around the block has such a cell, else the largest coordinate difference, in bricks and
///   at most 255, to the nearest brick that has one
/// A cell holds the level if it is valid and its corners, as the mirror's texels give them back, lie on both sides (value >= level
/// is above); of a cubic grid, if its control points do (cubic_cells.h). Where texels are scaled halves the test is a little wider than
/// their rounding. Made anew for another level. Read by shaders/lib/surface.glsl. Local positions as in grid_mirror.h.
#pragma once
#include "engine/field/grid/grid.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

struct CellMap {
  std::array<std::int32_t, 3> blocks{};  ///< an axis
  std::vector<std::uint16_t> texels;
  std::uint64_t cell_count = 0;  ///< that hold the level
  Vec3 lo{0.0}, hi{0.0};         ///< encloses them all; lo == hi: there is none

  std::size_t block_index(int x, int y, int z) const { return (std::size_t(z) * blocks[1] + y) * blocks[0] + x; }
};

/// `mirror` was made from `grid`. Where it would have more than `most_texels` the map is left without any, and lo, hi are the domain.
CellMap make_cell_map(const field::ScalarGrid& grid, const ResidentGrid& mirror, float level, std::uint64_t most_texels = 32 << 20);

/// R16_UINT.
Result<vk::Image> upload_cell_map(vk::Device& device, const CellMap& map);

}  // namespace catena::render
