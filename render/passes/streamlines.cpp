#include "render/passes/streamlines.h"

#include "render/passes/triangles.h"
#include "render/passes/tubes.h"

namespace catena::render {
namespace {

class StreamlinePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TubeDrawer lines, TubeDrawer::create(device));
    return std::unique_ptr<Pass>(new StreamlinePass(std::move(lines)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    if (!all_same(packet.tubes, tubes_)) {
      tubes_.clear();
      CATENA_CHECK(lines_.upload(frame.device, packet.tubes));
      tubes_ = packet.tubes;
    }
    if (all_same(packet.arrows, arrows_)) return Done{};
    arrows_.clear();
    Shape shape;
    for (const ArrowItem& arrow : packet.arrows) {
      const std::size_t first = shape.vertices.size();
      add_cone(shape, arrow.base, arrow.tip, arrow.radius, arrow.color);
      mark(shape, first, arrow.id, arrow.clipped);
    }
    if (!head_drawer_) {
      CATENA_TRY(head_drawer_, TriangleDrawer::create(frame.device));
    }
    CATENA_CHECK(heads_.upload(frame.device, shape));
    arrows_ = packet.arrows;
    return Done{};
  }
  Bounds bounds() const override {
    Bounds all = lines_.bounds();
    all.add(heads_.bounds());
    return all;
  }
  Outcome record(vk::Commands& commands, Frame& frame) override {
    CATENA_CHECK(line_drawer_.draw(commands, frame.rays, lines_));
    return head_drawer_ ? head_drawer_->draw(commands, frame.rays, heads_) : Outcome(Done{});
  }

 private:
  explicit StreamlinePass(TubeDrawer lines) : line_drawer_(std::move(lines)) {}
  TubeDrawer line_drawer_;
  std::optional<TriangleDrawer> head_drawer_;  ///< once there are any
  Tubes lines_;
  Triangles heads_;
  std::vector<TubeItem> tubes_;
  std::vector<ArrowItem> arrows_;
};

}  // namespace

const PassEntry kStreamlinePass{
    "streamlines", [](const Frame& frame) { return !frame.packet.tubes.empty() || !frame.packet.arrows.empty(); }, StreamlinePass::create};

}  // namespace catena::render
