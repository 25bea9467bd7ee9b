/// Tubes as rings on the device, from which the vertex shader makes the surface (shaders/shared/tube.h): 36 bytes a ring, where triangles
/// would take 500 and more. What is drawn is the surface of add_tube (shapes.h), but for rounding to floats and colours of ten bits, run
/// by run of 128 rings: with as many sides as its width in pixels asks for; where it is a few pixels wide as a ribbon that faces the eye,
/// of three vertices a ring, lit as round; beyond the picture's edges not at all. Frame thread.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"

namespace catena::render {

class Tubes {
 public:
  Outcome upload(vk::Device& device, std::span<const TubeItem> tubes);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return chunks_.empty(); }

 private:
  friend class TubeDrawer;
  static constexpr std::uint32_t kRunLength = 128;  ///< walls
  struct Run {
    Bounds bounds;
    double radius = 0;  ///< the largest
  };
  struct Chunk {
    vk::Buffer rings;
    std::uint32_t count = 0;  ///< of the rings; the last of a run is the first of the next
    std::vector<Run> runs;
  };
  class Filler;
  /// The walls of the longest piece with that many sides; made once.
  Result<const vk::Buffer*> indices(vk::Device& device, std::uint32_t sides);

  std::vector<Chunk> chunks_;
  std::uint32_t longest_chunk_ = 0;              ///< piece, in rings
  std::map<std::uint32_t, vk::Buffer> indices_;  ///< by sides; 0: ribbons
  vk::Buffer uniform_;
  Vec3 origin_{0.0};
  Bounds bounds_;
};

class TubeDrawer {
 public:
  explicit TubeDrawer(vk::Device& device) : device_(&device) {}
  /// CellFinder a pass over target::opaque. `pause` is called after about every 50,000 triangles; it ends the pass and goes on in another:
  /// what a software driver has sorted into tiles is drawn by then, and takes no more memory. (Of 10 million it would take gigabytes.)
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes, const std::function<void()>& pause);

 private:
  /// For that many sides; made once.
  Result<const vk::Pipeline*> pipeline(std::uint32_t sides);

  vk::Device* device_;
  std::optional<vk::Pipeline> tubes_, ribbons_;
};

}  // namespace catena::render
