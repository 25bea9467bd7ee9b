// SPDX-License-Identifier: MIT
/// Kooima's projection and a headset's tangents against their published formulas and against projected points.
#include "render/stereo/stereo_views.h"

#include <gtest/gtest.h>

#include "render/frame/camera.h"

namespace catena::render::projections_test {

TEST(ScreenView, ScreenCornersAreImageCornersFromAnyEye) {
  // a tilted screen, with eyes off its centre and beyond its edge
  const Screen screen{{1.0, 2.0, 0.5}, {2.2, 2.9, 0.5}, {1.0 - 0.3, 2.0 + 0.4, 0.5 + 1.2}};
  const Vec3 vr = direction(screen.lower_right - screen.lower_left), vu = direction(screen.upper_left - screen.lower_left);
  const Vec3 vn = direction(cross(vr, vu)), middle = 0.5 * (screen.lower_right + screen.upper_left);
  for (const Vec3& eye : {middle + 1.5 * vn, middle + 0.4 * vn + 0.3 * vr - 0.2 * vu, middle + 2.0 * vn + 3.0 * vr + 1.0 * vu}) {
    const auto view = make_screen_view(screen, eye);
    ASSERT_TRUE(view) << view.error().message;
    // non-square pixels: the field of view is the screen's, not the image's
    const Camera c = make_camera(*view, 500, 700, {});
    const auto lower_left = project(c, screen.lower_left), lower_right = project(c, screen.lower_right),
               upper_left = project(c, screen.upper_left);
    ASSERT_TRUE(lower_left && lower_right && upper_left);
    EXPECT_NEAR(lower_left->x, 0, 1e-9);
    EXPECT_NEAR(lower_left->y, 700, 1e-9);
    EXPECT_NEAR(lower_right->x, 500, 1e-9);
    EXPECT_NEAR(lower_right->y, 700, 1e-9);
    EXPECT_NEAR(upper_left->x, 0, 1e-9);
    EXPECT_NEAR(upper_left->y, 0, 1e-9);
    // the published formula, at n = 1
    const double d = -dot(vn, screen.lower_left - eye);
    EXPECT_NEAR(c.center_x - c.half_width, dot(vr, screen.lower_left - eye) / d, 1e-12);
    EXPECT_NEAR(c.center_x + c.half_width, dot(vr, screen.lower_right - eye) / d, 1e-12);
    EXPECT_NEAR(c.center_y - c.half_height, dot(vu, screen.lower_left - eye) / d, 1e-12);
    EXPECT_NEAR(c.center_y + c.half_height, dot(vu, screen.upper_left - eye) / d, 1e-12);
  }
}

TEST(ScreenView, AScreenAtTheZeroParallaxDistanceMatchesTheOffAxisPair) {
  const View centre{{0.0, -8.0, 1.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, 40, false, 1, {}};
  constexpr double aspect = 1.5, zero = 8.0;
  const double half = zero * std::tan(20 * std::acos(-1.0) / 180);
  const Screen screen{{-aspect * half, 0.0, 1 - half}, {aspect * half, 0.0, 1 - half}, {-aspect * half, 0.0, 1 + half}};
  for (const View& eye : make_stereo_views(centre, aspect, {2, 0.5, zero})) {
    const auto view = make_screen_view(screen, eye.position);
    ASSERT_TRUE(view);
    const Camera a = make_camera(eye, 300, 200, {}), b = make_camera(*view, 300, 200, {});
    const Mat4 difference = clip_from_world(a) - clip_from_world(b);
    for (int i = 0; i < 4; ++i)
      for (const int j : {0, 1, 3}) EXPECT_NEAR(difference[i][j], 0, 1e-12);  // near and far differ per view
  }
}

TEST(ScreenView, RefusesDegenerateScreensAndAnEyeBehindTheScreen) {
  const Screen screen{{-1.0, 0.0, -1.0}, {1.0, 0.0, -1.0}, {-1.0, 0.0, 1.0}};
  EXPECT_TRUE(make_screen_view(screen, {0.0, -2.0, 0.0}));
  EXPECT_FALSE(make_screen_view(screen, {0.0, 0.0, 0.0}));
  EXPECT_FALSE(make_screen_view(screen, {0.0, 2.0, 0.0}));
  EXPECT_TRUE(make_screen_view(screen, {9e5, -2.0, -9e5}));
  for (const double far : {1.1e6, 1e15, 1e308}) {
    EXPECT_FALSE(make_screen_view(screen, {far, -2.0, 0.0})) << far;
    EXPECT_FALSE(make_screen_view(screen, {0.0, -2.0, -far})) << far;
  }
  EXPECT_FALSE(make_screen_view({{-1.0, 0.0, -1.0}, {1.0, 0.0, -1.0}, {0.0, 0.0, 1.0}}, {0.0, -2.0, 0.0}));
  EXPECT_FALSE(make_screen_view({Vec3(1.0), Vec3(1.0), {-1.0, 0.0, 1.0}}, {0.0, -2.0, 0.0}));
}

TEST(HeadsetView, TheMatrixMatchesTheTangents) {
  // canted and asymmetric, with non-square pixels
  const FovTangents t{-1.37, 0.83, 0.96, -1.21};
  const double angle = 0.2, c = std::cos(angle), s = std::sin(angle);
  const Mat3 pose(Vec3(c, 0.0, -s), Vec3(0.0, 1.0, 0.0), Vec3(s, 0.0, c));
  const Vec3 position(0.03, 1.6, -0.4);
  const auto view = make_headset_view(position, pose, t);
  ASSERT_TRUE(view);
  Bounds bounds;
  bounds.extend(position - 5.0 * pose[2], 2);
  const Camera camera = make_camera(*view, 1440, 1600, bounds);
  const Mat4 m = clip_from_view(camera);
  const double n = camera.near, f = camera.far;
  EXPECT_NEAR(m[0][0], 2 / (t.right - t.left), 1e-13);
  EXPECT_NEAR(m[2][0], (t.right + t.left) / (t.right - t.left), 1e-13);
  EXPECT_NEAR(m[1][1], 2 / (t.down - t.up), 1e-13);
  EXPECT_NEAR(m[2][1], (t.up + t.down) / (t.down - t.up), 1e-13);
  EXPECT_NEAR(m[2][2], -f / (f - n), 1e-13);
  EXPECT_NEAR(m[3][2], -f * n / (f - n), 1e-9);
  EXPECT_EQ(m[2][3], -1);
  // the axes are those of the pose
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(camera.right[i], pose[0][i], 1e-14);
    EXPECT_NEAR(camera.up[i], pose[1][i], 1e-14);
    EXPECT_NEAR(camera.back[i], pose[2][i], 1e-14);
  }
}

TEST(HeadsetView, RefusesEdgesOutOfOrder) {
  EXPECT_TRUE(make_headset_view(Vec3(0.0), Mat3(1.0), {}));
  EXPECT_FALSE(make_headset_view(Vec3(0.0), Mat3(1.0), {1, -1, 1, -1}));
  EXPECT_FALSE(make_headset_view(Vec3(0.0), Mat3(1.0), {-1, 1, -1, 1}));
  EXPECT_FALSE(make_headset_view(Vec3(0.0), Mat3(1.0), {-1, NAN, 1, -1}));
}

}  // namespace catena::render::projections_test
