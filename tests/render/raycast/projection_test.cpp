// SPDX-License-Identifier: MIT
/// Projections of a volume: the maximum, minimum and mean along every ray, against dense sampling in double precision.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::projection_test {

using namespace catena::render;

struct Found {
  double max_value = -HUGE_VAL, min_value = HUGE_VAL, mean = 0;
  bool any = false;
};

/// Values along the ray within the domain, in valid cells.
Found along(const field::ScalarGrid& grid, const Ray& ray) {
  const auto [enter, leave] = ray_interval(grid, ray.origin, ray.direction);
  Found found;
  if (!(enter < leave)) return found;
  const int steps = 3000;
  field::Cursor cursor;
  int count = 0;
  for (int k = 0; k < steps; ++k) {
    const auto sample = grid.sample(ray.origin + (enter + (k + 0.5) * (leave - enter) / steps) * ray.direction, cursor);
    if (!sample.inside) continue;
    found.max_value = std::max(found.max_value, sample.value);
    found.min_value = std::min(found.min_value, sample.value);
    found.mean += sample.value;
    ++count;
  }
  found.any = count > 0;
  found.mean /= std::max(1, count);
  return found;
}

double of(const Found& found, Projection projection) {
  return projection == Projection::maximum ? found.max_value : projection == Projection::minimum ? found.min_value : found.mean;
}

GridPtr rough_grid(const std::function<bool(const Vec3&)>& valid = nullptr) {
  return make_grid(
      {40, 36, 32},
      [](const Vec3& p) { return 0.5 + 0.2 * std::sin(0.9 * p.x) + 0.15 * std::cos(0.8 * p.y) * std::sin(0.7 * p.z + 0.3 * p.x); },
      field::Mapping::from_linear(Mat3(0.8, 0.3, 0, -0.4, 1.1, 0.2, 0.1, 0, 1.3), {-50, 40, 3}), valid);
}

/// Grey by value, with opacity 1/2 over half a unit everywhere.
VolumeItem grey_item(GridPtr grid, Projection projection) {
  VolumeItem item = volume_item(std::move(grid), {{0, std::log(4.0)}, {1, std::log(4.0)}});
  item.transfer.colors = {{0, 0, 0, 0}, {1, 1, 1, 1}};
  item.transfer.opacity_length = 0.5;
  item.projection = projection;
  return item;
}

const char* name_of(Projection projection) {
  return projection == Projection::maximum ? "maximum" : projection == Projection::minimum ? "minimum" : "average";
}

/// A view of the rough grid.
FramePacket packet_of(const field::ScalarGrid& grid) {
  const Vec3 centre = grid.mapping().world_from_index({19.5, 17.5, 15.5});
  return make_packet(centre + Vec3(70, -60, 50), centre, 32);
}

RenderSettings fine(double step) {
  RenderSettings settings{.texel_format = TexelFormat::r32f, .fast = {}};
  settings.step_voxels = step;
  return settings;
}

class ProjectionTest : public ImageTest {
 protected:
  /// Maximum difference of colours over rays that hit the volume; alpha is checked for all rays.
  double worst(const Image8& image, const FramePacket& packet, Projection projection, const field::ScalarGrid& grid) {
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    double worst = 0;
    int hits = 0, disagree = 0;
    for (const auto& [x, y] : pixels_of(packet, 2)) {
      const Found f = along(grid, pixel_ray(camera, x + 0.5, y + 0.5));
      const int alpha = image.pixel(x, y)[3];
      if (f.any != (alpha > 0)) {
        ++disagree;  // grazing rays
        continue;
      }
      if (!f.any) continue;
      EXPECT_NEAR(alpha, 127.5, 1);
      ++hits;
      worst = std::max(worst, std::fabs(image.pixel(x, y)[0] - 255 * of(f, projection)));
    }
    EXPECT_GT(hits, 500);
    EXPECT_LE(disagree, 2);
    return worst;
  }
};

TEST_F(ProjectionTest, ExtremesAreExactForAnyStep) {
  const auto grid = rough_grid();
  FramePacket packet = packet_of(*grid);
  RenderSettings settings = fine(4);
  for (const Projection projection : {Projection::maximum, Projection::minimum})
    for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
      settings.layout = layout;
      packet.volumes = {grey_item(grid, projection)};
      const Image8 image = draw(packet, settings, name_of(projection));
      EXPECT_LE(worst(image, packet, projection, *grid), 1.01) << name_of(projection);
    }
}

TEST_F(ProjectionTest, TheMeanMatchesTheMeanAlongTheRay) {
  const auto grid = rough_grid();
  FramePacket packet = packet_of(*grid);
  set_orthographic(packet, 60);
  packet.volumes = {grey_item(grid, Projection::average)};
  const Image8 image = draw(packet, fine(0.25), "average");
  EXPECT_LE(worst(image, packet, Projection::average, *grid), 1.01);
}

TEST_F(ProjectionTest, InvalidCellsAreIgnored) {
  const auto grid = rough_grid([](const Vec3& p) { return p.x < 26 || p.y < 12; });
  FramePacket packet = packet_of(*grid);
  for (const Projection projection : {Projection::maximum, Projection::average}) {
    packet.volumes = {grey_item(grid, projection)};
    const Image8 image = draw(packet, fine(0.05), name_of(projection));
    EXPECT_LE(worst(image, packet, projection, *grid), 2.01) << name_of(projection);
  }
}

TEST_F(ProjectionTest, EndsAtOpaqueObjectsAndClipPlanes) {
  // value y / 20 seen along y: maximum at the end of the ray, minimum at its start
  const auto grid = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y / 20; });
  FramePacket packet = square_packet_along_y(64, 16);
  packet.clip_planes = {{{0, 3, 0}, {0, 1, 0}}};
  const auto blocker = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y + 0.2 * (p.x - 10); });
  packet.isosurfaces = {{blocker, 14, {0, 0, 0}}};
  const double lambert = 1 / std::sqrt(1.04), mirrored = 2 * lambert * lambert - 1, behind = 0.2 * std::pow(mirrored, 20);
  for (const Projection projection : {Projection::maximum, Projection::minimum, Projection::average}) {
    packet.volumes = {grey_item(grid, projection)};
    const Image8 image = draw(packet, {}, name_of(projection));
    for (std::uint32_t x = 4; x < 64; x += 8) {
      const double world = 10 + (x + 0.5 - 32) * 0.25, end = 14 - 0.2 * (world - 10);
      const double value = projection == Projection::maximum ? end : projection == Projection::minimum ? 3 : 0.5 * (3 + end);
      EXPECT_NEAR(image.pixel(x, 32)[0], 255 * (0.5 * value / 20 + 0.5 * behind), 1.5) << name_of(projection) << x;
    }
  }
}

TEST_F(ProjectionTest, IsRefusedTogetherWithOtherVolumes) {
  const auto grid = make_grid({8, 8, 8}, [](const Vec3& p) { return p.x / 8; });
  FramePacket packet = make_packet({20, -20, 20}, {4, 4, 4});
  packet.volumes = {grey_item(grid, Projection::maximum), grey_item(grid, Projection::composite)};
  expect_refused(packet, "expected alone");
}

}  // namespace catena::test::projection_test
