// SPDX-License-Identifier: MIT
#include "haptics/constraints/common/snap.h"

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::snap_test {

const std::string kPoint = R"({"name": "a", "type": "point", "position": [0, 0, 0])";

Fields flow_fields() {
  Fields fields;
  for (const char* name : {"circle", "uniform", "abc"}) fields.named[name].vector = field::make_analytic(name)->vector;
  for (const char* name : {"sphere", "gaussian"}) fields.named[name].scalar = analytic_field(name);
  return fields;
}

bool apart(const LinkState& s, const Vec3& probe) {
  return s.status == LinkStatus::released && s.released && !s.active() && bitwise_equal(s.proxy, probe);
}
bool held(const LinkState& s) { return s.status == LinkStatus::ok && !s.released && s.active(); }
/// After a tick.
bool apart_at(Rig& rig, const Vec3& probe) { return apart(rig.tick(probe), probe); }
bool held_at(Rig& rig, const Vec3& probe) { return held(rig.tick(probe)); }

TEST(Snap, SnapsAndReleasesAtItsDistances) {
  Rig rig(build(kPoint + R"(, "snap": 0.1, "release": 0.3})"));
  EXPECT_TRUE(apart_at(rig, {0.5, 0, 0}));
  EXPECT_TRUE(apart_at(rig, {std::nextafter(0.1, 1.0), 0, 0}));
  EXPECT_EQ(rig.state.residual, 0);
  EXPECT_TRUE(held_at(rig, {0.1, 0, 0}));
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.0)));
  EXPECT_EQ(rig.state.limit, 0.3);
  EXPECT_TRUE(held_at(rig, {std::nextafter(0.3, 0.0), 0, 0}));
  EXPECT_TRUE(apart_at(rig, {0.3, 0, 0}));
  EXPECT_TRUE(apart_at(rig, {0.11, 0, 0}));
  EXPECT_TRUE(held_at(rig, {-0.1, 0, 0}));
}

TEST(Snap, StartsHeldOnlyWithinSnap) {
  Rig near(build(kPoint + R"(, "snap": 0.1})")), far(build(kPoint + R"(, "snap": 0.1})"));
  EXPECT_TRUE(held_at(near, {0.09, 0, 0}));
  EXPECT_TRUE(apart_at(far, {0.15, 0, 0}));
  // the default of release is twice snap
  EXPECT_TRUE(held_at(near, {0.199, 0, 0}));
  EXPECT_TRUE(apart_at(near, {0.2, 0, 0}));
}

TEST(Snap, DoesNotChatterUnderATremorSmallerThanTheGap) {
  for (const double boundary : {0.1, 0.3}) {
    Rig rig(build(kPoint + R"(, "snap": 0.1, "release": 0.3})"));
    Random random(5);
    int changes = 0;
    bool was = false;
    // in to the snap distance with a tremor of up to 0.09, a long rest there, then away
    for (int i = 0; i < 4000; ++i) {
      const double way = i < 1000 ? 0.001 * i : i < 3000 ? 1.0 : 0.001 * (i - 2000);
      const double x = boundary == 0.1 ? 1.0 - 0.9 * std::min(way, 1.0) : 0.3 * way;
      rig.tick({x + random.uniform(-0.09, 0.09), 0, 0});
      if (i > 0 && rig.state.released != was) ++changes;
      was = rig.state.released;
    }
    EXPECT_EQ(changes, 1) << boundary;
  }
}

