// SPDX-License-Identifier: MIT
// A scene loaded a hundred times with new grids: memory of the device and of the process does not grow.
#include "tests/render/support/image_fixture.h"
#include "tests/render/support/scene_packet.h"
#include "tests/support/resident.h"

namespace catena::render::repeated_load_test {

const std::string kScene = R"({
  "fields": {"s": {"analytic": "sphere", "resolution": 17}, "v": {"analytic": "circle"}},
  "volumes": [{"field": "s", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}],
  "isosurfaces": [{"field": "s", "level": 1.0, "color": [0.8, 0.8, 0.9]}],
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0]], "radius": 0.05}],
  "camera": {"position": [6, -6, 4], "target": [0, 0, 0]}
})";

TEST(RepeatedLoad, AHundredLoadsHoldNoMoreMemory) {
  const auto renderer = test::make_renderer(0, false);
  ASSERT_TRUE(renderer);
  std::uint64_t device = 0, host = 0;
  constexpr int kWarm = 20;
  for (int k = 0; k < kWarm + 100; ++k) {
    const FramePacket packet = test::packet_from(kScene, "s.json", 48, 36);
    const std::uint64_t uploads = renderer->stats().uploads;
    const Outcome drawn = renderer->draw(packet);
    ASSERT_TRUE(drawn) << drawn.error().message;
    // a new grid each time
    EXPECT_GT(renderer->stats().uploads, uploads);
    EXPECT_EQ(renderer->device().retired_count(), 0u);
    if (k == kWarm) {
      device = renderer->device().counters().allocated_bytes;
      host = test::resident_bytes();
    }
    if (k > kWarm) {
      ASSERT_EQ(renderer->device().counters().allocated_bytes, device) << "load " << k;
    }
  }
  std::printf("host growth %.2f MB\n", 1e-6 * (double(test::resident_bytes()) - double(host)));
  if (test::kResidentIsReliable) {
    EXPECT_LT(test::resident_bytes(), host + 4'000'000);
  }
}

}  // namespace catena::render::repeated_load_test
