// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/navigation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/viewer/input/commands.h"
#include "engine/base/camera_limits.h"
#include "tests/support/results.h"

namespace catena::app::navigation_test {

using test::value_of;

Navigation controls(bool probe_mode = false) {
  Navigation c;
  c.probe_mode = probe_mode;
  c.view = c.home = {{0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 4};
  return c;
}

/// A notch of the wheel at the distance 10: 1 % of the image's height at that distance.
const double kNotch = 0.01 * 2 * 10 * std::tan(15 * std::numbers::pi / 180);

Input input(double dx, double dy, double wheel = 0) {
  Input i;
  i.width = 320;
  i.height = 240;
  i.dx = dx;
  i.dy = dy;
  i.wheel = wheel;
  return i;
}

/// A motion with a button or a modifier held down.
Input drag(bool Input::*held, Input motion) {
  motion.*held = true;
  return motion;
}

/// The depth and the pixel of a position in the image.
auto projected(const Navigation& c, const Vec3& place) { return render::project(render::make_camera(c.view, 320, 240, {}), place).value(); }

Bounds bounds_of(const Vec3& low, const Vec3& high) {
  Bounds bounds;
  bounds.extend(low);
  bounds.extend(high);
  return bounds;
}

TEST(Navigation, MotionWithoutAButtonDoesNothing) {
  Navigation c = controls();
  EXPECT_FALSE(apply(c, input(30, 20)).any());
  EXPECT_EQ(c.view.position, c.home.position);
}

TEST(Navigation, ALeftDragOrbitsAtAConstantDistance) {
  Navigation c = controls();
  const NavigationChanges changed = apply(c, drag(&Input::left, input(50, 0)));
  EXPECT_TRUE(changed.view);
  EXPECT_FALSE(changed.probe);
  EXPECT_NEAR(norm(c.view.position), 10, 1e-12);
  EXPECT_LT(c.view.position.x, -1);  // the scene follows the pointer to the right: the camera moves to the left
  EXPECT_NEAR(c.view.position.z, 0, 1e-12);

  // Dragging down shows the scene from above, and stops before the pole.
  apply(c, drag(&Input::left, input(0, 1000)));
  EXPECT_GT(c.view.position.z, 9.9);
  EXPECT_GT(std::hypot(c.view.position.x, c.view.position.y), 0.1);
  EXPECT_TRUE(apply(c, Action::reset_view, 4.0 / 3));
  EXPECT_EQ(c.view.position, c.home.position);
}

TEST(Navigation, AViewAlongUpCanStillBeOrbited) {
  render::View view{{0.0, 0.0, 5.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 1};
  orbit(view, 0.5, -0.5);
  EXPECT_TRUE(is_finite(view.position));
  EXPECT_NEAR(norm(view.position), 5, 1e-12);
  EXPECT_GT(std::hypot(view.position.x, view.position.y), 1);
}

TEST(Navigation, PanMovesTheSceneWithThePointer) {
  Navigation c = controls();
  EXPECT_TRUE(apply(c, drag(&Input::middle, input(24, -12))).view);
  const auto p = projected(c, Vec3(0.0));  // was in the center
  EXPECT_NEAR(p.x, 160 + 24, 1e-9);
  EXPECT_NEAR(p.y, 120 - 12, 1e-9);
}

TEST(Navigation, TheWheelZooms) {
  Navigation c = controls();
  EXPECT_TRUE(apply(c, input(0, 0, 1)).view);
  EXPECT_NEAR(norm(c.view.position), 9, 1e-12);
  c.view.orthographic = true;
  apply(c, input(0, 0, -1));
  EXPECT_NEAR(c.view.height, 4 / 0.9, 1e-12);
  EXPECT_NEAR(norm(c.view.position), 9, 1e-12);
}

TEST(Navigation, CameraAndProbeStayWithinTheLimits) {
  for (const double notches : {30.0, -30.0})
    for (const bool flat : {false, true})
      for (const bool as_hand : {false, true}) {
        Navigation c = controls(as_hand);
        c.view.orthographic = flat;
        for (int k = 0; k < 1000; ++k) {
          apply(c, input(50, -20, notches));
          ASSERT_TRUE(is_finite(c.view.position) && is_finite(c.probe)) << k;
          ASSERT_LE(std::max(max_abs(c.view.position), max_abs(c.probe)), kMaxCameraCoordinate) << k;
          ASSERT_EQ(validate_view(c.view.position, c.view.target), "") << k;
        }
      }
}

TEST(Navigation, TheNumberKeysLookAlongTheAxesAtTheWholeScene) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool back : {false, true})
      for (const bool flat : {false, true}) {
        Navigation c = controls();
        c.bounds = bounds_of({1.0, 2.0, 3.0}, {5.0, 3.0, 9.0});
        c.view.orthographic = flat;
        constexpr Action kAlong[2][3] = {{Action::view_along_plus_x, Action::view_along_plus_y, Action::view_along_plus_z},
                                         {Action::view_along_minus_x, Action::view_along_minus_y, Action::view_along_minus_z}};
        EXPECT_TRUE(apply(c, kAlong[back ? 1 : 0][axis], 320.0 / 240));
        Vec3 along(0.0);
        along[axis] = back ? -1 : 1;
        EXPECT_LE(norm(direction(c.view.target - c.view.position) - along), 1e-12);
        EXPECT_EQ(c.view.orthographic, flat);
        const auto camera = render::make_camera(c.view, 320, 240, c.bounds);
        double outermost = 0;
        for (int k = 0; k < 8; ++k) {
          const auto p = render::project(camera, c.bounds.corner(k)).value();
          outermost = std::max({outermost, std::fabs(p.x - 160) / 160, std::fabs(p.y - 120) / 120});
        }
        EXPECT_LE(outermost, 1);
        EXPECT_GE(outermost, 0.8) << "and it fills the picture";
      }
}

TEST(Navigation, FitKeepsTheDirectionAndNeedsBounds) {
  Navigation c = controls();
  EXPECT_FALSE(apply(c, Action::fit_view, 4.0 / 3));
  EXPECT_FALSE(apply(c, Action::view_along_plus_y, 4.0 / 3));
  EXPECT_EQ(c.view.position, c.home.position);

  c.bounds.extend(Vec3(4.0, 0.0, 0.0), 1);
  EXPECT_TRUE(apply(c, Action::fit_view, 4.0 / 3));
  EXPECT_LE(norm(c.view.target - Vec3(4.0, 0.0, 0.0)), 1e-12);
  EXPECT_LE(norm(direction(c.view.target - c.view.position) - Vec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(Navigation, TogglingTheProjectionKeepsSizesInTheTargetsPlane) {
  Navigation c = controls();
  const Vec3 corner(1.5, 0.0, 1.0);
  const auto before = projected(c, corner);
  EXPECT_TRUE(apply(c, Action::toggle_projection, 4.0 / 3));
  EXPECT_TRUE(c.view.orthographic);
  EXPECT_NEAR(projected(c, corner).x, before.x, 1e-9);
  EXPECT_NEAR(projected(c, corner).y, before.y, 1e-9);
  zoom(c.view, 0.5);
  apply(c, Action::toggle_projection, 4.0 / 3);
  EXPECT_FALSE(c.view.orthographic);
  EXPECT_NEAR(norm(c.view.position), 5, 1e-9) << "what was zoomed stays zoomed";
}

TEST(Navigation, TheProbeFollowsThePointerInTheImagePlane) {
  for (bool Input::*const held : {&Input::right, &Input::control}) {
    Navigation c = controls();
    c.probe = {0.2, 1.0, -0.3};
    const auto before = projected(c, c.probe);
    const NavigationChanges changed = apply(c, drag(held, input(40, 25)));
    EXPECT_TRUE(changed.probe);
    EXPECT_FALSE(changed.view);
    const auto after = projected(c, c.probe);
    EXPECT_NEAR(after.x - before.x, 40, 1e-9);
    EXPECT_NEAR(after.y - before.y, 25, 1e-9);
    EXPECT_NEAR(after.z, before.z, 1e-12);
  }
}

TEST(Navigation, InProbeModeTheWheelIsDepthAndTheLeftButtonIsButton1) {
  Navigation c = controls(true);
  EXPECT_TRUE(apply(c, input(0, 0, 2)).probe);
  EXPECT_NEAR(c.probe.y, 2 * kNotch, 1e-12);  // twice 1 % of the image's height at the distance 10, away from the camera
  EXPECT_EQ(c.view.position, c.home.position);
  const Input pressed = drag(&Input::left, input(0, 0));
  EXPECT_TRUE(apply(c, pressed).probe);
  EXPECT_EQ(c.buttons, 1u);
  EXPECT_FALSE(apply(c, pressed).any());
  EXPECT_TRUE(apply(c, input(0, 0)).probe);
  EXPECT_EQ(c.buttons, 0u);
}

TEST(Navigation, AProbeBehindTheCameraReturnsToTheTargetsDepth) {
  Navigation c = controls();
  c.probe = {0.0, -50.0, 0.0};
  apply(c, drag(&Input::right, input(1, 0)));
  EXPECT_NEAR(c.probe.y, 0, 1e-12);
}

scene::Scene scene_of(const std::string& text) { return value_of(scene::parse_scene(text, "test.json")); }

TEST(WorkspaceSetup, TheWorkspaceFillsTheDevicesRange) {
  const Bounds bounds = bounds_of({10.0, 0.0, 0.0}, {50.0, 4.0, 2.0});
  scene::Scene scene = scene_of(R"({"fields": {}, "chain": []})");
  fit_workspace(scene, bounds, 0.2);
  EXPECT_DOUBLE_EQ(scene.workspace.meters_per_unit, 0.005);
  EXPECT_LE(norm(device_from_world(scene.workspace, {50.0, 2.0, 1.0}) - Vec3(0.1, 0.0, 0.0)), 1e-15);
  EXPECT_EQ(scene.coupling.ramp_s, 0.02);
  EXPECT_EQ(initial_probe_position(scene, bounds), Vec3(30.0, 2.0, 1.0));
}

TEST(WorkspaceSetup, TheCenterOfTheDevicesRangeIsTheScenesCenter) {
  const Bounds bounds = bounds_of({10.0, 0.0, 0.0}, {50.0, 4.0, 2.0});
  scene::Scene scene = scene_of(R"({"fields": {}, "chain": []})");
  const Vec3 centre_m{0.0, 0.01, 0.12};
  fit_workspace(scene, bounds, 0.2, centre_m);
  EXPECT_LE(norm(device_from_world(scene.workspace, bounds.center()) - centre_m), 1e-15);
}

TEST(WorkspaceSetup, AStatedWorkspaceAndRampAreKept) {
  scene::Scene scene = scene_of(R"({"fields": {}, "chain": [], "workspace": {"metres_per_unit": 3}, "coupling": {"ramp_s": 0.5}})");
  Bounds bounds;
  bounds.extend(Vec3(0.0), 1);
  fit_workspace(scene, bounds, 0.2);
  EXPECT_EQ(scene.workspace.meters_per_unit, 3);
  EXPECT_EQ(scene.coupling.ramp_s, 0.5);
}

TEST(WorkspaceSetup, TheProbeStartsAtTheFirstSeed) {
  const scene::Scene scene = scene_of(
      R"({"fields": {"v": {"analytic": "circle"}}, "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0.5, 0]}]})");
  EXPECT_EQ(initial_probe_position(scene, {}), Vec3(1.0, 0.5, 0.0));
}

