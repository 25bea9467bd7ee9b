// SPDX-License-Identifier: MIT
/// The occluded cursor, against the blending formula of shaders/passes/compose.frag.
#include <algorithm>
#include <cmath>

#include "render/frame/camera.h"
#include "render/frame/tiles.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::occluded_overlay_test {

using namespace catena::render;

constexpr double kFace = 0.45;             // as in occluded_overlay.frag
constexpr double kLit = 0.9 * 0.95 + 0.2;  // the probe's white ball where it faces the camera (shaders/lib/lighting.glsl)
constexpr std::uint32_t kSide = 121, kMiddle = 60;
constexpr std::uint32_t kHand = 7, kBall = 3;

/// Orthographic view along +y, 0.25 units per pixel; the centre of pixel (60, 60) is at (16, y, 16).
FramePacket along_y() {
  FramePacket packet = make_packet({16, -40, 16}, {16, 0, 16});
  set_size(packet, kSide, kSide);
  set_orthographic(packet, 0.25 * kSide);
  packet.background = {0.1f, 0.2f, 0.3f, 1};
  return packet;
}

CursorItem hand(double y, bool ghost) {
  CursorItem item = cursor_item({16, y, 16}, 2);  // 8 pixels
  item.id = kHand;
  item.show_occluded = ghost;
  return item;
}

/// An opaque ball of radius 10 about (16, 16, 16).
IsosurfaceItem ball() {
  const auto grid = make_grid({33, 33, 33}, [](const Vec3& p) { return norm(p - Vec3(16)); });
  return {grid, 10.0, {0.4f, 0.4f, 0.4f}, 1.0f, kBall};
}

/// A volume with alpha 1 - exp(-extinction y) in front of y.
VolumeItem fog(double extinction) {
  return volume_item(make_grid({33, 33, 33}, [](const Vec3& p) { return p.x / 32; }), {{0, extinction}, {1, extinction}},
                     {0.2f, 0.5f, 0.9f});
}

FramePacket inside_ball(bool ghost) {
  FramePacket packet = along_y();
  packet.isosurfaces.push_back(ball());
  packet.cursors.push_back(hand(16, ghost));
  return packet;
}

class OccludedOverlay : public ImageTest {};

bool same_pixels(const std::uint8_t* a, const std::uint8_t* b, std::size_t count = 1) { return std::equal(a, a + 4 * count, b); }

TEST_F(OccludedOverlay, IsDrawnThroughASurfaceWithAnOutline) {
  FramePacket empty = inside_ball(false);
  empty.cursors.clear();
  const Image8 without = draw(empty), off = draw(inside_ball(false)), on = draw(inside_ball(true), {}, "inside");
  EXPECT_EQ(max_difference(without, off), 0);
  EXPECT_EQ(renderer_->stats().passes, (std::vector<std::string>{"cursor", "isosurfaces", "ghost", "compose"}));
  for (std::uint32_t c = 0; c < 3; ++c)
    EXPECT_NEAR(on.pixel(kMiddle, kMiddle)[c], 255 * kFace * kLit + (1 - kFace) * off.pixel(kMiddle, kMiddle)[c], 1.01);

  // outwards from half of the radius: the face, a bright and a dark ring
  const std::uint32_t face = kMiddle + 4;
  std::uint32_t brightest = face, darkest = face;
  for (std::uint32_t x = face; x < kMiddle + 8; ++x) {
    if (on.pixel(x, kMiddle)[0] > on.pixel(brightest, kMiddle)[0]) brightest = x;
    if (on.pixel(x, kMiddle)[0] < on.pixel(darkest, kMiddle)[0]) darkest = x;
  }
  EXPECT_GT(on.pixel(brightest, kMiddle)[0], on.pixel(face, kMiddle)[0] + 20);
  EXPECT_LT(on.pixel(darkest, kMiddle)[0], off.pixel(darkest, kMiddle)[0] - 30);
  EXPECT_GT(brightest, face);
  EXPECT_GT(darkest, brightest);

  // unchanged outside
  int changed = 0;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const bool differs = !same_pixels(on.pixel(x, y), off.pixel(x, y));
      changed += differs;
      if (differs) {
        EXPECT_LE(std::hypot(int(x) - int(kMiddle), int(y) - int(kMiddle)), 8.01);
      }
    }
  EXPECT_NEAR(changed, M_PI * 64, 12);
}

