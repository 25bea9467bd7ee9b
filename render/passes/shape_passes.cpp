// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>

#include "render/passes/passes.h"
#include "render/passes/triangles.h"
#include "render/passes/tubes.h"

namespace catena::render {
namespace {

void add_arrow(ShapeMesh& shape, const ArrowItem& arrow) {
  const std::size_t first = shape.vertices.size();
  add_cone(shape, arrow.base, arrow.tip, arrow.radius, arrow.color);
  assign_object(shape, first, arrow.id, arrow.is_clipped);
}

/// Pass for triangles of some of a packet's items; rebuilds them when the items change.
///   Kind::Items                copy of the items, to detect changes
///   Kind::of(packet)           the items, or references to them
///   Kind::add(shape, items)    adds their triangles
template <class Kind>
class ShapePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new ShapePass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    decltype(auto) items = Kind::of(frame.packet);
    if (items == built_) return Done{};
    ShapeMesh shape;
    Kind::add(shape, items);
    CATENA_CHECK(triangles_.upload(frame.device, shape));
    built_ = items;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit ShapePass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  TriangleDrawer drawer_;
  Triangles triangles_;
  typename Kind::Items built_;
};

struct Aids {
  using Items = EnvironmentItems;
  static constexpr int kSides = 8;
  static const Items& of(const FramePacket& packet) { return packet.environment; }
  static void add(ShapeMesh& shape, const Items& items) {
    for (const TubeItem& tube : items.tubes) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, tube, kSides);
      assign_object(shape, first, tube.id, false);
    }
    for (const MeshItem& mesh : items.meshes) {
      const std::size_t first = shape.vertices.size();
      add_mesh(shape, mesh);
      assign_object(shape, first, mesh.id, false);
    }
  }
};

struct Widgets {
  using Items = WidgetItems;
  static constexpr int kSides = 10, kSphereSides = 20;
  static const Items& of(const FramePacket& packet) { return packet.widgets; }
  static void add(ShapeMesh& shape, const Items& items) {
    for (const TubeItem& tube : items.tubes) {
      const std::size_t first = shape.vertices.size();
      add_tube(shape, tube, tube.points.size() == 1 ? kSphereSides : kSides);
      assign_object(shape, first, tube.id, tube.is_clipped);
    }
    for (const ArrowItem& arrow : items.arrows) add_arrow(shape, arrow);
    for (const MeshItem& mesh : items.meshes) add_mesh(shape, mesh);
  }
};

struct GlyphArrows {
  using Items = std::vector<GlyphItem>;
  static constexpr int kShaftSides = 8, kHeadSides = 12;
  static const Items& of(const FramePacket& packet) { return packet.glyphs; }
  static void add(ShapeMesh& shape, const Items& items) {
    for (const GlyphItem& item : items) {
      const std::size_t first = shape.vertices.size();
      for (const Glyph& glyph : item.glyphs) {
        const Vec3 whole = glyph.tip - glyph.tail, neck = glyph.tip - item.head_length * whole;
        const double length = norm(whole);
        add_cylinder(shape, glyph.tail, neck, item.shaft_radius * length, glyph.color, kShaftSides);
        if (item.head_length > 0) add_cone(shape, neck, glyph.tip, item.head_radius * length, glyph.color, kHeadSides);
      }
      assign_object(shape, first, item.id, item.is_clipped);
    }
  }
};

/// Meshes of opacity 1; translucent meshes are drawn by LayersPass.
struct OpaqueMeshes {
  using Items = std::vector<MeshItem>;
  static bool has(const MeshItem& item) { return item.opacity >= 1; }
  static Items of(const FramePacket& packet) {
    Items items;
    std::ranges::copy_if(packet.meshes, std::back_inserter(items), has);
    return items;
  }
  static void add(ShapeMesh& shape, const Items& items) {
    for (const MeshItem& mesh : items) add_mesh(shape, mesh);
  }
};

/// Cursors, those with an occluded overlay first, and indicators.
class CursorPass final : public Pass {
 public:
  static constexpr int kIndicatorSides = 12;
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(TriangleDrawer drawer, TriangleDrawer::create(device));
    return std::unique_ptr<Pass>(new CursorPass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    if (packet.cursors != cursors_ || packet.indicators != indicators_) {
      cursors_.clear();
      indicators_.clear();
      ShapeMesh shape;
      add_cursors(shape, packet, true);
      ghost_indices_ = std::uint32_t(shape.triangles.size());
      add_cursors(shape, packet, false);
      for (const IndicatorItem& indicator : packet.indicators) add_indicator(shape, indicator);
      CATENA_CHECK(triangles_.upload(frame.device, shape));
      cursors_ = packet.cursors;
      indicators_ = packet.indicators;
    }
    frame.occluded_triangles = &triangles_;
    frame.occluded_index_count = ghost_indices_;
    return Done{};
  }
  Bounds bounds() const override { return triangles_.bounds(); }
  Outcome record(vk::Commands& commands, Frame& frame) override { return drawer_.draw(commands, frame.rays, triangles_); }

