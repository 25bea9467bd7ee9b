// SPDX-License-Identifier: MIT
/// Label maps in images: no colours other than the labels', grids with different transforms, order of coplanar slices.
#include <algorithm>
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::labels_test {

using namespace catena::render;

class LabelImage : public ImageTest {};

using Rgb = std::array<int, 3>;

/// Labels with distant numbers and unordered colours, so that a blend of two is detected.
constexpr double kLabels[] = {0, 3, 40, 41, 2035, 14175};
constexpr Rgb kRgb[] = {{0, 0, 0}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 0}, {0, 255, 255}};

std::vector<std::array<double, 4>> label_rows() {
  std::vector<std::array<double, 4>> rows;
  for (std::size_t i = 1; i < std::size(kLabels); ++i)
    for (const double end : {-0.5, 0.5}) rows.push_back({kLabels[i] + end, kRgb[i][0] / 255.0, kRgb[i][1] / 255.0, kRgb[i][2] / 255.0});
  return rows;
}

std::size_t label_index(const Vec3& p) { return std::size_t(7 * int(p.x) + 5 * int(p.y) + 3 * int(p.z) + int(p.x) * int(p.y)) % 6; }

GridPtr label_grid(const field::Mapping& mapping = {}, const field::Index3& n = {14, 12, 13}) {
  return make_grid(
             n, [](const Vec3& p) { return kLabels[label_index(p)]; }, mapping)
      ->with_interpolation(field::Interpolation::nearest);
}

field::Mapping turned() {
  const Mat3 turn = Mat3(Vec3(0.8, 0.6, 0.0), Vec3(-0.6, 0.8, 0.0), Vec3(0.0, 0.0, 1.0));
  return field::Mapping::from_linear(turn * Mat3(Vec3(1.1, 0, 0), Vec3(0, 0.9, 0), Vec3(0, 0, 1.3)), {5, -3, 2});
}

Vec3 middle(const field::ScalarGrid& grid) {
  return grid.mapping().world_from_index(0.5 * grid.index_box().lo + 0.5 * grid.index_box().hi);
}

Rgb rgb(const Image8& image, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

SliceItem slice_of(const GridPtr& grid, const Vec3& normal) {
  SliceItem item{grid, middle(*grid) + Vec3(0.07, 0.03, 0.11), normal, label_rows()};
  item.hidden_label = 0;
  return item;
}

TEST_F(LabelImage, ASliceHasTheColorOfTheNearestVoxelInEveryPixel) {
  const auto grid = label_grid(turned());
  FramePacket packet = make_packet(middle(*grid) + Vec3(12, -25, 20), middle(*grid));
  packet.slices = {slice_of(grid, {0.3, -0.5, 0.8})};
  const Image8 image = draw(packet, {}, "slice");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  int seen = 0, empty = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const SliceItem& item = packet.slices[0];
    const Vec3 world = ray.origin + dot(item.normal, item.point - ray.origin) / dot(item.normal, ray.direction) * ray.direction;
    const Vec3 index = grid->mapping().index_from_world(world);
    const Rgb got = rgb(image, x, y);
    const bool drawn = image.pixel(x, y)[3] > 0;
    ASSERT_TRUE(!drawn || std::count(std::begin(kRgb), std::end(kRgb), got) == 1) << "a colour of no label";
    // within a thousandth of a face float rounding decides
    bool sure = true, inside = true;
    for (int a = 0; a < 3; ++a) {
      sure = sure && std::fabs(index[a] - std::floor(index[a]) - 0.5) > 1e-3;
      inside = inside && index[a] > grid->index_box().lo[a] && index[a] < grid->index_box().hi[a];
      sure = sure && std::fabs(index[a] - grid->index_box().lo[a]) > 1e-2 && std::fabs(index[a] - grid->index_box().hi[a]) > 1e-2;
    }
    if (!sure) continue;
    const std::size_t label = inside ? label_index({std::round(index.x), std::round(index.y), std::round(index.z)}) : 0;
    ASSERT_EQ(drawn, label != 0) << x << " " << y;
    label != 0 ? ++seen : ++empty;
    ASSERT_TRUE(!drawn || got == kRgb[label]) << x << " " << y;
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(empty, 2000);
}

TEST_F(LabelImage, AVolumeDoesNotBlendColorsBetweenLabels) {
  const auto grid = make_grid({14, 12, 13}, [](const Vec3& p) {
                      return std::min(kLabels[label_index(p)], 6000.0);
                    })->with_interpolation(field::Interpolation::nearest);
  FramePacket packet = make_packet(middle(*grid) + Vec3(12, -25, 20), middle(*grid));
  VolumeItem item;
  item.grid = grid;
  item.transfer.is_categorical = true;
  item.transfer.extinctions = {{0.4, 0}, {0.6, 1e4}};
  // unlabelled voxels are green
  for (const double label : {3.0, 40.0, 41.0, 2035.0, 6000.0}) {
    const double red = label == 40 ? 0 : 1;
    item.transfer.colors.insert(
        item.transfer.colors.end(),
        {{label - 0.5, 0, 1, 0}, {label - 0.5, red, 0, 1 - red}, {label + 0.5, red, 0, 1 - red}, {label + 0.5, 0, 1, 0}});
  }
  packet.volumes = {item};
  const Image8 image = draw(packet, {}, "volume");
  int seen = 0, red = 0, blue = 0, green = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const Rgb got = rgb(image, x, y);
    seen += image.pixel(x, y)[3] == 255;
    red += got[0] > 200;
    blue += got[2] > 200;
    green = std::max(green, got[1]);
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(red, 1000);
  EXPECT_GT(blue, 300);
  EXPECT_EQ(green, 0);
}

TEST_F(LabelImage, TheSurfaceOfALabelHasNoColorOfItsNeighbors) {
  const field::Index3 n{16, 16, 16};
  const auto map = make_grid(n, [](const Vec3& p) { return p.x < 7.5 ? 41.0 : 40.0; })->with_interpolation(field::Interpolation::nearest);
  const auto inside = make_grid(n, [](const Vec3& p) { return p.x < 7.5 ? 0.0 : 1.0; });
  FramePacket packet = make_packet({-30, 7.5, 7.5}, {7.5, 7.5, 7.5});
  ColorSource colors{map, label_rows(), true, true};
  colors.labels = {40};
  packet.isosurfaces = {{inside, 0.5, {1, 0, 0}, 1, 1, true, colors}};
  const Image8 image = draw(packet, {}, "neighbors");
  int green = 0, others = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const Rgb got = rgb(image, x, y);
    green += got[1] > 100;
    others += got[0] > 60 || got[2] > 60;
  }
  EXPECT_GT(green, 500);
  EXPECT_EQ(others, 0) << "blue of the label in front of the surface";
}