TEST(Snap, SweepsShowHysteresis) {
  // streamline: a straight line along x
  Rig rig(
      build(R"({"name": "a", "type": "streamline", "field": "uniform", "seed": [0, 0, 0], "snap": 0.2, "release": 0.5})", flow_fields()));
  std::vector<double> takes, lets;
  bool was = true;
  for (int i = 0; i < 4000; ++i) {
    const double phase = (i % 2000) * 0.001;
    const double y = phase < 1 ? 1 - phase : phase - 1;
    const Vec3 probe(0.2, y, 0);
    rig.tick(probe);
    if (rig.state.released && !was) lets.push_back(y);
    if (!rig.state.released && was) takes.push_back(y);
    was = rig.state.released;
    if (rig.state.released) {
      ASSERT_TRUE(apart(rig.state, probe));
    } else {
      ASSERT_LE(norm(rig.state.proxy - Vec3(0.2, 0, 0)), 1e-12);
    }
  }
  ASSERT_EQ(takes.size(), 2u);
  ASSERT_EQ(lets.size(), 2u);
  for (const double y : takes) EXPECT_NEAR(y, 0.2, 1e-12);
  for (const double y : lets) EXPECT_NEAR(y, 0.5, 1e-12);
}

TEST(Snap, ReleaseAloneStartsHeldAndReArmsWithinATenth) {
  Rig rig(build(R"({"name": "a", "type": "streamline", "field": "uniform", "seed": [0, 0, 0], "release": 0.5})", flow_fields()));
  EXPECT_TRUE(held_at(rig, {0, 0.4, 0}));
  EXPECT_TRUE(apart_at(rig, {0, 0.5, 0}));
  EXPECT_TRUE(apart_at(rig, {1, 0.051, 0}));
  EXPECT_TRUE(held_at(rig, {1, 0.05, 0}));
  EXPECT_LE(norm(rig.state.proxy - Vec3(1, 0, 0)), 1e-12);
}

TEST(Snap, WithoutSnapSurfacesKeepTheirOwnReArmRule) {
  const std::string floor = R"({"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "release": 0.25)";
  Rig own(build(floor + "}")), snaps(build(floor + R"(, "snap": 0.1})"));
  for (Rig* rig : {&own, &snaps}) {
    EXPECT_EQ(rig->tick({0, 0, 0.1}).status, LinkStatus::free);
    EXPECT_TRUE(bitwise_equal(rig->state.proxy, Vec3(0, 0, 0.1)));
    EXPECT_TRUE(rig->state.active());
    EXPECT_EQ(rig->tick({0, 0, -0.2}).status, LinkStatus::ok);
    EXPECT_TRUE(bitwise_equal(rig->state.proxy, Vec3(0, 0, 0)));
    EXPECT_EQ(rig->tick({0, 0, -0.25}).status, LinkStatus::released);
    EXPECT_EQ(rig->tick({0, 0, -0.2}).status, LinkStatus::released);
  }
  // the surface's own rule re-arms on the free side, snap within its distance
  EXPECT_EQ(own.tick({0, 0, -0.05}).status, LinkStatus::released);
  expect_steps(snaps, {{{0, 0, -0.05}, kOk, {0, 0, 0}}});
  EXPECT_EQ(own.tick({0, 0, 0.05}).status, LinkStatus::free);
  EXPECT_EQ(snaps.tick({0, 0, 0.05}).status, LinkStatus::free);
}

TEST(Snap, ASurfaceIsFoundFromAnyPosition) {
  Rig rig(build(R"({"name": "a", "type": "isosurface", "field": "sphere", "level": 1, "snap": 0.05, "release": 0.2})", flow_fields()));
  Random random(6);
  for (int i = 0; i < 300; ++i) {
    const Vec3 away = random.unit() * 1.5, onto = random.unit();
    ASSERT_TRUE(apart_at(rig, away)) << i;
    ASSERT_TRUE(apart_at(rig, onto * 1.06)) << i;
    ASSERT_TRUE(held_at(rig, onto * 1.04)) << i;
    ASSERT_LE(norm(rig.state.proxy - onto), 1e-8) << i;
    ASSERT_LE(rig.state.evaluations, kMaxEvaluations);
  }
}

