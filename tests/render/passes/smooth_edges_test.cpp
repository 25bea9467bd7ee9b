// SPDX-License-Identifier: MIT
/// Antialiased contours: coverage of triangles and of an isosurface against the mean of 8 x 8 samples a pixel.
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::smooth_edges_test {

using namespace catena::render;

constexpr std::uint32_t kSamples = 8;

class SmoothEdges : public ImageTest {
 protected:
  Image8 drawn(FramePacket packet, bool smooth, const std::string& name = "") {
    RenderSettings settings;
    settings.smooth_edges = smooth;
    return draw(packet, settings, name);
  }
  /// Mean of kSamples^2 samples a pixel, of the red channel.
  std::vector<double> reference(FramePacket packet) {
    const std::uint32_t width = packet.width, height = packet.height;
    packet.width *= kSamples;
    packet.height *= kSamples;
    const Image8 image = drawn(packet, false);
    std::vector<double> mean(std::size_t(width) * height);
    for (std::uint32_t y = 0; y < packet.height; ++y)
      for (std::uint32_t x = 0; x < packet.width; ++x)
        mean[std::size_t(y / kSamples) * width + x / kSamples] += image.pixel(x, y)[0] / double(kSamples * kSamples);
    return mean;
  }
  /// Expects that smoothing removes most of the error at contours and changes no other pixel, nor depths and ids.
  void expect_smoother(const FramePacket& packet, double most_left, const std::string& name) {
    const std::vector<double> mean = reference(packet);
    const Image8 plain = drawn(packet, false, name + "-plain");
    const auto depths_before = depths();
    const auto ids_before = ids();
    const Image8 smooth = drawn(packet, true, name + "-smooth");
    EXPECT_EQ(depths(), depths_before);
    EXPECT_EQ(ids(), ids_before);
    double plain_squares = 0, smooth_squares = 0;
    for (std::uint32_t y = 1; y + 1 < packet.height; ++y)
      for (std::uint32_t x = 1; x + 1 < packet.width; ++x) {
        const std::size_t i = std::size_t(y) * packet.width + x;
        const double before = plain.pixel(x, y)[0] - mean[i], after = smooth.pixel(x, y)[0] - mean[i];
        plain_squares += before * before;
        smooth_squares += after * after;
        const auto id = [&](std::uint32_t a, std::uint32_t b) { return ids_before[std::size_t(b) * packet.width + a]; };
        const bool is_flat = id(x, y) == id(x - 1, y) && id(x, y) == id(x + 1, y) && id(x, y) == id(x, y - 1) && id(x, y) == id(x, y + 1);
        if (is_flat) {
          EXPECT_EQ(smooth.pixel(x, y)[0], plain.pixel(x, y)[0]) << x << " " << y;
        }
      }
    EXPECT_GT(plain_squares, 1000);
    EXPECT_LT(std::sqrt(smooth_squares / plain_squares), most_left) << name;
    RecordProperty(name + "_error_left", std::to_string(std::sqrt(smooth_squares / plain_squares)));
  }
};

TEST_F(SmoothEdges, ASquareAtAnyAngleHasTheCoverageOfItsPixels) {
  for (const double degrees : {3.0, 7.0, 20.0, 33.0, 45.0, 71.0}) {
    const Vec3 off(0.043, 0, 0.029);  // no pixel center on an edge
    FramePacket packet = make_packet(Vec3(0, -50, 0) + off, off);
    packet.background = {0, 0, 0, 1};
    set_orthographic(packet, 30);
    const double angle = degrees * std::acos(-1.0) / 180;
    packet.view.up = {std::sin(angle), 0, std::cos(angle)};
    MeshItem item{square_at(0, 9.3), {1, 1, 1}, 3};
    packet.meshes = {item};
    expect_smoother(packet, 0.75, "square" + std::to_string(int(degrees)));
  }
}

TEST_F(SmoothEdges, AnIsosurfaceHasASmoothRimInFrontOfAnything) {
  const auto ball = make_grid({32, 32, 32}, [](const Vec3& p) { return norm(p - Vec3(15.5)); });
  FramePacket packet = make_packet({15.5, -60, 15.5}, {15.5, 15.5, 15.5}, 28);
  packet.background = {1, 1, 1, 1};
  packet.isosurfaces = {{ball, 11, {1, 0.9f, 0.8f}, 1, 5}};
  expect_smoother(packet, 0.75, "ball");
  // in front of another part of the same mesh, whose id is equal: the depths jump
  packet.isosurfaces.clear();
  auto two = std::make_shared<MeshGeometry>(*square_at(0, 6));
  const auto behind = square_at(30, 30);
  for (const std::uint32_t i : behind->triangles) two->triangles.push_back(i + 4);
  two->vertices.insert(two->vertices.end(), behind->vertices.begin(), behind->vertices.end());
  two->colors = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  packet = make_packet({0, -50, 0}, {0, 0, 0});
  set_orthographic(packet, 30);
  packet.view.up = {0.3, 0, 1};
  packet.meshes = {{two, {1, 1, 1}, 3}};
  const std::vector<double> mean = reference(packet);
  const Image8 plain = drawn(packet, false), smooth = drawn(packet, true, "one-mesh");
  double before = 0, after = 0;
  for (std::uint32_t y = 0; y < packet.height; ++y)
    for (std::uint32_t x = 0; x < packet.width; ++x) {
      const double m = mean[std::size_t(y) * packet.width + x];
      before += std::pow(plain.pixel(x, y)[0] - m, 2);
      after += std::pow(smooth.pixel(x, y)[0] - m, 2);
    }
  EXPECT_LT(after, 0.4 * before);
}

}  // namespace catena::test::smooth_edges_test
