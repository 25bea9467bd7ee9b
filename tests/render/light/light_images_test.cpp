// SPDX-License-Identifier: MIT
/// Shadows, ambient occlusion and the environment in images: known places, both ways to draw volumes, what does not change.
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::light_images_test {

using namespace catena::render;

class LightImages : public ImageTest {
 protected:
  /// A floor at y = 0, seen along +y, with a smaller square one unit in front of it: 0.1 units per pixel, lit from the right.
  static FramePacket floor_packet() {
    FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
    packet.background = {0, 0, 0, 1};
    set_size(packet, 60, 60);
    set_orthographic(packet, 6);
    packet.meshes.push_back({square_at(0, 2.5), {0.5f, 0.5f, 0.5f}});
    packet.meshes.push_back({square_at(-1, 0.5), {0.5f, 0.5f, 0.5f}});
    packet.lights = {{{0.6, -1, 0}, {1, 1, 1}, false}};
    packet.illumination.bounds = {Vec3(-2.5, -1, -2.5), Vec3(2.5, 0, 2.5)};
    return packet;
  }
  /// Returns the red channel at a point of the floor.
  static int at(const Image8& image, double x, double z) { return image.pixel(std::uint32_t(30 + 10 * x), std::uint32_t(30 - 10 * z))[0]; }
  /// Returns the root mean square of the differences of two images, over all channels.
  static double rmse(const Image8& a, const Image8& b) {
    double sum = 0;
    for (std::uint32_t y = 0; y < a.height; ++y)
      for (std::uint32_t x = 0; x < a.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const double d = double(a.pixel(x, y)[c]) - double(b.pixel(x, y)[c]);
          sum += d * d;
        }
    return std::sqrt(sum / (3.0 * a.width * a.height));
  }
};

TEST_F(LightImages, AShadowFallsAwayFromTheLight) {
  FramePacket packet = floor_packet();
  const Image8 open = draw(packet, {}, "open");
  packet.illumination.shadows = true;
  const Image8 cast = draw(packet, {}, "cast");
  EXPECT_NEAR(at(cast, -0.85, 0), 0.2 * 0.5 * 255, 6);
  EXPECT_NEAR(at(open, -0.85, 0), at(open, 1.5, 0), 1);
  for (const double x : {-2.0, -1.5, 1.5, 2.0}) EXPECT_NEAR(at(cast, x, 0), at(open, x, 0), 4) << x;
  EXPECT_NEAR(at(cast, 0, 0), at(open, 0, 0), 4);  // the small square itself
  // what is cut away casts nothing
  packet.clip_planes = {{Vec3(0, -0.5, 0), Vec3(0, 1, 0)}};
  EXPECT_NEAR(at(draw(packet, {}, "cut"), -0.85, 0), at(open, 1.5, 0), 4);
}

TEST_F(LightImages, OcclusionDarkensWhatIsEnclosed) {
  FramePacket packet = floor_packet();
  packet.meshes[1].geometry = square_at(-0.5, 1.2);
  packet.lights = {{{0, 0, 1}, {0, 0, 0}, true}};
  packet.illumination.sky = packet.illumination.ground = {0.8f, 0.8f, 0.8f};
  const Image8 plain = draw(packet, {}, "environment");
  EXPECT_NEAR(at(plain, -0.7, 0), 0.8 * 0.5 * 255, 1);
  packet.illumination.occlusion_reach = 1;
  const Image8 occluded = draw(packet, {}, "occluded");
  EXPECT_LT(at(occluded, 1.3, 0), at(occluded, 2.3, 0) - 12);
  EXPECT_NEAR(at(occluded, -2.2, 2.2), at(plain, -2.2, 2.2), 10);
  packet.illumination.sky = {0.2f, 0.2f, 0.2f};
  packet.illumination.occlusion_reach = 0;
  EXPECT_NEAR(at(draw(packet, {}, "mixed"), -0.7, 0), 0.5 * 0.5 * 255, 1);  // the floor faces the horizon
}

// A convex surface is not darkened by itself, however it lies in the cells.
TEST_F(LightImages, AConvexSurfaceDoesNotDarkenItself) {
  const auto grid = make_grid({48, 48, 48}, [](const Vec3& p) { return 20.3 - norm(p - Vec3(23.5)); });
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 1), Vec3(-1, 2, -1)}) {
    FramePacket packet = make_packet(Vec3(23.5) + 90.0 * direction(side), {23.5, 23.5, 23.5});
    packet.background = {0, 0, 0, 1};
    set_size(packet, 64, 64);
    set_orthographic(packet, 48);
    packet.isosurfaces.push_back({grid, 0, {1, 1, 1}});
    packet.illumination.bounds = grid->world_bounds();
    packet.lights = {{side, {1, 1, 1}, false}};
    const Image8 open = draw(packet);
    packet.illumination.shadows = true;
    packet.illumination.occlusion_reach = 8;
    const Image8 lit = draw(packet);
    int least = 255;
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 64; ++x)
        if (std::hypot(x - 31.5, y - 31.5) < 0.75 * 20.3 * 64 / 48) least = std::min(least, 255 + lit.pixel(x, y)[0] - open.pixel(x, y)[0]);
    EXPECT_GE(least, 255 - 13) << side.x << side.y << side.z;
  }
}

TEST_F(LightImages, BothRaycastsReceiveTheSameLight) {
  const auto grid = make_grid({40, 40, 40}, [](const Vec3& p) { return std::max(0.0, 1 - norm(p - Vec3(19.5)) / 18); });
  for (const bool is_shaded : {false, true}) {
    FramePacket packet = make_packet({60, -60, 40}, {19.5, 19.5, 19.5});
    packet.background = {0, 0, 0, 1};
    set_size(packet, 96, 96);
    packet.volumes.push_back(volume_item(grid, {{0, 0}, {1, 0.3}}));
    packet.volumes.back().is_shaded = is_shaded;
    packet.lights = {{{1, 0.3, 1}, {1, 0.9f, 0.8f}, false}};
    const Image8 open = draw(packet, {}, is_shaded ? "shaded_open" : "plain_open");
    packet.illumination.bounds = grid->world_bounds();
    packet.illumination.shadows = true;
    packet.illumination.occlusion_reach = 8;
    RenderSettings fast;
    fast.fast.emplace();
    const std::string name = is_shaded ? "shaded_" : "plain_";
    const Image8 exact_image = draw(packet, {}, name + "exact"), fast_image = draw(packet, fast, name + "fast");
    EXPECT_LT(rmse(exact_image, fast_image), 1.5) << name;
    EXPECT_GT(rmse(exact_image, open), 8) << name;
  }
}

// A camera or a hand that moves rebuilds nothing; without light from elsewhere the image is that of a scene without it.
TEST_F(LightImages, LightThatIsTurnedOffLeavesNoTrace) {
  FramePacket packet = floor_packet();
  const Image8 before = draw(packet, {}, "before");
  packet.illumination.shadows = true;
  draw(packet, {}, "between");
  packet.illumination.shadows = false;
  EXPECT_EQ(rmse(draw(packet, {}, "after"), before), 0);
}

}  // namespace catena::test::light_images_test
