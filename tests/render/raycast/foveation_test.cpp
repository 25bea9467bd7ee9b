// SPDX-License-Identifier: MIT
/// Foveated rendering: unchanged within the fovea, interpolated from fewer rays far from it.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::foveation_test {

using namespace catena::render;

class Foveation : public ImageTest {
 protected:
  void SetUp() override {
    ImageTest::SetUp();
    const auto grid =
        make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(1.1 * p.x) * std::cos(0.9 * p.y + 0.8 * p.z); });
    packet_ = make_packet({40, -6, 30}, {23.5, 19.5, 21.5}, 80);
    set_size(packet_, 192, 144);
    packet_.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
  }
  static RenderSettings settings(std::uint32_t spacing, double half, double full) {
    RenderSettings out{.fast = FastSettings{1, spacing, half, full}};
    return out;
  }
  FramePacket packet_;
};

struct Counts {
  int inside = 0, inside_other = 0;  ///< pixels in the fovea; those that differ from the fully refined image
  int outside = 0, outside_refined = 0,
      outside_interpolated = 0;  ///< pixels far from the fovea where the refined and the interpolated image differ
};

bool same(const Image8& a, const Image8& b, std::uint32_t x, std::uint32_t y) {
  return std::equal(a.pixel(x, y), a.pixel(x, y) + 4, b.pixel(x, y));
}

TEST_F(Foveation, RefinesTheFoveaAndNotFarFromIt) {
  for (const auto& [spacing, half, full] : {std::tuple{2u, 0.0, 0.3}, std::tuple{4u, 0.3, 0.3}}) {
    const Image8 refined = draw(packet_, settings(spacing, half, full), "everywhere");
    const Image8 rough = draw(packet_, settings(spacing, half > 0 ? -1 : 0, -1), "nowhere");
    for (const auto& [right, up] : {std::pair{0.0, 0.0}, std::pair{0.5, -0.3}}) {
      RenderSettings some = settings(spacing, half, full);
      some.fast->fovea_tangent = std::tan(12 * M_PI / 180);
      some.fast->gaze_right = right;
      some.fast->gaze_up = up;
      const Image8 image = draw(packet_, some, right > 0 ? "gaze" : "middle");
      const Camera camera = make_camera(packet_.view, packet_.width, packet_.height, {});
      Counts c;
      for (const auto& [x, y] : pixels_of(packet_)) {
        const Vec3 d = pixel_ray(camera, x + 0.5, y + 0.5).direction;
        const double ahead = -dot(d, camera.back);
        const double off = std::hypot(dot(d, camera.right) / ahead - right, dot(d, camera.up) / ahead - up) / some.fast->fovea_tangent;
        // the block's centre decides for the whole block, on both lattices
        if (off < 0.6) {
          ++c.inside;
          c.inside_other += same(image, refined, x, y) ? 0 : 1;
        } else if (off > 2 && !same(refined, rough, x, y)) {
          ++c.outside;
          c.outside_refined += same(image, refined, x, y) ? 1 : 0;
          c.outside_interpolated += same(image, rough, x, y) ? 1 : 0;
        }
      }
      EXPECT_GT(c.inside, 300) << spacing << " " << right;
      EXPECT_EQ(c.inside_other, 0) << spacing << " " << right;
      EXPECT_GT(c.outside, 2000);
      EXPECT_GT(c.outside_interpolated, c.outside / (spacing == 2 ? 3 : 8)) << "of two levels one may be refined";
      EXPECT_LT(c.outside_refined, c.outside * 2 / 3);
    }
  }
}

TEST_F(Foveation, WithoutAFoveaOrAnglesTheImageIsUnchanged) {
  set_orthographic(packet_, 40);
  const Image8 plain = draw(packet_, settings(2, 0, 0.3), "flat");
  RenderSettings some = settings(2, 0, 0.3);
  some.fast->fovea_tangent = 0.1;
  EXPECT_EQ(max_difference(draw(packet_, some, "flat_fovea"), plain), 0);
}

}  // namespace catena::test::foveation_test
