// SPDX-License-Identifier: MIT

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::box_test {

struct Made {
  Vec3 center{0.0}, size{1.0};
  Mat3 turn{1.0};  ///< world from box
  Vec3 world(const Vec3& y) const { return center + turn * y; }
  Vec3 local(const Vec3& x) const { return glm::transpose(turn) * (x - center); }
};

Made random_box(Random& random, bool axis_aligned = false) {
  Made box;
  box.center = random.box(1);
  box.size = {random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
  if (!axis_aligned) {
    const Vec3 x = random.unit(), z = direction(cross(x, random.unit()));
    box.turn = Mat3(x, cross(z, x), z);
  }
  return box;
}

std::string text(const Made& b, const std::string& more = "") {
  const Mat3 rows = glm::transpose(b.turn);
  return R"({"name": "a", "type": "box", "center": )" + to_json(b.center) + R"(, "size": )" + to_json(b.size) + R"(, "rotation": [)" +
         to_json(rows[0]) + "," + to_json(rows[1]) + "," + to_json(rows[2]) + "]" + more + "}";
}

/// Distance to the surface: the minimum over the six rectangles.
double brute_distance(const Made& b, const Vec3& x) {
  const Vec3 y = b.local(x);
  double minimum = 1e300;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      Vec3 q = glm::clamp(y, -0.5 * b.size, 0.5 * b.size);
      q[axis] = side * b.size[axis];
      minimum = std::min(minimum, norm(y - q));
    }
  return minimum;
}

double brute_value(const Made& b, const Vec3& x) {
  const bool inside = max_abs(b.local(x) / b.size) < 0.5;
  return inside ? -brute_distance(b, x) : brute_distance(b, x);
}

TEST(Box, StartsAtTheClosestPoint) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Made box = random_box(random, i % 4 == 0);
    const auto made = build(text(box));
    for (int k = 0; k < 40; ++k) {
      Rig rig(made);
      const Vec3 probe = k % 2 ? box.center + random.box(3) : box.world(random.box(0.5) * box.size);
      ASSERT_NEAR(norm(probe - rig.tick(probe).proxy), brute_distance(box, probe), 3e-15);
      ASSERT_LE(brute_distance(box, rig.state.proxy), 2e-15);
      ASSERT_LE(rig.state.residual, 2e-15);
      ASSERT_EQ(rig.state.status, LinkStatus::ok);
    }
  }
}

TEST(Box, IsExactAtFacesEdgesAndCorners) {
  Rig rig(build(text({Vec3(0.0), Vec3(1, 2, 3)})));
  expect_steps(rig, {{{0.1, 5, 0.2}, {}, {0.1, 1, 0.2}}, {{0.7, 5, 0.2}, {}, {0.5, 1, 0.2}}, {{0.7, 5, -2}, {}, {0.5, 1, -1.5}}});
  EXPECT_EQ(rig.state.residual, 0);
  for (const double far : {1e16, 1e160, 1e300}) {
    EXPECT_TRUE(bitwise_equal(rig.tick(Vec3(far, far, far)).proxy, Vec3(0.5, 1, 1.5))) << far;
    EXPECT_TRUE(bitwise_equal(rig.tick(Vec3(far, 0.25, -far)).proxy, Vec3(0.5, 0.25, -1.5))) << far;
  }
}

TEST(Box, FromOutsideTheProxyNeverMovesFurtherThanTheProbe) {
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    const Made box = random_box(random);
    Rig rig(build(text(box)));
    // a circle outside of the box
    const Vec3 u = random.unit(), v = direction(cross(u, random.unit()));
    const double radius = 0.6 * norm(box.size);
    Vec3 last_probe = box.center + u * radius, last = rig.tick(last_probe).proxy;
    for (int k = 1; k <= 3000; ++k) {
      const Vec3 probe = box.center + (u * std::cos(k * 2.1e-3) + v * std::sin(k * 2.1e-3)) * radius;
      const Vec3 proxy = rig.tick(probe).proxy;
      ASSERT_LE(norm(proxy - last), norm(probe - last_probe) * (1 + 1e-9) + 1e-15);
      ASSERT_NEAR(norm(proxy - probe), brute_distance(box, probe), 2e-15 * 4);
      last = proxy;
      last_probe = probe;
    }
  }
}

