/// Pointing at a panel: the pixel that a ray means, and what a press does at its edges.
#include "engine/immersive/panel.h"

#include <gtest/gtest.h>

namespace panel_test {

using namespace catena;
using namespace catena::immersive;

const Panel kPanel{{0.3, 1.4, -1.0}, rotation_of({0, 0.4, 0}), 0.8, 0.6, 800, 600};

/// The room place of a pixel.
Vec3 place_of(const Panel& p, double x, double y) {
  return p.middle_m + rotate(p.orientation, Vec3((x / p.width_px - 0.5) * p.width_m, (0.5 - y / p.height_px) * p.height_m, 0));
}
AimRay aimed(const Vec3& from, const Vec3& at) { return {from, direction(at - from)}; }

TEST(Panel, TheRayMeansThePixelThatItMeets) {
  const Vec3 hand(0.1, 1.1, 0.2);
  for (double x = 0.5; x < 800; x += 61)
    for (double y = 0.5; y < 600; y += 47) {
      const auto hit = meet(kPanel, aimed(hand, place_of(kPanel, x, y)));
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->x_px, x, 1e-9);
      EXPECT_NEAR(hit->y_px, y, 1e-9);
      EXPECT_NEAR(hit->distance_m, norm(place_of(kPanel, x, y) - hand), 1e-12);
      EXPECT_TRUE(hit->inside);
    }
  EXPECT_FALSE(meet(kPanel, aimed(hand, place_of(kPanel, 801, 300)))->inside);
  EXPECT_FALSE(meet(kPanel, aimed(hand, place_of(kPanel, 300, -1)))->inside);
  const Vec3 normal = rotate(kPanel.orientation, Vec3(0, 0, 1));
  EXPECT_FALSE(meet(kPanel, {hand, normal})) << "away from it";
  EXPECT_FALSE(meet(kPanel, aimed(kPanel.middle_m - normal, kPanel.middle_m))) << "from behind";
  EXPECT_FALSE(meet(kPanel, {hand, rotate(kPanel.orientation, Vec3(1, 0, 0))})) << "along it";
  EXPECT_FALSE(meet(kPanel, {Vec3(NAN), Vec3(0, 0, -1)}));
  EXPECT_LT(norm(aim_ray(hand, rotation_of({0, M_PI / 2, 0})).direction - Vec3(-1, 0, 0)), 1e-15);
}

TEST(Panel, StandsLevelBeforeTheHead) {
  const Vec3 head(1, 1.7, 2);
  // looking to the left and down
  const Panel p = in_front_of(head, rotation_of({0, M_PI / 2, 0}) * rotation_of({-0.5, 0, 0}), 1.2, 0.2, kPanel);
  EXPECT_LT(norm(p.middle_m - Vec3(-0.2, 1.5, 2)), 1e-12);
  EXPECT_LT(norm(rotate(p.orientation, Vec3(0, 0, 1)) - Vec3(1, 0, 0)), 1e-12) << "it is read from where the head is";
  EXPECT_LT(norm(rotate(p.orientation, Vec3(0, 1, 0)) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_TRUE(is_finite(in_front_of(head, rotation_of({-M_PI / 2, 0, 0}), 1, 0, kPanel).middle_m)) << "straight down";
}

TEST(PanelPointer, APressKeepsThePanelItBeganOn) {
  const Vec3 hand(0.1, 1.1, 0.2);
  PanelPointer pointer;
  const auto at = [&](double x, double y, bool selects) { return pointer.step(kPanel, aimed(hand, place_of(kPanel, x, y)), selects); };
  EXPECT_TRUE(at(400, 300, false).here);
  EXPECT_FALSE(at(400, 300, false).pressed);
  EXPECT_TRUE(at(400, 300, true).pressed);
  const PanelPointer::Mouse beside = at(900, 300, true);
  EXPECT_TRUE(beside.here && beside.pressed) << "dragged over the edge";
  EXPECT_NEAR(beside.x_px, 900, 1e-9);
  EXPECT_FALSE(at(900, 300, false).here);
  EXPECT_FALSE(at(900, 300, true).here);
  EXPECT_FALSE(at(400, 300, true).here) << "a press that began on the data stays theirs";
  EXPECT_TRUE(at(400, 300, false).here);
}

}  // namespace panel_test
