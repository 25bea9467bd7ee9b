// SPDX-License-Identifier: MIT
/// A voxel of 1e20 among values from 0 to 1 changes only its own cells: neither 16-bit texels nor 8-bit codes are scaled to it.
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::raycast_outliers_test {

using namespace catena::render;

class RaycastOutliers : public ImageTest {};

int different_pixels(const Image8& a, const Image8& b) {
  int count = 0;
  for (const auto& [x, y] : pixels_of(a)) count += std::abs(a.pixel(x, y)[3] - b.pixel(x, y)[3]) > 8;
  return count;
}

TEST_F(RaycastOutliers, AnOutlierChangesOnlyItsOwnCells) {
  const auto wave = [](const Vec3& p) { return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.3 * p.z); };
  const auto clean = make_grid({24, 24, 24}, wave);
  RenderSettings fast{.fast = FastSettings{1, 1, -1, -1}};
  for (const double outlier : {1e20, -9999.0}) {
    const auto spoiled = make_grid({24, 24, 24}, [&](const Vec3& p) { return p.x == 4 && p.y == 5 && p.z == 20 ? outlier : wave(p); });
    for (const bool shade : {false, true})
      for (const bool exact : {true, false}) {
        FramePacket packet = make_packet({60, -40, 45}, {11.5, 11.5, 11.5});
        packet.volumes = {volume_item(clean, {{0, 0}, {1, 0.3}})};
        packet.volumes[0].is_shaded = shade;
        const RenderSettings settings = exact ? RenderSettings{} : fast;
        const Image8 expected = draw(packet, settings);
        packet.volumes[0].grid = spoiled;
        // the outlier's cells are two voxels wide, a fiftieth of the box's image
        EXPECT_LT(different_pixels(draw(packet, settings, exact ? "exact" : "fast"), expected), 250) << outlier << shade << exact;
      }
  }
}

}  // namespace catena::test::raycast_outliers_test