/// A ball in one grid, coloured by labels of another, rotated grid: the colour depends on the half-space of the pixel's point.
TEST_F(LabelImage, ASurfaceIsColoredByAGridWithAnotherTransform) {
  const auto ball = make_grid(
      {40, 40, 40}, [](const Vec3& p) { return norm(p - Vec3(19.5)); }, field::Mapping::from_linear(Mat3(0.5), {-9.75, -9.75, -9.75}));
  const field::Mapping mapping = turned();
  const Vec3 centre = mapping.world_from_index(Vec3(19.5));
  const field::Mapping shifted = field::Mapping::from_linear(mapping.world_from_index_linear, mapping.origin - centre);
  const auto halves =
      make_grid(
          {40, 40, 40}, [&](const Vec3& p) { return shifted.world_from_index(p).x > 0   ? 41
                                                    : shifted.world_from_index(p).z > 2 ? 0
                                                                                        : 40; },
          shifted)
          ->with_interpolation(field::Interpolation::nearest);
  FramePacket packet = make_packet({0, -40, 0}, {0, 0, 0});
  packet.isosurfaces = {{ball, 14, {1, 0, 0}, 1, 1, true, ColorSource{halves, label_rows(), true, false}}};
  const Image8 image = draw(packet, {}, "turned");
  const std::vector<float> depth = depths();
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  int counts[3] = {0, 0, 0}, wrong = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const double t = depth[y * packet.width + x];
    if (!std::isfinite(t)) continue;
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const Vec3 world = ray.origin + t / dot(ray.direction, -camera.back) * ray.direction;
    field::Cursor cursor;
    const Vec3 index = shifted.index_from_world(world);
    bool sure = true;
    for (int a = 0; a < 3; ++a) sure = sure && std::fabs(index[a] - std::floor(index[a]) - 0.5) > 1e-2;
    if (!sure) continue;
    const double label = halves->sample(world, cursor).value;
    const Rgb got = rgb(image, x, y);
    const int channel = label == 41 ? 2 : label == 40 ? 1 : 0;
    ++counts[channel];
    wrong += got[std::size_t(channel)] < 40 || got[std::size_t(channel)] != *std::max_element(got.begin(), got.end());
  }
  for (const int count : counts) EXPECT_GT(count, 300);
  EXPECT_EQ(wrong, 0);
}

/// Of coplanar slices the later is on top, for any opacity and from both sides.
TEST_F(LabelImage, CoplanarSlicesAreDrawnInTheirOrder) {
  const auto one = make_grid({9, 9, 9}, [](const Vec3&) { return 1; });
  const auto two = make_grid(
      {17, 17, 17}, [](const Vec3&) { return 1; }, field::Mapping::from_linear(Mat3(0.5), Vec3(0.0)));
  for (const double side : {-1.0, 1.0})
    for (const bool first_opaque : {true, false}) {
      FramePacket packet = make_packet(Vec3(4.0) + Vec3(7, 9, 20 * side), Vec3(4.0));
      packet.background = {0, 0, 0, 1};
      SliceItem below{one, {0, 0, 4.3}, {0, 0, 1}, {{0, 1, 0, 0}}, first_opaque ? 1.f : 0.5f};
      SliceItem over{two, {3, 2, 4.3}, {0, 0, 1}, {{0, 0, 0, 1}}, 0.5f};
      over.stack_order = 1;
      below.id = 1;
      over.id = 2;
      packet.slices = {below, over};
      const Image8 image = draw(packet, {}, std::string(side > 0 ? "above" : "below") + (first_opaque ? "1" : "2"));
      int both = 0;
      for (const auto& [x, y] : pixels_of(packet)) {
        const Rgb got = rgb(image, x, y);
        if (got[0] == 0 || got[2] == 0) continue;
        ++both;
        ASSERT_NEAR(got[2], 128, 1) << x << " " << y;
        ASSERT_NEAR(got[0], first_opaque ? 128 : 64, 1) << x << " " << y;
      }
      EXPECT_GT(both, 1500);
    }
}

}  // namespace catena::test::labels_test
