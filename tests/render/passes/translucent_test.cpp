// SPDX-License-Identifier: MIT
/// Translucent meshes and slices, alone and with each other, volumes, isosurfaces and opaque objects, against closed forms.
#include <algorithm>
#include <cmath>

#include "tests/render/support/image_fixture.h"
#include "tests/support/mesh_shapes.h"

namespace catena::test::translucent_test {

using namespace catena::render;

class Translucent : public ImageTest {};

/// 0.25 units per pixel, centre (10, 10).
FramePacket along_y() { return square_packet_along_y(120, 30); }

GridPtr cube() {
  return make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; });
}

MeshItem mesh_item(const mesh::TriangleSoup& soup, Color color, float opacity, std::uint32_t id = 1) {
  return {geometry_of(soup), color, id, true, opacity};
}

SliceItem slice_at(GridPtr grid, double y, Color color, float opacity, std::uint32_t id = 1) {
  SliceItem item{std::move(grid), {0, y, 0}, {0, 1, 0}, {{0, color.r, color.g, color.b}}, opacity};
  item.id = id;
  return item;
}

/// A wall y = 10 + slope (x - 10) over the cube's face.
mesh::TriangleSoup wall(double slope) {
  mesh::TriangleSoup soup;
  const double a = 10 - 10 * slope, b = 10 + 10 * slope;
  add_quad(soup, {0, a, 0}, {20, b, 0}, {20, b, 20}, {0, a, 20});
  return soup;
}

/// Colour factor and white highlight at cosine n between normal and view.
struct Light {
  double share, white;
};
Light light(double n) { return {0.2 + 0.7 * n, 0.2 * std::pow(std::max(0.0, 2 * n * n - 1), 20)}; }

/// Colour and transmittance accumulated front to back along a ray, in 255ths.
struct Ray {
  double through = 1;
  std::array<double, 3> sum{};
  void meet(const std::array<double, 3>& color, double alpha) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += through * alpha * color[c];
    through *= 1 - alpha;
  }
  void fog(double sigma, double length) { meet({1, 1, 1}, 1 - std::exp(-sigma * length)); }
};

/// Compares a pixel, which has straight alpha, with the ray.
void expect_pixel(const Image8& image, std::uint32_t x, std::uint32_t y, const Ray& ray, double tolerance = 2) {
  const std::uint8_t* p = image.pixel(x, y);
  const double alpha = 1 - ray.through;
  EXPECT_NEAR(p[3], 255 * alpha, tolerance) << x << " " << y;
  if (alpha < 0.02) return;
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(p[c] * alpha, 255 * ray.sum[c], tolerance) << x << " " << y << " " << c;
}

std::array<double, 3> lit_color(const std::array<double, 3>& color, const Light& l) {
  return {l.share * color[0] + l.white, l.share * color[1] + l.white, l.share * color[2] + l.white};
}

TEST_F(Translucent, TwoCrossingWallsInFogAreInOrderOnBothSides) {
  constexpr double sigma = 0.05, slope = 0.6, a = 0.5, b = 0.3;
  const Light l = light(1 / std::sqrt(1 + slope * slope));
  const auto red = lit_color({1, 0, 0}, l), blue = lit_color({0, 0, 1}, l);
  for (const bool fog : {true, false})
    for (const bool turned : {false, true}) {
      FramePacket packet = along_y();
      if (fog) packet.volumes = {volume_item(cube(), {{0, sigma}, {20, sigma}})};
      packet.meshes = {mesh_item(wall(slope), {1, 0, 0}, float(a), 1), mesh_item(wall(-slope), {0, 0, 1}, float(b), 2)};
      if (turned) std::swap(packet.meshes[0], packet.meshes[1]);
      const Image8 image = draw(packet, {}, std::string(fog ? "fog" : "clear") + (turned ? "_turned" : ""));
      for (std::uint32_t x = 24; x < 98; x += 3) {
        const double offset = (x + 0.5 - 60) * 0.25 * slope;  // offset of the red wall from y = 10
        if (std::fabs(offset) < 0.1) continue;
        const double first = 10 - std::fabs(offset), second = 10 + std::fabs(offset);
        const double s = fog ? sigma : 0;
        Ray ray;
        ray.fog(s, first);
        offset < 0 ? ray.meet(red, a) : ray.meet(blue, b);
        ray.fog(s, second - first);
        offset < 0 ? ray.meet(blue, b) : ray.meet(red, a);
        ray.fog(s, 20 - second);
        expect_pixel(image, x, 55, ray);
      }
      expect_pixel(image, 10, 55, {});
    }
}

