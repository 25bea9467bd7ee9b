// SPDX-License-Identifier: MIT
/// Detection of tiles in which the opaque objects in front of the rays have changed since the previous image. While nothing else changes,
/// only the tiles near such changes are re-marched: a moving cursor over a static volume costs little. Changes are detected by two 32-bit
/// hashes of the depths of each block of 4 x 4 pixels. Frame thread only.
#pragma once
#include <array>
#include <map>

#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "shaders/shared/frame.h"

namespace catena::render {

/// Everything an image of rays depends on, apart from the opaque depths and the ray settings.
struct RayImageState {
  shared::FrameData frame;
  std::uint64_t appearance_version = 0;  ///< counts changes in the appearance of volumes and surfaces
  std::uint64_t layers_version = 0;      ///< RayScene::layers_version
  const vk::Image* target = nullptr;
  VkImage target_image = VK_NULL_HANDLE;
  VkRect2D area{};
  bool has_opaque = false;  ///< there is an opaque depth
  /// Returns whether the image for `other` is the same wherever the opaque depth has not changed.
  bool matches(const RayImageState& other) const;
};

/// Opaque and dirty tiles of one view, from image to image.
class DirtyTiles {
 public:
  explicit DirtyTiles(vk::Device& device) : device_(&device) {}
  /// Analyzes the opaque depth of an image: fills opaque_tiles() and compares the hashes of successive images.
  Outcome analyze(vk::Commands& commands, const vk::Image& opaque_depth);
  /// To be called after analyze(): fills dirty_tiles() with the tiles that are at most `distance` tiles from a changed one (0: only these).
  Outcome find_dirty(vk::Commands& commands, int distance);
  /// Returns a mask of 4 x 4 pixel blocks, R8_UINT: 1 where something opaque is visible.
  vk::Image& opaque_tiles() { return opaque_tiles_; }
  /// Returns a mask of 16 x 16 pixel tiles, R8_UINT: 1 where rays must be re-marched.
  vk::Image& dirty_tiles() { return dirty_tiles_; }

 private:
  Outcome find_tiles(vk::Commands& commands, int distance, vk::Image& before, vk::Image& now, vk::Image& target);

  vk::Device* device_;
  vk::Image opaque_tiles_, near_dirty_, dirty_tiles_;
  std::array<vk::Image, 2> depth_hashes_;
  std::size_t latest_ = 0;
  vk::Pipeline analyze_pipeline_;
  std::map<int, vk::Pipeline> find_pipelines_;  ///< key: reach
};

}  // namespace catena::render
