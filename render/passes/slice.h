// SPDX-License-Identifier: MIT
/// Slices: a plane through a grid, colored by the trilinear values in the plane, with contour lines. No polygon is generated: each pixel's
/// ray is intersected with the plane, so that depth and value are exact, also with the camera inside the grid.
///   color: the color table, piecewise linear, at full precision
///   contour line of a level: |value - level| / |gradient per pixel| is the distance in pixels, measured a second time at the foot point of
///                    that distance; drawn by coverage over `line_width` pixels
/// Cells that are masked or not finite are transparent. Opaque slices are rendered by the pass kSlicePass, others in the layers (passes.h).
#pragma once
#include <map>

#include "render/passes/slab_cache.h"
#include "render/passes/triangles.h"
#include "render/raycast/grid_bindings.h"

namespace catena::render {

/// Device resources of one slice.
class Slice {
 public:
  /// Uploads what changed; returns false if the grid cannot be rendered (thinner than a cell).
  Result<bool> prepare(Frame& frame, SlabCache& slabs, const SliceItem& item);
  /// Returns the grid that is drawn: that of the item, or the part of a paged grid around the plane.
  const field::ScalarGrid& grid() const { return *grid_; }
  std::uint32_t id() const { return item_.id; }

 private:
  friend class SliceDrawer;
  SliceItem item_;
  std::shared_ptr<const field::ScalarGrid> grid_;
  std::shared_ptr<const ResidentGrid> resident_;
  BrickMap map_;
  vk::Buffer colors_, levels_, texture_, frame_data_, slice_data_, layer_data_;
};

/// Renders slices; caches the pipelines.
class SliceDrawer {
 public:
  static Result<SliceDrawer> create(vk::Device& device);
  /// Records the slice in a render pass over target::opaque or over a layer.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Slice& slice, const PeelState& peel);
  /// Returns an image of one texel, bound where there is no id image.
  const vk::Image& placeholder_id() const { return placeholder_id_; }

 private:
  SliceDrawer() = default;
  Result<const vk::Pipeline*> pipeline(std::uint32_t flags, std::uint32_t mode, bool has_opaque);
  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  vk::Image placeholder_id_;
  std::map<std::array<std::uint32_t, 3>, vk::Pipeline> pipelines_;
};

/// Updates `slices` to the items of the packet for which `chosen` is true.
Outcome prepare_slices(Frame& frame, SlabCache& slabs, std::vector<Slice>& slices, bool (*chosen)(const SliceItem&));

/// Returns whether the slice is rendered in the layers: opacity < 1, and not completely invisible.
bool is_translucent(const SliceItem& item);

}  // namespace catena::render
