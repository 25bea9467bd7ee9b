// SPDX-License-Identifier: MIT
/// The link key "align" from scene to tick: its keys, and the alignment of the tool's axis with every kind of feature.
#include "tests/haptics/build/build_fixture.h"

namespace catena::haptics::align_test {

using build_tests::expect_error;
using build_tests::program_of;

constexpr const char* kFields = R"("fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}}, )";

std::string with_link(const std::string& keys, const std::string& coupling = "{}") {
  return std::string("{") + kFields + "\"coupling\": " + coupling + ", \"chain\": [\n{\"name\": \"a\", " + keys + "}]}";
}

TEST(ExtractAlign, ReadsItsKeysAndTheCouplings) {
  const std::string plane = R"("type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1])";
  const auto full = program_of(with_link(plane + R"(, "align": {"axis": [0, 3, 4], "stiffness": 0.2, "sign": "same"})",
                                         R"({"rotational_stiffness": 0.8, "rotational_damping": 0.001})"));
  const Align& align = full->links[0].align;
  EXPECT_TRUE(align.enabled);
  EXPECT_EQ(align.tool_axis, Vec3(0, 0.6, 0.8));
  EXPECT_EQ(align.stiffness_nm_per_rad, 0.2);
  EXPECT_EQ(align.sign, Align::Sign::same);
  EXPECT_EQ(full->coupling.rotational_damping_nms_per_rad, 0.001);
  const auto bare = program_of(with_link(plane + R"(, "align": {})", R"({"rotational_stiffness": 0.8})"));
  EXPECT_TRUE(bare->links[0].align.enabled);
  EXPECT_EQ(bare->links[0].align.tool_axis, Vec3(0, 0, 1));
  EXPECT_EQ(bare->links[0].align.stiffness_nm_per_rad, 0.8);
  EXPECT_EQ(bare->links[0].align.sign, Align::Sign::either);
  EXPECT_FALSE(program_of(with_link(plane))->links[0].align.enabled);
  EXPECT_EQ(program_of(with_link(plane + R"(, "align": {})"))->links[0].align.stiffness_nm_per_rad, 0.5);
}

TEST(ExtractAlign, ErrorsNameTheirLine) {
  const std::string plane = R"("type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "align": )";
  expect_error(with_link(plane + "1"), 2, {"align", "object"});
  expect_error(with_link(plane + "{\n\"axis\": [0, 0, 0]}"), 3, {"\"axis\" is zero", "was expected"});
  expect_error(with_link(plane + "{\n\"stiffness\": -1}"), 3, {"\"stiffness\" is -1", ">= 0"});
  expect_error(with_link(plane + "{\n\"sign\": \"both\"}"), 3, {"sign", "either", "same"});
  expect_error(with_link(plane + "{\n\"axes\": [0, 0, 1]}"), 3, {"unknown key \"axes\"", "axis"});
  expect_error(with_link(R"("type": "point", "position": [0, 0, 0], "align": {})"), 2, {"\"point\" link has no axis", "surface"});
  expect_error(with_link(R"("type": "drag", "threshold": 0.1, "align": {})"), 2, {"\"drag\" link has no axis", "curve"});
  expect_error(with_link(plane + "{}", R"({"method": "pipe"})"), 2, {"\"align\" needs", "\"chain\" was expected"});
}

struct Hand : test::ChainDriver {
  explicit Hand(const std::string& text) : ChainDriver(*program_of(text)) {}
  void step(const Vec3& p, const Quat& q) { at(t + 1e-3, p, 0, q); }
};

struct Case {
  const char* keys;
  Vec3 (*axis)(const Vec3& proxy);
  double tolerance;
};

Vec3 radial(const Vec3& p) { return direction(p); }
Vec3 around(const Vec3& p) { return direction({-p.y, p.x, 0}); }
Vec3 up(const Vec3&) { return {0, 0, 1}; }
Vec3 along(const Vec3&) { return direction({1, 2, 0}); }

constexpr double kCurve = 5e-8;  // tolerance of the drawn curve's tangent against the exact circle's

