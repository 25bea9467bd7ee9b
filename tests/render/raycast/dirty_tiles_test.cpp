// SPDX-License-Identifier: MIT
/// While a cursor moves over a static volume, only the tiles near it are marched, and the image is bit-identical to a new renderer's.
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::still_tiles_test {

using namespace catena::render;

class DirtyTileImages : public ImageTest {
 protected:
  void SetUp() override {
    ImageTest::SetUp();
    other_ = make_renderer();
    ASSERT_TRUE(other_);
    const auto grid =
        make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.9 * p.x) * std::cos(0.7 * p.y + 0.8 * p.z); });
    packet_ = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
    set_size(packet_, 480, 360);
    packet_.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
    packet_.volumes[0].transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
    packet_.volumes[0].is_shaded = true;
    packet_.cursors = {cursor_item({0, 0, 0}, 1.5)};
    exact_.reuse_rays = true;
  }
  static RenderSettings keeping(std::uint32_t spacing, double half, double full) {
    RenderSettings settings{.fast = FastSettings{1, spacing, half, full}, .reuse_rays = true};
    return settings;
  }
  /// Image of the packet by a new renderer.
  Image8 fresh(RenderSettings settings) {
    settings.reuse_rays = false;
    EXPECT_TRUE(other_->draw(packet_, settings));
    return other_->read_back().value();
  }
  /// Moves the cursor to its k-th place and draws; the image is that of a new renderer.
  void draw_step(int k, const RenderSettings& settings, const std::string& name = "") {
    packet_.cursors[0].probe = Vec3(5 + 7 * k, 5.3 * k - 3, 40 - 4.1 * k);
    expect_fresh(settings, name);
  }
  /// Draws; the image is that of a new renderer.
  void expect_fresh(const RenderSettings& settings, const std::string& name = "") {
    const Image8 found = draw(packet_, settings, name);
    ASSERT_EQ(max_difference(found, fresh(settings)), 0) << name;
  }
  std::unique_ptr<Renderer> other_;
  FramePacket packet_;
  RenderSettings exact_;
};

TEST_F(DirtyTileImages, AMovingCursorLeavesOtherTilesUnchangedBitForBit) {
  for (const auto& settings : {keeping(1, 0, -1), keeping(2, 0, -1), keeping(2, 0, 3), keeping(4, 1, 3), keeping(4, -1, -1)}) {
    for (int k = 0; k < 6; ++k) {
      SCOPED_TRACE(testing::Message() << settings.fast->spacing << " " << settings.fast->refine_full_255 << " " << k);
      draw_step(k, settings, k == 5 && settings.fast->spacing == 4 ? "last" : "");
      EXPECT_EQ(renderer_->stats().rays_reused, k > 0);
    }
  }
}

/// The tiles of 16 x 16 pixels with different ids in two images, and those within `reach` tiles of them.
std::uint32_t tiles_near(const IdImage& a, const IdImage& b, int reach) {
  const int across = int(a.width + 15) / 16, down = int(a.height + 15) / 16;
  std::vector<std::uint8_t> changed(std::size_t(across) * std::size_t(down));
  for (const auto& [x, y] : pixels_of(a))
    if (a.ids[std::size_t(y) * a.width + x] != 0 || b.ids[std::size_t(y) * a.width + x] != 0)
      changed[std::size_t(y / 16) * std::size_t(across) + x / 16] = 1;
  std::uint32_t count = 0;
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      bool near = false;
      for (int j = std::max(0, y - reach); j <= std::min(down - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(across - 1, x + reach); ++i)
          near = near || changed[std::size_t(j) * std::size_t(across) + std::size_t(i)];
      count += near;
    }
  return count;
}

TEST_F(DirtyTileImages, ExactRaysAreMarchedOnlyUnderTheCursorsOldAndNewOutline) {
  packet_.cursors[0].id = 1;
  set_size(packet_, 240, 180);
  const auto other = make_grid({24, 24, 24}, [](const Vec3& p) { return 0.04 * p.x; });
  for (const bool several : {false, true}) {
    if (several) {
      packet_.volumes.push_back(volume_item(other, {{0, 0}, {1, 0.05}}));
      packet_.isosurfaces = {{packet_.volumes[0].grid, 0.7, {}, 0.4f}};
      packet_.lights = {{{1, 1, 1}, {1, 1, 1}, false}};
      packet_.fog = FogItem{{0.5f, 0.5f, 0.5f}, 100, 300, 0.5};
    }
    IdImage before;
    for (int k = 0; k < 3; ++k) {
      SCOPED_TRACE(testing::Message() << several << k);
      draw_step(k, exact_);
      const MarchedTiles tiles = renderer_->marched_tiles().value();
      const IdImage now = renderer_->read_ids().value();
      EXPECT_EQ(tiles.total, 15u * 12);
      if (k == 0)
        EXPECT_EQ(tiles.marched, tiles.total);
      else
        EXPECT_LE(tiles.marched, tiles_near(before, now, 0));
      EXPECT_GT(tiles.marched, 0u);
      before = now;
    }
    draw(packet_, exact_);
    EXPECT_EQ(renderer_->marched_tiles().value().marched, 0u) << "nothing has moved";
    packet_.cursors[0].probe.z += 0.01;
    packet_.lights.push_back({{0, 1, 1}, {0.5f, 0.5f, 0.5f}, false});
    expect_fresh(exact_);
    EXPECT_FALSE(renderer_->stats().rays_reused) << "the light";
  }
}