TEST_F(Translucent, AClosedMeshIsBlendedTwice) {
  FramePacket packet = along_y();
  packet.meshes = {mesh_item(box_soup({5, 5, 5}, {15, 15, 15}), {0, 0.5f, 0}, 0.4f)};
  const auto green = lit_color({0, 0.5, 0}, light(1));
  Ray both, once;
  both.meet(green, 0.4), both.meet(green, 0.4);
  once.meet(green, 0.4);
  const Image8 whole = draw(packet, {}, "whole");
  expect_pixel(whole, 60, 60, both);
  expect_pixel(whole, 45, 70, both);
  expect_pixel(whole, 20, 60, {});
  // clipped: the inside is also visible and shaded
  packet.clip_planes = {{{0, 8, 0}, {0, 1, 0}}};
  expect_pixel(draw(packet, {}, "open"), 60, 60, once);
  packet.meshes[0].opacity = 1;
  const Image8 solid = draw(packet, {}, "solid");
  EXPECT_NEAR(depths()[60 * 120 + 60], 55, 1e-4);
  EXPECT_NEAR(solid.pixel(60, 60)[1], 255 * 0.65, 1);
  EXPECT_EQ(solid.pixel(60, 60)[3], 255);
  packet.meshes[0].is_clipped = false;
  draw(packet, {}, "unclipped");
  EXPECT_NEAR(depths()[60 * 120 + 60], 45, 1e-4);
}

TEST_F(Translucent, AnOpaqueSurfaceHidesLayersBehindItAndIsVisibleThroughThoseInFront) {
  const auto red = lit_color({1, 0, 0}, light(1));
  for (const double at : {6.0, 14.0}) {
    FramePacket packet = along_y();
    packet.isosurfaces = {{cube(), 10, {0.5f, 0.5f, 0.5f}}};
    mesh::TriangleSoup soup;
    add_quad(soup, {0, at, 0}, {20, at, 0}, {20, at, 20}, {0, at, 20});
    packet.meshes = {mesh_item(soup, {1, 0, 0}, 0.5f)};
    const Image8 image = draw(packet, {}, "mesh" + std::to_string(int(at)));
    const auto grey = lit_color({0.5, 0.5, 0.5}, light(1));
    Ray ray;
    if (at < 10) ray.meet(red, 0.5);
    ray.meet({std::min(1.0, grey[0]), std::min(1.0, grey[1]), std::min(1.0, grey[2])}, 1);
    expect_pixel(image, 60, 60, ray);
    // an unshaded slice instead of the mesh
    packet.meshes.clear();
    packet.slices = {slice_at(cube(), at, {1, 0, 0}, 0.5f)};
    Ray second;
    if (at < 10) second.meet({1, 0, 0}, 0.5);
    second.meet(grey, 1);
    expect_pixel(draw(packet, {}, "slice" + std::to_string(int(at))), 60, 60, second);
  }
}