TEST_F(OccludedOverlay, DoesNotChangeAVisibleCursor) {
  for (const bool volume : {false, true}) {
    FramePacket packets[2];
    for (const bool ghost : {false, true}) {
      packets[ghost] = along_y();
      packets[ghost].cursors.push_back(hand(-4, ghost));
      if (volume)
        packets[ghost].volumes.push_back(fog(0.1));
      else
        packets[ghost].isosurfaces.push_back(ball());
    }
    EXPECT_EQ(max_difference(draw(packets[0]), draw(packets[1])), 0);
  }
}

TEST_F(OccludedOverlay, IsDrawnOnlyForCursorsWithTheOption) {
  FramePacket packet = inside_ball(false);
  draw(packet);
  EXPECT_EQ(renderer_->stats().passes, (std::vector<std::string>{"cursor", "isosurfaces", "compose"}));
  // only the cursor of two with the option
  packet.cursors[0].probe.x = 20;
  const Image8 one = draw(packet);
  packet.cursors.push_back(hand(16, true));
  packet.cursors[1].id = kHand + 1;
  const Image8 two = draw(packet, {}, "two");
  for (std::uint32_t x = kMiddle + 9; x < kMiddle + 30; ++x) EXPECT_TRUE(same_pixels(two.pixel(x, kMiddle), one.pixel(x, kMiddle)));
  EXPECT_FALSE(same_pixels(two.pixel(kMiddle, kMiddle), one.pixel(kMiddle, kMiddle)));
}

TEST_F(OccludedOverlay, IsDrawnThroughAVolumeByItsAlpha) {
  for (const double extinction : {0.02, 0.1, 1.0}) {
    FramePacket packet = along_y();
    packet.volumes.push_back(fog(extinction));
    packet.cursors.push_back(hand(16, true));
    const double alpha = 1 - std::exp(-extinction * 14), share = alpha * kFace;
    RenderSettings fast = balanced_settings();
    fast.fast =
        FastSettings{.step_voxels = 1, .spacing = 4, .refine_full_255 = -1};  // refinement ends at half resolution where nothing is opaque
    for (const RenderSettings& settings : {RenderSettings{}, fast}) {
      const Image8 image = draw(packet, settings, "e" + std::to_string(int(100 * extinction)) + (settings.fast ? "fast" : ""));
      const double volume[3] = {0.2, 0.5, 0.9};
      for (std::size_t c = 0; c < 3; ++c) {
        const double seen = alpha * volume[c] + (1 - alpha) * kLit;
        EXPECT_NEAR(image.pixel(kMiddle, kMiddle)[c], 255 * std::min(1.0, share * kLit + (1 - share) * seen), 2) << extinction << " " << c;
      }
    }
  }
}

/// The overlay affects only pixels that the cursor or its occluder covers: alpha is unchanged, and the colours equal those over a
/// background.
TEST_F(OccludedOverlay, IsCorrectOnATransparentBackgroundAndInFloats) {
  FramePacket off = inside_ball(false), on = inside_ball(true);
  const Image8 solid = draw(on);
  off.background = on.background = {0, 0, 0, 0};
  const Image8 before = draw(off), after = draw(on, {}, "transparent");
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      ASSERT_EQ(before.pixel(x, y)[3], after.pixel(x, y)[3]);
      if (after.pixel(x, y)[3] == 0) continue;
      ASSERT_TRUE(same_pixels(after.pixel(x, y), solid.pixel(x, y)));
    }
  RenderSettings floats{.float_image = true, .fast = {}};
  ASSERT_TRUE(renderer_->draw(on, floats));
  const auto image = renderer_->read_back_float();
  ASSERT_TRUE(image);
  for (std::size_t i = 0; i < after.rgba.size(); ++i)
    ASSERT_NEAR(255 * std::clamp(image->rgba[i], 0.0f, 1.0f), after.rgba[i], uses_lavapipe() ? 0.51 : 0.6);
}

TEST_F(OccludedOverlay, DoesNotChangeDepthsAndIds) {
  std::vector<std::uint32_t> id[2];
  std::vector<float> depth[2];
  for (const bool ghost : {false, true}) {
    FramePacket packet = inside_ball(ghost);
    packet.cursors[0].probe = {16, 6.5, 16};  // half outside the ball
    draw(packet, {}, ghost ? "half" : "half_off");
    id[ghost] = ids();
    depth[ghost] = depths();
  }
  EXPECT_EQ(id[0], id[1]);
  EXPECT_EQ(depth[0], depth[1]);
  EXPECT_EQ(id[1][kMiddle * kSide + kMiddle], kHand);
  EXPECT_EQ(id[1][(kMiddle + 20) * kSide + kMiddle], kBall);
}

