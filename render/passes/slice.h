/// Slices: a plane through a grid, coloured by the trilinear values that it cuts, with lines of constant value on it. No polygon
/// is made: each pixel's ray is cut with the plane, so that depth and value are exact, also with the eye within the grid.
///   colour: the table, piecewise linear, at full precision
///   line of a level: |value - level| / |gradient a pixel| pixels away, measured a second time at the foot of that distance;
///                    drawn by coverage over `line_width` pixels
/// CellCache that are masked or not finite are transparent. Opaque slices are drawn by SlicePass, others in the layers (passes.h).
#pragma once
#include <map>

#include "render/passes/triangles.h"
#include "render/raycast/grid_bindings.h"

namespace catena::render {

/// A slice on the device.
class Slice {
 public:
  /// Uploads what changed; false: its grid cannot be drawn (thinner than a cell).
  Result<bool> prepare(Frame& frame, const SliceItem& item);
  const field::ScalarGrid& grid() const { return *item_.grid; }
  std::uint32_t id() const { return item_.id; }

 private:
  friend class SliceDrawer;
  SliceItem item_;
  std::shared_ptr<const ResidentGrid> resident_;
  BrickMap map_;
  vk::Buffer colors_, levels_, frame_data_, slice_data_, layer_data_;
};

class SliceDrawer {
 public:
  static Result<SliceDrawer> create(vk::Device& device);
  /// CellFinder a pass over target::opaque, or a layer's.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Slice& slice, const PeelState& peel);
  /// One texel, bound where there is no id to be read.
  const vk::Image& placeholder_id() const { return placeholder_id_; }

 private:
  SliceDrawer() = default;
  Result<const vk::Pipeline*> pipeline(std::uint32_t flags, std::uint32_t mode, bool has_opaque);
  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  vk::Image placeholder_id_;
  std::map<std::array<std::uint32_t, 3>, vk::Pipeline> pipelines_;
};

/// A list of slices that follows the packet's.
Outcome prepare_slices(Frame& frame, std::vector<Slice>& slices, bool (*chosen)(const SliceItem&));

bool is_translucent(const SliceItem& item);

}  // namespace catena::render