TEST_F(Translucent, SlicesAndTranslucentIsosurfacesAreInOrder) {
  FramePacket packet = along_y();
  packet.isosurfaces = {{cube(), 10, {1, 1, 1}, 0.5f}};
  packet.volumes = {volume_item(cube(), {{0, 0.02}, {20, 0.02}})};
  packet.slices = {slice_at(cube(), 15, {0, 0, 1}, 0.7f, 2), slice_at(cube(), 5, {1, 0, 0}, 0.4f, 1)};
  const auto white = lit_color({1, 1, 1}, light(1));
  Ray ray;
  ray.fog(0.02, 5);
  ray.meet({1, 0, 0}, 0.4);
  ray.fog(0.02, 5);
  ray.meet(white, 0.5);
  ray.fog(0.02, 5);
  ray.meet({0, 0, 1}, 0.7);
  ray.fog(0.02, 5);
  expect_pixel(draw(packet, {}, "exact"), 60, 60, ray);
  // the fast raycast is replaced by exact rays if there are layers
  packet.isosurfaces.clear();
  RenderSettings settings{.fast = FastSettings{1, 1, -1, -1}};
  Ray without;
  without.fog(0.02, 5);
  without.meet({1, 0, 0}, 0.4);
  without.fog(0.02, 10);
  without.meet({0, 0, 1}, 0.7);
  without.fog(0.02, 5);
  expect_pixel(draw(packet, settings, "fast"), 60, 60, without);
}

/// Up to four layers are exact; of more, the fourth and all behind it are averaged as in passes.h.
TEST_F(Translucent, FourLayersAreExactAndFurtherOnesAreAveraged) {
  const std::vector<std::array<double, 3>> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
  const double alphas[] = {0.3, 0.4, 0.2, 0.5, 0.6, 0.7};
  const auto grid = cube();
  std::vector<SliceItem> all;
  for (std::size_t i = 0; i < 6; ++i)
    all.push_back(slice_at(grid, 2 + 3.0 * double(i), {float(colors[i][0]), float(colors[i][1]), float(colors[i][2])}, float(alphas[i]),
                           std::uint32_t(i + 1)));
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 6u}) {
    FramePacket packet = along_y();
    packet.slices.assign(all.begin(), all.begin() + std::ptrdiff_t(count));
    Ray ray;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, count > 4 ? 3 : 4); ++i) ray.meet(colors[i], alphas[i]);
    if (count > 4) {
      double weight = 0, through = 1;
      std::array<double, 3> mean{};
      for (std::size_t i = 3; i < count; ++i) {
        const double w = -std::log(1 - alphas[i]);
        weight += w;
        through *= 1 - alphas[i];
        for (std::size_t c = 0; c < 3; ++c) mean[c] += w * colors[i][c];
      }
      for (double& m : mean) m /= weight;
      ray.meet(mean, 1 - through);
    }
    const Image8 image = draw(packet, {}, std::to_string(count));
    expect_pixel(image, 60, 60, ray, 1.5);
    std::reverse(packet.slices.begin(), packet.slices.end());
    EXPECT_LE(max_difference(image, draw(packet)), 1) << count;
    // with a distant mesh the layer count changes, the colours do not
    mesh::TriangleSoup aside;
    add_quad(aside, {-4, 3, 8}, {-3, 3, 8}, {-3, 3, 12}, {-4, 3, 12});
    packet.meshes = {mesh_item(aside, {1, 1, 1}, 0.5f, 99)};
    expect_pixel(draw(packet, {}, std::to_string(count) + "_mesh"), 60, 60, ray, 1.5);
  }
}

TEST_F(Translucent, CoincidentLayersAreBothBlended) {
  const auto grid = cube();
  for (const bool turned : {false, true}) {
    FramePacket packet = along_y();
    packet.slices = {slice_at(grid, 10, {1, 0, 0}, 0.5f, 1), slice_at(grid, 10, {0, 1, 0}, 0.5f, 2)};
    if (turned) std::swap(packet.slices[0], packet.slices[1]);
    const Image8 image = draw(packet, {}, turned ? "turned" : "same");
    int off = 0;
    for (std::uint32_t y = 21; y < 99; ++y)
      for (std::uint32_t x = 21; x < 99; ++x) off += std::abs(image.pixel(x, y)[3] - 191) > 1;
    EXPECT_EQ(off, 0) << turned;
  }
}

