#include "render/passes/aids.h"

#include "render/passes/triangles.h"

namespace catena::render {
namespace {

constexpr int kSides = 8;

class AidPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new AidPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const AidItems& items = frame.packet.aids;
    if (all_same(items.tubes, built_.tubes) && all_same(items.meshes, built_.meshes)) return Done{};
    Shape shape;
    for (const TubeItem& tube : items.tubes) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, tube, kSides);
      mark(shape, first, tube.id, false);
    }
    for (const MeshItem& mesh : items.meshes) {
      const std::size_t first = shape.vertices.size();
      add_mesh(shape, mesh);
      mark(shape, first, mesh.id, false);
    }
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    built_ = items;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit AidPass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  AidItems built_;
};

}  // namespace

const PassEntry kAidPass{"aids", [](const Frame& frame) { return !frame.packet.aids.empty(); }, AidPass::create};

}  // namespace catena::render
