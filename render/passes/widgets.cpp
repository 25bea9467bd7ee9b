#include "render/passes/widgets.h"

#include "render/passes/triangles.h"

namespace catena::render {
namespace {

constexpr int kSides = 10, kBallSides = 20;

class WidgetPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new WidgetPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const WidgetItems& items = frame.packet.widgets;
    if (all_same(items.tubes, built_.tubes) && all_same(items.arrows, built_.arrows) && all_same(items.meshes, built_.meshes))
      return Done{};
    Shape shape;
    for (const TubeItem& tube : items.tubes) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, tube, tube.points.size() == 1 ? kBallSides : kSides);
      mark(shape, first, tube.id, tube.clipped);
    }
    for (const ArrowItem& arrow : items.arrows) {
      const std::size_t first = shape.vertices.size();
      add_cone(shape, arrow.base, arrow.tip, arrow.radius, arrow.color);
      mark(shape, first, arrow.id, arrow.clipped);
    }
    for (const MeshItem& mesh : items.meshes) add_mesh(shape, mesh);
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    built_ = items;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit WidgetPass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  WidgetItems built_;
};

}  // namespace

const PassEntry kWidgetPass{"widgets", [](const Frame& frame) { return !frame.packet.widgets.empty(); }, WidgetPass::create};

}  // namespace catena::render