/// Moves the pointer to the pixel (x, y) of the image, from dx to the left.
Input to_pixel(double x, double y, double dx = 1, double wheel = 0) {
  Input i = input(dx, 0, wheel);
  i.x = x - dx;
  i.y = y;
  return i;
}

TEST(Navigation, InProbeModeTheProbeIsOnTheSurfaceUnderThePointer) {
  Navigation c = controls(true);
  c.pointer_hit = Vec3(0.7, 2, 0.3);
  begin_probe_mode(c);
  EXPECT_EQ(c.probe, Vec3(0.7, 2, 0.3));
  const auto camera = render::make_camera(c.view, 320, 240, {});
  c.pointer_hit = render::unproject(camera, 80, 60, 7.5);
  EXPECT_TRUE(apply(c, to_pixel(80, 60)).probe);
  EXPECT_LE(norm(c.probe - *c.pointer_hit), 1e-12);
  // A probe that is pushed with the wheel keeps its depth below the surface.
  apply(c, to_pixel(80, 60, 0, 3));
  const double push = c.wheel_depth;
  EXPECT_NEAR(push, 3 * 0.75 * kNotch, 1e-12);
  EXPECT_NEAR(projected(c, c.probe).z, 7.5 + push, 1e-12);
  EXPECT_NEAR(projected(c, c.probe).x, 80, 1e-9) << "along the view";
  c.pointer_hit = render::unproject(camera, 90, 65, 7.2);
  apply(c, to_pixel(90, 65));
  EXPECT_NEAR(projected(c, c.probe).z, 7.2 + push, 1e-12);
  // Where the pointer hits nothing, the depth stays; while a button is pressed, the depth stays over any surface.
  c.pointer_hit.reset();
  apply(c, to_pixel(200, 100));
  EXPECT_NEAR(projected(c, c.probe).z, 7.2 + push, 1e-12);
  c.pointer_hit = render::unproject(camera, 210, 100, 3.0);
  apply(c, drag(&Input::left, to_pixel(210, 100)));
  EXPECT_NEAR(projected(c, c.probe).z, 7.2 + push, 1e-12);
  EXPECT_NEAR(projected(c, c.probe).x, 210, 1e-9);
}

