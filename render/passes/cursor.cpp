#include "render/passes/cursor.h"

#include "render/passes/triangles.h"

namespace catena::render {
namespace {

constexpr int kIndicatorSides = 12;

bool same(const CursorItem& a, const CursorItem& b) {
  return a.probe == b.probe && a.proxies == b.proxies && a.active == b.active && a.force_n == b.force_n && a.size == b.size &&
         a.leaving == b.leaving && a.id == b.id && a.strain == b.strain;
}
bool same(const IndicatorItem& a, const IndicatorItem& b) { return render::same(a.tube, b.tube) && render::same(a.arrow, b.arrow); }

template <class Items>
bool all_same_here(const Items& a, const Items& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}

class CursorPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new CursorPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    if (all_same_here(packet.cursors, cursors_) && all_same_here(packet.indicators, indicators_)) return Done{};
    Shape shape;
    for (const CursorItem& cursor : packet.cursors) {
      const std::size_t first = shape.vertices.size();
      add_cursor(shape, cursor);
      mark(shape, first, cursor.id, false);
    }
    for (const IndicatorItem& indicator : packet.indicators) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, indicator.tube, kIndicatorSides);
      add_cone(shape, indicator.arrow.base, indicator.arrow.tip, indicator.arrow.radius, indicator.arrow.color);
      mark(shape, first, indicator.tube.id, false);
    }
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    cursors_ = packet.cursors;
    indicators_ = packet.indicators;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit CursorPass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  std::vector<CursorItem> cursors_;
  std::vector<IndicatorItem> indicators_;
};

}  // namespace

const PassEntry kCursorPass{"cursor", [](const Frame& frame) { return !frame.packet.cursors.empty() || !frame.packet.indicators.empty(); },
                            CursorPass::create};

}  // namespace catena::render
