// SPDX-License-Identifier: MIT
/// Extinction of everything that casts shadows, in one coarse grid over the scene. CPU code, any thread; blocks, uses all cores.
///   volumes          that of the mean transmittance of a voxel in the cell
///   surfaces         cells that a surface crosses have its opacity: isosurfaces, meshes
///   tubes, arrows,   the share of a cell's face that they cover; thick ones fill cells
///   spheres
/// Not included: what clip planes remove, the hand, widgets, spatial references, slices, projections.
#pragma once
#include <vector>

#include "engine/field/cell.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Cubic cells along the world's axes, in display units.
struct LightCells {
  Vec3 lo{0.0};                   ///< lower corner
  double edge = 0;                ///< edge of a cell; 0: nothing casts shadows
  field::Index3 size{0, 0, 0};    ///< number of cells
  std::vector<float> extinction;  ///< per display unit, x fastest
  std::vector<float> open;        ///< share that surfaces leave open; empty: there are no surfaces

  std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
  }
};

/// Largest number of cells along an axis.
inline constexpr int kMaxLightCells = 128;

/// Fills the cells. Their edge is the longest extent / kMaxLightCells, but not less than a voxel edge of the fields.
LightCells make_light_cells(const FramePacket& packet);

}  // namespace catena::render