TEST(Box, InsideTheBoxTheProxyStaysOnTheFaceOfEntry) {
  // no jump at the middle planes: within the box the proxy slides on its face
  Random random(6);
  for (int i = 0; i < 40; ++i) {
    const Made box = random_box(random);
    Rig rig(build(text(box, R"(, "free": "above")")));
    Vec3 y(0, 0, 0.51 * box.size.z);
    ASSERT_EQ(rig.tick(box.world(y)).status, LinkStatus::free);
    y.z = 0.499 * box.size.z;
    Vec3 last_probe = box.world(y), last = rig.tick(last_probe).proxy;
    for (int k = 0; k < 500; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        y[axis] = std::clamp(y[axis] + random.uniform(-0.02, 0.02), -0.499 * box.size[axis], 0.499 * box.size[axis]);
      const Vec3 probe = box.world(y), proxy = rig.tick(probe).proxy;
      ASSERT_EQ(rig.state.status, LinkStatus::ok);
      ASSERT_LE(norm(proxy - box.world({y.x, y.y, 0.5 * box.size.z})), 2e-15);
      ASSERT_LE(norm(proxy - last), norm(probe - last_probe) + 1e-15);
      last = proxy;
      last_probe = probe;
    }
  }
}

TEST(Box, SlidingPastAnEdgeFreesTheHand) {
  Rig rig(build(text({Vec3(0.0), Vec3(1, 1, 1)}, R"(, "free": "above")")));
  rig.tick({0.3, 0, 0.6});
  for (double x = 0.3; x < 0.5; x += 0.001) {
    ASSERT_EQ(rig.tick({x, 0, 0.49}).status, LinkStatus::ok);
    ASSERT_TRUE(bitwise_equal(rig.state.proxy, Vec3(x, 0, 0.5)));
  }
  expect_steps(rig, {
                        {{0.5001, 0, 0.49}, kFree}, {{0.4999, 0, 0.49}, kOk, {0.5, 0, 0.49}}  // re-entry through the side face
                    });
}

TEST(Box, TwoSidedTheProxyPassesAnEdgeContinuously) {
  Rig rig(build(text({Vec3(0.0), Vec3(1, 1, 1)})));
  rig.tick({0.3, 0, 0.6});
  const auto path = [](int i) { return Vec3(0.45 + 0.15 * std::sin(i * 1.5707963e-3), 0, 0.45 + 0.15 * std::cos(i * 1.5707963e-3)); };
  expect_no_jumps(rig, 1000, path, 0, 2.4e-4);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0, 0.45)), 1e-7);
  EXPECT_TRUE(bitwise_equal(rig.tick({0.4, 0, 0.46}).proxy, Vec3(0.5, 0, 0.46)));
}

TEST(Box, TwoSidedTheProxyIsTheClosestPointOutsideAndKeepsItsFaceInside) {
  Random random(7);
  for (int i = 0; i < 60; ++i) {
    const Made box = random_box(random);
    Rig rig(build(text(box)));
    Vec3 y = random.box(1), held(0.0);
    bool was_inside = false;
    for (int k = 0; k < 2000; ++k) {
      for (int axis = 0; axis < 3; ++axis) y[axis] = std::clamp(y[axis] + random.uniform(-0.05, 0.05), -1.2, 1.2);
      const Vec3 probe = box.world(y);
      const Vec3 proxy = rig.tick(probe).proxy, q = box.local(proxy);
      const double value = brute_value(box, probe);
      if (std::fabs(value) < 1e-9) continue;
      ASSERT_LE(rig.state.residual, 2e-15);
      if (value > 0) {
        ASSERT_NEAR(norm(probe - proxy), value, 4e-15);
      } else {
        // always the projection onto the same face
        Vec3 face(0.0);
        for (int axis = 0; axis < 3; ++axis)
          if (std::fabs(q[axis] - y[axis]) > 1e-13) face[axis] = q[axis] > 0 ? 1 : -1;
        ASSERT_LE(dot(face, face), 1);
        ASSERT_EQ(dot(face, held), was_inside && dot(held, held) > 0 ? dot(face, face) : 0);
        if (dot(face, face) > 0) held = face;
      }
      was_inside = value < 0;
      if (!was_inside) held = Vec3(0.0);
    }
  }
}

TEST(Box, FreeProxyIsTheProbeAndHeldProxyIsTheClosestPoint) {
  Random random(9);
  for (int i = 0; i < 60; ++i) {
    const Made box = random_box(random);
    for (const bool above : {true, false}) {
      const auto made = build(text(box, above ? R"(, "free": "above")" : R"(, "free": "below")"));
      for (int k = 0; k < 30; ++k) {
        Rig rig(made);
        const Vec3 probe = box.center + random.box(1.2);
        const double value = brute_value(box, probe);
        if (std::fabs(value) < 1e-12) continue;
        rig.tick(probe);
        if ((value > 0) == above) {
          ASSERT_EQ(rig.state.status, LinkStatus::free);
          ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe));
        } else {
          ASSERT_EQ(rig.state.status, LinkStatus::ok);
          ASSERT_NEAR(norm(probe - rig.state.proxy), std::fabs(value), 3e-15);
        }
      }
    }
  }
}

