#include "render/passes/mesh.h"

#include "render/passes/triangles.h"

namespace catena::render {
namespace {

class MeshPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new MeshPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const auto& items = frame.packet.meshes;
    if (all_same(items, built_)) return Done{};
    Shape shape;
    for (const MeshItem& mesh : items) {
      const std::size_t first = shape.vertices.size();
      add_mesh(shape, mesh);
      mark(shape, first, mesh.id, mesh.clipped);
    }
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    built_ = items;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit MeshPass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  std::vector<MeshItem> built_;
};

}  // namespace

const PassEntry kMeshPass{"meshes", [](const Frame& frame) { return !frame.packet.meshes.empty(); }, MeshPass::create};

}  // namespace catena::render
