// SPDX-License-Identifier: MIT
/// Stereo eyes against closed forms: projected points in each eye, and the matrices of screens and headsets.
#include "render/stereo/stereo_views.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "render/frame/camera.h"
#include "render/stereo/xr_views.h"

namespace catena::render::stereo_views_test {

constexpr double kWidth = 800, kHeight = 600;

View oblique_view(bool orthographic) { return {{3.0, -11.0, 4.0}, {0.5, 0.2, -0.3}, {0.1, 0.0, 1.0}, 34, orthographic, 5, {}}; }

Camera camera_of(const View& view) { return make_camera(view, kWidth, kHeight, {}); }

/// A point at distance `depth` along the view's axis, with offset x and y.
Vec3 place(const Camera& c, double x, double y, double depth) { return c.position + x * c.right + y * c.up - depth * c.back; }

TEST(Eyes, DisparityMatchesTheClosedFormWithoutVerticalParallax) {
  for (const bool orthographic : {false, true}) {
    const View centre = oblique_view(orthographic);
    const Camera c = camera_of(centre);
    constexpr double separation = 0.4, zero = 9.0;
    const std::vector<View> pair = make_stereo_views(centre, kWidth / kHeight, {2, separation, zero});
    ASSERT_EQ(pair.size(), 2u);
    const Camera left = camera_of(pair[0]), right = camera_of(pair[1]);
    EXPECT_NEAR(dot(right.position - left.position, c.right), separation, 1e-12);
    for (const double depth : {4.0, 9.0, 9.5, 20.0})
      for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.7, -0.4}, {-1.2, 0.9}}) {
        const Vec3 p = place(c, x, y, depth);
        const auto in_left = project(left, p), in_right = project(right, p), in_centre = project(c, p);
        ASSERT_TRUE(in_left && in_right && in_centre);
        const double scale = orthographic ? 1 : 1 / depth;
        const double expected = separation * (depth - zero) / zero * scale * 0.5 * kHeight / c.half_height;
        EXPECT_NEAR(in_right->x - in_left->x, expected, 1e-9) << depth;
        EXPECT_NEAR(0.5 * (in_right->x + in_left->x), in_centre->x, 1e-9);
        EXPECT_NEAR(in_left->y, in_right->y, 1e-9);
        EXPECT_NEAR(in_left->y, in_centre->y, 1e-9);
        // signs of the disparity: crossed in front of the zero-parallax distance, zero at it, uncrossed behind
        const int sign = depth < zero ? -1 : depth > zero ? 1 : 0;
        EXPECT_GE(sign * (in_right->x - in_left->x), sign == 0 ? -1e-9 : 1);
      }
  }
}

TEST(Eyes, TheLeftFrustumMatchesTheTextbookFormula) {
  // l, r = -+ a w + (s / 2) (n / F), w = n tan(fovy / 2), at near n = 1
  const View centre = oblique_view(false);
  constexpr double s = 0.3, f = 7.0, aspect = kWidth / kHeight;
  const double w = std::tan(17 * std::acos(-1.0) / 180);
  const std::vector<View> pair = make_stereo_views(centre, aspect, {2, s, f});
  const Camera left = camera_of(pair[0]), right = camera_of(pair[1]);
  EXPECT_NEAR(left.center_x - left.half_width, -aspect * w + 0.5 * s / f, 1e-14);
  EXPECT_NEAR(left.center_x + left.half_width, aspect * w + 0.5 * s / f, 1e-14);
  EXPECT_NEAR(right.center_x - right.half_width, -aspect * w - 0.5 * s / f, 1e-14);
  EXPECT_NEAR(right.center_x + right.half_width, aspect * w - 0.5 * s / f, 1e-14);
}

TEST(Eyes, AnyNumberOfEyesIsEquallySpacedOnALine) {
  for (const bool orthographic : {false, true})
    for (const std::size_t n : {1u, 3u, 8u}) {
      const View centre = oblique_view(orthographic);
      const Camera c = camera_of(centre);
      const std::vector<View> row = make_stereo_views(centre, kWidth / kHeight, {n, 0.1, 12.0});
      ASSERT_EQ(row.size(), n);
      const Vec3 p = place(c, 0.3, 0.2, 15);
      const double step = 0.1 * 3 / 12 * (orthographic ? 1 : 1 / 15.0) * 0.5 * kHeight / c.half_height;
      for (std::size_t k = 0; k < n; ++k) {
        const double offset = double(k) - 0.5 * double(n - 1);
        EXPECT_NEAR(dot(row[k].position - c.position, c.right), 0.1 * offset, 1e-12);
        EXPECT_NEAR(project(camera_of(row[k]), p)->x, project(c, p)->x + step * offset, 1e-9);
      }
    }
}

