/// Tubes as rings on the device, from which the vertex shader makes the surface (shaders/shared/tube.h): 36 bytes a ring, where triangles
/// would take 500 and more. What is drawn is the surface of add_tube (shapes.h), with as many sides as its width in pixels asks for, but
/// for rounding to floats and colours of ten bits; a tube that is a few pixels wide is a ribbon that faces the eye, of three vertices a
/// ring (28 bytes), lit as round. Frame thread.
#pragma once
#include <array>
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
  /// With as many sides as the camera's pixels show where the tubes are nearest to it.
  Outcome upload(vk::Device& device, std::span<const TubeItem> tubes, const Camera& camera);
  /// Whether what was uploaded has the sides that this camera asks for.
  bool suits(const Camera& camera) const;
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return pieces_.empty(); }

 private:
  friend class TubeDrawer;
  static constexpr int kSides[] = {12, 16, 0};  ///< by kind; 0: ribbons
  struct Piece {
    vk::Buffer rings;
    std::uint32_t count = 0;
    std::size_t kind = 0;  ///< of kSides
  };
  template <class Ring>
  class Filler;
  template <class Ring>
  Outcome fill(vk::Device& device, std::span<const TubeItem> tubes, std::size_t kind);
  std::vector<Piece> pieces_;
  std::array<vk::Buffer, std::size(kSides)> indices_;  ///< of the longest piece of that many sides
  vk::Buffer uniform_;
  Vec3 origin_{0.0};
  std::map<double, int> sides_;  ///< by radius, for the pixels that it was made for
  Bounds bounds_;
};

class TubeDrawer {
 public:
  explicit TubeDrawer(vk::Device& device) : device_(&device) {}
  /// Makes the pipelines that the tubes need and that are not made yet. Before draw().
  Outcome prepare(const Tubes& tubes);
  /// Within a pass over target::opaque. `pause` is called after about every 50,000 triangles; it ends the pass and goes on in another:
  /// what a software driver has sorted into tiles is drawn by then, and takes no more memory. (Of 10 million it would take gigabytes.)
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes, const std::function<void()>& pause);

 private:
  vk::Device* device_;
  std::optional<vk::Pipeline> tubes_, ribbons_;
};

}  // namespace catena::render