TEST(Navigation, TheProbesDepthFollowsTheProxy) {
  const auto at = [](double depth) {
    Navigation c = controls(true);
    c.probe = {0, depth - 10, 0};
    c.last_proxy = Vec3(0, 3, 0);
    return c;
  };
  const auto depth = [](const Navigation& c) { return projected(c, c.probe).z; };
  Navigation c = at(11);
  apply(c, to_pixel(160, 120, 0, 1));
  EXPECT_NEAR(depth(c), 11 + 1.1 * kNotch, 1e-9) << "the wheel alone presses";
  c = at(11);
  apply(c, to_pixel(190, 120, Navigation::kDepthBlendPixels / 2));
  EXPECT_NEAR(depth(c), 12, 1e-9) << "half the way";
  apply(c, to_pixel(190, 120, 10 * Navigation::kDepthBlendPixels));
  EXPECT_NEAR(depth(c), 13, 1e-9) << "all of it, and no further";
  // A hit far in front of or behind the proxy is not used as the depth.
  c = at(13);
  c.pointer_hit = Vec3(0, -4, 0);
  apply(c, to_pixel(161, 120));
  EXPECT_NEAR(depth(c), 13, 1e-9);
  c.pointer_hit = Vec3(0, 3.2, 0);
  apply(c, to_pixel(160, 120));
  EXPECT_NEAR(depth(c), 13.2, 1e-9);
  // The depth follows the proxy in probe mode only.
  c = at(11);
  c.probe_mode = false;
  apply(c, drag(&Input::control, input(30, 0)));
  EXPECT_NEAR(depth(c), 11, 1e-9);
}

