// SPDX-License-Identifier: MIT
/// Bindings of resident grids in ray shaders (shaders/lib/grids.glsl: value image, brick map and mask at three bindings, flag bits); state
/// of a grid rendered as an isosurface, and of a grid that colors another item.
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

/// Grid with its brick map, to be bound to a shader.
struct GridBinding {
  std::shared_ptr<const ResidentGrid> resident;
  const BrickMap* map = nullptr;
  bool is_shaded = false;    ///< volumes only
  bool skips_empty = false;  ///< volumes only: rays skip empty space
};

/// Returns the specialization constant GRID_FLAGS; volumes come first in `grids`.
std::uint32_t grid_flags(std::span<const GridBinding> grids);
/// Returns whether any grid uses cubic interpolation.
bool has_cubic_grid(std::uint32_t grid_flags);

/// Appends the binding slots of a pipeline for `count` grids.
void add_grid_layout(std::vector<vk::LayoutBinding>& slots, std::uint32_t count);
/// Appends the bindings of `count` grids: grid i, or the first one if there are fewer.
void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const GridBinding> grids, std::uint32_t count,
                       const vk::Sampler& linear);

/// Isosurface of a resident grid, ready to be bound: bricks that do not contain the level are inactive. For a cubic grid, the map is built
/// from the map of its cells (render/residency/cell_map.h), because its corner values do not bound the level.
struct SurfaceState {
  std::shared_ptr<const ResidentGrid> resident;
  float level = 0;
  BrickMap map;
  CellMap cells;  ///< cubic grids only, without texels: they are merged into `map`
  /// Rebuilds the map if the resident grid or the level changed. `grid`: source of the resident grid.
  Outcome update(vk::Device& device, const field::ScalarGrid& grid, std::shared_ptr<const ResidentGrid> next_resident, double next_level);
  GridBinding binding() const { return {resident, &map, true, true}; }
};
/// Returns the shader data: ray mapping, level, color and opacity.
shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item);

/// Grid that colors another item: its GPU copy, the table of its colors, and a map in which all bricks are active.
struct ColorGrid {
  std::shared_ptr<const ResidentGrid> resident;
  ColorSource source;
  TransferLut lut;
  BrickMap map;

  /// Updates to a grid and source; returns whether anything changed.
  Result<bool> update(vk::Device& device, std::shared_ptr<const ResidentGrid> next_resident, const ColorSource& next);
  GridBinding binding() const { return {resident, &map, false, false}; }
};
/// Returns the shader data; the color table begins at entry `start` of the table buffer.
shared::GridData color_data(const CameraRays& rays, const ColorGrid& colors, std::uint32_t start);

/// Returns the minimum and maximum of all valid cells of a resident grid; 0, 0 if there is none.
BrickRange value_range(const ResidentGrid& grid);
/// Returns the specialization constant TABLES (shaders/lib/tables.glsl) for one table; for several tables, combine the bits.
std::uint32_t table_flags(const TransferLut& lut);
/// Appends TABLES to the specialization constants of a pipeline with one table.
void add_table_flags(std::vector<std::uint32_t>& constants, const TransferLut& lut);
/// Returns where the table begins in the table buffer (`start`) and how it is read.
shared::TableData table_data(const TransferLut& lut, std::uint32_t start);

}  // namespace catena::render
