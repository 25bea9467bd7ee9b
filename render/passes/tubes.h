/// Tubes as rings on the device, from which the vertex shader makes the surface (shaders/shared/tube.h): 36 bytes a ring, where triangles
/// would take 500 and more. What is drawn is the surface of add_tube (shapes.h), but for rounding to floats and colours of ten bits.
/// Frame thread.
#pragma once
#include <array>
#include <span>

#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"

namespace catena::render {

class Tubes {
 public:
  Outcome upload(vk::Device& device, std::span<const TubeItem> tubes);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return pieces_.empty(); }

 private:
  friend class TubeDrawer;
  static constexpr int kSides[] = {8, 12, 16};
  struct Piece {
    vk::Buffer rings;
    std::uint32_t count = 0;
    std::size_t kind = 0;  ///< of kSides
  };
  class Filler;
  std::vector<Piece> pieces_;
  std::array<vk::Buffer, std::size(kSides)> indices_;  ///< of the longest piece of that many sides
  vk::Buffer uniform_;
  Vec3 origin_{0.0};
  Bounds bounds_;
};

class TubeDrawer {
 public:
  static Result<TubeDrawer> create(vk::Device& device);
  /// Within a pass over target::opaque.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes);

 private:
  TubeDrawer() = default;
  vk::Device* device_ = nullptr;
  vk::Pipeline pipeline_;
};

}  // namespace catena::render
