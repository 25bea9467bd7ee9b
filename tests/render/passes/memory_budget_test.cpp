// SPDX-License-Identifier: MIT
// The memory budget is never exceeded; grids that do not fit are drawn downsampled, at their position, and reported.
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::memory_budget_test {

using namespace catena::render;

constexpr std::uint64_t kPixels = 160 * 120, kReserve = 1'000'000 + kPixels * (4 + 16 + 4);

constexpr const char* kOwnSizes = "what an image takes is a driver's own: these budgets are lavapipe's";

RenderSettings exact() {
  RenderSettings settings{.texel_format = TexelFormat::r32f, .fast = {}};
  return settings;
}

class MemoryBudget : public ImageTest {
 protected:
  /// Sets the budget to the image's own memory plus `left` bytes.
  void limit(std::uint64_t left) {
    renderer_ = make_renderer(kReserve + left);
    ASSERT_TRUE(renderer_);
  }
  int factor() const {
    const auto list = renderer_->stats().downsampled_grids;
    return list.empty() ? 1 : list.front().factor;
  }
  void expect_within() const { EXPECT_LE(renderer_->device().counters().peak_bytes, renderer_->stats().gpu_budget); }
};

GridPtr linear_grid() {
  return make_grid({64, 64, 64}, [](const Vec3& p) { return (p.x + 0.5 * p.y + 0.25 * p.z) / 112; });
}

FramePacket packet_of(const std::vector<VolumeItem>& volumes) {
  FramePacket packet = make_packet({110, -90, 70}, {32, 32, 32});
  packet.volumes = volumes;
  return packet;
}

TEST_F(MemoryBudget, ALinearFieldLooksTheSameAtEveryResolution) {
  if (!uses_lavapipe()) GTEST_SKIP() << kOwnSizes;
  const FramePacket packet = packet_of({volume_item(linear_grid(), {{0, 0}, {1, 0.06}}, {1, 0.8f, 0.4f})});
  const Image8 whole = draw(packet, exact(), "whole");
  EXPECT_EQ(factor(), 1);
  EXPECT_GT(whole.pixel(80, 60)[3], 100);
  // 64^3 floats are 1 MB, half the resolution an eighth of it
  for (const auto& [left, expected] : {std::pair{1'300'000, 1}, {400'000, 2}, {80'000, 4}, {30'000, 8}}) {
    limit(std::uint64_t(left));
    const Image8 coarse = draw(packet, exact(), "factor-" + std::to_string(expected));
    EXPECT_EQ(factor(), expected) << left;
    EXPECT_LE(max_difference(whole, coarse), 2) << "factor " << expected;
    expect_within();
    EXPECT_EQ(renderer_->stats().validation_messages, 0u);
  }
}

TEST_F(MemoryBudget, DownsampledGridsAreReportedWithTheirReason) {
  if (!uses_lavapipe()) GTEST_SKIP() << kOwnSizes;
  limit(400'000);
  FramePacket packet = packet_of({volume_item(linear_grid(), {{0, 0}, {1, 0.06}})});
  draw(packet, exact());
  const auto list = renderer_->stats().downsampled_grids;
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].grid, "density");
  EXPECT_EQ(list[0].message(), "density: 64^3 needs 1.3 MB of GPU memory, 0.4 MB are left: drawn at half resolution");
  packet.volumes.clear();
  draw(packet, exact());
  EXPECT_TRUE(renderer_->stats().downsampled_grids.empty());
}

TEST_F(MemoryBudget, AnIsosurfaceOfAPlaneKeepsItsPosition) {
  if (!uses_lavapipe()) GTEST_SKIP() << kOwnSizes;
  FramePacket packet = packet_of({});
  packet.isosurfaces = {{linear_grid(), 0.5, {0.8f, 0.8f, 0.9f}}};
  draw(packet, {}, "whole");
  const std::vector<float> whole = depths();
  limit(400'000 + kPixels * 20);
  draw(packet, {}, "half");
  EXPECT_EQ(factor(), 2);
  const std::vector<float> half = depths();
  int hit = 0, differing = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::isfinite(whole[i]) != std::isfinite(half[i])) {
      ++differing;
    } else if (std::isfinite(whole[i])) {
      ++hit;
      ASSERT_NEAR(whole[i], half[i], 2e-3) << i;
    }
  }
  EXPECT_GT(hit, 1000);
  EXPECT_LE(differing, hit / 100);
  expect_within();
}

TEST_F(MemoryBudget, ASparseGridIsDownsampledInItsAtlas) {
  if (!uses_lavapipe()) GTEST_SKIP() << kOwnSizes;
  const auto ball = [](const Vec3& p) { return std::max(0.0, 1 - norm(p - Vec3(40, 32, 32)) / 14); };
  FramePacket packet = make_packet({130, -100, 70}, {32, 32, 32});
  packet.volumes = {volume_item(make_grid({64, 64, 64}, ball), {{0, 0}, {1, 0.2}}, {1, 1, 1})};
  packet.background = {0, 0, 0, 1};
  RenderSettings settings = exact();
  settings.layout = GridLayout::atlas;
  const Image8 whole = draw(packet, settings, "whole");
  EXPECT_GT(whole.pixel(76, 60)[0], 50);
  limit(300'000);
  const Image8 half = draw(packet, settings, "half");
  EXPECT_EQ(factor(), 2);
  // averages of a curved field differ slightly, its position does not
  EXPECT_LE(max_difference(whole, half), 10);
  double moment[2] = {0, 0}, mass[2] = {0, 0};
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    mass[0] += whole.rgba[4 * i];
    mass[1] += half.rgba[4 * i];
    moment[0] += double(i % 160) * whole.rgba[4 * i];
    moment[1] += double(i % 160) * half.rgba[4 * i];
  }
  EXPECT_NEAR(moment[0] / mass[0], moment[1] / mass[1], 0.05);
  EXPECT_NEAR(mass[1] / mass[0], 1, 0.02);
  expect_within();
}

TEST_F(MemoryBudget, TwoGridsShareTheBudget) {
  limit(500'000);
  draw(packet_of({volume_item(linear_grid(), {{0, 0}, {1, 0.03}}), volume_item(linear_grid(), {{0, 0}, {1, 0.03}})}), exact(), "two");
  EXPECT_EQ(renderer_->stats().resident_grids, 2u);
  EXPECT_EQ(renderer_->stats().downsampled_grids.size(), 2u);
  expect_within();
}

TEST_F(MemoryBudget, AGridReturnsToFullResolutionWhenItFits) {
  limit(1'900'000);
  const VolumeItem one = volume_item(linear_grid(), {{0, 0}, {1, 0.03}}), two = volume_item(linear_grid(), {{0, 0}, {1, 0.03}});
  FramePacket packet = packet_of({one, two});
  draw(packet, exact());
  EXPECT_EQ(factor(), 2);
  packet.volumes = {two};
  draw(packet, exact());
  draw(packet, exact());
  EXPECT_EQ(factor(), 1);
  expect_within();
}

TEST_F(MemoryBudget, AGridThatFitsAtNoResolutionIsAnErrorInOneLine) {
  limit(2'000);
  FramePacket packet = packet_of({volume_item(linear_grid(), {{0, 0}, {1, 0.03}})});
  const Outcome drawn = renderer_->draw(packet, exact());
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().message.find('\n'), std::string::npos);
  EXPECT_NE(drawn.error().message.find("density: 64^3 needs 1.3 MB of GPU memory"), std::string::npos) << drawn.error().message;
  EXPECT_EQ(renderer_->stats().gpu_bytes, 0u);
  // the renderer can be reused
  packet.volumes.clear();
  packet.background = {1, 1, 1, 1};
  EXPECT_EQ(draw(packet).pixel(80, 60)[0], 255);
}

TEST_F(MemoryBudget, ALargerImageStaysWithinTheBudget) {
  limit(1'400'000);
  FramePacket packet = packet_of({volume_item(linear_grid(), {{0, 0}, {1, 0.06}})});
  draw(packet, exact());
  EXPECT_EQ(factor(), 1);
  set_size(packet, 256, 192);
  EXPECT_GT(draw(packet, exact()).pixel(128, 96)[3], 100);
  // a budget too small for the image is an error in one line
  set_size(packet, 1024, 1024);
  expect_refused(packet, "MB", exact());
  expect_within();
}

}  // namespace catena::test::memory_budget_test