 private:
  explicit CursorPass(TriangleDrawer drawer) : drawer_(std::move(drawer)) {}
  static void add_cursors(ShapeMesh& shape, const FramePacket& packet, bool ghosts) {
    for (const CursorItem& cursor : packet.cursors) {
      if (cursor.show_occluded != ghosts) continue;
      const std::size_t first = shape.vertices.size();
      add_cursor(shape, cursor);
      assign_object(shape, first, cursor.id, false);
    }
  }
  static void add_indicator(ShapeMesh& shape, const IndicatorItem& indicator) {
    const std::size_t first = shape.vertices.size();
    add_tube(shape, indicator.tube, kIndicatorSides);
    add_cone(shape, indicator.arrow.base, indicator.arrow.tip, indicator.arrow.radius, indicator.arrow.color);
    assign_object(shape, first, indicator.tube.id, false);
  }

  TriangleDrawer drawer_;
  Triangles triangles_;
  std::uint32_t ghost_indices_ = 0;
  std::vector<CursorItem> cursors_;
  std::vector<IndicatorItem> indicators_;
};

/// Tubes as rings (tubes.h), and their arrowheads.
class StreamlinePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) { return std::unique_ptr<Pass>(new StreamlinePass(device)); }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    left_out_ = packet.omitted;
    if (packet.tubes != tubes_) {
      tubes_.clear();
      CATENA_CHECK(lines_.upload(frame.device, packet.tubes));
      tubes_ = packet.tubes;
    }
    if (packet.arrows == arrows_) return Done{};
    arrows_.clear();
    ShapeMesh shape;
    for (const ArrowItem& arrow : packet.arrows) add_arrow(shape, arrow);
    if (!head_drawer_) {
      CATENA_TRY(head_drawer_, TriangleDrawer::create(frame.device));
    }
    CATENA_CHECK(heads_.upload(frame.device, shape));
    arrows_ = packet.arrows;
    return Done{};
  }
  std::string warning() const override { return left_out_; }
  Bounds bounds() const override {
    Bounds all = lines_.bounds();
    all.extend(heads_.bounds());
    return all;
  }
  Outcome record(vk::Commands& commands, Frame& frame) override {
    const auto pause = [&] {
      commands.end_pass();
      frame.targets.begin(commands, target::opaque, 0);
      commands.set_scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
    };
    CATENA_CHECK(line_drawer_.draw(commands, frame.rays, lines_, pause));
    return head_drawer_ ? head_drawer_->draw(commands, frame.rays, heads_) : Outcome(Done{});
  }

 private:
  explicit StreamlinePass(vk::Device& device) : line_drawer_(device) {}
  TubeDrawer line_drawer_;
  std::optional<TriangleDrawer> head_drawer_;  ///< created with the first arrowheads
  Tubes lines_;
  Triangles heads_;
  std::vector<TubeItem> tubes_;
  std::vector<ArrowItem> arrows_;
  std::string left_out_;
};

}  // namespace

const PassEntry kEnvironmentPass{"aids", [](const Frame& frame) { return !frame.packet.environment.empty(); }, ShapePass<Aids>::create};

const PassEntry kWidgetPass{"widgets", [](const Frame& frame) { return !frame.packet.widgets.empty(); }, ShapePass<Widgets>::create};

const PassEntry kMeshPass{"meshes", [](const Frame& frame) { return std::ranges::any_of(frame.packet.meshes, OpaqueMeshes::has); },
                          ShapePass<OpaqueMeshes>::create};

const PassEntry kStreamlinePass{
    "streamlines", [](const Frame& frame) { return !frame.packet.tubes.empty() || !frame.packet.arrows.empty(); }, StreamlinePass::create};

const PassEntry kGlyphPass{"glyphs", [](const Frame& frame) { return !frame.packet.glyphs.empty(); }, ShapePass<GlyphArrows>::create};

const PassEntry kCursorPass{"cursor", [](const Frame& frame) { return !frame.packet.cursors.empty() || !frame.packet.indicators.empty(); },
                            CursorPass::create};

}  // namespace catena::render