TEST_F(DirtyTileImages, EveryEyeKeepsItsOwnTiles) {
  set_size(packet_, 160, 120);
  packet_.packing = Packing::side_by_side;
  packet_.eyes = {packet_.view, packet_.view};
  packet_.eyes[1].position.x += 6;
  const IsosurfaceItem surface{packet_.volumes[0].grid, 0.9, {0.9f, 0.5f, 0.2f}};
  for (const RenderSettings& settings : {keeping(1, 0, -1), keeping(2, 0, 3), exact_}) {
    packet_.isosurfaces.resize(settings.fast ? 0 : 1, surface);
    for (int k = 0; k < 4; ++k) {
      draw_step(k, settings);
      EXPECT_EQ(renderer_->stats().rays_reused, k > 0) << k;
      EXPECT_EQ(renderer_->stats().surfaces_reused, k > 0 && !settings.fast) << k;
      const MarchedTiles tiles = renderer_->marched_tiles().value();
      EXPECT_EQ(tiles.marched<tiles.total, k> 0) << k;
    }
    // only one eye has moved
    packet_.eyes[1].position.x += 1;
    expect_fresh(settings);
    EXPECT_TRUE(renderer_->stats().rays_reused) << "the first eye's";
  }
}

TEST_F(DirtyTileImages, TranslucentMeshesAndSlicesAreMarchedOnlyUnderTheCursor) {
  set_size(packet_, 160, 120);
  const SliceItem slice{packet_.volumes[0].grid, {23, 19, 22}, {0, 0, 1}, {{0, 0.2, 0.3, 0.9}, {1, 0.9, 0.8, 0.1}}, 0.5f};
  auto triangle = std::make_shared<MeshGeometry>();
  triangle->vertices = {{0, 0, 10}, {47, 0, 30}, {20, 39, 20}};
  triangle->triangles = {0, 1, 2};
  packet_.slices = {slice};
  packet_.meshes = {{triangle, {}, 0, true, 0.4f}};
  for (int k = 0; k < 3; ++k) {
    draw_step(k, exact_, k == 2 ? "last" : "");
    EXPECT_EQ(renderer_->stats().rays_reused, k > 0) << k;
    const MarchedTiles tiles = renderer_->marched_tiles().value();
    EXPECT_EQ(tiles.marched<0.5 * tiles.total, k> 0) << k;
  }
  const auto expect_whole = [&](const char* what) {
    SCOPED_TRACE(what);
    expect_fresh(exact_);
    EXPECT_FALSE(renderer_->stats().rays_reused);
  };
  packet_.slices[0].point.z += 1;
  expect_whole("the slice");
  packet_.slices[0].opacity = 0.6f;
  expect_whole("its opacity");
  packet_.meshes[0].color = {0.1f, 0.9f, 0.3f};
  expect_whole("the mesh");
  packet_.meshes.clear();
  expect_whole("without the mesh");
  packet_.slices.clear();
  expect_whole("without layers");
  packet_.slices = {slice};
  expect_whole("layers again");
}

TEST_F(DirtyTileImages, OpaqueSurfacesAreFoundOnceAndDrawnAmongMovingObjects) {
  set_size(packet_, 240, 180);
  const GridPtr grid = packet_.volumes[0].grid;
  packet_.isosurfaces = {{grid, 0.9, {0.9f, 0.5f, 0.2f}, 1, 3}, {grid, 0.2, {0.2f, 0.5f, 0.9f}, 1, 3}};
  packet_.cursors[0].radius = 8;
  packet_.cursors[0].id = 4;
  for (const bool alone : {true, false}) {
    if (alone) packet_.volumes.clear();
    for (int k = 0; k < 4; ++k) {
      // in front, between and behind
      packet_.cursors[0].probe = Vec3(60 - 15 * k, 20, 22);
      expect_fresh(exact_, k == 3 ? "last" : "");
      EXPECT_EQ(renderer_->stats().surfaces_reused, k > 0) << alone << k;
      EXPECT_EQ(renderer_->read_ids().value().ids, other_->read_ids().value().ids);
      EXPECT_EQ(renderer_->read_depth().value().depth, other_->read_depth().value().depth);
    }
    packet_.isosurfaces[0].level -= 0.1;
    expect_fresh(exact_);
    EXPECT_FALSE(renderer_->stats().surfaces_reused) << "another level";
    packet_.view.position.x += 1;
    expect_fresh(exact_);
    EXPECT_FALSE(renderer_->stats().surfaces_reused) << "another eye";
    packet_.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
    packet_.lights = {{{1, 1, 1}, {1, 1, 1}, false}};
  }
}

