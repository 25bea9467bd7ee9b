/// Volumes and translucent isosurfaces, one raycast for all of them (at most MAX_VOLUMES and MAX_SURFACES), in front of the opaque
/// depth. Tables and brick maps are rebuilt only when a transfer function, a level or a grid changes.
#pragma once
#include <array>
#include <map>

#include "render/passes/isosurface.h"
#include "render/passes/transfer_lut.h"

namespace catena::render {

struct RaySettings {
  double step_voxels = 1;
  double termination = 1.0 / 512;
  bool skip = true;
};

class VolumePass {
 public:
  template <class Item>
  using Mirrored = std::pair<const Item*, std::shared_ptr<const GridMirror>>;

  static Result<VolumePass> create(vk::Device& device);
  Outcome prepare(std::span<const Mirrored<VolumeItem>> volumes, std::span<const Mirrored<IsosurfaceItem>> surfaces);
  /// Within a pass over the volume target. `opaque_depth` null: nothing opaque; `none` is bound instead.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                 const vk::Image* opaque_depth, const vk::Image& none);

 private:
  struct Volume {
    std::shared_ptr<const GridMirror> mirror;
    VolumeItem item;
    TransferLut lut;
    BrickMap map;
    std::uint32_t table_start = 0;
  };
  struct Surface {
    SurfaceState state;
    IsosurfaceItem item;
  };
  VolumePass() = default;
  Result<const vk::Pipeline*> pipeline(std::uint32_t flags, std::uint32_t volumes, std::uint32_t surfaces, bool opaque);

  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  std::map<std::array<std::uint32_t, 4>, vk::Pipeline> pipelines_;
  std::vector<Volume> volumes_;
  std::vector<Surface> surfaces_;
  vk::Buffer tables_, uniform_;
};

}  // namespace catena::render
