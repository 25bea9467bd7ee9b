#include "render/passes/streamlines.h"

#include "render/passes/triangles.h"

namespace catena::render {
namespace {

class StreamlinePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new StreamlinePass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    if (all_same(packet.tubes, tubes_) && all_same(packet.arrows, arrows_)) return Done{};
    Bounds bounds;
    for (const TubeItem& tube : packet.tubes)
      for (const Vec3& p : tube.points) bounds.add(p, tube.radius);
    Shape shape;
    for (const TubeItem& tube : packet.tubes) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, tube, tube_sides(tube.radius, bounds.diagonal()));
      mark(shape, first, tube.id, tube.clipped);
    }
    for (const ArrowItem& arrow : packet.arrows) {
      const std::size_t first = shape.vertices.size();
      add_cone(shape, arrow.base, arrow.tip, arrow.radius, arrow.color);
      mark(shape, first, arrow.id, arrow.clipped);
    }
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    tubes_ = packet.tubes;
    arrows_ = packet.arrows;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit StreamlinePass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  std::vector<TubeItem> tubes_;
  std::vector<ArrowItem> arrows_;
};

}  // namespace

const PassEntry kStreamlinePass{
    "streamlines", [](const Frame& frame) { return !frame.packet.tubes.empty() || !frame.packet.arrows.empty(); }, StreamlinePass::create};

}  // namespace catena::render
