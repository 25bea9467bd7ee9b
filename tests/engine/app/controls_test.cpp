#include "engine/app/viewer/shell/controls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/app/hand/open_hand.h"
#include "engine/app/viewer/shell/commands.h"
#include "engine/base/eye_limits.h"

namespace catena::app {
namespace controls_test {

Controls controls() {
  Controls c;
  c.view = c.home = {{0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 4};
  return c;
}

Input input(double dx, double dy, double wheel = 0) {
  Input i;
  i.width = 320;
  i.height = 240;
  i.dx = dx;
  i.dy = dy;
  i.wheel = wheel;
  return i;
}

TEST(Controls, MotionWithoutAButtonDoesNothing) {
  Controls c = controls();
  EXPECT_FALSE(apply(c, input(30, 20)).any());
  EXPECT_EQ(c.view.position, c.home.position);
}

TEST(Controls, ALeftDragOrbitsAtTheSameDistance) {
  Controls c = controls();
  Input i = input(50, 0);
  i.left = true;
  const Changed changed = apply(c, i);
  EXPECT_TRUE(changed.view);
  EXPECT_FALSE(changed.hand);
  EXPECT_NEAR(norm(c.view.position), 10, 1e-12);
  EXPECT_LT(c.view.position.x, -1);  // the scene follows the pointer to the right: the eye goes left
  EXPECT_NEAR(c.view.position.z, 0, 1e-12);

  // dragging down shows the scene from above, and stops short of the pole
  i = input(0, 1000);
  i.left = true;
  apply(c, i);
  EXPECT_GT(c.view.position.z, 9.9);
  EXPECT_GT(std::hypot(c.view.position.x, c.view.position.y), 0.1);
  EXPECT_TRUE(apply(c, Action::first_view, 4.0 / 3));
  EXPECT_EQ(c.view.position, c.home.position);
}

TEST(Controls, AViewAlongUpCanStillBeOrbited) {
  render::View view{{0.0, 0.0, 5.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 1};
  orbit(view, 0.5, -0.5);
  EXPECT_TRUE(is_finite(view.position));
  EXPECT_NEAR(norm(view.position), 5, 1e-12);
  EXPECT_GT(std::hypot(view.position.x, view.position.y), 1);
}

TEST(Controls, PanMovesTheSceneWithThePointer) {
  Controls c = controls();
  Input i = input(24, -12);
  i.middle = true;
  EXPECT_TRUE(apply(c, i).view);
  const auto camera = render::make_camera(c.view, 320, 240, {});
  const auto p = render::project(camera, Vec3(0.0));  // was in the middle
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x, 160 + 24, 1e-9);
  EXPECT_NEAR(p->y, 120 - 12, 1e-9);
}

TEST(Controls, TheWheelZooms) {
  Controls c = controls();
  EXPECT_TRUE(apply(c, input(0, 0, 1)).view);
  EXPECT_NEAR(norm(c.view.position), 9, 1e-12);
  c.view.orthographic = true;
  apply(c, input(0, 0, -1));
  EXPECT_NEAR(c.view.height, 4 / 0.9, 1e-12);
  EXPECT_NEAR(norm(c.view.position), 9, 1e-12);
}

TEST(Controls, NeitherEyeNorHandLeavesTheWorld) {
  for (const double notches : {30.0, -30.0})
    for (const bool flat : {false, true})
      for (const bool as_hand : {false, true}) {
        Controls c = controls();
        c.view.orthographic = flat;
        c.hand_mode = as_hand;
        for (int k = 0; k < 1000; ++k) {
          apply(c, input(50, -20, notches));
          ASSERT_TRUE(is_finite(c.view.position) && is_finite(c.hand)) << k;
          ASSERT_LE(std::max(max_abs(c.view.position), max_abs(c.hand)), kMaxEyeCoordinate) << k;
          ASSERT_EQ(eye_problem(c.view.position, c.view.target), "") << k;
        }
      }
}

TEST(Controls, TheNumberKeysLookAlongTheAxesAtAllThatIsDrawn) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool back : {false, true})
      for (const bool flat : {false, true}) {
        Controls c = controls();
        c.bounds.add(Vec3(1.0, 2.0, 3.0));
        c.bounds.add(Vec3(5.0, 3.0, 9.0));
        c.view.orthographic = flat;
        constexpr Action kAlong[2][3] = {{Action::along_x, Action::along_y, Action::along_z},
                                         {Action::against_x, Action::against_y, Action::against_z}};
        EXPECT_TRUE(apply(c, kAlong[back ? 1 : 0][axis], 320.0 / 240));
        Vec3 along(0.0);
        along[axis] = back ? -1 : 1;
        EXPECT_LE(norm(direction(c.view.target - c.view.position) - along), 1e-12);
        EXPECT_EQ(c.view.orthographic, flat);
        const auto camera = render::make_camera(c.view, 320, 240, c.bounds);
        double most_x = 0, most_y = 0;
        for (int k = 0; k < 8; ++k) {
          const auto p = render::project(camera, c.bounds.corner(k));
          ASSERT_TRUE(p);
          most_x = std::max(most_x, std::fabs(p->x - 160) / 160);
          most_y = std::max(most_y, std::fabs(p->y - 120) / 120);
        }
        EXPECT_LE(std::max(most_x, most_y), 1);
        EXPECT_GE(std::max(most_x, most_y), 0.8) << "and it fills the picture";
      }
}

TEST(Controls, FitKeepsTheDirectionAndWithoutBoundsNothingHappens) {
  Controls c = controls();
  EXPECT_FALSE(apply(c, Action::fit, 4.0 / 3));
  EXPECT_FALSE(apply(c, Action::along_y, 4.0 / 3));
  EXPECT_EQ(c.view.position, c.home.position);

  c.bounds.add(Vec3(4.0, 0.0, 0.0), 1);
  EXPECT_TRUE(apply(c, Action::fit, 4.0 / 3));
  EXPECT_LE(norm(c.view.target - Vec3(4.0, 0.0, 0.0)), 1e-12);
  EXPECT_LE(norm(direction(c.view.target - c.view.position) - Vec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(Controls, OKeepsTheSizeOfThingsInTheTargetsPlane) {
  Controls c = controls();
  const Vec3 corner(1.5, 0.0, 1.0);
  const auto place = [&] { return render::project(render::make_camera(c.view, 320, 240, {}), corner); };
  const auto before = place();
  EXPECT_TRUE(apply(c, Action::projection, 4.0 / 3));
  EXPECT_TRUE(c.view.orthographic);
  EXPECT_NEAR(place()->x, before->x, 1e-9);
  EXPECT_NEAR(place()->y, before->y, 1e-9);
  zoom(c.view, 0.5);
  apply(c, Action::projection, 4.0 / 3);
  EXPECT_FALSE(c.view.orthographic);
  EXPECT_NEAR(norm(c.view.position), 5, 1e-9) << "what was zoomed stays zoomed";
}

TEST(Controls, TheHandFollowsThePointerInThePicturesPlane) {
  for (const int way : {0, 1, 2}) {
    Controls c = controls();
    c.hand = {0.2, 1.0, -0.3};
    const auto camera = render::make_camera(c.view, 320, 240, {});
    const auto before = render::project(camera, c.hand);
    Input i = input(40, 25);
    i.right = way == 0;
    i.control = way == 1;
    c.hand_mode = way == 2;
    const Changed changed = apply(c, i);
    EXPECT_TRUE(changed.hand);
    EXPECT_FALSE(changed.view);
    const auto after = render::project(camera, c.hand);
    EXPECT_NEAR(after->x - before->x, 40, 1e-9);
    EXPECT_NEAR(after->y - before->y, 25, 1e-9);
    EXPECT_NEAR(after->z, before->z, 1e-12);
  }
}

TEST(Controls, InHandModeTheWheelIsDepthAndTheButtonIsTheDevices) {
  Controls c = controls();
  c.hand_mode = true;
  EXPECT_TRUE(apply(c, input(0, 0, 2)).hand);
  EXPECT_NEAR(c.hand.y, 0.2, 1e-12);  // 1 % of the distance 10, twice, away from the eye
  EXPECT_EQ(c.view.position, c.home.position);
  Input i = input(0, 0);
  i.left = true;
  EXPECT_TRUE(apply(c, i).hand);
  EXPECT_EQ(c.buttons, 1u);
  EXPECT_FALSE(apply(c, i).any());
  i.left = false;
  EXPECT_TRUE(apply(c, i).hand);
  EXPECT_EQ(c.buttons, 0u);
}

TEST(Controls, AHandBehindTheEyeComesBackIntoThePicture) {
  Controls c = controls();
  c.hand = {0.0, -50.0, 0.0};
  Input i = input(1, 0);
  i.right = true;
  apply(c, i);
  EXPECT_NEAR(c.hand.y, 0, 1e-12);
}

TEST(HandSetup, TheWorkspaceFillsTheDevicesReach) {
  auto scene = scene::parse_scene(R"({"fields": {}, "chain": []})", "test.json");
  ASSERT_TRUE(scene);
  Bounds bounds;
  bounds.add(Vec3(10.0, 0.0, 0.0));
  bounds.add(Vec3(50.0, 4.0, 2.0));
  fit_workspace(*scene, bounds, 0.2);
  EXPECT_DOUBLE_EQ(scene->workspace.metres_per_unit, 0.005);
  EXPECT_LE(norm(device_from_world(scene->workspace, {50.0, 2.0, 1.0}) - Vec3(0.1, 0.0, 0.0)), 1e-15);
  EXPECT_EQ(scene->coupling.ramp_s, 0.02);
  EXPECT_EQ(first_probe(*scene, bounds), Vec3(30.0, 2.0, 1.0));
}

TEST(HandSetup, TheMiddleOfTheDevicesReachIsTheMiddleOfTheScene) {
  auto scene = scene::parse_scene(R"({"fields": {}, "chain": []})", "test.json");
  ASSERT_TRUE(scene);
  Bounds bounds;
  bounds.add(Vec3(10.0, 0.0, 0.0));
  bounds.add(Vec3(50.0, 4.0, 2.0));
  const Vec3 centre_m{0.0, 0.01, 0.12};
  fit_workspace(*scene, bounds, 0.2, centre_m);
  EXPECT_LE(norm(device_from_world(scene->workspace, bounds.centre()) - centre_m), 1e-15);
}

TEST(HandSetup, AGivenWorkspaceAndRampStay) {
  auto scene =
      scene::parse_scene(R"({"fields": {}, "chain": [], "workspace": {"metres_per_unit": 3}, "coupling": {"ramp_s": 0.5}})", "test.json");
  ASSERT_TRUE(scene);
  Bounds bounds;
  bounds.add(Vec3(0.0), 1);
  fit_workspace(*scene, bounds, 0.2);
  EXPECT_EQ(scene->workspace.metres_per_unit, 3);
  EXPECT_EQ(scene->coupling.ramp_s, 0.5);
}

TEST(HandSetup, TheHandBeginsAtTheFirstSeed) {
  auto scene = scene::parse_scene(
      R"({"fields": {"v": {"analytic": "circle"}}, "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0.5, 0]}]})",
      "test.json");
  ASSERT_TRUE(scene);
  EXPECT_EQ(first_probe(*scene, {}), Vec3(1.0, 0.5, 0.0));
}

