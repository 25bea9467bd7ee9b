// SPDX-License-Identifier: MIT
#include "engine/scene/ruler.h"

#include <numbers>
#include <random>

#include "engine/scene/widgets.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::ruler_test {

using How = RulerMeasure::PathKind;
constexpr double kPi = std::numbers::pi;

/// A scene with a ruler along the named links of `chain`.
Scene scene_with(const std::string& chain, const std::string& along) {
  return parsed(R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}, "u": {"analytic": "uniform"}},
    "chain": [)" +
                chain + R"(], "widgets": [{"name": "u", "type": "ruler", "from": [0, 0, 0], "to": [1, 0, 0])" +
                (along.empty() ? "" : ", \"along\": [" + along + "]") +
                R"(}, {"name": "p", "type": "seed", "position": [1, 0, 0]},
      {"name": "l", "type": "isolevel", "field": "s", "position": [1, 0, 0]}]})");
}

RulerMeasure measured(Scene& scene, const Vec3& from, const Vec3& to) {
  const Entity ruler = find_widget(scene, "u");
  EXPECT_TRUE(set_widget_pose(scene, ruler, {{from, to}, kIdentityRotation}));
  return value_of(resolve_ruler(scene, ruler));
}

const std::string kCurve = R"({"name": "curve", "type": "streamline", "field": "v", "seed": [1, 0, 0]})";
const std::string kSkin = R"({"name": "skin", "type": "isosurface", "field": "s", "level": 1})";

TEST(Ruler, WithoutALinkTheLineIsStraight) {
  Scene scene = scene_with("", "");
  const RulerMeasure measure = measured(scene, {1, 2, 3}, {1, 5, 7});
  EXPECT_EQ(measure.path_kind, How::straight);
  EXPECT_EQ(measure.length, 5);
  EXPECT_EQ(measure.points, (std::vector<Vec3>{{1, 2, 3}, {1, 5, 7}}));
  EXPECT_TRUE(measure.note.empty());
}

TEST(Ruler, AlongAClosedStreamlineItTakesTheShorterWay) {
  Scene scene = scene_with(kCurve, "\"curve\"");
  const auto at = [](double degrees, double radius = 1) {
    return radius * Vec3(std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180), 0);
  };
  const auto expect = [&](double from, double to, double degrees) {
    const RulerMeasure measure = measured(scene, at(from, 1.1), at(to, 0.8));
    EXPECT_EQ(measure.path_kind, How::streamline);
    EXPECT_NEAR(measure.length, degrees * kPi / 180, 1e-8) << from << " " << to;
    ASSERT_GE(measure.points.size(), 2u);
    EXPECT_LT(norm(measure.points.front() - at(from)), 1e-8) << "from the first end";
    EXPECT_LT(norm(measure.points.back() - at(to)), 1e-8);
    double polyline = 0;
    for (std::size_t i = 1; i < measure.points.size(); ++i) {
      polyline += norm(measure.points[i] - measure.points[i - 1]);
      EXPECT_NEAR(norm(measure.points[i]), 1, 1e-8) << "what is drawn lies on the line";
    }
    EXPECT_NEAR(polyline, measure.length, 1e-3 * measure.length);
  };
  for (const auto& [from, to, degrees] : {std::tuple{30, 100, 70}, {20, 220, 160}, {-30, 40, 70}}) {
    expect(from, to, degrees);
    expect(to, from, degrees);
  }
  expect(1, 359, 2);
}

TEST(Ruler, FollowsAnOpenStreamlineAndAMovingSeed) {
  Scene scene = scene_with(R"({"name": "curve", "type": "streamline", "field": "u", "seed": [0, 0, 0]})", "\"curve\"");
  const Vec3 t = direction(
      (*resolve_streamline(scene, {resolve_field(scene, find_field(scene, "u"), {})->vector.get()}, {0, 0, 0}, {}))->knots()[0].t);
  const RulerMeasure measure = measured(scene, -0.5 * t, 1.5 * t);
  EXPECT_EQ(measure.path_kind, How::streamline);
  EXPECT_NEAR(measure.length, 2, 1e-9);

  Scene moving = scene_with(R"({"name": "curve", "type": "streamline", "field": "v", "seed": {"widget": "p"}})", "\"curve\"");
  EXPECT_NEAR(measured(moving, {1, 0, 0}, {0, 1, 0}).length, 0.5 * kPi, 1e-8);
  ASSERT_TRUE(set_widget_pose(moving, find_widget(moving, "p"), {{Vec3(0.5, 0, 0), Vec3(0)}, kIdentityRotation}));
  EXPECT_NEAR(resolve_ruler(moving, find_widget(moving, "u"))->length, 0.25 * kPi, 1e-8);
  // A seed where no line starts: a note, and a straight line.
  ASSERT_TRUE(set_widget_pose(moving, find_widget(moving, "p"), {{Vec3(0), Vec3(0)}, kIdentityRotation}));
  const RulerMeasure none = value_of(resolve_ruler(moving, find_widget(moving, "u")));
  EXPECT_EQ(none.path_kind, How::straight);
  EXPECT_TRUE(has(none.note, "zero at the seed"));
}

