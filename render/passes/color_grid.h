/// A grid that colours what another one shapes: its mirror, the table of its colours, and a map by which any of its bricks is found.
#pragma once
#include "render/passes/grid_bindings.h"
#include "render/passes/transfer_lut.h"

namespace catena::render {

struct ColorGrid {
  std::shared_ptr<const GridMirror> mirror;
  ColorSource source;
  TransferLut lut;
  BrickMap map;

  /// Whether anything was new.
  Result<bool> update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, const ColorSource& next);
  BoundGrid bound() const { return {mirror, &map, false, false}; }
};

/// The least and the greatest value of a mirrored grid.
BrickRange range_of(const GridMirror& mirror);
/// Tells the shader where in the buffer of tables that of a grid begins.
void set_table(shared::GridData& data, const TransferLut& lut, std::uint32_t start);

}  // namespace catena::render
