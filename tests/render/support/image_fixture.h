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

inline render::CursorItem cursor_item(const Vec3& probe, double radius) {
  render::CursorItem item;
  item.probe = probe;
  item.radius = radius;
  return item;
}

/// A square of two triangles at `y`, perpendicular to y, with |x|, |z| <= half.
inline std::shared_ptr<const render::MeshGeometry> square_at(double y, double half) {
  auto geometry = std::make_shared<render::MeshGeometry>();
  geometry->vertices = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
  geometry->triangles = {0, 1, 2, 0, 2, 3};
  return geometry;
}

/// The triangles of a mesh::TriangleSoup.
template <class Soup>
std::shared_ptr<const render::MeshGeometry> geometry_of(const Soup& soup) {
  auto geometry = std::make_shared<render::MeshGeometry>();
  geometry->vertices = soup.vertices;
  for (const auto& t : soup.triangles) geometry->triangles.insert(geometry->triangles.end(), t.begin(), t.end());
  return geometry;
}

/// Saves an image as pictures/SUITE.CASE.name.png in the build folder.
inline void save_picture(const render::Image8& image, const std::string& name, bool alpha) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string folder = binary_dir() + "/pictures";
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(render::write_png(folder + "/" + test->test_suite_name() + "." + test->name() + "." + name + ".png", image, alpha));
}

/// A renderer with the validation layer; null, and the test fails, if there is no device.
inline std::unique_ptr<render::Renderer> make_renderer(std::uint64_t memory_budget_bytes = 0, bool validation = true) {
  use_lavapipe();
  render::vk::DeviceOptions options;
  options.validation = validation;
  options.device_filter = test_device();
  options.memory_budget_bytes = memory_budget_bytes;
  auto renderer = render::Renderer::create(options);
  EXPECT_TRUE(renderer) << renderer.error().message;
  return renderer ? std::move(*renderer) : nullptr;
}

/// Fails a test with validation messages.
class ImageTest : public testing::Test {
 protected:
  void SetUp() override {
    renderer_ = make_renderer();
    ASSERT_TRUE(renderer_);
  }
  void TearDown() override {
    if (!renderer_) return;
    EXPECT_EQ(renderer_->stats().validation_messages, 0u);
    for (const std::string& text : renderer_->validation_texts()) ADD_FAILURE() << text;
  }

  /// Draws an image, reads it back and saves it, if it has a name.
  render::Image8 draw(const render::FramePacket& packet, const render::RenderSettings& settings = {}, const std::string& name = "") {
    const auto drawn = renderer_->draw(packet, settings);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    if (!drawn) return {packet.width, packet.height, std::vector<std::uint8_t>(std::size_t(4) * packet.width * packet.height)};
    auto image = renderer_->read_back();
    EXPECT_TRUE(image);
    if (!name.empty()) save_picture(*image, name, packet.background[3] < 1);
    return *image;
  }
  /// Depths of the last image's pixels, in rows from the top.
  std::vector<float> depths() {
    auto read = renderer_->read_depth();
    EXPECT_TRUE(read);
    return std::move(read.value().depth);
  }
  /// Ids of the last image's pixels, in rows from the top.
  std::vector<std::uint32_t> ids() {
    auto read = renderer_->read_ids();
    EXPECT_TRUE(read);
    return std::move(read.value().ids);
  }
  /// Checks that a packet is refused with a message that contains `part`.
  void expect_refused(const render::FramePacket& packet, const std::string& part, const render::RenderSettings& settings = {}) {
    const auto drawn = renderer_->draw(packet, settings);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find(part), std::string::npos) << drawn.error().message;
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

inline void set_size(render::FramePacket& packet, std::uint32_t width, std::uint32_t height) {
  packet.width = width;
  packet.height = height;
}

/// Makes the view orthographic, `height` world units from the image's bottom to its top.
inline void set_orthographic(render::FramePacket& packet, double height) {
  packet.view.orthographic = true;
  packet.view.height = height;
}

/// An orthographic view along y of a square image centred at (10, y, 10), transparent.
inline render::FramePacket square_packet_along_y(std::uint32_t side, double height) {
  render::FramePacket packet = make_packet({10, -40, 10}, {10, 10, 10});
  set_size(packet, side, side);
  set_orthographic(packet, height);
  return packet;
}

/// The pixels (x, y) of an image or a packet, row by row; every `step`-th in both directions.
template <class Sized>
std::vector<std::array<std::uint32_t, 2>> pixels_of(const Sized& sized, std::uint32_t step = 1) {
  std::vector<std::array<std::uint32_t, 2>> all;
  for (std::uint32_t y = 0; y < sized.height; y += step)
    for (std::uint32_t x = 0; x < sized.width; x += step) all.push_back({x, y});
  return all;
}

/// The number of pixels with an alpha of at least `alpha`.
inline int covered(const render::Image8& image, int alpha = 1) {
  int count = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) count += image.rgba[i] >= alpha;
  return count;
}

/// The largest difference between `part` and the pixels of `whole` from (x0, y0) on.
inline int max_difference(const render::Image8& part, const render::Image8& whole, std::uint32_t x0, std::uint32_t y0) {
  int maximum = 0;
  for (std::uint32_t y = 0; y < part.height; ++y)
    for (std::uint32_t i = 0; i < 4 * part.width; ++i)
      maximum = std::max(maximum, std::abs(int(part.pixel(0, y)[i]) - int(whole.pixel(x0, y0 + y)[i])));
  return maximum;
}

inline int max_difference(const render::Image8& a, const render::Image8& b) {
  int maximum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) maximum = std::max(maximum, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  return maximum;
}

/// Parameters at which a world ray enters (0 or more) and leaves a grid's domain; they are not in order if it does not meet it.
inline std::array<double, 2> ray_interval(const field::ScalarGrid& grid, const Vec3& origin, const Vec3& direction) {
  const Vec3 o = grid.mapping().index_from_world(origin), d = grid.mapping().index_from_world_linear * direction;
  double enter = 0, leave = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (o[a] < grid.index_box().lo[a] || o[a] > grid.index_box().hi[a]) return {0, 0};
      continue;
    }
    const double s = (grid.index_box().lo[a] - o[a]) / d[a], t = (grid.index_box().hi[a] - o[a]) / d[a];
    enter = std::max(enter, std::min(s, t));
    leave = std::min(leave, std::max(s, t));
  }
  return {enter, leave};
}

/// Length of a world ray within a grid's domain, in front of the eye's plane.
inline double chord_length(const field::ScalarGrid& grid, const Vec3& origin, const Vec3& direction) {
  const auto [enter, leave] = ray_interval(grid, origin, direction);
  return std::max(0.0, leave - enter);
}

}  // namespace catena::test
