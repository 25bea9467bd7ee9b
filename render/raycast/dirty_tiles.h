/// What is opaque in front of rays, tile by tile: where there is something, and where it is not what it was in the picture before. While
/// nothing else changes, only the tiles near such places are marched again: a cursor moves over a still volume at little cost. Tiles are
/// told by two 32-bit signs of their depths a block of 4 x 4 pixels. Frame thread only.
#pragma once
#include <array>
#include <map>

#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "shaders/shared/frame.h"

namespace catena::render {

/// What a picture of rays follows from, beside what is opaque and how it is marched.
struct RayImageState {
  shared::FrameData frame;
  std::uint64_t appearance_version = 0;  ///< counts what volumes and surfaces look like
  std::uint64_t layers_version = 0;      ///< RayScene::layers_version
  const vk::Image* target = nullptr;
  VkImage target_image = VK_NULL_HANDLE;
  VkRect2D area{};
  bool has_opaque = false;  ///< something is
  /// Whether the other one comes out the same where nothing opaque has changed.
  bool matches(const RayImageState& other) const;
};

class DirtyTiles {
 public:
  explicit DirtyTiles(vk::Device& device) : device_(&device) {}
  /// Looks at a picture's opaque depth: fills opaque(), and knows what was seen the last time.
  Outcome analyze(vk::Commands& commands, const vk::Image& opaque_depth);
  /// After look(): fills changed(), which holds the tiles that are at most `reach` tiles from one that has changed (0: these alone).
  Outcome find_dirty(vk::Commands& commands, int reach);
  /// R8_UINT, by 4 x 4 pixels: 1 where something opaque is seen.
  vk::Image& opaque_tiles() { return opaque_tiles_; }
  /// R8_UINT, by 16 x 16 pixels.
  vk::Image& dirty_tiles() { return dirty_tiles_; }

 private:
  Outcome find_tiles(vk::Commands& commands, int reach, vk::Image& before, vk::Image& now, vk::Image& target);

  vk::Device* device_;
  vk::Image opaque_tiles_, near_dirty_, dirty_tiles_;
  std::array<vk::Image, 2> depth_hashes_;
  std::size_t latest_ = 0;
  vk::Pipeline analyze_pipeline_;
  std::map<int, vk::Pipeline> find_pipelines_;  ///< by reach
};

}  // namespace catena::render
