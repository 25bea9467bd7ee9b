// SPDX-License-Identifier: MIT
/// Images submitted to the headset: position of a ball for canted and asymmetric eyes at every depth, and bytes equal to a window's.
#include <array>
#include <cstdlib>

#include "render/image/image.h"
#include "tests/render/xr/xr_fixture.h"

namespace catena::test::submitted_images_test {

using namespace xr_rig;
using xr_runtime::CapturedImage;

/// Position in pixels.
using Place = std::array<double, 2>;

Place centroid(const CapturedImage& rendered) {
  double x = 0, y = 0, count = 0;
  for (std::uint32_t j = 0; j < rendered.height; ++j)
    for (std::uint32_t i = 0; i < rendered.width; ++i) {
      const std::uint8_t* p = &rendered.rgba[4 * (std::size_t(j) * rendered.width + i)];
      if (std::abs(p[0] - 26) <= 1 && std::abs(p[1] - 51) <= 1 && std::abs(p[2] - 77) <= 1) continue;  // skip the background
      x += i + 0.5;
      y += j + 0.5;
      ++count;
    }
  return {x / count, y / count};
}

/// Expected position of a ball in the room, by rays from the eye as OpenXR defines it, without Catena's cameras.
Place expected_centroid(const XrView& view, const Vec3& centre, double radius, double width, double height) {
  constexpr int kFine = 4;
  const Vec3 eye(view.pose.position.x, view.pose.position.y, view.pose.position.z), to = centre - eye;
  double x = 0, y = 0, count = 0;
  for (int j = 0; j < kFine * int(height); ++j)
    for (int i = 0; i < kFine * int(width); ++i) {
      const double px = (i + 0.5) / kFine, py = (j + 0.5) / kFine;
      const Vec3 ray = ray_of(view, px, py, width, height);
      const double along = dot(ray, to);
      if (along <= 0 || dot(to, to) - along * along > radius * radius) continue;
      x += px;
      y += py;
      ++count;
    }
  return {x / count, y / count};
}

class HeadsetImages : public HeadsetFixture {};

TEST_F(HeadsetImages, ABallIsAtItsPositionInBothEyes) {
  runtime_.script().capture_images = true;
  set_image_size(200, 180);
  // eyes canted about two axes, head rotated
  runtime_.script().views[1].pose.orientation = {0.05f, -0.09f, 0.02f, 0.994f};
  ASSERT_TRUE(opens());
  Placement placement;
  placement.world_origin = {3.0, -2.0, 1.0};
  placement.world_from_room = Mat3(Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(1.0, 0.0, 0.0));
  placement.meters_per_unit = 0.02;
  for (const double depth : {0.2, 0.5, 1.0, 3.0, 20.0}) {
    const Vec3 room(0.1 * depth, -0.06 * depth, -depth);
    const double radius = 0.16 * depth;
    FramePacket packet = ball_packet(placement.to_world(room), radius / placement.meters_per_unit);
    ASSERT_TRUE(shows(packet, placement, 4));
    ASSERT_EQ(runtime_.record().last_images.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const CapturedImage& rendered = runtime_.record().last_images[k];
      const Place seen = centroid(rendered), due = expected_centroid(runtime_.script().views[k], room, radius, 200, 180);
      EXPECT_NEAR(seen[0], due[0], 0.1) << "eye " << k << " at " << depth << " m";
      EXPECT_NEAR(seen[1], due[1], 0.1) << "eye " << k << " at " << depth << " m";
      if (const char* folder = std::getenv("CATENA_XR_PICTURES")) {
        const std::string path = std::string(folder) + "/eye" + std::to_string(k) + "-" + std::to_string(depth) + ".png";
        EXPECT_TRUE(write_png(path, {rendered.width, rendered.height, rendered.rgba}, false));
      }
    }
  }
  EXPECT_EQ(runtime_.record().moved_poses, 0u);
}

/// The cursor at the hand while the head moves: drawn with the frame's poses it covers the hand in both eyes.
TEST_F(HeadsetImages, TheCursorIsAtTheHandWhileTheHeadMoves) {
  runtime_.script().capture_images = true;
  set_image_size(160, 160);
  const std::vector<XrView> still = runtime_.script().views;
  runtime_.script().on_frame = [still](std::uint64_t frame, xr_runtime::Script& script) {
    const float t = float(frame);
    for (std::size_t k = 0; k < still.size(); ++k) {
      script.views[k].pose.position.x = still[k].pose.position.x + 0.01f * t;
      script.views[k].pose.position.z = still[k].pose.position.z - 0.005f * t;
      script.views[k].pose.orientation = {0.01f * t, still[k].pose.orientation.y + 0.004f * t, 0, still[k].pose.orientation.w};
      // a unit quaternion, as from a runtime
      XrQuaternionf& q = script.views[k].pose.orientation;
      const float length = std::sqrt(q.x * q.x + q.y * q.y + q.w * q.w);
      q = {q.x / length, q.y / length, 0, q.w / length};
    }
    script.hands[1].grip.position = {0.05f, -0.1f + 0.003f * t, -0.5f};
  };
  ASSERT_TRUE(open());
  Placement placement;
  placement.meters_per_unit = 0.3;
  placement.world_origin = {1.0, 2.0, 3.0};
  double maximum = 0;
  for (int i = 0; i < 12; ++i) {
    const xr::Frame frame = begin_frame();
    ASSERT_TRUE(headset_->actions().sync());
    const auto hand = headset_->actions().controller(1, frame.display_time);
    ASSERT_TRUE(hand);
    const Vec3 room = hand->grip.position;
    FramePacket packet = ball_packet(placement.to_world(room), 0.05 / placement.meters_per_unit);
    show(frame, packet, {}, placement);
    if (!frame.should_render || !hand->is_tracked) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      const Place seen = centroid(runtime_.record().last_images[k]),
                  due = expected_centroid(runtime_.script().views[k], room, 0.05, 160, 160);
      maximum = std::max({maximum, std::abs(seen[0] - due[0]), std::abs(seen[1] - due[1])});
    }
  }
  EXPECT_GT(maximum, 0);  // at least one pixel was compared
  EXPECT_LT(maximum, 0.25);
  EXPECT_EQ(runtime_.record().moved_poses, 0u);
}

