/// The cells of a grid that hold a level, one bit each: a ray fetches the corners of no other cell. By bricks of 4^3 cells:
///   distance: 0 where the brick holds such a cell, else the largest coordinate difference, in bricks and at most 255, to the nearest
///             brick that does; two words of 32 bits: bit x + 4 y + 16 (z & 1) of word z / 2
/// A cell holds the level if it is valid and its corners, as the mirror's texels give them back, lie on both sides (value >= level
/// is above). Where texels are scaled halves the test is a little wider than their rounding. Made anew for another level.
/// In a buffer for shaders/lib/surface.glsl: the bricks an axis, then three words a brick, x fastest. Local positions as in grid_mirror.h.
#pragma once
#include "engine/field/grid.h"
#include "render/mirror/grid_mirror.h"

namespace catena::render {

inline constexpr int kCellBrick = 4;

struct CellMap {
  std::array<std::int32_t, 3> bricks{};  ///< an axis
  std::vector<std::uint32_t> words;      ///< the buffer's
  std::uint64_t cells = 0;               ///< that hold the level
  Vec3 lo{0.0}, hi{0.0};                 ///< encloses them all; lo == hi: there is none

  std::size_t word_index(int x, int y, int z) const { return 3 + 3 * ((std::size_t(z) * bricks[1] + y) * bricks[0] + x); }
};

/// `mirror` was made from `grid`. Where the words would take more than `most_bytes` the map is left without words.
CellMap make_cell_map(const field::ScalarGrid& grid, const GridMirror& mirror, float level, std::uint64_t most_bytes = 64 << 20);

}  // namespace catena::render
