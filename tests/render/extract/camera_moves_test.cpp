// SPDX-License-Identifier: MIT
#include "render/frame/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::render::camera_moves_test {

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LE(norm(a - b), 1e-12) << a.x << " " << a.y << " " << a.z; }

const Bounds kSlab{{-1.0, -2.0, -3.0}, {1.0, 2.0, 5.0}};

/// Checks that all corners of the slab are in the image.
void expect_slab_seen(const Camera& camera, double width, double height) {
  for (int i = 0; i < 8; ++i) {
    const auto p = project(camera, kSlab.corner(i));
    ASSERT_TRUE(p);
    EXPECT_TRUE(p->x > 0 && p->x < width && p->y > 0 && p->y < height);
  }
}

View from_south() { return {{0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 4}; }

TEST(CameraMoves, AxisViewsLookAlongTheirAxisAndSeeEverything) {
  const struct {
    const char* words;
    Vec3 look_direction, up;
  } cases[] = {{"+x", {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, {"-x", {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}},
               {"+y", {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {"-y", {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0}},
               {"+z", {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}, {"-z", {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.words);
    const auto view = axis_view(kSlab, 4.0 / 3, c.words);
    ASSERT_TRUE(view);
    const Camera camera = make_camera(*view, 400, 300, kSlab);
    expect_near(-camera.back, c.look_direction);
    expect_near(camera.up, c.up);
    expect_near(view->target, kSlab.center());
    expect_slab_seen(camera, 400, 300);
  }
  for (const char* words : {"x", "+w", "", "++", "+xy", "top"}) EXPECT_FALSE(axis_view(kSlab, 1, words)) << words;
}

TEST(CameraMoves, IsoSeesThreeSidesAlike) {
  const auto to_camera = axis_direction("iso");
  ASSERT_TRUE(to_camera);
  expect_near(*to_camera, Vec3(1.0, -1.0, 1.0) / std::sqrt(3.0));
}

TEST(CameraMoves, AnAzimuthTurnIsCounterClockwiseSeenFromAbove) {
  expect_near(orbit_view(from_south(), 90, 0).position, {10.0, 0.0, 0.0});
  expect_near(orbit_view(from_south(), 180, 0).position, {0.0, 10.0, 0.0});
  expect_near(orbit_view(from_south(), 360, 0).position, from_south().position);
}

TEST(CameraMoves, ElevationRaisesTheEyeAndNeverFlips) {
  const double s = 10 / std::sqrt(2.0);
  expect_near(orbit_view(from_south(), 0, 45).position, {0.0, -s, s});
  expect_near(orbit_view(from_south(), 0, -45).position, {0.0, -s, -s});
  expect_near(orbit_view(from_south(), 90, 45).position, {s, 0.0, s});
  // at the pole and beyond: the up vector rotates with the camera
  const Camera above = make_camera(orbit_view(from_south(), 0, 90), 10, 10, {});
  expect_near(above.back, {0.0, 0.0, 1.0});
  expect_near(above.up, {0.0, 1.0, 0.0});
  const Camera beyond = make_camera(orbit_view(orbit_view(from_south(), 0, 60), 0, 60), 10, 10, {});
  EXPECT_LT(beyond.up.z, 0);
  EXPECT_GT(beyond.up.y, 0);
}

TEST(CameraMoves, ZoomEnlargesByItsFactor) {
  for (const bool orthographic : {false, true}) {
    View view = from_south();
    view.orthographic = orthographic;
    const Camera before = make_camera(view, 200, 200, {}), after = make_camera(zoom_view(view, 2.5), 200, 200, {});
    const Vec3 point(0.3, 1.0, 0.2);
    EXPECT_NEAR(project(after, point)->x - 100, 2.5 * (project(before, point)->x - 100), 1e-9);
    EXPECT_NEAR(project(after, point)->y - 100, 2.5 * (project(before, point)->y - 100), 1e-9);
  }
}

TEST(CameraMoves, FittingKeepsDirectionUpAngleAndProjection) {
  View view{{30.0, -4.0, 1.0}, {29.0, 2.0, 3.0}, {0.2, 0.1, 1.0}, 50, true, 9};
  const View fit = refit_view(view, kSlab, 1.5);
  const Camera a = make_camera(view, 300, 200, {}), b = make_camera(fit, 300, 200, kSlab);
  expect_near(a.back, b.back);
  expect_near(a.up, b.up);
  EXPECT_EQ(fit.fovy_deg, 50);
  EXPECT_TRUE(fit.orthographic);
  expect_slab_seen(b, 300, 200);
}

}  // namespace catena::render::camera_moves_test
