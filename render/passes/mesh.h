/// Triangle meshes, tubes and glyphs: lit triangles into the opaque targets. Meshes are built and uploaded again only when the shapes
/// change.
#pragma once
#include "render/passes/camera_rays.h"
#include "render/passes/shapes.h"
#include "render/vk/commands.h"

namespace catena::render {

class MeshPass {
 public:
  static Result<MeshPass> create(vk::Device& device);
  /// The bounds of what prepare() made.
  Outcome prepare(const FramePacket& packet);
  Bounds bounds() const;
  /// Within a pass over the opaque targets.
  Outcome record(vk::Commands& commands, const CameraRays& rays);

 private:
  struct Mesh {
    vk::Buffer vertices, indices, uniform;
    std::uint32_t index_count = 0;
    Vec3 origin{0.0};
    Bounds bounds;
  };
  MeshPass() = default;
  Outcome upload(Mesh& mesh, const Shape& shape);

  vk::Device* device_ = nullptr;
  vk::Pipeline pipeline_;
  Mesh meshes_, tubes_, cursors_;
  std::vector<MeshItem> built_meshes_;
  std::vector<TubeItem> built_tubes_;
  std::vector<ArrowItem> built_arrows_;
  std::vector<CursorItem> built_cursors_;
  std::vector<IndicatorItem> built_indicators_;
  bool built_ = false;
};

}  // namespace catena::render
