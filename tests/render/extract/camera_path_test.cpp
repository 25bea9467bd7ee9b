// SPDX-License-Identifier: MIT
#include "render/frame/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::render::camera_path_test {

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LE(norm(a - b), 1e-12) << a.x << " " << a.y << " " << a.z; }

CameraPath path_of(const char* text) {
  auto path = parse_camera_path(text, "c.csv");
  EXPECT_TRUE(path) << path.error().message;
  return std::move(*path);
}

TEST(CameraPath, PassesThroughEveryKeyframe) {
  const CameraPath path =
      path_of("t,px,py,pz,tx,ty,tz,ux,uy,uz,fovy\n0,9,0,0,0,0,0,0,0,1,30\n1,8,3,1,0,1,0,0,1,1,40\n2.5,2,7,-1,1,0,0,0,1,0,20\n");
  EXPECT_EQ(path.start_s(), 0);
  EXPECT_EQ(path.duration_s(), 2.5);
  expect_near(path.at({}, 0).position, {9.0, 0.0, 0.0});
  expect_near(path.at({}, 1).position, {8.0, 3.0, 1.0});
  expect_near(path.at({}, 1).target, {0.0, 1.0, 0.0});
  expect_near(path.at({}, 1).up, direction(Vec3(0.0, 1.0, 1.0)));
  EXPECT_NEAR(path.at({}, 1).fovy_deg, 40, 1e-12);
  expect_near(path.at({}, 2.5).position, {2.0, 7.0, -1.0});
  EXPECT_NEAR(path.at({}, 0.5).fovy_deg, 35, 1e-12);
  // constant outside of the keyframes
  expect_near(path.at({}, -4).position, {9.0, 0.0, 0.0});
  expect_near(path.at({}, 99).position, {2.0, 7.0, -1.0});
}

TEST(CameraPath, AUniformMotionStaysUniformAtNonuniformTimes) {
  // Catmull-Rom tangents for nonuniform times reproduce a uniform linear motion exactly
  const CameraPath path = path_of("t,px,py,pz,tx,ty,tz\n0,0,1,0,5,0,0\n1,2,1,0,5,0,0\n4,8,1,0,5,0,0\n4.5,9,1,0,5,0,0\n");
  for (const double t : {0.1, 0.9, 1.5, 3.3, 4.2}) expect_near(path.at({}, t).position, {2 * t, 1.0, 0.0});
}

TEST(CameraPath, IsSmoothAtAKeyframe) {
  const CameraPath path = path_of("t,px,py,pz,tx,ty,tz\n0,0,1,0,5,0,0\n1,2,4,0,5,0,0\n1.5,3,1,2,5,0,0\n3,3,1,0,5,0,0\n");
  constexpr double h = 1e-6;
  for (const double t : {1.0, 1.5}) {
    const Vec3 before = (path.at({}, t).position - path.at({}, t - h).position) * (1 / h);
    const Vec3 after = (path.at({}, t + h).position - path.at({}, t).position) * (1 / h);
    EXPECT_LE(norm(before - after), 1e-3);
    EXPECT_GT(norm(after), 0.1);
  }
}

TEST(CameraPath, OmittedColumnsAreTheScenes) {
  View base;
  base.up = {1.0, 0.0, 0.0};
  base.fovy_deg = 12;
  base.orthographic = true;
  const View view = path_of("t,px,py,pz,tx,ty,tz\n3,1,2,3,0,0,0\n").at(base, 3);
  expect_near(view.position, {1.0, 2.0, 3.0});
  expect_near(view.up, {1.0, 0.0, 0.0});
  EXPECT_EQ(view.fovy_deg, 12);
  EXPECT_TRUE(view.orthographic);
}

TEST(CameraPath, BadRowsNameTheirLine) {
  const struct {
    const char *text, *part;
  } cases[] = {{"t,px,py,pz,tx,ty,tz\n0,1,0,0,0,0,0\n0,2,0,0,0,0,0\n", "c.csv:3: t is 0 after 0"},
               {"t,px,py,pz,tx,ty,tz\n0,1,0,0,1,0,0\n", "c.csv:2: the target is at the position"},
               {"t,px,py,pz,tx,ty,tz,ux,uy,uz\n0,1,0,0,0,0,0,0,0,0\n", "c.csv:2: up is 0,0,0"},
               {"t,px,py,pz,tx,ty,tz,fovy\n0,1,0,0,0,0,0,180\n", "c.csv:2: fovy is 180"},
               {"t,px,py,pz,tx,ty,tz,ux\n0,1,0,0,0,0,0,0\n", "\"uy\" is missing"},
               {"t,px,py,pz\n0,1,0,0\n", "\"tx\" is missing"}};
  for (const auto& c : cases) {
    const auto path = parse_camera_path(c.text, "c.csv");
    ASSERT_FALSE(path) << c.part;
    EXPECT_NE(path.error().message.find(c.part), std::string::npos) << path.error().message;
  }
  EXPECT_FALSE(read_camera_path("/nowhere/c.csv"));
}

}  // namespace catena::render::camera_path_test