TEST(Controls, TheHandsDepthFollowsWhatHoldsIt) {
  Controls c = controls();
  c.hand_mode = true;
  c.hand = {0, 1, 0};
  c.held = Vec3(0, 3, 0);  // two units deeper
  Input still = input(0, 0, 1);
  const double before = c.hand.y;
  apply(c, still);
  EXPECT_LT(std::fabs(c.hand.y - before), 0.2) << "the wheel alone presses";
  c.hand = {0, 1, 0};
  Input sideways = input(Controls::kDepthPixels / 2, 0);
  apply(c, sideways);
  EXPECT_NEAR(c.hand.y, 2, 1e-9) << "half the way";
  sideways.dx = 10 * Controls::kDepthPixels;
  apply(c, sideways);
  EXPECT_NEAR(c.hand.y, 3, 1e-9) << "all of it, and no further";
  c.hand_mode = false;
  c.hand = {0, 1, 0};
  sideways.control = true;
  apply(c, sideways);
  EXPECT_NEAR(c.hand.y, 1, 1e-9) << "only in hand mode";
}

TEST(Controls, InHandModeTheMouseYieldsToTheForceButNotAwayFromIt) {
  const Vec3 force(0, 0, 4);
  EXPECT_EQ(yielding({0, 0, -1}, force, 8), Vec3(0, 0, -1 + 0.375)) << "half the greatest force takes half of three quarters";
  EXPECT_EQ(yielding({0, 0, -1}, 10.0 * force, 8), Vec3(0, 0, -0.25)) << "the hand is never stuck";
  EXPECT_EQ(yielding({0, 0, 1}, force, 8), Vec3(0, 0, 1));
  EXPECT_EQ(yielding({2, 1, 0}, force, 8), Vec3(2, 1, 0));
  EXPECT_EQ(yielding({0, 0, -1}, Vec3(0.0), 8), Vec3(0, 0, -1));
  // with the button alone, as before, the hand goes with the mouse
  Controls free = controls(), held = controls();
  free.force_n = held.force_n = {-8, 0, 0};
  free.max_force_n = held.max_force_n = 8;
  held.hand_mode = true;
  Input i = input(40, 0);
  i.right = true;
  apply(free, i);
  apply(held, i);
  EXPECT_NEAR(held.hand.x, 0.25 * free.hand.x, 1e-12);
  EXPECT_GT(free.hand.x, 0);
}

TEST(Controls, InFlightALeftDragLooksAboutAndTheWheelSetsThePace) {
  Controls c = controls();
  c.fly = true;
  Input i = input(40, 0);
  i.left = true;
  EXPECT_TRUE(apply(c, i).view);
  EXPECT_EQ(c.view.position, c.home.position);
  EXPECT_GT(c.view.target.x, 0);
  apply(c, input(0, 0, 2));
  EXPECT_GT(c.fly_speed, 1);
  EXPECT_EQ(c.view.position, c.home.position);
}

}  // namespace controls_test
}  // namespace catena::app