TEST_F(OccludedOverlay, IsDrawnInBothEyesAndInEveryTile) {
  FramePacket packet = inside_ball(true);
  packet.width = packet.height = 128;
  const Image8 whole = draw(packet);
  FramePacket eyes = packet;
  eyes.packing = Packing::side_by_side;
  eyes.eyes = {packet.view, packet.view};
  eyes.eyes[1].position.x += 4;
  const Image8 pair = draw(eyes, {}, "eyes");
  FramePacket right = packet;
  right.view = eyes.eyes[1];
  const Image8 other = draw(right);
  for (std::uint32_t y = 0; y < 128; ++y) {
    ASSERT_TRUE(same_pixels(whole.pixel(0, y), pair.pixel(0, y), 128));
    ASSERT_TRUE(same_pixels(other.pixel(0, y), pair.pixel(128, y), 128));
  }
  const TilePlan plan = plan_tiles(128, 128, 1, 64, false, 4096);
  for (const std::uint32_t column : {0u, 1u})
    for (const std::uint32_t row : {0u, 1u}) {
      const TileArea area = plan.area(column, row);
      ASSERT_LE(max_difference(draw(make_tile_packet(packet, plan, area)), whole, area.x, area.y), 2);
    }
}

TEST_F(OccludedOverlay, ACursorOutsideTheImageOrAroundTheEyeIsHandled) {
  FramePacket packet = inside_ball(true);
  const Image8 before = draw(packet);
  packet.cursors[0].probe.x = 60;
  FramePacket off = packet;
  off.cursors[0].show_occluded = false;
  EXPECT_EQ(max_difference(draw(packet), draw(off)), 0);
  packet.cursors[0].radius = 0;  // not drawn
  EXPECT_EQ(max_difference(draw(packet), draw(off)), 0);
  // the camera is inside the ball, partly behind the surface
  packet = make_packet({16, 5, 16}, {16, 16, 16}, 60);
  packet.isosurfaces.push_back(ball());
  packet.cursors.push_back(hand(16, true));
  packet.cursors[0].radius = 12;
  draw(packet, {}, "around");
  EXPECT_EQ(max_difference(draw(inside_ball(true)), before), 0);
}

TEST_F(OccludedOverlay, ADropLineLeadsToItsFoot) {
  FramePacket packet = inside_ball(true);
  packet.cursors[0].probe = {18, 16, 18};
  packet.cursors[0].foot_point = Vec3(18, 16, 2);  // 4 units below the ball
  const Image8 image = draw(packet, {}, "drop_line");
  FramePacket off = packet;
  off.cursors[0].show_occluded = false;
  const Image8 solid = draw(off);
  const std::vector<std::uint32_t> id = ids();
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  const auto at = [&](const Vec3& world) { return *project(camera, world); };
  const auto id_at = [&](const Vec3& world) { return id[std::uint32_t(at(world).y) * kSide + std::uint32_t(at(world).x)]; };
  for (double z = 15.5; z > 2; z -= 0.25) {
    const Vec3 p = at({18, 16, z});
    const auto x = std::uint32_t(p.x), y = std::uint32_t(p.y);
    const bool hidden = norm(Vec3(18, 16, z) - Vec3(16)) < 10;
    const double off_axis = norm(Vec3(2, 0, z - 16));
    if (off_axis < 9.8 || off_axis > 10.2) {
      EXPECT_EQ(id_at({18, 16, z}), off_axis < 9.8 ? kBall : kHand) << z;
    }
    EXPECT_EQ(std::equal(image.pixel(x, y), image.pixel(x, y) + 3, solid.pixel(x, y)), !hidden) << z;
  }
  // the cross extends to both sides of the foot; below it the image is empty
  for (const double side : {-2.5, 2.5}) EXPECT_EQ(id_at({18 + side, 16, 2}), kHand);
  EXPECT_EQ(id_at({18, 16, 1}), 0u);
}

}  // namespace catena::test::occluded_overlay_test
