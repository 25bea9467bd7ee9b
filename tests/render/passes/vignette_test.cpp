// SPDX-License-Identifier: MIT
/// The comfort vignette: every pixel against its viewing angle, also for off-axis eyes.
#include <cmath>

#include "render/frame/camera.h"
#include "render/passes/passes.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::vignette_test {

using namespace catena::render;

class VignetteImage : public ImageTest {};

FramePacket packet_of(double strength) {
  FramePacket packet = make_packet({0, -3, 0}, {0, 0, 0}, 90);
  set_size(packet, 64, 48);
  packet.background = {1, 0.8f, 0.6f, 1};
  packet.vignette = strength;
  return packet;
}

TEST_F(VignetteImage, DarkensByTheAngleFromTheViewAxis) {
  for (const double shift : {0.0, 0.5}) {
    FramePacket packet = packet_of(0.75);
    packet.view.window = {-1 + shift, 1 + shift, -1, 1};  // an off-axis eye
    const Image8 image = draw(packet, {}, "vignette");
    const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
    const Vec3 axis = -camera.back;
    int inside = 0, between = 0, outside = 0;
    for (const auto& [x, y] : pixels_of(packet)) {
      const double angle = std::acos(std::min(1.0, dot(axis, pixel_ray(camera, x + 0.5, y + 0.5).direction)));
      const double inner = std::tan(kVignetteInner_deg * M_PI / 180), outer = std::tan(kVignetteOuter_deg * M_PI / 180);
      const double t = std::clamp((std::tan(angle) - inner) / (outer - inner), 0.0, 1.0), light = 1 - 0.75 * t * t * (3 - 2 * t);
      (t <= 0 ? inside : t >= 1 ? outside : between) += 1;
      const std::uint8_t* found = image.pixel(x, y);
      ASSERT_NEAR(found[0], 255 * light, 1.01) << x << " " << y;
      ASSERT_NEAR(found[2], 255 * 0.6 * light, 1.01);
      ASSERT_EQ(found[3], 255);
    }
    EXPECT_GT(inside, 40);
    EXPECT_GT(between, 200);
    EXPECT_GT(outside, 800);
  }
}

TEST_F(VignetteImage, WithoutAVignetteOrAnglesTheImageIsUnchanged) {
  const Image8 plain = draw(packet_of(0), {}, "vignette_none");
  EXPECT_EQ(plain.pixel(0, 0)[0], 255);
  FramePacket flat = packet_of(1);
  flat.view.orthographic = true;
  EXPECT_EQ(draw(flat, {}, "vignette_flat").pixel(0, 0)[0], 255);
}

}  // namespace catena::test::vignette_test
