// SPDX-License-Identifier: MIT
/// Light that arrives in the cells, against closed forms: Beer's law, a half space, empty space; and what casts shadows.
#include <gtest/gtest.h>

#include <cmath>

#include "render/light/light_sweep.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::light_sweep_test {

using namespace catena::render;

LightCells make_cells(int x, int y, int z, float extinction = 0) {
  LightCells cells;
  cells.edge = 0.1;
  cells.size = {x, y, z};
  cells.extinction.assign(cells.count(), extinction);
  return cells;
}

TEST(LightSweep, ASlabAttenuatesByBeersLaw) {
  const LightCells cells = make_cells(40, 30, 50, 0.8f);
  for (const Vec3& to : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.3, 0.2, 1), Vec3(-0.2, 0.1, 1)}) {
    const Vec3 l = direction(to);
    const std::vector<float> light = sweep_light(cells, l);
    // from the middle of the cells the light leaves through the face of the main axis
    const int k = 5;
    const int x = l.x == 1 ? 39 - k : 20, y = l.y == -1 ? k : 15, z = l.z > 0.5 ? 49 - k : l.z < -0.5 ? k : 25;
    const double length = (k + 0.5) * 0.1 / std::max({std::fabs(l.x), std::fabs(l.y), std::fabs(l.z)});
    EXPECT_NEAR(light[cells.index(x, y, z)], std::exp(-0.8 * length), 1e-5) << to.x << to.y << to.z;
  }
}

// Behind the edge of an opaque half plane the share is the part of the disc that is seen.
TEST(LightSweep, APenumbraIsAsWideAsTheLight) {
  LightCells cells = make_cells(100, 20, 60);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 50; ++x) cells.extinction[cells.index(x, y, 50)] = 200;
  constexpr double kSize = 20;
  const std::vector<float> light = sweep_light(cells, {0, 0, 1}, kSize);
  const double height = 4.0, radius = height * std::tan(0.5 * kSize * M_PI / 180);
  for (int x = 30; x < 70; x += 2) {
    const double d = std::clamp((0.1 * (x + 0.5) - 5.0) / radius, -1.0, 1.0);  // of the edge from the middle of the disc
    const double seen = 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / M_PI;
    EXPECT_NEAR(light[cells.index(x, 10, 10)], seen, 0.12) << x;
  }
}

TEST(LightSweep, NothingIsDarkInEmptySpace) {
  const LightCells cells = make_cells(9, 7, 8);
  const auto environment = sweep_environment(cells, 1);
  for (const float share : environment[0]) EXPECT_NEAR(share, 1, 1e-5);
  for (const float share : sweep_light(cells, direction(Vec3(1, -2, 3)))) EXPECT_NEAR(share, 1, 1e-5);
}

// At the height h over an opaque plane 1/2 of the environment and E2(h / reach) / 2 of the rest are lost.
TEST(LightSweep, AHalfSpaceTakesHalfOfTheEnvironment) {
  LightCells cells = make_cells(96, 96, 40);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) cells.extinction[cells.index(x, y, 0)] = 100;
  const auto e2 = [](double x) {
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) sum += std::exp(-x / ((i + 0.5) / kSteps)) / kSteps;  // over the cosine
    return sum;
  };
  for (const double reach : {0.5, 1.0}) {
    const std::vector<float> light = sweep_environment(cells, reach)[0];
    for (const int height : {1, 3, 6})
      EXPECT_NEAR(light[cells.index(48, 48, height)], 1 - 0.5 * e2((height - 0.5) * 0.1 / reach), 0.03) << reach << " " << height;
  }
}