TEST(Navigation, InProbeModeMotionAgainstTheForceIsReduced) {
  const Vec3 force(0, 0, 4);
  EXPECT_EQ(compliant_motion({0, 0, -1}, force, 8), Vec3(0, 0, -1 + 0.375)) << "half the greatest force takes half of three quarters";
  EXPECT_EQ(compliant_motion({0, 0, -1}, 10.0 * force, 8), Vec3(0, 0, -0.25)) << "the hand is never stuck";
  EXPECT_EQ(compliant_motion({0, 0, 1}, force, 8), Vec3(0, 0, 1));
  EXPECT_EQ(compliant_motion({2, 1, 0}, force, 8), Vec3(2, 1, 0));
  EXPECT_EQ(compliant_motion({0, 0, -1}, Vec3(0.0), 8), Vec3(0, 0, -1));
  // The wheel pushes less against a force, and pulls out at full speed.
  Navigation c = controls(true);
  c.force_n = {0, -8, 0};
  c.max_force_n = 8;
  apply(c, to_pixel(160, 120, 0, 1));
  EXPECT_NEAR(c.probe.y, 0.25 * kNotch, 1e-12);
  apply(c, to_pixel(160, 120, 0, -1));
  EXPECT_NEAR(c.probe.y, 0.25 * kNotch - (1 + 0.025 * kNotch) * kNotch, 1e-12);
}

TEST(Navigation, InFlyModeALeftDragLooksAroundAndTheWheelSetsTheSpeed) {
  Navigation c = controls();
  c.fly = true;
  EXPECT_TRUE(apply(c, drag(&Input::left, input(40, 0))).view);
  EXPECT_EQ(c.view.position, c.home.position);
  EXPECT_GT(c.view.target.x, 0);
  apply(c, input(0, 0, 2));
  EXPECT_GT(c.fly_speed, 1);
  EXPECT_EQ(c.view.position, c.home.position);
}

}  // namespace catena::app::navigation_test