/// In sRGB and in linear formats the bytes equal those of an image file.
TEST_F(HeadsetImages, SubmittedImagesEqualImageFiles) {
  for (const std::int64_t format : {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM}) {
    runtime_.script().capture_images = true;
    runtime_.script().formats = {VK_FORMAT_B8G8R8A8_SRGB, format};
    ASSERT_TRUE(opens());
    const Placement placement;
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
    ASSERT_TRUE(run_frames(packet, placement, 3));
    // the window mirrors the first eye, which is drawn last
    const auto mirrored = renderer_->read_back();
    ASSERT_TRUE(mirrored);
    EXPECT_EQ(mirrored->rgba, runtime_.record().last_images[0].rgba);
    // each eye equals the image of its view by a renderer without a headset
    auto plain = Renderer::create({true, test_device(), {}});
    ASSERT_TRUE(plain);
    for (std::size_t k = 0; k < 2; ++k) {
      packet.view = *make_xr_eye_view(placement, xr::make_xr_eye(runtime_.script().views[k]));
      ASSERT_TRUE((*plain)->draw(packet, {}));
      const auto rendered = (*plain)->read_back();
      const auto& shown = runtime_.record().last_images[k].rgba;
      ASSERT_EQ(rendered->rgba.size(), shown.size());
      int maximum = 0;
      for (std::size_t i = 0; i < shown.size(); ++i) maximum = std::max(maximum, std::abs(int(shown[i]) - int(rendered->rgba[i])));
      EXPECT_LE(maximum, 2);
    }
    close();
  }
}

/// A coarser level uses a part of the same images.
TEST_F(HeadsetImages, ReducedPixelsUseAPartOfTheImage) {
  runtime_.script().capture_images = true;
  ASSERT_TRUE(open());
  FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
  ASSERT_TRUE(run_frames(packet, {}, 3, 0.5));
  EXPECT_EQ(runtime_.record().last_images[0].width, 48u);
  EXPECT_EQ(runtime_.record().last_images[0].height, 40u);
  const Place seen = centroid(runtime_.record().last_images[0]),
              due = expected_centroid(runtime_.script().views[0], {0.0, 0.0, -1.0}, 0.3, 48, 40);
  EXPECT_NEAR(seen[0], due[0], 0.1);
  EXPECT_NEAR(seen[1], due[1], 0.1);
}

}  // namespace catena::test::submitted_images_test