TEST(LightCells, MeanExtinctionOfAVolume) {
  FramePacket packet;
  const auto grid = make_grid({33, 33, 33}, [](const Vec3& p) { return p.x; });
  packet.volumes.push_back({grid, {{{0, 1, 1, 1}}, {{0, 0}, {32, 3.2}}, {}}});
  packet.illumination.bounds = grid->world_bounds();
  const LightCells whole = make_light_cells(packet);
  ASSERT_GT(whole.edge, 0);
  double sum = 0;
  for (const float v : whole.extinction) sum += double(v);
  EXPECT_NEAR(sum / (33 * 33 * 33), 1.6, 0.1);
  // what is cut away casts nothing
  packet.clip_planes = {{Vec3(16.5, 0, 0), Vec3(1, 0, 0)}};
  const LightCells cut = make_light_cells(packet);
  double left = 0, right = 0;
  for (int z = 0; z < cut.size.z; ++z)
    for (int y = 0; y < cut.size.y; ++y)
      for (int x = 0; x < cut.size.x; ++x)
        (cut.lo.x + cut.edge * (x + 0.5) < 16 ? left : right) += double(cut.extinction[cut.index(x, y, z)]);
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 0.5 * sum);
}

// No light passes between the cells of a closed surface, from any direction.
TEST(LightCells, ASurfaceIsTight) {
  FramePacket packet;
  const auto grid = make_grid({48, 48, 48}, [](const Vec3& p) { return 20.3 - norm(p - Vec3(23.5)); });
  packet.isosurfaces.push_back({grid, 0, {1, 1, 1}});
  packet.illumination.bounds = grid->world_bounds();
  const LightCells cells = make_light_cells(packet);
  const Vec3 middle = (Vec3(23.5) - cells.lo) / cells.edge;
  for (const Vec3& to : {Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, 0, -1), Vec3(-1, 2, 3), Vec3(-3, -1, 0.5)})
    EXPECT_LT(sweep_light(cells, direction(to))[cells.index(int(middle.x), int(middle.y), int(middle.z))], 0.02) << to.x;
}

// A symmetric volume receives the same light from opposite sides.
TEST(LightCells, LightIsSymmetric) {
  FramePacket packet;
  const auto grid = make_grid({32, 32, 32}, [](const Vec3& p) { return std::fabs(p.z - 15.5) < 8 ? 1 : 0; });
  packet.volumes.push_back(volume_item(grid, {{0, 0}, {1, 0.1}}));
  packet.illumination.bounds = grid->world_bounds();
  const LightCells cells = make_light_cells(packet);
  ASSERT_NEAR(cells.edge, 1, 1e-12);
  const std::vector<float> above = sweep_light(cells, {0, 0, 1}), below = sweep_light(cells, {0, 0, -1});
  const int first = int(-cells.lo.z), middle = int(16 - cells.lo.x);  // cell of voxel 0
  for (int z = 0; z < 32; ++z) {
    const float share = above[cells.index(middle, middle, first + z)];
    EXPECT_NEAR(share, below[cells.index(middle, middle, first + 31 - z)], 1e-5) << z;
    EXPECT_NEAR(share, std::exp(-0.1 * std::clamp(23.5 - z, 0.0, 16.0)), 1e-3) << z;
  }
}

TEST(LightCells, SurfacesAreOpaqueAndThinTubesAreNot) {
  FramePacket packet;
  packet.meshes.push_back({square_at(0, 2), {1, 1, 1}});
  packet.tubes.push_back({{{-2, 1, 0}, {2, 1, 0}}, 0.005, {1, 1, 1}});
  packet.illumination.bounds = {Vec3(-2, -1, -2), Vec3(2, 2, 2)};
  const LightCells cells = make_light_cells(packet);
  const auto at = [&](const Vec3& p) {
    const Vec3 cell = (p - cells.lo) / cells.edge;
    return double(cells.extinction[cells.index(int(cell.x), int(cell.y), int(cell.z))]);
  };
  EXPECT_GT(at({0.3, 0.001, 0.7}) * cells.edge, 5);
  EXPECT_EQ(at({0.3, 0.5, 0.7}), 0);
  // the tube covers 2 r / edge of a cell's face
  EXPECT_NEAR(1 - std::exp(-at({0.3, 1, 0}) * cells.edge), 0.01 / cells.edge, 0.15 * 0.01 / cells.edge);
}

}  // namespace catena::test::light_sweep_test
