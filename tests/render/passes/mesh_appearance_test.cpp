// SPDX-License-Identifier: MIT
/// Meshes: smooth shading, edges, colours by vertex.
#include <cmath>

#include "tests/render/support/image_fixture.h"
#include "tests/support/mesh_shapes.h"

namespace catena::test::mesh_appearance_test {

using namespace catena::render;

class MeshAppearance : public ImageTest {};

/// Orthographic view along y, 0.05 units per pixel, black background.
FramePacket along_y() {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_orthographic(packet, 6);
  return packet;
}

MeshItem item_of(const mesh::MeshPtr& mesh, Color color) {
  auto geometry = std::make_shared<MeshGeometry>();
  geometry->vertices = mesh->vertices();
  for (const mesh::Triangle& t : mesh->triangles()) geometry->triangles.insert(geometry->triangles.end(), t.begin(), t.end());
  for (std::uint32_t v = 0; v < mesh->vertices().size(); ++v) geometry->normals.push_back(mesh->vertex_normal(v));
  return {geometry, color, 1};
}

/// A blue sphere of 500 faces; outside the highlight its blue is 0.2 + 0.7 n, with n the height over the unit disc.
TEST_F(MeshAppearance, ASmoothSphereIsShadedAsASphere) {
  FramePacket packet = along_y();
  packet.meshes = {item_of(make_mesh_from(sphere_soup(5, 2)), {0, 0, 1})};
  double flat_error = 0, smooth_error = 0;
  for (const bool smooth : {false, true}) {
    packet.meshes[0].smooth = smooth;
    const Image8 image = draw(packet, {}, smooth ? "smooth" : "flat");
    double& worst = smooth ? smooth_error : flat_error;
    for (std::uint32_t y = 0; y < 120; ++y)
      for (std::uint32_t x = 0; x < 160; ++x) {
        const double r = std::hypot(x - 79.5, y - 59.5) * 0.05 / 2;
        if (r < 0.55 || r > 0.9) continue;
        const double n = std::sqrt(1 - r * r), mirrored = std::max(0.0, 2 * n * n - 1);
        worst = std::max(worst, std::fabs(image.pixel(x, y)[2] - 255 * (0.2 + 0.7 * n + 0.2 * std::pow(mirrored, 20))));
      }
  }
  EXPECT_LE(smooth_error, 6);
  EXPECT_GE(flat_error, 12);
}

/// Two faces with a common edge, seen from the front.
TEST_F(MeshAppearance, EdgesAreOnePixelWide) {
  FramePacket packet = along_y();
  mesh::TriangleSoup soup;
  add_quad(soup, {-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2});
  packet.meshes = {item_of(make_mesh_from(soup), {0, 1, 0})};
  packet.meshes[0].show_edges = true;
  const Image8 image = draw(packet, {}, "edges");
  // 40 pixels to each side of the centre; the diagonal from the lower left to the upper right
  for (const std::uint32_t y : {31u, 47u, 70u, 85u}) {
    double dark = 0, moment = 0;
    for (std::uint32_t x = 0; x < 160; ++x) {
      if (x < 44 || x > 115) continue;
      const double d = (255 - image.pixel(x, y)[1]) / 191.0;
      dark += d;
      moment += d * (x + 0.5);
    }
    EXPECT_NEAR(dark, std::sqrt(2.0), 0.15) << y;
    EXPECT_NEAR(moment / dark, 80 - (y + 0.5 - 60), 0.1) << y;
  }
  // the border: half of the line's width is on the face
  EXPECT_LT(image.pixel(40, 80)[1], 180);
  EXPECT_EQ(image.pixel(45, 80)[1], 255);
  packet.meshes[0].show_edges = false;
  EXPECT_EQ(draw(packet).pixel(40, 80)[1], 255);
}

TEST_F(MeshAppearance, ColorsAreInterpolatedBetweenVertices) {
  FramePacket packet = along_y();
  auto geometry = std::make_shared<MeshGeometry>(*square_at(0, 2));
  geometry->colors = {{0, 0, 0}, {0.5f, 0, 0}, {0.5f, 0.25f, 0}, {0, 0.25f, 0}};
  packet.meshes = {{geometry, {1, 1, 1}, 1}};
  const Image8 image = draw(packet, {}, "colors");
  for (std::uint32_t y = 22; y < 98; y += 9)
    for (std::uint32_t x = 42; x < 118; x += 9) {
      const double u = (x + 0.5 - 40) / 80, v = (100 - y - 0.5) / 80;
      EXPECT_NEAR(image.pixel(x, y)[0], 255 * (0.9 * 0.5 * u + 0.2), 1) << x << " " << y;
      EXPECT_NEAR(image.pixel(x, y)[1], 255 * (0.9 * 0.25 * v + 0.2), 1) << x << " " << y;
    }
}

}  // namespace catena::test::mesh_appearance_test
