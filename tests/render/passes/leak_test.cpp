// SPDX-License-Identifier: MIT
// A thousand frames with changing objects: memory of the device and the process does not grow.
#include <cmath>

#include "tests/render/support/image_fixture.h"
#include "tests/support/resident.h"

namespace catena::test::leak_test {

using namespace catena::render;

class ResourceLeaks : public ImageTest {};

FramePacket frame_of(int k, const std::vector<GridPtr>& grids) {
  FramePacket packet = make_packet({45.0 + k % 7, -50, 40}, {8, 8, 8});
  set_size(packet, 32, 24);
  if (k % 5 != 0) packet.volumes = {volume_item(grids[std::size_t(k) % grids.size()], {{0, 0}, {1, 0.02 + 0.001 * (k % 11)}})};
  if (k % 3 != 0) packet.isosurfaces.push_back({grids[std::size_t(k / 2) % grids.size()], 0.3 + 0.01 * (k % 13), {}});
  if (k % 2 == 0) packet.tubes.push_back({{{0, 0, 0}, {16, 16, 1.0 + k % 16}}, 0.5, {}});
  // the packet always has an opaque object, so that passes and pipelines are kept
  packet.cursors = {cursor_item({8, 8, double(k % 16)}, k % 4 == 0 ? 0.5 : 1)};
  return packet;
}

TEST_F(ResourceLeaks, AThousandFramesHoldNoMoreMemory) {
  // without the validation layer, which allocates memory of its own
  const auto renderer = make_renderer(0, false);
  ASSERT_TRUE(renderer);
  std::vector<GridPtr> grids;
  for (int g = 0; g < 3; ++g) grids.push_back(make_grid({16, 16, 16}, [g](const Vec3& p) { return norm(p - Vec3(8, 8, 4 + 4 * g)) / 16; }));
  // objects change in every frame; every hundredth frame passes are also destroyed and pipelines recreated
  const auto draw_frames = [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      FramePacket packet = frame_of(k, grids);
      if (k % 100 != 0) {
        const FramePacket full = frame_of(1 + 30 * k, grids);
        if (packet.volumes.empty()) packet.volumes = full.volumes;
        if (packet.isosurfaces.empty()) packet.isosurfaces = frame_of(1, grids).isosurfaces;
        if (packet.tubes.empty()) packet.tubes = frame_of(2, grids).tubes;
      }
      const Outcome drawn = renderer->draw(packet);
      ASSERT_TRUE(drawn) << drawn.error().message;
    }
  };
  const auto settled = [&] {
    const FramePacket packet = frame_of(1, grids);
    EXPECT_TRUE(renderer->draw(packet));
    EXPECT_TRUE(renderer->draw(packet));
  };
  draw_frames(0, 200);
  settled();
  const std::uint64_t device_before = renderer->device().counters().allocated_bytes, host_before = resident_bytes();
  draw_frames(200, 1000);
  settled();
  EXPECT_EQ(renderer->device().counters().allocated_bytes, device_before);
  EXPECT_EQ(renderer->device().retired_count(), 0u);
  // tolerance for the driver, which keeps about 0.2 MB per pipeline with discard (8 x 2 in these 800 frames)
  const std::uint64_t host_after = resident_bytes();
  RecordProperty("host_growth_bytes", std::to_string(std::int64_t(host_after) - std::int64_t(host_before)));
  std::printf("host growth %.2f MB\n", 1e-6 * (double(host_after) - double(host_before)));
  if (kResidentIsReliable) {
    EXPECT_LT(host_after, host_before + 8'000'000);
  }
}

TEST_F(ResourceLeaks, ChangingScenesCauseNoValidationMessages) {
  std::vector<GridPtr> grids{make_grid({16, 16, 16}, [](const Vec3& p) { return norm(p) / 28; })};
  for (int k = 1; k < 40; ++k) draw(frame_of(k, grids));
  FramePacket empty = make_packet({45, -50, 40}, {8, 8, 8});
  set_size(empty, 32, 24);
  draw(empty);
  draw(empty);
  EXPECT_EQ(renderer_->stats().resident_grids, 0u);
  EXPECT_EQ(renderer_->device().retired_count(), 0u);
}

}  // namespace catena::test::leak_test
