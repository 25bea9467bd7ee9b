// SPDX-License-Identifier: MIT
/// Objects that follow a widget, in the packet: valid frames at any position of the widget.
#include "engine/scene/prepare.h"
#include "engine/scene/widgets.h"
#include "tests/render/support/scene_packet.h"

namespace catena::render::widget_followers_test {

scene::Scene parsed() {
  return test::scene_from(R"({
    "fields": {"s": {"analytic": "sphere", "resolution": 17, "box": [-1, 1]}, "v": {"analytic": "circle"}},
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0.25], "normal": [0, 0, 1]},
      {"name": "r", "type": "rake", "from": [0.5, 0, 0], "to": [1, 0, 0]},
      {"name": "l", "type": "isolevel", "field": "s", "position": [0.5, 0, 0]}],
    "slices": [{"field": "s", "widget": "cut", "contours": {"count": 3}}],
    "clip": [{"widget": "cut", "side": "behind"}],
    "streamlines": [{"field": "v", "seeds": {"widget": "r", "count": 4}, "color_by": {"quantity": "speed"}, "arrows": 0.5}],
    "isosurfaces": [{"field": "s", "level": {"widget": "l"}}],
    "scalar_bars": [{"streamlines": 0}, {"slice": 0}], "bounding_box": true})");
}

FramePacket frame(scene::Scene& scene) { return test::packet_from(scene, 64, 48); }

void move(scene::Scene& scene, const char* name, const Vec3& a, const Vec3& b = Vec3(0.0)) {
  ASSERT_TRUE(scene::set_widget_pose(scene, scene::find_widget(scene, name), {{a, b}, kIdentityRotation}));
}

TEST(WidgetFollowers, ThePacketFollowsTheWidgets) {
  scene::Scene scene = parsed();
  FramePacket packet = frame(scene);
  ASSERT_EQ(packet.slices.size(), 1u);
  EXPECT_EQ(packet.slices[0].point, Vec3(0, 0, 0.25));
  EXPECT_EQ(packet.clip_planes[0].normal, Vec3(0, 0, -1));
  EXPECT_EQ(packet.tubes.size(), 4u);
  EXPECT_EQ(packet.isosurfaces[0].level, 0.5) << "nobody has driven them but the extraction itself";
  move(scene, "cut", {0, 0, -0.5});
  move(scene, "r", {0, 0.2, 0}, {0, 0.4, 0});
  move(scene, "l", {0, 0.75, 0});
  packet = frame(scene);
  EXPECT_EQ(packet.slices[0].point.z, -0.5);
  EXPECT_EQ(packet.clip_planes[0].point.z, -0.5);
  EXPECT_EQ(packet.isosurfaces[0].level, 0.75);
  ASSERT_EQ(packet.tubes.size(), 4u);
  EXPECT_NEAR(norm(packet.tubes[0].points[0]), 0.2, 1e-5);
}

TEST(WidgetFollowers, OutsideTheDomainTheFrameIsValid) {
  scene::Scene scene = parsed();
  frame(scene);
  move(scene, "cut", {0, 0, 50});
  move(scene, "r", {0, 0, 0}, {0, 0, 1});  // where the flow is zero
  move(scene, "l", {30, 0, 0});
  FramePacket packet = frame(scene);
  EXPECT_EQ(packet.tubes.size(), 0u);
  EXPECT_EQ(packet.arrows.size(), 0u);
  EXPECT_EQ(packet.slices.size(), 1u) << "scalar bars count them";
  EXPECT_EQ(packet.isosurfaces[0].level, packet.isosurfaces[0].grid->max_value());
  // back in the flow
  move(scene, "r", {0.5, 0, 0}, {1, 0, 0});
  EXPECT_EQ(frame(scene).tubes.size(), 4u);
}

}  // namespace catena::render::widget_followers_test