TEST(RaysMatch, IgnoreOpaqueObjectsAndDetectOtherChanges) {
  const auto grid = make_grid({8, 8, 8}, [](const Vec3& p) { return 0.1 * p.x; });
  FramePacket first = make_packet({30, -20, 10}, {4, 4, 4});
  first.volumes = {volume_item(grid, {{0, 0}, {1, 0.1}})};
  first.isosurfaces = {{grid, 0.3, {}}, {grid, 0.3, {}, 0.5f}};
  const auto same = [&](const std::function<void(FramePacket&)>& change) {
    FramePacket other = first;
    change(other);
    return rays_match(first, other);
  };
  EXPECT_TRUE(same([](FramePacket& p) { p.cursors.resize(1); }));
  EXPECT_TRUE(same([](FramePacket& p) { p.isosurfaces[0].level = 0.4; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.isosurfaces[1].level = 0.4; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.lights.resize(1); }));
  EXPECT_FALSE(same([](FramePacket& p) { p.fog = FogItem{}; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.clip_planes = {{{4, 4, 4}, {1, 0, 0}}}; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.view.position.x += 1; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.eyes = {p.view, p.view}; }));
  first.meshes.resize(2);
  first.meshes[1].opacity = 0.5f;
  first.slices.resize(2);
  first.slices[1].opacity = 0.5f;
  EXPECT_TRUE(same([](FramePacket& p) { p.meshes[0].color = {0, 1, 0}; }));
  EXPECT_TRUE(same([](FramePacket& p) { p.slices[0].point.x += 1; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.meshes[1].color = {0, 1, 0}; }));
  EXPECT_FALSE(same([](FramePacket& p) { p.slices[1].point.x += 1; }));
  first.eyes = {first.view, first.view};
  EXPECT_TRUE(same([](FramePacket& p) { p.cursors.resize(1); }));
  EXPECT_FALSE(same([](FramePacket& p) { p.eyes[1].position.x += 1; }));
}

TEST_F(DirtyTileImages, FastRaysAreMarchedWithinTheirInterpolationDistanceOfTheOutline) {
  packet_.cursors[0].id = 1;
  for (const auto& [settings, reach] : {std::pair{keeping(1, 0, -1), 1}, {keeping(2, 0, 3), 3}, {keeping(4, 1, 3), 6}}) {
    draw(packet_, settings);
    const IdImage before = renderer_->read_ids().value();
    packet_.cursors[0].probe = packet_.cursors[0].probe + Vec3(7, 5.3, -4.1);
    draw(packet_, settings);
    const MarchedTiles tiles = renderer_->marched_tiles().value();
    EXPECT_LE(tiles.marched, tiles_near(before, renderer_->read_ids().value(), reach)) << reach;
    EXPECT_LT(tiles.marched, tiles.total) << reach;
  }
}

TEST_F(DirtyTileImages, OtherChangesRedrawTheWholeImage) {
  const RenderSettings settings = keeping(2, 0, 3);
  draw(packet_, settings);
  const auto expect_whole = [&](const char* what) {
    SCOPED_TRACE(what);
    expect_fresh(settings);
    EXPECT_FALSE(renderer_->stats().rays_reused);
    draw(packet_, settings);
    EXPECT_TRUE(renderer_->stats().rays_reused);
  };
  packet_.view.position.x += 0.5;
  expect_whole("the eye");
  packet_.volumes[0].transfer.extinctions[2][1] = 0.2;
  expect_whole("the transfer function");
  packet_.clip_planes = {{{20, 20, 20}, {1, 0, 0}}};
  expect_whole("a clip plane");
  packet_.width = 500;
  expect_whole("the size");
  packet_.volumes[0].grid = make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.5 * p.x); });
  expect_whole("the grid");
  // another ray type has drawn into the same image
  draw(packet_);
  expect_whole("exact rays between");
}

}  // namespace catena::test::still_tiles_test