TEST(Snap, ASelectedStreamlineSnapsToItsClosestPoint) {
  Rig rig(build(R"({"name": "a", "type": "streamline", "field": "circle", "seed": [1, 0, 0], "snap": 0.1})", flow_fields()));
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const double a = random.uniform(-3.14, 3.14);
    const Vec3 place(std::cos(a), std::sin(a), 0);
    ASSERT_TRUE(apart_at(rig, place * 0.79));
    ASSERT_TRUE(held_at(rig, place * 1.09)) << i;
    ASSERT_LE(norm(rig.state.proxy - place), 1e-9) << i;
  }
}

TEST(Snap, AnOnlineStreamlineWithoutASeedSnapsAtTheProbe) {
  Rig rig(build(R"({"name": "a", "type": "streamline", "field": "uniform", "snap": 0.1, "release": 0.3})", flow_fields()));
  EXPECT_TRUE(held_at(rig, {0, 0.5, 0}));
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0.5, 0)));
  EXPECT_LE(norm(rig.tick({0.2, 0.7, 0}).proxy - Vec3(0.2, 0.5, 0)), 1e-11);
  // pulled off it is released, then snaps to the line through the probe
  EXPECT_TRUE(apart_at(rig, {0.2, 0.81, 0}));
  EXPECT_TRUE(held_at(rig, {0.2, 0.81, 0}));
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.2, 0.81, 0)));
}

TEST(Snap, AnOnlineStreamlineWithASeedStaysOnItsLine) {
  Rig rig(build(R"({"name": "a", "type": "streamline", "field": "circle", "seed": [1, 0, 0], "follow": "online", "snap": 0.1})",
                flow_fields()));
  for (int i = 0; i <= 300; ++i) {
    const double a = 0.01 * i;
    ASSERT_TRUE(rig.tick(Vec3(std::cos(a), std::sin(a), 0) * 0.5).released);
  }
  EXPECT_TRUE(held_at(rig, Vec3(std::cos(3.0), std::sin(3.0), 0) * 0.95));
  EXPECT_LE(norm(rig.state.proxy - Vec3(std::cos(3.0), std::sin(3.0), 0)), 1e-7);
}

TEST(Snap, TheDistancesMayFollowAField) {
  // gaussian: 1 at the origin and decreasing; both distances follow it, and release is never below snap
  Rig rig(build(kPoint + R"(, "snap": {"field": "gaussian", "map": [[0, 0.2], [1, 0.4]]},
      "release": {"field": "gaussian", "map": [[0, 0.1], [1, 0.1]]}})",
                flow_fields()));
  EXPECT_TRUE(apart_at(rig, {0.095, 0, 0}));
  EXPECT_EQ(rig.state.evaluations, 2);
  EXPECT_TRUE(held_at(rig, {0.08, 0, 0}));
  EXPECT_TRUE(apart_at(rig, {0.1, 0, 0}));
}

TEST(Snap, WithoutASurfaceTheProbePassesThrough) {
  Rig rig(isosurface(analytic_field("constant"), 1, R"(, "snap": 0.1)"));
  for (int k = 0; k < 3; ++k) rig.tick({0.1, 0.2, 0.3});
  EXPECT_EQ(rig.state.status, LinkStatus::no_surface);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0.2, 0.3)));
  EXPECT_FALSE(rig.state.released);
}

TEST(Snap, RefusesBadKeys) {
  const std::tuple<const char*, int, const char*> bad[] = {
      {",\n\"snap\": 0}", 2, "\"snap\" is 0"},
      {",\n\"snap\": \"x\"}", 2, "\"snap\""},
      {",\n\"snap\": 0.1,\n\"release\": 0.1}", 3, "\"release\" is 0.1; a number > \"snap\""},
      {",\n\"snap\": 0.1,\n\"release\": -1}", 3, "\"release\" is -1"},
      {",\n\"snap\": {\"field\": \"none\", \"map\": [[0, 1]]}}", 2, "none"}};
  for (const auto& [more, line, what] : bad) expect_refused(kPoint + more, line, {what});
}

}  // namespace catena::haptics::tests::snap_test
