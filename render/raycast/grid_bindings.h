/// ResidentItem grids as the shaders of rays get them: how one is bound (shaders/lib/grids.glsl: value image, brick map and mask at three
/// bindings, flag bits), one with a level, and one that colours what another one shapes.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "render/raycast/camera_rays.h"
#include "render/raycast/transfer_tables.h"
#include "render/residency/brick_map.h"
#include "render/residency/cell_map.h"
#include "render/vk/commands.h"
#include "shaders/shared/frame.h"

namespace catena::render {

struct GridBinding {
  std::shared_ptr<const ResidentGrid> resident;
  const BrickMap* map = nullptr;
  bool is_shaded = false;    ///< of a volume
  bool skips_empty = false;  ///< of a volume
};

/// The constant GRID_FLAGS; volumes are the first grids.
std::uint32_t grid_flags(std::span<const GridBinding> grids);
bool has_cubic_grid(std::uint32_t grid_flags);

/// The pipeline's slots for `count` grids, and what to push for them: grid i, or the first one where there are fewer.
void add_grid_layout(std::vector<vk::LayoutBinding>& slots, std::uint32_t count);
void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const GridBinding> grids, std::uint32_t count,
                       const vk::Sampler& linear);

/// A level of a mirrored grid, ready to be bound: bricks without the level are inactive. Of a cubic grid the map is that of its cells
/// (render/residency/cell_map.h): its corners do not tell which of them hold the level.
struct SurfaceState {
  std::shared_ptr<const ResidentGrid> resident;
  float level = 0;
  BrickMap map;
  CellMap cells;  ///< of a cubic grid, without texels: they are in the map
  /// Rebuilds the map when the mirror or the level is another one. `grid`: that was mirrored.
  Outcome update(vk::Device& device, const field::ScalarGrid& grid, std::shared_ptr<const ResidentGrid> next_mirror, double next_level);
  GridBinding binding() const { return {resident, &map, true, true}; }
};
/// The ray's numbers, level, colour and opacity.
shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item);

/// A grid that colours what another one shapes: its mirror, the table of its colours, and a map by which any of its bricks is found.
struct ColorGrid {
  std::shared_ptr<const ResidentGrid> resident;
  ColorSource source;
  TransferLut lut;
  BrickMap map;

  /// Whether anything was new.
  Result<bool> update(vk::Device& device, std::shared_ptr<const ResidentGrid> next_mirror, const ColorSource& next);
  GridBinding binding() const { return {resident, &map, false, false}; }
};
/// The ray's numbers and the table, which begins at `start`.
shared::GridData color_data(const CameraRays& rays, const ColorGrid& colors, std::uint32_t start);

/// The least and the greatest value of a mirrored grid.
BrickRange value_range(const ResidentGrid& mirror);
/// The constant TABLES (shaders/lib/tables.glsl) of one table; of several, all bits. To the constants of a pipeline with one table.
std::uint32_t table_flags(const TransferLut& lut);
void add_table_flags(std::vector<std::uint32_t>& constants, const TransferLut& lut);
/// Where in the buffer of tables one begins, and how it is read.
shared::TableData table_data(const TransferLut& lut, std::uint32_t start);

}  // namespace catena::render
