// SPDX-License-Identifier: MIT
/// Tubes as rings on the device, from which the vertex shader generates the surface (shaders/shared/tube.h): 36 bytes per ring, where
/// triangles would take 500 or more. The surface equals that of add_tube (shapes.h), except for rounding to floats and 10-bit colors. It is
/// drawn in runs of 128 rings: with a number of sides that depends on the width in pixels; if only a few pixels wide, as a camera-facing
/// ribbon of three vertices per ring, lit as if round; not at all if outside the image. Frame thread.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"

namespace catena::render {

/// Tubes on the device.
class Tubes {
 public:
  /// Replaces the tubes. An Error if there is no memory.
  Outcome upload(vk::Device& device, std::span<const TubeItem> tubes);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return chunks_.empty(); }

 private:
  friend class TubeDrawer;
  static constexpr std::uint32_t kRunLength = 128;  ///< walls per run
  struct Run {
    Bounds bounds;
    double radius = 0;  ///< maximum radius
  };
  struct Chunk {
    vk::Buffer rings;
    std::uint32_t count = 0;  ///< number of rings; the last ring of a run is the first of the next
    std::vector<Run> runs;
  };
  class Filler;
  /// Returns the index buffer of the longest chunk's walls with that number of sides; built on first use.
  Result<const vk::Buffer*> indices(vk::Device& device, std::uint32_t sides);

  std::vector<Chunk> chunks_;
  std::uint32_t longest_chunk_ = 0;              ///< number of rings of the longest chunk
  std::map<std::uint32_t, vk::Buffer> indices_;  ///< key: number of sides; 0: ribbons
  vk::Buffer uniform_;
  Vec3 origin_{0.0};
  Bounds bounds_;
};

/// Renders tubes.
class TubeDrawer {
 public:
  explicit TubeDrawer(vk::Device& device) : device_(&device) {}
  /// Records the tubes in a render pass over target::opaque. `pause` is called after about every 50,000 triangles; it must end the render
  /// pass and begin another one: a software driver then renders the triangles it has binned and frees their memory. (10 million binned
  /// triangles would take gigabytes.)
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes, const std::function<void()>& pause);

 private:
  /// Returns the pipeline for that number of sides; built on first use.
  Result<const vk::Pipeline*> pipeline(std::uint32_t sides);

  vk::Device* device_;
  std::optional<vk::Pipeline> tubes_, ribbons_;
};

}  // namespace catena::render
