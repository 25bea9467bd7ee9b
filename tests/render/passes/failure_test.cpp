// SPDX-License-Identifier: MIT
// The driver fails at each call of a frame in turn: one error line, no leaks, no hang, and the next image is correct.
#include <cmath>

#include "tests/render/support/failure_injector.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::failure_test {

using namespace catena::render;
using vk::DriverCall;

/// A packet with every kind of object that needs device memory.
FramePacket everything() {
  FramePacket packet = make_packet({45, -50, 40}, {12, 12, 12});
  set_size(packet, 64, 48);
  const auto grid = make_grid({24, 24, 24}, [](const Vec3& p) { return norm(p - Vec3(12, 12, 12)) / 21; });
  packet.volumes = {volume_item(grid, {{0, 0.2}, {1, 0}}, {1, 0.5f, 0.2f})};
  packet.isosurfaces.push_back({grid, 0.2, {}});
  packet.tubes.push_back({{{0, 0, 0}, {24, 20, 24}}, 1, {0, 1, 0}});
  packet.cursors = {cursor_item({20, 4, 12}, 1)};
  return packet;
}

class DriverFailures : public ImageTest {
 protected:
  void SetUp() override {
    ImageTest::SetUp();
    failing_ = std::make_shared<FailureInjector>();
    start_over();
  }
  void start_over() {
    if (renderer_) expect_silence();
    auto renderer = Renderer::create(failing_options(failing_));
    ASSERT_TRUE(renderer) << renderer.error().message;
    renderer_ = std::move(*renderer);
  }
  void expect_silence() const {
    for (const std::string& text : renderer_->validation_texts()) ADD_FAILURE() << text;
  }
  /// Checks that the packet is refused with one line that names the result.
  void expect_failure(const FramePacket& packet, const char* result) {
    const Outcome drawn = renderer_->draw(packet);
    ASSERT_FALSE(drawn);
    EXPECT_EQ(drawn.error().message.find('\n'), std::string::npos);
    EXPECT_NE(drawn.error().message.find(result), std::string::npos) << drawn.error().message;
  }
  int calls_of_a_frame(const FramePacket& packet, DriverCall call) {
    start_over();
    failing_->arm(call, VK_SUCCESS, 0);
    EXPECT_TRUE(renderer_->draw(packet));
    return failing_->calls;
  }
  std::shared_ptr<FailureInjector> failing_;
};

TEST_F(DriverFailures, OutOfMemoryAtEveryAllocation) {
  const FramePacket packet = everything();
  FramePacket smaller = packet;
  smaller.isosurfaces.clear();
  smaller.tubes.clear();
  const int allocations = calls_of_a_frame(packet, DriverCall::allocate);
  ASSERT_GT(allocations, 12);
  const Image8 all = draw(packet, {}, "all"), few = draw(smaller, {}, "fewer");
  EXPECT_GT(max_difference(all, few), 50);
  start_over();
  for (int n = 1; n <= allocations; ++n) {
    failing_->arm(DriverCall::allocate, VK_ERROR_OUT_OF_DEVICE_MEMORY, n);
    SCOPED_TRACE(n);
    expect_failure(packet, "VK_ERROR_OUT_OF_DEVICE_MEMORY");
    EXPECT_FALSE(renderer_->device().is_lost());
    // all memory of the frame is freed
    EXPECT_EQ(renderer_->device().counters().allocated_bytes, 0u);
    EXPECT_EQ(renderer_->device().retired_count(), 0u);
    EXPECT_EQ(renderer_->stats().resident_grids, 0u);
    // every fourth time the renderer is reused, for a smaller and then for the full packet
    if (n % 4 != 1 && n != allocations) continue;
    EXPECT_EQ(max_difference(draw(smaller), few), 0);
    EXPECT_EQ(max_difference(draw(packet), all), 0);
    start_over();
  }
}

TEST_F(DriverFailures, OutOfMemoryDuringAReadBack) {
  const FramePacket packet = everything();
  const Image8 all = draw(packet);
  failing_->arm(DriverCall::allocate, VK_ERROR_OUT_OF_DEVICE_MEMORY, 1);
  const auto image = renderer_->read_back();
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("VK_ERROR_OUT_OF_DEVICE_MEMORY"), std::string::npos);
  EXPECT_EQ(renderer_->device().counters().allocated_bytes, 0u);
  EXPECT_EQ(max_difference(draw(packet), all), 0);
}

TEST_F(DriverFailures, TheSceneSurvivesALostDevice) {
  const FramePacket packet = everything();
  const Image8 before = draw(packet);
  for (const DriverCall call : {DriverCall::submit, DriverCall::wait}) {
    const int calls = calls_of_a_frame(packet, call);
    ASSERT_GT(calls, 3);
    // the first call, one in the middle, and the frame's submission
    for (const int n : {1, calls / 2, calls}) {
      start_over();
      failing_->arm(call, VK_ERROR_DEVICE_LOST, n);
      expect_failure(packet, "VK_ERROR_DEVICE_LOST");
      EXPECT_TRUE(renderer_->device().is_lost());
      // the device stays lost, and the next draw reports it at once
      expect_failure(packet, "VK_ERROR_DEVICE_LOST");
      start_over();
      EXPECT_FALSE(renderer_->device().is_lost());
      EXPECT_EQ(max_difference(draw(packet), before), 0) << "call " << n;
    }
  }
}

TEST_F(DriverFailures, ADeviceLostBetweenImagesIsReported) {
  const FramePacket packet = everything();
  const Image8 before = draw(packet);
  failing_->arm(DriverCall::wait, VK_ERROR_DEVICE_LOST, 1);
  const auto image = renderer_->read_back();
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("VK_ERROR_DEVICE_LOST"), std::string::npos);
  start_over();
  EXPECT_EQ(max_difference(draw(packet), before), 0);
}

}  // namespace catena::test::failure_test
