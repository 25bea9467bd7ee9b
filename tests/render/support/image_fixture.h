// SPDX-License-Identifier: MIT
/// Shared helpers of the image tests: small grids by formula, a renderer with validation, images saved in the build folder.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "engine/field/grid/grid.h"
#include "render/passes/renderer.h"
#include "tests/support/support.h"
#include "tests/support/vulkan.h"

namespace catena::test {

using GridPtr = std::shared_ptr<const field::ScalarGrid>;

/// A grid of f(index) on n[0] x n[1] x n[2] voxels.
inline GridPtr make_grid(const field::Index3& n, const std::function<double(const Vec3&)>& f, const field::Mapping& mapping = {},
                         const std::function<bool(const Vec3&)>& valid = nullptr) {
  std::vector<float> values;
  std::vector<std::uint8_t> mask;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        values.push_back(float(f(Vec3(x, y, z))));
        if (valid) mask.push_back(valid(Vec3(x, y, z)));
      }
  return field::make_scalar_grid("density", mapping, n, values, mask);
}

inline render::VolumeItem volume_item(GridPtr grid, const std::vector<std::array<double, 2>>& extinctions, Color color = {1, 1, 1}) {
  render::VolumeItem item;
  item.grid = std::move(grid);
  item.transfer.colors = {{0, color.r, color.g, color.b}, {1, color.r, color.g, color.b}};
  item.transfer.extinctions = extinctions;
  return item;
}

/// Fails a test with validation messages.
class ImageTest : public testing::Test {
 protected:
  void SetUp() override {
    use_lavapipe();
    render::vk::DeviceOptions options;
    options.validation = true;
    options.device_filter = test_device();
    auto renderer = render::Renderer::create(options);
    ASSERT_TRUE(renderer) << renderer.error().message;
    renderer_ = std::move(*renderer);
  }
  void TearDown() override {
    if (!renderer_) return;
    EXPECT_EQ(renderer_->stats().validation_messages, 0u);
    for (const std::string& text : renderer_->validation_texts()) ADD_FAILURE() << text;
  }

  /// Draws an image, reads it back and saves it as pictures/SUITE.CASE.name.png in the build folder.
  render::Image8 draw(const render::FramePacket& packet, const render::RenderSettings& settings = {}, const std::string& name = "") {
    const auto drawn = renderer_->draw(packet, settings);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    if (!drawn) return {packet.width, packet.height, std::vector<std::uint8_t>(std::size_t(4) * packet.width * packet.height)};
    auto image = renderer_->read_back();
    EXPECT_TRUE(image);
    if (!name.empty()) {
      const auto* test = testing::UnitTest::GetInstance()->current_test_info();
      const std::string folder = test::binary_dir() + "/pictures";
      std::filesystem::create_directories(folder);
      const std::string path = folder + "/" + test->test_suite_name() + "." + test->name() + "." + name + ".png";
      EXPECT_TRUE(render::write_png(path, *image, packet.background[3] < 1));
    }
    return *image;
  }

  std::unique_ptr<render::Renderer> renderer_;
};

/// A packet of 160 x 120 pixels, transparent, looking at `target` from `position`.
inline render::FramePacket make_packet(const Vec3& position, const Vec3& target, double fovy_deg = 30) {
  render::FramePacket packet;
  packet.width = 160;
  packet.height = 120;
  packet.view.position = position;
  packet.view.target = target;
  packet.view.fovy_deg = fovy_deg;
  packet.background = {0, 0, 0, 0};
  return packet;
}

inline int max_difference(const render::Image8& a, const render::Image8& b) {
  int maximum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) maximum = std::max(maximum, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  return maximum;
}

/// Length of a world ray within a grid's domain, in front of the eye's plane.
inline double chord_length(const field::ScalarGrid& grid, const Vec3& origin, const Vec3& direction) {
  const Vec3 o = grid.mapping().index_from_world(origin), d = grid.mapping().index_from_world_linear * direction;
  double enter = 0, leave = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (o[a] < grid.index_box().lo[a] || o[a] > grid.index_box().hi[a]) return 0;
      continue;
    }
    const double s = (grid.index_box().lo[a] - o[a]) / d[a], t = (grid.index_box().hi[a] - o[a]) / d[a];
    enter = std::max(enter, std::min(s, t));
    leave = std::min(leave, std::max(s, t));
  }
  return std::max(0.0, leave - enter);
}

}  // namespace catena::test
