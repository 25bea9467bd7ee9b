// SPDX-License-Identifier: MIT
// Tubes expanded from rings in the vertex shader: the image of add_tube's triangles with a fraction of their memory.
#include "render/passes/tubes.h"

#include <cmath>
#include <numbers>

#include "tests/render/support/image_fixture.h"

namespace catena::test::tubes_test {

using namespace catena::render;

class TubesTest : public ImageTest {};

TubeItem bent(double radius, const Vec3& middle, double turns, int count) {
  std::vector<Vec3> points;
  std::vector<Color> colors;
  for (int k = 0; k <= count; ++k) {
    const double angle = 2 * std::numbers::pi * turns * (k == count && turns == 1 ? 0 : k) / count;
    points.push_back(middle + 4.0 * Vec3(std::cos(angle), 0.3 * std::sin(2 * angle), std::sin(angle)));
    colors.push_back({float(0.5 + 0.5 * std::cos(angle)), 0.6f, float(0.5 + 0.5 * std::sin(angle))});
  }
  return {std::move(points), radius, {}, std::move(colors), 7};
}

/// An open and a closed tube, a ball, two consecutive tubes and a corner, with 8, 12 and 16 sides.
std::vector<TubeItem> some_tubes() {
  const TubeItem ball{std::vector<Vec3>{{9, 2, 9}}, 1.5, {1, 0.5f, 0.2f}},
      corner{{{-9, 0, -9}, {-4, 0, -9}, {-4, 0, -4}, {-9, 0, -8}}, 0.2, {0.3f, 0.9f, 0.4f}};
  return {bent(0.6, {-6, 0, 5}, 0.8, 40), bent(0.4, {5, 0, -5}, 1, 60), bent(0.1, {5, 1, 5}, 1, 30), ball, corner,
          bent(0.05, {0, 0, 0}, 0.7, 30)};
}

/// The tubes as triangle meshes.
std::vector<MeshItem> as_meshes(const std::vector<TubeItem>& tubes) {
  std::vector<MeshItem> meshes;
  for (const TubeItem& tube : tubes) {
    ShapeMesh shape;
    add_tube(shape, tube, 24);
    MeshGeometry geometry;
    for (const MeshVertex& v : shape.vertices) {
      geometry.vertices.push_back(v.position);
      geometry.normals.push_back(v.normal);
      geometry.colors.push_back(v.color);
    }
    geometry.triangles = shape.triangles;
    MeshItem item;
    item.geometry = std::make_shared<const MeshGeometry>(std::move(geometry));
    item.smooth = true;
    item.id = tube.id;
    meshes.push_back(std::move(item));
  }
  return meshes;
}

/// Small images draw ribbons, large ones tubes with sides.
TEST_F(TubesTest, MatchesTheImageOfTriangulatedTubes) {
  for (const std::uint32_t width : {192u, 1536u})
    for (const bool clipped : {false, true}) {
      FramePacket packet = make_packet({3, -30, 12}, {0, 0, 0});
      set_size(packet, width, width * 3 / 4);
      packet.background = {0.1f, 0.1f, 0.15f, 1};
      // clipped open, with light from the side
      if (clipped) {
        packet.clip_planes = {{Vec3(0, 0.1, 0), Vec3(0.1, 1, 0)}};
        packet.lights = {{.direction = {1, -0.5, 0.3}, .color = {1, 1, 1}, .camera_relative = true}};
      }
      FramePacket meshes = packet;
      packet.tubes = some_tubes();
      meshes.meshes = as_meshes(packet.tubes);
      const std::string name = (clipped ? "clipped-" : "whole-") + std::to_string(width);
      const Image8 a = draw(packet, {}, name), b = draw(meshes, {}, name + "-triangles");
      double sum = 0;
      int other = 0, drawn = 0;
      for (const auto& [x, y] : pixels_of(a)) {
        int maximum = 0;
        for (int c = 0; c < 3; ++c) maximum = std::max(maximum, std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]));
        sum += maximum;
        other += maximum > 50;
        drawn += std::abs(b.pixel(x, y)[0] - 26) > 3;
      }
      EXPECT_GT(drawn, width * width / 40) << name;
      EXPECT_LE(other, drawn / 50) << name << ": at outlines a pixel may fall to the other side";
      EXPECT_LE(sum / drawn, width < 1000 ? 4 : 2) << name;
    }
}

TEST_F(TubesTest, APointTakesLessThanAHundredBytesOfDeviceMemory) {
  FramePacket packet = make_packet({0, -60, 0}, {0, 0, 0});
  set_size(packet, 32, 24);
  const auto bytes = [&](int tubes) {
    packet.tubes.clear();
    for (int k = 0; k < tubes; ++k) packet.tubes.push_back(bent(0.01, {0.01 * k, 0, 0}, 0.9, 1000));
    draw(packet);
    return renderer_->stats().gpu_bytes;
  };
  // more points than one draw's indices
  const auto some = bytes(100), more = bytes(300);
  EXPECT_LT(double(more - some) / (200 * 1000), 100) << "triangles take more than 500";
}

}  // namespace catena::test::tubes_test
