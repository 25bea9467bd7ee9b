// SPDX-License-Identifier: MIT
/// Pointing at a panel: the pixel that a ray hits, and presses at the panel's edges.
#include "engine/app/viewer/xr/panel.h"

#include <gtest/gtest.h>

namespace catena::panel_test {

using namespace catena::xr_interaction;

const Panel kPanel{{0.3, 1.4, -1.0}, rotation_from_vector({0, 0.4, 0}), 0.8, 0.6, 800, 600};

/// The position of a pixel in the room.
Vec3 place_of(const Panel& p, double x, double y) {
  return p.center_m + rotate(p.orientation, Vec3((x / p.width_px - 0.5) * p.width_m, (0.5 - y / p.height_px) * p.height_m, 0));
}
AimRay aimed(const Vec3& from, const Vec3& at) { return {from, direction(at - from)}; }

TEST(Panel, ARayHitsThePixelAtItsIntersection) {
  const Vec3 hand(0.1, 1.1, 0.2);
  for (double x = 0.5; x < 800; x += 61)
    for (double y = 0.5; y < 600; y += 47) {
      const auto hit = intersect(kPanel, aimed(hand, place_of(kPanel, x, y)));
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->x_px, x, 1e-9);
      EXPECT_NEAR(hit->y_px, y, 1e-9);
      EXPECT_NEAR(hit->distance_m, norm(place_of(kPanel, x, y) - hand), 1e-12);
      EXPECT_TRUE(hit->is_inside);
    }
  EXPECT_FALSE(intersect(kPanel, aimed(hand, place_of(kPanel, 801, 300)))->is_inside);
  EXPECT_FALSE(intersect(kPanel, aimed(hand, place_of(kPanel, 300, -1)))->is_inside);
  const Vec3 normal = rotate(kPanel.orientation, Vec3(0, 0, 1));
  EXPECT_FALSE(intersect(kPanel, {hand, normal})) << "away from it";
  EXPECT_FALSE(intersect(kPanel, aimed(kPanel.center_m - normal, kPanel.center_m))) << "from behind";
  EXPECT_FALSE(intersect(kPanel, {hand, rotate(kPanel.orientation, Vec3(1, 0, 0))})) << "along it";
  EXPECT_FALSE(intersect(kPanel, {Vec3(NAN), Vec3(0, 0, -1)}));
  EXPECT_LT(norm(aim_ray(hand, rotation_from_vector({0, M_PI / 2, 0})).direction - Vec3(-1, 0, 0)), 1e-15);
}

TEST(Panel, IsPlacedUprightInFrontOfTheHead) {
  const Vec3 head(1, 1.7, 2);
  // The head looks to the left and down.
  const Panel p = place_in_front(head, rotation_from_vector({0, M_PI / 2, 0}) * rotation_from_vector({-0.5, 0, 0}), 1.2, 0.2, kPanel);
  EXPECT_LT(norm(p.center_m - Vec3(-0.2, 1.5, 2)), 1e-12);
  EXPECT_LT(norm(rotate(p.orientation, Vec3(0, 0, 1)) - Vec3(1, 0, 0)), 1e-12) << "it is read from where the head is";
  EXPECT_LT(norm(rotate(p.orientation, Vec3(0, 1, 0)) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_TRUE(is_finite(place_in_front(head, rotation_from_vector({-M_PI / 2, 0, 0}), 1, 0, kPanel).center_m)) << "straight down";
}

TEST(PanelPointer, APressStaysWithThePanelOrTheDataWhereItBegan) {
  const Vec3 hand(0.1, 1.1, 0.2);
  PanelPointer pointer;
  const auto at = [&](double x, double y, bool selects) { return pointer.step(kPanel, aimed(hand, place_of(kPanel, x, y)), selects); };
  EXPECT_TRUE(at(400, 300, false).has_pointer);
  EXPECT_FALSE(at(400, 300, false).pressed);
  EXPECT_TRUE(at(400, 300, true).pressed);
  const PanelPointer::Mouse beside = at(900, 300, true);
  EXPECT_TRUE(beside.has_pointer && beside.pressed) << "dragged over the edge";
  EXPECT_NEAR(beside.x_px, 900, 1e-9);
  EXPECT_FALSE(at(900, 300, false).has_pointer);
  EXPECT_FALSE(at(900, 300, true).has_pointer);
  EXPECT_FALSE(at(400, 300, true).has_pointer) << "a press that began on the data stays theirs";
  EXPECT_TRUE(at(400, 300, false).has_pointer);
}

}  // namespace catena::panel_test