const Case kCases[] = {
    {R"("type": "plane", "point": [0, 0, 0], "normal": [0, 0, 5])", up, 1e-12},
    {R"("type": "sphere", "center": [0, 0, 0], "radius": 0.4)", radial, 1e-12},
    {R"("type": "isosurface", "field": "s", "level": 0.4)", radial, 1e-12},
    {R"("type": "line", "point": [0, 0, 0], "direction": [1, 2, 0])", along, 1e-12},
    {R"("type": "segment", "from": [-3, -6, 0], "to": [3, 6, 0])", along, 1e-12},
    {R"("type": "plane", "point": [0, 0, 0], "normal": [0, 0, 5], "release": 1.5)", up, 1e-12},
    {R"("type": "line", "point": [0, 0, 0], "direction": [1, 2, 0], "snap": 2)", along, 1e-12},
    {R"("type": "streamline", "field": "v", "seed": [0.5, 0, 0])", around, kCurve},
    {R"("type": "streamline", "field": "v", "seed": [0.5, 0, 0], "follow": "online")", around, kCurve},
};

TEST(ExtractAlign, TheToolsAxisAlignsWithEveryKindOfFeature) {
  for (const Case& c : kCases) {
    Hand hand(with_link(std::string(c.keys) + R"(, "align": {"axis": [1, 0, 1], "stiffness": 0.3})")), plain(with_link(c.keys));
    ASSERT_EQ(hand.program.links.size() + plain.program.links.size(), 2u);
    const Vec3 tool = direction({1, 0, 1});
    Vec3 end(0.0);
    for (int k = 0; k < 200; ++k) {
      const double a = 0.02 * k;
      const Vec3 p(0.5 * std::cos(a), 0.5 * std::sin(a), 0.1 * std::sin(3 * a));
      const Quat q = rotation_from_vector({std::sin(2 * a), 0.3 * a, std::cos(a)});
      hand.step(p, q);
      plain.step(p, q);
      const LinkReport& link = hand.link();
      EXPECT_EQ(link.proxy, plain.link().proxy) << c.keys;  // alignment does not change the position
      EXPECT_LE(link.evaluations, kMaxEvaluations);
      EXPECT_LE(link.evaluations - plain.link().evaluations, 1) << c.keys;
      const Vec3 n = c.axis(link.proxy), before = rotate(q, tool), after = rotate(link.orientation, tool);
      // the axis keeps the last tick's sign until the tool is 10 degrees past perpendicular
      Vec3 goal = dot(k > 0 ? end : before, n) < 0 ? -n : n;
      if (dot(before, goal) < -0.17) goal = -goal;
      end = goal;
      ASSERT_LE(norm(after - goal), c.tolerance) << c.keys << " tick " << k;
      const double angle = std::atan2(norm(cross(before, goal)), dot(before, goal));
      ASSERT_LE(norm(hand.out.torque_nm - direction(cross(before, goal)) * (0.3 * angle)), 2 * c.tolerance) << c.keys;
    }
  }
}

TEST(ExtractAlign, OnTheFreeSideTheToolIsFree) {
  Hand hand(with_link(R"("type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "align": {})"));
  const Quat q = rotation_from_vector({0.4, 0, 0});
  hand.step({0, 0, 0.1}, q);
  EXPECT_EQ(hand.out.torque_nm, Vec3(0.0));
  EXPECT_EQ(hand.link().orientation, q);
  hand.step({0, 0, -0.01}, q);
  EXPECT_NEAR(hand.out.torque_nm.x, -0.5 * 0.4, 1e-12);
}

TEST(ExtractAlign, ASurfaceAndAStreamlineFixTheOrientation) {
  // the tool's z along the surface's normal and its x along the curve: compatible on a circle of the sphere
  Hand hand(std::string("{") + kFields + R"("chain": [
    {"name": "skin", "type": "isosurface", "field": "s", "level": 0.5, "align": {"axis": [0, 0, 1], "sign": "same"}},
    {"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0], "align": {"axis": [1, 0, 0], "sign": "same"}}]})");
  for (int k = 0; k < 100; ++k) {
    const double a = 0.03 * k;
    hand.step({0.52 * std::cos(a), 0.52 * std::sin(a), 0}, rotation_from_vector({0.3, 1.2, a - 0.4}));
    const LinkReport& curve = hand.link(1);
    EXPECT_LE(norm(rotate(curve.orientation, {1, 0, 0}) - around(curve.proxy)), kCurve);
    EXPECT_LE(norm(rotate(curve.orientation, {0, 0, 1}) - radial(curve.proxy)), kCurve);
  }
}

}  // namespace catena::haptics::align_test