/// Without translucent objects there are neither layers nor a raycast.
TEST_F(Translucent, LayersExistOnlyWithTranslucentObjects) {
  const auto has = [&](const char* name) {
    const auto passes = renderer_->stats().passes;
    return std::find(passes.begin(), passes.end(), name) != passes.end();
  };
  FramePacket packet = along_y();
  packet.slices = {slice_at(cube(), 10, {1, 0, 0}, 1)};
  packet.meshes = {mesh_item(wall(0.5), {1, 0, 0}, 1)};
  draw(packet);
  EXPECT_TRUE(has("slices") && has("meshes"));
  EXPECT_FALSE(has("layers") || has("raycast"));
  const std::uint64_t before = renderer_->stats().gpu_bytes;
  packet.slices[0].opacity = 0.5f;
  draw(packet);
  EXPECT_TRUE(has("layers") && has("meshes"));
  EXPECT_FALSE(has("slices"));
  packet.meshes[0].opacity = 0;
  packet.slices[0].opacity = 0;
  const Image8 nothing = draw(packet, {}, "nothing");
  EXPECT_FALSE(has("layers") || has("slices") || has("meshes"));
  for (const std::uint8_t v : nothing.rgba) ASSERT_EQ(v, 0);
  // the contours of an invisible slice are visible
  packet.slices[0].contour_levels = {10};
  packet.slices[0].normal = {0, 0.6, 0.8};
  packet.slices[0].point = {10, 10, 10};
  packet.slices[0].line_width = 3;
  packet.slices[0].line_color = {1, 1, 1};
  const Image8 lines = draw(packet, {}, "lines");
  EXPECT_TRUE(has("layers"));
  EXPECT_EQ(lines.pixel(60, 60)[3], 255);
  EXPECT_EQ(lines.pixel(60, 52)[3], 0);
  packet.slices[0].opacity = 1;
  packet.meshes[0].opacity = 1;
  packet.slices[0].contour_levels.clear();
  packet.slices[0].point = {0, 10, 0};
  packet.slices[0].normal = {0, 1, 0};
  draw(packet);
  const std::uint64_t rounding = uses_lavapipe() ? 0 : 1 << 16;  // alignment of a GPU's images
  EXPECT_LE(renderer_->stats().gpu_bytes, before + 16 * 120 * 120 + rounding) << "the target of the raycast alone stays";
}

/// A window of the frustum draws the corresponding part of the image.
TEST_F(Translucent, AWindowShowsItsPartOfTheImage) {
  FramePacket packet = make_packet({-14, -30, 26}, {10, 10, 10}, 40);
  packet.volumes = {volume_item(cube(), {{0, 0.02}, {20, 0.05}})};
  packet.meshes = {mesh_item(sphere_soup(4, 7, {10, 10, 10}), {1, 0.4f, 0.1f}, 0.4f, 1)};
  packet.meshes[0].show_edges = true;
  SliceItem slice = slice_at(cube(), 10, {0, 1, 0}, 0.6f, 2);
  slice.normal = {0.2, 0.5, 0.8};
  slice.point = {10, 10, 10};
  slice.colors = {{0, 0, 0, 1}, {20, 1, 1, 0}};
  slice.contour_levels = {4, 8, 12, 16};
  packet.slices = {slice};
  const Image8 whole = draw(packet, {}, "whole");
  packet.width /= 2;
  packet.height /= 2;
  packet.view.window = {0, 1, 0, 1};  // right and upper half
  const Image8 part = draw(packet, {}, "part");
  EXPECT_LE(max_difference(part, whole, 80, 0), 3);
}

}  // namespace catena::test::translucent_test
