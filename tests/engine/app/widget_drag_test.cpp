// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/widget_drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/scene/widgets.h"
#include "engine/widget/handles.h"
#include "tests/support/results.h"

namespace catena::app::widget_drag_test {

using test::value_of;

constexpr double kWidth = 800, kHeight = 600;
const Bounds kDrawn{Vec3(-1.0), Vec3(1.0)};

scene::Scene scene_with(const std::string& widget) {
  scene::Scene scene =
      value_of(scene::parse_scene("{\"fields\": {\"d\": {\"analytic\": \"sphere\"}}, \"widgets\": [" + widget + "]}", "s.json"));
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget&) { value_of(scene::resolve_widget(scene, e)); });
  return scene;
}

render::Camera camera(bool orthographic) {
  render::View view;
  view.position = {3, -5, 2.5};
  view.target = {0.1, 0, 0.2};
  view.orthographic = orthographic;
  view.height = 4;
  return render::make_camera(view, kWidth, kHeight, kDrawn);
}

scene::Widget& widget_of(scene::Scene& scene) { return scene.entities.get<scene::Widget>(scene::find_widget(scene, "w")); }

/// Drags from the image of `from` to the image of `to`.
widget::Pose drag(scene::Scene& scene, const render::Camera& camera, const Vec3& from, const Vec3& to, int handle, int axis) {
  const Vec3 press = *render::project(camera, from), release = *render::project(camera, to);
  const auto part = find_widget_part(scene, kDrawn, camera, press.x, press.y);
  if (!part || part->handle != handle || part->axis != axis) {
    ADD_FAILURE() << "handle " << (part ? part->handle : -9) << ", axis " << (part ? part->axis : -9) << " instead of " << handle << ", "
                  << axis;
    return {};
  }
  return WidgetDrag(widget_of(scene), *part, camera).pose_at(camera, release.x, release.y);
}

class WidgetDrag : public testing::TestWithParam<bool> {
 protected:
  const render::Camera camera_ = camera(GetParam());
};

TEST_P(WidgetDrag, TheArrowAndTheOutlineSlideThePlaneAlongItsNormal) {
  scene::Scene scene = scene_with(R"({"name": "w", "type": "cutting_plane", "center": [0.1, 0.2, 0], "normal": [1, 2, 2], "radius": 0.5})");
  const Vec3 center(0.1, 0.2, 0), normal = direction(Vec3(1, 2, 2));
  const Vec3 outline(1, 0.2 - 0.45, 0);  // on the face x = 1
  for (const Vec3& from : {center + 0.6 * normal, outline}) {
    const widget::Pose pose = drag(scene, camera_, from, from + 0.3 * normal, 0, -1);
    EXPECT_LT(norm(pose.points[0] - (center + 0.3 * normal)), 1e-6);
    EXPECT_EQ(pose.orientation, widget_of(scene).report.pose.orientation);
  }
}

TEST_P(WidgetDrag, ACircleTurnsThePlaneAboutItsAxis) {
  scene::Scene scene = scene_with(R"({"name": "w", "type": "cutting_plane", "center": [0.1, 0.2, 0], "normal": [1, 2, 2], "radius": 0.5})");
  const widget::Pose before = widget_of(scene).report.pose;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 e = widget::frame_axis(before.orientation, axis), u = widget::frame_axis(before.orientation, (axis + 1) % 3),
               v = widget::frame_axis(before.orientation, (axis + 2) % 3);
    const auto on_circle = [&](double angle) { return before.points[0] + 0.5 * (std::cos(angle) * u + std::sin(angle) * v); };
    // a point on the near side, away from the other circles
    double angle = 0.7;
    while (dot(on_circle(angle) - before.points[0], camera_.back) < 0.1) angle += 0.5 * std::numbers::pi;
    const widget::Pose pose = drag(scene, camera_, on_circle(angle), on_circle(angle + 0.2), -1, axis);
    EXPECT_EQ(pose.points[0], before.points[0]);
    EXPECT_LT(norm(widget::frame_axis(pose.orientation, axis) - e), 1e-12);
    const Vec3 turned = widget::frame_axis(pose.orientation, (axis + 1) % 3);
    EXPECT_NEAR(std::atan2(dot(turned, v), dot(turned, u)), 0.2, 0.01);
  }
}

TEST_P(WidgetDrag, HandlesMoveUnderThePointer) {
  const Vec3 step = 0.2 * camera_.right - 0.1 * camera_.up;
  scene::Scene rake = scene_with(R"({"name": "w", "type": "rake", "from": [-0.5, 0, 0], "to": [0.5, 0.2, 0]})");
  widget::Pose pose = drag(rake, camera_, {0.5, 0.2, 0}, Vec3(0.5, 0.2, 0) + step, 1, -1);
  EXPECT_EQ(pose.points[0], Vec3(-0.5, 0, 0));
  EXPECT_LT(norm(pose.points[1] - (Vec3(0.5, 0.2, 0) + step)), 1e-9);
  pose = drag(rake, camera_, {-0.25, 0.05, 0}, Vec3(-0.25, 0.05, 0) + step, 2, -1);  // the segment
  EXPECT_LT(norm(pose.points[0] - (Vec3(-0.5, 0, 0) + step)), 1e-6);
  scene::Scene box = scene_with(R"({"name": "w", "type": "box", "min": [-0.5, -0.5, -0.5], "max": [0.5, 0.6, 0.7]})");
  pose = drag(box, camera_, {0.5, 0.05, 0.1}, {0.8, 0.05, 0.1}, 1, -1);
  EXPECT_EQ(pose.points[0], Vec3(-0.5));
  EXPECT_LT(norm(pose.points[1] - Vec3(0.8, 0.6, 0.7)), 1e-9);
  pose = drag(box, camera_, {0.5, 0.05, 0.1}, {-3, 0.05, 0.1}, 1, -1);
  EXPECT_GT(pose.points[1].x, pose.points[0].x) << "the face passes the opposite one";
}

TEST_P(WidgetDrag, NothingIsFoundAwayFromTheParts) {
  const scene::Scene scene =
      scene_with(R"({"name": "w", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.5})");
  const Vec3 inside = *render::project(camera_, {0.75, 0, 0});
  EXPECT_FALSE(find_widget_part(scene, kDrawn, camera_, inside.x, inside.y)) << "on the plane, between sphere and outline";
  EXPECT_FALSE(find_widget_part(scene, kDrawn, camera_, 5, 5));
}

INSTANTIATE_TEST_SUITE_P(Cameras, WidgetDrag, testing::Bool(), [](const auto& one) { return one.param ? "Orthographic" : "Perspective"; });

}  // namespace catena::app::widget_drag_test