TEST(Ruler, AlongASphereItIsTheGreatCircle) {
  Scene scene = scene_with(kSkin, "\"skin\"");
  std::mt19937 engine{4};
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 20; ++i) {
    const Vec3 a = direction({any(engine), any(engine), any(engine)}), b = direction({any(engine), any(engine), any(engine)});
    const double arc = std::atan2(norm(cross(a, b)), dot(a, b));
    const RulerMeasure measure = measured(scene, 1.05 * a, 0.9 * b);
    EXPECT_EQ(measure.path_kind, How::isosurface);
    EXPECT_NEAR(measure.length, arc, 1e-3 * arc);
    for (const Vec3& p : measure.points) EXPECT_NEAR(norm(p), 1, 1e-6);
  }
  // Opposite ends: any half circle.
  EXPECT_NEAR(measured(scene, {0, 0, 1}, {0, 0, -1}).length, kPi, 1e-3 * kPi);
  EXPECT_NEAR(measured(scene, {1, 0, 0}, {1, 0, 0}).length, 0, 1e-6);
}

TEST(Ruler, TheLevelMayFollowAWidget) {
  Scene scene = scene_with(R"({"name": "skin", "type": "isosurface", "field": "s", "level": {"widget": "l"}})", "\"skin\"");
  EXPECT_NEAR(measured(scene, {1, 0, 0}, {0, 1, 0}).length, 0.5 * kPi, 2e-3);
  ASSERT_TRUE(set_widget_pose(scene, find_widget(scene, "l"), {{Vec3(0.5, 0, 0), Vec3(0)}, kIdentityRotation}));
  EXPECT_NEAR(resolve_ruler(scene, find_widget(scene, "u"))->length, 0.25 * kPi, 1e-3);
}

TEST(Ruler, OfSeveralLinksTheStreamlineCounts) {
  Scene scene = scene_with(kSkin + ", " + kCurve, "\"skin\", \"curve\"");
  EXPECT_EQ(measured(scene, {1, 0, 0}, {0, 1, 0}).path_kind, How::streamline);
}

TEST(Ruler, UnsupportedLinksAreMeasuredStraightWithANote) {
  Scene plane = scene_with(R"({"name": "flat", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]})", "\"flat\"");
  RulerMeasure measure = measured(plane, {0, 0, 0}, {3, 4, 0});
  EXPECT_EQ(measure.path_kind, How::straight);
  EXPECT_EQ(measure.length, 5);
  EXPECT_FALSE(measure.note.empty());
  Scene probe = scene_with(R"({"name": "curve", "type": "streamline", "field": "v"})", "\"curve\"");
  measure = measured(probe, {0, 0, 0}, {3, 4, 0});
  EXPECT_EQ(measure.path_kind, How::straight);
  EXPECT_NE(measure.note.find("has a seed, a level or a mesh"), std::string::npos) << measure.note;
  // An end at the center of the sphere, where no direction leads to the surface.
  Scene ball = scene_with(kSkin, "\"skin\"");
  measure = measured(ball, {0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(measure.path_kind, How::straight);
  EXPECT_FALSE(measure.note.empty());
}

TEST(Ruler, TheMeasureIsCachedUntilAnEndMoves) {
  Scene scene = scene_with(kSkin, "\"skin\"");
  const RulerMeasure first = measured(scene, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(resolve_ruler(scene, find_widget(scene, "u"))->points, first.points);
  EXPECT_NE(measured(scene, {1, 0, 0}, {0, 0, 1}).points, first.points);
}

}  // namespace catena::scene::ruler_test
