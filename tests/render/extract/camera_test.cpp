// SPDX-License-Identifier: MIT
#include "render/frame/camera.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <random>

namespace catena::render::camera_test {

const Bounds kBox{Vec3(-1.0), Vec3(1.0)};

View looking_along_y(bool orthographic = false) { return {{0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, orthographic, 4}; }

void expect_near(const Vec3& a, const Vec3& b, double tolerance) { EXPECT_LE(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z; }

TEST(Camera, AnAxisPointProjectsToTheCentre) {
  for (const bool orthographic : {false, true}) {
    const Camera c = make_camera(looking_along_y(orthographic), 640, 480, kBox);
    const auto p = project(c, {0.0, 3.0, 0.0});
    ASSERT_TRUE(p);
    expect_near(*p, {320.0, 240.0, 13.0}, 1e-9);
  }
}

TEST(Camera, UpIsUpAndRightIsRight) {
  const Camera c = make_camera(looking_along_y(), 640, 480, kBox);
  expect_near(c.right, {1.0, 0.0, 0.0}, 1e-15);
  expect_near(c.up, {0.0, 0.0, 1.0}, 1e-15);
  EXPECT_LT(project(c, {0.0, 0.0, 1.0})->y, 240);  // row 0 is the top
  EXPECT_GT(project(c, {1.0, 0.0, 0.0})->x, 320);
}

TEST(Camera, FieldOfViewIsVertical) {
  // at distance 10 the image's upper edge is 10 tan(15 degrees) above the axis
  const double top = 10 * std::tan(15 * std::acos(-1.0) / 180);
  const Camera c = make_camera(looking_along_y(), 640, 320, kBox);
  EXPECT_NEAR(project(c, {0.0, 0.0, top})->y, 0, 1e-9);
  EXPECT_NEAR(project(c, {2 * top, 0.0, 0.0})->x, 640, 1e-9);
}

TEST(Camera, OrthographicHeightIsTheImageHeight) {
  const Camera c = make_camera(looking_along_y(true), 200, 100, kBox);
  EXPECT_NEAR(project(c, {0.0, 0.0, 2.0})->y, 0, 1e-12);
  EXPECT_NEAR(project(c, {-4.0, 5.0, 0.0})->x, 0, 1e-12);
}

TEST(Camera, PixelCentresAreAtHalfIntegers) {
  // 2 x 2 pixels: the ray of the upper left pixel is at a quarter of width and height
  const Camera c = make_camera(looking_along_y(), 2, 2, kBox);
  const Ray ray = pixel_ray(c, 0.5, 0.5);
  const double t = std::tan(15 * std::acos(-1.0) / 180);
  expect_near(ray.direction, direction(Vec3(-0.5 * t, 1.0, 0.5 * t)), 1e-15);
  expect_near(ray.origin, {0.0, -10.0, 0.0}, 0);
}

TEST(Camera, RoundTripsAgreeWithTheMatrices) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 position{30 * u(random), 30 * u(random), 30 * u(random)}, target{u(random), u(random), u(random)},
        up{u(random), u(random), u(random)};
    const View view{position, target, up, 30, i % 2 == 1, 5};
    const Camera c = make_camera(view, 801, 603, {Vec3(-2.0), Vec3(2.0)});
    const Vec3 p{2 * u(random), 2 * u(random), 2 * u(random)};
    const auto pixel = project(c, p);
    if (!pixel) continue;
    expect_near(unproject(c, pixel->x, pixel->y, pixel->z), p, 1e-11);

    // projection by the matrices, and unprojection
    const glm::dvec4 clip = clip_from_world(c) * glm::dvec4(p, 1.0);
    EXPECT_NEAR(0.5 * (clip.x / clip.w + 1) * 801, pixel->x, 1e-7);
    EXPECT_NEAR(0.5 * (clip.y / clip.w + 1) * 603, pixel->y, 1e-7);
    const glm::dvec4 back = world_from_clip(c) * clip;
    expect_near(Vec3(back) / back.w, p, 1e-8);

    // the point is on the pixel's ray
    const Ray ray = pixel_ray(c, pixel->x, pixel->y);
    EXPECT_LE(norm(cross(p - ray.origin, ray.direction)), 1e-10);
    EXPECT_NEAR(norm(ray.direction), 1, 1e-14);
  }
}

TEST(Camera, DepthIsZeroAtNearAndOneAtFar) {
  for (const bool orthographic : {false, true}) {
    const Camera c = make_camera(looking_along_y(orthographic), 64, 64, kBox);
    for (const auto& [depth, expected] : {std::pair{c.near, 0.0}, std::pair{c.far, 1.0}}) {
      const glm::dvec4 clip = clip_from_view(c) * glm::dvec4(0, 0, -depth, 1);
      EXPECT_NEAR(clip.z / clip.w, expected, 1e-12);
    }
    EXPECT_LT(c.near, 9);
    EXPECT_GT(c.near, 8.9);
    EXPECT_GT(c.far, 11);
    EXPECT_LT(c.far, 11.1);
  }
}

TEST(Camera, InsideTheBoundsTheNearPlaneStaysPositive) {
  View view = looking_along_y();
  view.position = {0.1, 0.2, 0.3};
  const Camera c = make_camera(view, 64, 64, kBox);
  EXPECT_GT(c.near, 0);
  EXPECT_LT(c.near, 1e-3);
  EXPECT_GT(c.far, 1);
}

TEST(Camera, DegenerateViewsGiveAValidFrame) {
  View along_up = looking_along_y();
  along_up.up = {0.0, 1.0, 0.0};
  View nowhere = looking_along_y();
  nowhere.target = nowhere.position;
  for (const View& view : {along_up, nowhere}) {
    const Camera c = make_camera(view, 64, 64, Bounds());
    EXPECT_NEAR(norm(c.right), 1, 1e-14);
    EXPECT_NEAR(norm(c.up), 1, 1e-14);
    EXPECT_NEAR(dot(cross(c.right, c.up), c.back), 1, 1e-14);
    EXPECT_GT(c.far, c.near);
  }
}

TEST(Camera, ABallIsVisibleIfAnyOfItsPointsIs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  int unseen = 0, left_out = 0;
  for (int i = 0; i < 2000; ++i) {
    View view{{10 * u(random), 10 * u(random), 10 * u(random)}, {u(random), u(random), u(random)}, {0, 0, 1}, 30, i % 2 == 1, 5};
    if (i % 3 == 0) view.window = {0.2, 1.4, -1.2, -0.5};
    const Camera c = make_camera(view, 80, 60, Bounds());
    const Vec3 centre{8 * u(random), 8 * u(random), 8 * u(random)};
    const double radius = 1 + u(random);
    const bool seen = may_be_visible(c, centre, radius);
    bool any = false;
    for (int k = 0; k < 200; ++k) {
      const Vec3 out = direction(Vec3(u(random), u(random), u(random)));
      const auto pixel = project(c, centre + (k % 4 == 0 ? 0.5 : 1.0) * radius * out);
      any = any || (pixel && pixel->x > 0 && pixel->x < 80 && pixel->y > 0 && pixel->y < 60);
    }
    EXPECT_TRUE(seen || !any) << i;
    unseen += !any;
    left_out += !seen;
  }
  EXPECT_GT(left_out, 0.8 * unseen) << "of " << unseen;
}

TEST(Camera, FitShowsTheWholeBoxAndFillsTheImage) {
  for (const double aspect : {0.5, 1.0, 2.0})
    for (const Vec3& towards : {default_view_direction(), Vec3(0.0, 0.0, 1.0), Vec3(-1.0, 0.2, -0.4)})
      for (const bool orthographic : {false, true}) {
        const Bounds bounds{{3.0, -100.0, 7.0}, {9.0, -70.0, 8.0}};
        View view = fit_view(bounds, aspect, towards);
        view.orthographic = orthographic;
        const Camera c = make_camera(view, 400 * aspect, 400, bounds);
        double widest = 0;
        for (int i = 0; i < 8; ++i) {
          const auto p = project(c, bounds.corner(i));
          ASSERT_TRUE(p);
          widest = std::max({widest, std::fabs(p->x / (200 * aspect) - 1), std::fabs(p->y / 200 - 1)});
        }
        EXPECT_LT(widest, 1);
        EXPECT_GT(widest, 0.75);
      }
}

TEST(Camera, FitToPointsFillsTheShareExactlyAndCentresThem) {
  FitPoints cloud;
  for (int i = 0; i < 200; ++i) cloud.points.push_back({9 * std::sin(1.7 * i), 20 + 5 * std::cos(2.3 * i), 3 * std::sin(0.9 * i)});
  for (const double aspect : {0.4, 1.0, 2.5})
    for (const Vec3& towards : {default_view_direction(), Vec3(0.0, 0.0, 1.0), Vec3(-1.0, 0.2, -0.4)}) {
      const View view = fit_view({cloud}, aspect, 0.6, 0.8, towards);
      const Camera c = make_camera(view, 400 * aspect, 400, Bounds());
      Bounds seen;
      for (const Vec3& p : cloud.points) {
        const auto at = project(c, p);
        ASSERT_TRUE(at);
        seen.extend({at->x / (400 * aspect), at->y / 400, 0});
      }
      const Vec3 size = seen.hi - seen.lo;
      EXPECT_LT(size.x, 0.6 + 1e-9);
      EXPECT_LT(size.y, 0.8 + 1e-9);
      EXPECT_TRUE(size.x > 0.6 - 1e-6 || size.y > 0.8 - 1e-6) << size.x << " " << size.y;
      EXPECT_NEAR(size.y > 0.8 - 1e-6 ? seen.center().y : seen.center().x, 0.5, 1e-9);
    }
}

TEST(Camera, FitToPointsIgnoresOutliers) {
  FitPoints cloud;
  for (int i = 0; i < 1000; ++i) cloud.points.push_back({std::sin(1.7 * i), std::cos(2.3 * i), std::sin(0.9 * i)});
  const double near = norm(fit_view({cloud}, 1, 0.8, 0.8).position);
  cloud.points.push_back({50, 0, 0});
  EXPECT_GT(norm(fit_view({cloud}, 1, 0.8, 0.8).position), 5 * near);
  cloud.outlier_share = 0.002;
  EXPECT_NEAR(norm(fit_view({cloud}, 1, 0.8, 0.8).position), near, 0.1 * near);
}

TEST(Camera, FitToOnePointOrNone) {
  for (const std::vector<FitPoints>& clouds : {std::vector<FitPoints>{}, {{}}, {{{Vec3(5.0)}, 0}}}) {
    const View view = fit_view(clouds, 1, 0.8, 0.8);
    EXPECT_TRUE(is_finite(view.position));
    EXPECT_GT(norm(view.position - view.target), 0.5);
  }
}

TEST(Camera, FitToAnEmptyBoxAndToAPoint) {
  const View nothing = fit_view(Bounds(), 1);
  EXPECT_TRUE(is_finite(nothing.position));
  EXPECT_GT(norm(nothing.position), 2);
  const View point = fit_view({Vec3(5.0), Vec3(5.0)}, 1);
  EXPECT_GT(norm(point.position - Vec3(5.0)), 0.5);
}

}  // namespace catena::render::camera_test