TEST(Box, AFastHandIsHeldOnItsFaceOfEntry) {
  Random random(10);
  for (int i = 0; i < 2000; ++i) {
    const Made box = random_box(random);
    Rig rig(build(text(box, R"(, "free": "above")")));
    const int axis = i % 3;
    Vec3 outside = random.box(0.4), inside = outside;
    outside[axis] = 0.51;
    inside[axis] = -0.45;  // nearer to the opposite face
    rig.tick(box.world(outside * box.size));
    ASSERT_EQ(rig.tick(box.world(inside * box.size)).status, LinkStatus::ok);
    inside[axis] = 0.5;
    ASSERT_LE(norm(rig.state.proxy - box.world(inside * box.size)), 2e-15);
  }
}

TEST(Box, TwoSidedAHandThatCutsAnEdgeIsHeldOnItsFaceOfEntry) {
  Rig rig(build(R"({"name": "a", "type": "box", "center": [0, 0, 0], "size": [2, 2, 2]})"));
  // from the region beyond the edge: enters through y = 1 at (0.8, 1), then through x = 1 at (1, 0.8)
  rig.tick({1.2, 1.1, 0});
  EXPECT_LE(norm(rig.tick({0.7, 0.975, 0}).proxy - Vec3(0.7, 1, 0)), 1e-15);
  rig.tick({1.1, 1.2, 0});
  EXPECT_LE(norm(rig.tick({0.975, 0.7, 0}).proxy - Vec3(1, 0.7, 0)), 1e-15);
}

TEST(Box, AThinBoxHoldsSlowAndFastHands) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    Made box = random_box(random, i % 3 == 0);
    const int axis = i % 3;
    box.size = Vec3(1.0);
    box.size[axis] = 0.001;
    const double side = i % 2 ? 1 : -1, step = i < 100 ? 0.0002 : random.uniform(0.0002, 0.08);
    Rig rig(build(text(box, R"(, "free": "above")")));
    Vec3 y = random.box(0.4);
    y[axis] = side * (0.0005 + random.uniform(1e-6, step));
    ASSERT_EQ(rig.tick(box.world(y)).status, LinkStatus::free);
    // through the box, up to the distance behind the face where it still holds
    while (side * (y[axis] - side * step) > 0.0005 - 0.0799) {
      y[axis] -= side * step;
      rig.tick(box.world(y));
      if (side * y[axis] > 0.0005) {
        ASSERT_EQ(rig.state.status, LinkStatus::free);
        continue;
      }
      Vec3 held = y;
      held[axis] = side * 0.0005;
      ASSERT_EQ(rig.state.status, LinkStatus::ok) << "step " << step << " at " << y[axis];
      ASSERT_LE(norm(rig.state.proxy - box.world(held)), 2e-15);
    }
    // back in front of that face it is free
    y[axis] = side * 0.00051;
    ASSERT_EQ(rig.tick(box.world(y)).status, LinkStatus::free);
    // held at any distance behind in steps of a hand; a step above 0.02 L = 0.08 frees it
    for (y[axis] = -side * 0.03; side * y[axis] > -0.4; y[axis] -= side * 0.07) ASSERT_EQ(rig.tick(box.world(y)).status, LinkStatus::ok);
    y[axis] -= side * 0.09;
    ASSERT_EQ(rig.tick(box.world(y)).status, LinkStatus::free);
  }
}

TEST(Box, BehindAThinBoxTheHandIsFreeBesideIt) {
  Rig rig(build(text({Vec3(0.0), Vec3(1, 1, 0.001)}, R"(, "free": "above")")));
  expect_steps(rig, {
                        {{0.48, 0, 0.02}},
                        {{0.49, 0, -0.02}, kOk, {0.49, 0, 0.0005}},
                        {{0.51, 0, -0.02}, kFree},
                        {{0.49, 0, -0.02}, kFree},                  // the probe is now below the box
                        {{0.49, 0, 0.02}, kOk, {0.49, 0, -0.0005}}  // held on the bottom face
                    });
}

TEST(Box, ACornerCutWithinOneTickIsFree) {
  Rig rig(build(text({Vec3(0.0), Vec3(1, 1, 1)}, R"(, "free": "above")")));
  rig.tick({0.49, 0, 0.51});
  EXPECT_EQ(rig.tick({0.51, 0, 0.485}).status, LinkStatus::free);
}

TEST(Box, AStartOnTheSurfaceDoesNotPassThrough) {
  Rig rig(build(text({Vec3(0, 0, -0.0005), Vec3(1, 1, 0.001)}, R"(, "free": "above")")));
  expect_steps(rig, {{{0.1, 0.1, 0}, kFree}, {{0.1, 0.1, -0.05}, kOk, {0.1, 0.1, 0}}});
}

