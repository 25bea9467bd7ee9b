// SPDX-License-Identifier: MIT
/// Estimated path length of exact rays where it is known: through a homogeneous box, into an opaque box, to a slab in empty space.
#include "render/quality/ray_path_length.h"

#include "tests/render/support/image_fixture.h"

namespace catena::render::ray_length_test {

constexpr int kEdge = 64;

/// Parallel rays along y through a cube of 64 voxels of edge 0.5, which fills the image; value = y, in voxels.
RayPathLength path_length_of(const std::vector<std::array<double, 2>>& extinctions, std::vector<Plane> clip = {}) {
  const int n = kEdge + 1;
  const auto grid = test::make_grid(
      {n, n, n}, [](const Vec3& index) { return index.y; }, field::Mapping::from_linear(Mat3(0.5), Vec3(0)));
  FramePacket packet = test::make_packet({16, -100, 16}, {16, 16, 16});
  test::set_size(packet, 256, 256);
  test::set_orthographic(packet, 31);
  packet.clip_planes = std::move(clip);
  packet.volumes.push_back(test::volume_item(grid, extinctions));
  return measure_ray_path_length(packet);
}

TEST(RayLength, MatchesTheMarchedLength) {
  constexpr double kRays = 256 * 256;
  const RayPathLength haze = path_length_of({{0, 0.001}, {64, 0.001}});
  EXPECT_NEAR(haze.marched / kRays, kEdge, 4);
  EXPECT_DOUBLE_EQ(haze.visible, haze.marched);
  // an opaque volume seen from y = 0 ends a ray at once
  EXPECT_NEAR(path_length_of({{0, 100}, {64, 100}}).marched / kRays, 2, 1);
  // the last eight voxels are visible, the brick before them is sampled, the rest is skipped
  const RayPathLength slab = path_length_of({{55.99, 0}, {56, 0.01}, {64, 0.01}});
  EXPECT_NEAR(slab.visible / kRays, 8, 2);
  EXPECT_NEAR(slab.marched / kRays, 14, 3);
  EXPECT_NEAR(path_length_of({{0, 0.001}, {64, 0.001}}, {{{0, 24, 0}, {0, 1, 0}}}).marched / kRays, kEdge / 4., 3);
}

}  // namespace catena::render::ray_length_test
