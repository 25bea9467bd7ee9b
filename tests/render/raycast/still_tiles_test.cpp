/// While a cursor moves over a volume that stands still, only the tiles near it are marched again, and the picture is that of a new
/// renderer, to the bit.
#include <cmath>

#include "tests/render/support/frames.h"

namespace catena::test {
namespace still_tiles_test {

using namespace catena::render;

class StillTiles : public PictureTest {
 protected:
  void SetUp() override {
    PictureTest::SetUp();
    auto other = Renderer::create({true, "cpu", {}});
    ASSERT_TRUE(other) << other.error().message;
    other_ = std::move(*other);
    const auto grid =
        make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.9 * p.x) * std::cos(0.7 * p.y + 0.8 * p.z); });
    packet_ = packet_of({130, -100, 90}, {23.5, 19.5, 21.5});
    packet_.width = 480;
    packet_.height = 360;
    packet_.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
    packet_.volumes[0].transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
    packet_.volumes[0].shade = true;
    CursorItem cursor;
    cursor.size = 1.5;
    packet_.cursors = {cursor};
  }
  static RenderSettings keeping(std::uint32_t spacing, double half, double full) {
    RenderSettings settings;
    settings.fast = FastSettings{1, spacing, half, full};
    settings.keep = true;
    return settings;
  }
  /// What a renderer that has drawn nothing else of it makes of the packet.
  Picture fresh(RenderSettings settings) {
    settings.keep = false;
    EXPECT_TRUE(other_->draw(packet_, settings));
    return other_->read_back().value();
  }
  std::unique_ptr<Renderer> other_;
  FramePacket packet_;
};

TEST_F(StillTiles, AMovingCursorLeavesTheRestAsItIsToTheBit) {
  for (const auto& settings : {keeping(1, 0, -1), keeping(2, 0, -1), keeping(2, 0, 3), keeping(4, 1, 3), keeping(4, -1, -1)}) {
    Vec3 at(5, -3, 40);
    for (int k = 0; k < 6; ++k) {
      packet_.cursors[0].probe = at;
      const Picture found = draw(packet_, settings, k == 5 && settings.fast->spacing == 4 ? "last" : "");
      EXPECT_EQ(renderer_->stats().rays_kept, k > 0) << settings.fast->spacing << " " << k;
      ASSERT_EQ(max_difference(found, fresh(settings)), 0) << settings.fast->spacing << " " << settings.fast->refine_full_255 << " " << k;
      at = at + Vec3(7, 5.3, -4.1);
    }
  }
}

TEST_F(StillTiles, WhatElseChangesIsDrawnWhole) {
  const RenderSettings settings = keeping(2, 0, 3);
  draw(packet_, settings);
  const auto expect_whole = [&](const char* what) {
    const Picture found = draw(packet_, settings);
    EXPECT_FALSE(renderer_->stats().rays_kept) << what;
    EXPECT_EQ(max_difference(found, fresh(settings)), 0) << what;
    draw(packet_, settings);
    EXPECT_TRUE(renderer_->stats().rays_kept) << what;
  };
  packet_.view.position.x += 0.5;
  expect_whole("the eye");
  packet_.volumes[0].transfer.extinctions[2][1] = 0.2;
  expect_whole("the transfer function");
  packet_.clip = {{{20, 20, 20}, {1, 0, 0}}};
  expect_whole("a clip plane");
  packet_.width = 500;
  expect_whole("the size");
  packet_.volumes[0].grid = make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.5 * p.x); });
  expect_whole("the grid");
  // rays of another kind have drawn into the same image
  draw(packet_);
  expect_whole("exact rays between");
}

}  // namespace still_tiles_test
}  // namespace catena::test