TEST(Box, OneSidedReleaseAndReArm) {
  Rig rig(build(text({Vec3(0.0), Vec3(2, 2, 2)}, R"(, "free": "above", "release": 0.25)")));
  expect_steps(rig, {{{0, 0, 1.1}, kFree}, {{0, 0, 0.76}, kOk}});
  EXPECT_EQ(rig.state.limit, 0.25);
  expect_steps(rig, {{{0, 0, 0.75}, kReleased, {0, 0, 0.75}}, {{0, 0, 0.99}, kReleased}, {{0, 0, 1.01}, kFree}, {{0, 0, 0.99}, kOk}});
  Rig deep(build(text({Vec3(0.0), Vec3(2, 2, 2)}, R"(, "free": "above", "release": 0.25)")));
  EXPECT_EQ(deep.tick({0.1, 0, 0.7}).status, LinkStatus::released);
}

TEST(Box, TwoSidedReleaseAndReArm) {
  expect_steps(text({Vec3(0.0), Vec3(2, 2, 2)}, R"(, "release": 0.25)"),
               {{{0, 0, 1.2}, kOk},
                {{0, 0, 1.3}, kReleased},
                {{1.3, 1.3, 1.3}, kReleased},
                {{1.02, 1.02, 0}, kReleased},  // 0.028 from an edge
                {{1.01, 1.01, 0}, kOk},        // 0.014
                {{1.3, 1.3, 0}, kReleased},
                {{0.9, 0, 0}, kOk, {1, 0, 0}},  // crossed the surface  // passes the plane y = 1 beside the box and enters through x = 1
                // the segment misses the box beside an edge
                {{0.5, 0, 1.3}, kReleased},
                {{1.2, 0, 0.9}, kReleased}});
  // in and out within one tick
  expect_steps(text({Vec3(0.0), Vec3(1, 1, 0.01)}, R"(, "release": 0.25)"), {{{0, 0, 0.1}}, {{0, 0, 0.3}, kReleased}, {{0, 0, -0.1}, kOk}});
}

TEST(Box, ThePrimitiveIsAPlaneALineOrAPoint) {
  Rig rig(build(text({Vec3(0.0), Vec3(2, 2, 2)})));
  rig.tick({0, 0, 1.2});
  expect_primitive(rig, {0.3, 0.2, 0.8}, Primitive::Kind::plane, {0.3, 0.2, 1}, {0, 0, 1});
  expect_primitive(rig, {1.3, 0.2, 1.4}, Primitive::Kind::line, {1, 0.2, 1}, {0, 1, 0});
  expect_primitive(rig, {1.3, -1.2, 1.4}, Primitive::Kind::point, {1, -1, 1});
}

TEST(Box, AllFormsOfARotationAreEqual) {
  const std::pair<const char*, double> forms[] = {
      {"[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", 0}, {"[0, -1, 0, 1, 0, 0, 0, 0, 1]", 0}, {R"({"axis": [0, 0, 5], "angle_deg": 90})", 1e-15}};
  for (const auto& [rotation, tolerance] : forms) {
    Rig rig(build(std::string(R"({"name": "a", "type": "box", "center": [0, 0, 0], "size": [1, 2, 3], "rotation": )") + rotation + "}"));
    EXPECT_LE(norm(rig.tick({9, 9, 9}).proxy - Vec3(1, 0.5, 1.5)), tolerance) << rotation;
  }
}

TEST(Box, ARoundedRotationIsOrthonormalized) {
  Rig rig(build(R"({"name": "a", "type": "box", "center": [0, 0, 0], "size": [2, 2, 2],
      "rotation": [0.6000002, -0.8, 0, 0.8, 0.5999999, 0, 0, 1e-7, 1]})"));
  Random random(3);
  for (int i = 0; i < 100; ++i) EXPECT_LE(rig.tick(random.box(3)).residual, 1e-15);
}

TEST(Box, RefusesBadKeys) {
  expect_refused("{\"name\": \"a\", \"type\": \"box\", \"center\": [0, 0, 0],\n \"size\": [1, 0, 1]}", 2, {});
  const std::string head = R"({"name": "a", "type": "box", "center": [0, 0, 0])", size = head + R"(, "size": [1, 1, 1])";
  EXPECT_TRUE(try_build(size + "}"));
  for (const char* bad : {R"("rotation": [1, 0, 0, 0, 2, 0, 0, 0, 1])", R"("rotation": [1, 0, 0, 0, 1, 0, 0, 0, -1])", R"("rotation": 3)",
                          R"("rotation": {"axis": [0, 0, 0], "angle_deg": 3})", R"("free": "left")"})
    EXPECT_FALSE(try_build(size + ", " + bad + "}")) << bad;
  EXPECT_FALSE(try_build(head + "}"));
}

}  // namespace catena::haptics::tests::box_test
