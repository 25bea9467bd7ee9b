#include "render/passes/mesh.h"

#include <algorithm>
#include <iterator>

#include "render/passes/triangles.h"

namespace catena::render {
bool is_translucent(const MeshItem& item) { return item.opacity > 0 && item.opacity < 1; }

namespace {

bool is_opaque_mesh(const MeshItem& item) { return item.opacity >= 1; }

class MeshPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new MeshPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    std::vector<MeshItem> items;
    std::copy_if(frame.packet.meshes.begin(), frame.packet.meshes.end(), std::back_inserter(items), is_opaque_mesh);
    if (all_same(items, built_)) return Done{};
    Shape shape;
    for (const MeshItem& mesh : items) add_mesh(shape, mesh);
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    built_ = std::move(items);
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

const PassEntry kMeshPass{
    "meshes", [](const Frame& frame) { return std::any_of(frame.packet.meshes.begin(), frame.packet.meshes.end(), is_opaque_mesh); },
    MeshPass::create};

}  // namespace catena::render
