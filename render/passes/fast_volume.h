/// One volume, fast, with an error that is measured and not assumed (render/passes/quality.h): packed words, pre-integrated
/// table, Hermite midpoints, leaps over plain bricks; rays on a lattice of every 4th, 2nd or every pixel, refined where the fourth
/// difference of the picture says that interpolation would err.   lattice -> marks -> finer lattice -> .. -> every pixel
/// Volumes that it cannot draw (several at once, masked cells, too many voxels) belong to VolumePass. Frame thread only.
#pragma once
#include <map>

#include "render/mirror/plain_map.h"
#include "render/passes/camera_rays.h"
#include "render/passes/fast_settings.h"
#include "render/passes/preintegrated.h"
#include "render/vk/commands.h"

namespace catena::render {

class FastVolumePass {
 public:
  static Result<FastVolumePass> create(vk::Device& device);
  /// Packs the volume, its table and its map, if they are new. `item.grid` can_be_packed.
  Outcome prepare(const VolumeItem& item);
  /// Draws into `target` (cleared first; of the picture's size), or into half() where the settings end there; not within a pass.
  /// `opaque_depth` null: nothing opaque; `none` is bound instead.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, const VkRect2D& area,
                 const VkExtent3D& picture, vk::Image* target, const vk::Image* opaque_depth, const vk::Image& none);
  /// Every 2nd pixel, for UpsamplePass.
  vk::Image& half() { return half_.color; }
  double build_ms() const { return build_ms_; }

 private:
  /// A lattice of rays: what it needs to be drawn.
  struct Level {
    vk::Image color, marks;
    vk::Buffer data;
  };
  FastVolumePass() = default;
  Outcome ensure(Level& level, std::uint32_t spacing, const VkExtent3D& target);
  Result<const vk::Pipeline*> pipeline(const std::array<std::uint32_t, 5>& constants);
  Outcome mark(vk::Commands& commands, Level& level, vk::Image& coarser);

  vk::Device* device_ = nullptr;
  VolumeItem item_;
  ValueInterval active_;
  std::uint64_t version_ = 0;
  PackedVolume packed_;
  PlainMap map_;
  vk::Image table_;
  vk::Buffer frame_;
  Level quarter_, half_, full_;
  std::map<std::array<std::uint32_t, 5>, vk::Pipeline> pipelines_;
  vk::Pipeline mark_pipeline_;
  double build_ms_ = 0;
};

}  // namespace catena::render
