// SPDX-License-Identifier: MIT
// Mouse input in the planes of a page of orthogonal views.
#include "engine/app/viewer/input/plane_views.h"

#include <gtest/gtest.h>

#include "engine/app/viewer/input/commands.h"
#include "engine/field/field_display_range.h"
#include "render/extract/extract.h"
#include "render/extract/plane_views.h"
#include "tests/support/results.h"

namespace catena::app::plane_input_test {

using test::value_of;

const Area kPage{300, 20, 800, 600};

Input segment(double x, double y, double dx, double dy, double wheel, bool Input::*button) {
  Input input;
  input.x = x;
  input.y = y;
  input.dx = dx;
  input.dy = dy;
  input.wheel = wheel;
  if (button != nullptr) input.*button = true;
  return input;
}

class PlaneInput : public testing::Test {
 protected:
  PlaneInput() : scene_(value_of(scene::parse_scene(kScene, "s.json"))) { draw(); }
  void draw() {
    packet_ = value_of(render::make_frame(scene_, 400, 300));
    const auto planes = value_of(render::find_ortho_planes(scene_));
    value_of(render::add_plane_views(scene_, planes, controls_.ortho, packet_));
  }
  /// Applies an input to the view at its position, and draws again.
  NavigationChanges at(Input input) {
    const int view = page_view_at(kPage, input.x, input.y);
    const NavigationChanges changed =
        apply_to_plane(controls_, input, *packet_.planes[static_cast<std::size_t>(view - 1)], page_view_area(kPage, view));
    draw();
    return changed;
  }
  static constexpr const char* kScene =
      R"({"fields": {"d": {"analytic": "sphere", "resolution": 17}}, "isosurfaces": [{"field": "d", "level": 1}]})";
  scene::Scene scene_;
  Navigation controls_;
  render::FramePacket packet_;
};

TEST_F(PlaneInput, ViewsFillThePage) {
  const int order[] = {1, 0, 2, 3};
  for (int k = 0; k < 4; ++k) {
    const Area area = page_view_area(kPage, order[k]);
    EXPECT_EQ(area.x, 300 + k % 2 * 400);
    EXPECT_EQ(area.y, 20 + k / 2 * 300);
    EXPECT_EQ(page_view_at(kPage, area.x + 1, area.y + 1), order[k]);
    EXPECT_EQ(page_view_at(kPage, area.x + area.width - 1, area.y + area.height - 1), order[k]);
  }
}

TEST_F(PlaneInput, ADragMovesTheCommonPointUnderThePointer) {
  // plane x y: its view is at the top left, 1.06 times 4 units high
  EXPECT_TRUE(at(segment(500, 170, 60, -30, 0, &Input::left)).view);
  const double pixel = 1.06 * 4 / 300;
  ASSERT_TRUE(controls_.ortho.focus);
  EXPECT_LT(norm(*controls_.ortho.focus - Vec3(60 * pixel, 30 * pixel, 0)), 1e-9);
  // plane x z keeps y
  at(segment(500, 470, 0, -50, 0, &Input::left));
  EXPECT_LT(norm(*controls_.ortho.focus - Vec3(0, 30 * pixel, 50 * pixel)), 1e-9);
}

TEST_F(PlaneInput, TheWheelMovesThePlaneByAVoxel) {
  at(segment(400, 100, 0, 0, 1, nullptr));
  EXPECT_LT(norm(*controls_.ortho.focus - Vec3(0, 0, 0.25)), 1e-9);
  at(segment(400, 100, 0, 0, -2, nullptr));
  EXPECT_LT(norm(*controls_.ortho.focus - Vec3(0, 0, -0.25)), 1e-9);
}

TEST_F(PlaneInput, ARightDragChangesWindowAndLevel) {
  at(segment(400, 100, 40, 0, 0, &Input::right));
  const DisplayRange& range = field::display_range(*packet_.planes[0]->slices[0].grid);
  const double whole = range.hi - range.lo, middle = 0.5 * (range.lo + range.hi);
  ASSERT_TRUE(controls_.ortho.window);
  auto [lo, hi] = *controls_.ortho.window;
  EXPECT_NEAR(hi - lo, 1.2 * whole, 1e-9);
  EXPECT_NEAR(0.5 * (lo + hi), middle, 1e-9);
  at(segment(400, 100, 0, -30, 0, &Input::right));
  std::tie(lo, hi) = std::pair((*controls_.ortho.window)[0], (*controls_.ortho.window)[1]);
  EXPECT_NEAR(0.5 * (lo + hi), middle - 0.1 * whole, 1e-9) << "brighter";
  EXPECT_NEAR(packet_.planes[0]->slices[0].colors.front()[0], lo, 1e-9) << "it is drawn";
  for (int k = 0; k < 20; ++k) at(segment(400, 100, -400, 0, 0, &Input::right));
  EXPECT_LT((*controls_.ortho.window)[0], (*controls_.ortho.window)[1]) << "a window stays";
}

TEST_F(PlaneInput, ControlAndWheelZoomAboutThePointerAndAMiddleDragMovesTheImages) {
  controls_.ortho.focus = Vec3(0, 0, 0.5);
  draw();
  const Area area = page_view_area(kPage, 1);
  const auto seen = [&](const Area& where) { return plane_point(*packet_.planes[0], where, 420, 130); };
  const Vec3 before = seen(area);
  Input zoom = segment(420, 130, 0, 0, 3, nullptr);
  zoom.control = true;
  EXPECT_TRUE(at(zoom).view);
  EXPECT_LT(norm(seen(area) - before), 1e-9) << "under the pointer";
  EXPECT_NEAR(packet_.planes[2]->view.height, 1.06 * 4 / std::pow(1.15, 3), 1e-9) << "all planes have one scale";
  EXPECT_EQ(*controls_.ortho.focus, Vec3(0, 0, 0.5)) << "the plane stays";
  const Vec3 y_z = packet_.planes[2]->view.target;
  at(segment(420, 130, 30, -20, 0, &Input::middle));
  EXPECT_LT(norm(plane_point(*packet_.planes[0], area, 450, 110) - before), 1e-9) << "the point follows the pointer";
  EXPECT_EQ(packet_.planes[2]->view.target.z, y_z.z);
  controls_.bounds = render::packet_bounds(packet_);
  apply(controls_, Action::fit_view, 1);
  EXPECT_EQ(controls_.ortho.zoom, 1) << "shows everything";
}

TEST_F(PlaneInput, AnAreaOfLessThanAPixelHasACamera) {
  const Area area{0, 0, 0.5, 0.5};
  EXPECT_TRUE(is_finite(plane_point(*packet_.planes[0], area, 0, 0)));
  EXPECT_TRUE(is_finite(render::pixel_ray(make_area_camera(packet_.view, 0, 0), 0, 0).direction));
}

TEST_F(PlaneInput, InProbeModeTheProbeMovesInThePlane) {
  controls_.ortho.focus = Vec3(0, 0, 0.5);
  draw();
  controls_.probe_mode = true;
  const NavigationChanges changed = at(segment(500, 170, 60, 0, 0, &Input::left));
  EXPECT_TRUE(changed.probe);
  EXPECT_LT(norm(controls_.probe - Vec3(60 * 1.06 * 4 / 300, 0, 0.5)), 1e-9);
  EXPECT_EQ(controls_.buttons, 1u);
  EXPECT_EQ(*controls_.ortho.focus, Vec3(0, 0, 0.5)) << "the plane stays";
}

}  // namespace catena::app::plane_input_test