TEST(Eyes, OneEyeOrNoSeparationEqualsTheView) {
  for (const StereoSettings& settings : {StereoSettings{1, {}, {}}, StereoSettings{2, 0.0, {}}})
    for (const bool orthographic : {false, true})
      for (const View& eye : make_stereo_views(oblique_view(orthographic), kWidth / kHeight, settings)) {
        const Camera a = camera_of(oblique_view(orthographic)), b = camera_of(eye);
        const Mat4 difference = clip_from_world(a) - clip_from_world(b);
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j) EXPECT_NEAR(difference[i][j], 0, 1e-12);
      }
}

TEST(Eyes, DefaultsAreZeroParallaxAtTheTargetAndAThirtiethAsSeparation) {
  const View centre = oblique_view(false);
  const std::vector<View> pair = make_stereo_views(centre, kWidth / kHeight);
  const double distance = norm(centre.target - centre.position);
  EXPECT_NEAR(norm(pair[1].position - pair[0].position), distance / 30, 1e-12);
  EXPECT_NEAR(project(camera_of(pair[0]), centre.target)->x, 0.5 * kWidth, 1e-9);
  EXPECT_NEAR(project(camera_of(pair[1]), centre.target)->x, 0.5 * kWidth, 1e-9);
  // a zero-parallax distance without a separation scales the separation
  const std::vector<View> nearer = make_stereo_views(centre, kWidth / kHeight, {2, {}, 3.0});
  EXPECT_NEAR(norm(nearer[1].position - nearer[0].position), 0.1, 1e-12);
}

TEST(Eyes, TilesOfAnEyeEqualEyesOfATile) {
  // the upper right quarter of each eye's image, as a window
  for (const bool orthographic : {false, true}) {
    const View centre = oblique_view(orthographic);
    View tile = centre;
    tile.window = {0, 1, 0, 1};
    const std::vector<View> whole = make_stereo_views(centre, kWidth / kHeight, {2, 0.5, 8.0}),
                            tiles = make_stereo_views(tile, kWidth / kHeight, {2, 0.5, 8.0});
    for (std::size_t k = 0; k < 2; ++k) {
      const Camera a = camera_of(whole[k]), b = make_camera(tiles[k], kWidth / 2, kHeight / 2, {});
      const Vec3 p = place(camera_of(centre), 0.4, 0.3, 10);
      EXPECT_NEAR(project(b, p)->x, project(a, p)->x - kWidth / 2, 1e-9);
      EXPECT_NEAR(project(b, p)->y, project(a, p)->y, 1e-9);
    }
  }
}

TEST(Eyes, AViewAlongItsUpVectorHasConsistentEyes) {
  View down = oblique_view(false);
  down.position = {0.0, 0.0, 10.0};
  down.target = Vec3(0.0);
  down.up = {0.0, 0.0, 1.0};
  const std::vector<View> pair = make_stereo_views(down, 1, {2, 0.2, 10.0});
  const Camera left = camera_of(pair[0]), right = camera_of(pair[1]);
  EXPECT_NEAR(norm(left.right - right.right), 0, 1e-15);
  EXPECT_NEAR(norm(right.position - left.position - 0.2 * left.right), 0, 1e-12);
}

/// The view's target is at arm's length, at the view's elevation angle below the eyes and with up vertical; steep angles are clamped.
TEST(Eyes, TheRoomPlacesTheWorldAsInTheView) {
  for (const auto& [above_deg, due_deg] : {std::pair{25.0, 25.0}, {0.0, 0.0}, {-10.0, -10.0}, {75.0, 40.0}, {-60.0, -15.0}}) {
    const double above = above_deg * M_PI / 180, due = due_deg * M_PI / 180;
    View view;
    view.target = {1.0, 2.0, -3.0};
    view.position = view.target + 14.0 * Vec3(0.6 * std::cos(above), 0.8 * std::cos(above), std::sin(above));
    view.up = {0.0, 0.0, 2.0};
    const Placement placement = make_initial_placement(view);
    EXPECT_NEAR(placement.meters_per_unit, kArmLengthM / 14, 1e-12);
    EXPECT_NEAR(norm(placement.to_room(view.target) - kArmLengthM * Vec3(0.0, -std::sin(due), -std::cos(due))), 0, 1e-12) << above_deg;
    const Vec3 up = placement.to_room(view.target + Vec3(0.0, 0.0, 1.0)) - placement.to_room(view.target);
    EXPECT_NEAR(norm(up - Vec3(0.0, placement.meters_per_unit, 0.0)), 0, 1e-12);
  }
}

}  // namespace catena::render::stereo_views_test
