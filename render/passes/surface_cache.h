// SPDX-License-Identifier: MIT
/// Cache of rendered isosurfaces (RenderSettings::reuse_rays): while the surfaces, the camera and the lights are unchanged, their rays are
/// not marched, whatever else moves in front of or behind them. Holds their colors, depths and ids, 20 bytes per pixel, from the first
/// image that requests reuse. The resulting image is identical to the bit. Frame thread only.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "shaders/shared/frame.h"

namespace catena::render {

/// Color, depth and id images of the opaque isosurfaces.
class SurfaceCache {
 public:
  /// Everything the images of the surfaces depend on: the shader data of each surface, and a version counter of all else.
  struct Key {
    std::vector<shared::FrameData> surfaces;
    std::uint64_t version = 0;
    /// Returns whether images of both keys are identical.
    bool matches(const Key& other) const;
  };

  /// Allocates the images for the given size. An Error if there is no memory; the cache is empty then.
  Outcome ensure(vk::Device& device, const VkExtent3D& extent);
  /// To be called after ensure(), outside a render pass. `draw` renders the surfaces into opaque targets that contain nothing else; it is
  /// called only if `key` differs from the cached key.
  Outcome update(vk::Commands& commands, Key key, const std::function<Outcome()>& draw);
  /// Copies the cached surfaces into the image's opaque targets, within a render pass over them. `frame`: frame data of the image.
  Outcome draw(vk::Device& device, vk::Commands& commands, const shared::FrameData& frame);
  /// Returns whether the last update() found the cache valid.
  bool reused_previous() const { return reused_previous_; }

 private:
  vk::Image color_, depth_, id_, depth_buffer_;
  std::optional<Key> key_;  ///< key of the cached images
  bool reused_previous_ = false;
  vk::Pipeline pipeline_;
  vk::Buffer uniform_;
};

}  // namespace catena::render
