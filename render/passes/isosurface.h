/// Opaque isosurfaces: the drawn surface is the level set of the trilinear field itself, found along each pixel's ray from the
/// cubic of the cell (no triangles), written with its depth. Translucent ones are drawn by the volume pass, in order with volumes.
#pragma once
#include <map>

#include "render/mirror/cell_map.h"
#include "render/passes/camera_rays.h"
#include "render/passes/grid_bindings.h"

namespace catena::render {

/// A level of a mirrored grid, ready to be bound: bricks without the level are inactive.
struct SurfaceState {
  std::shared_ptr<const GridMirror> mirror;
  float level = 0;
  BrickMap map;
  /// Rebuilds the map when the mirror or the level is another one.
  Outcome update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, double next_level);
  BoundGrid bound() const { return {mirror, &map, true, true}; }
};
/// The ray's numbers, level, colour and opacity.
shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item);

class IsosurfacePass {
 public:
  static Result<IsosurfacePass> create(vk::Device& device);
  /// Prepares the surfaces of this frame, in order. Those whose grid cannot be drawn are left out.
  Outcome prepare(std::span<const std::pair<const IsosurfaceItem*, std::shared_ptr<const GridMirror>>> items);
  /// Within a pass over the opaque targets.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const VkRect2D& area);

 private:
  struct Surface {
    SurfaceState state;
    CellMap cells;  // without its texels, which are in the image
    vk::Image cell_map;  // none: too large
    IsosurfaceItem item;
    vk::Buffer uniform;
  };
  IsosurfacePass() = default;
  Result<const vk::Pipeline*> pipeline(std::uint32_t flags, bool has_cells);
  Outcome make_cells(Surface& surface);

  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  std::map<std::pair<std::uint32_t, bool>, vk::Pipeline> pipelines_;
  std::vector<Surface> surfaces_;
};

}  // namespace catena::render
