// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/mesh_fixture.h"

namespace catena::haptics::tests::mesh_test {

TEST(Mesh, BoxIsFreeOutsideAndHoldsInside) {
  Rig rig(mesh_link(make_mesh_from(box_soup())));
  expect_steps(
      rig,
      {
          {{0.1, 0.2, 0.8}, kFree, {0.1, 0.2, 0.8}}, {{0.1, 0.2, 0.5}, kFree}, {{0.1, 0.2, 0.3}, kOk}  // within the tick of the crossing
      });
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.1, 0.2, 0.5)), 1e-12);
  EXPECT_EQ(rig.state.evaluations, 0);
  // deep and nearer to a side wall, the proxy stays on the face of entry
  EXPECT_EQ(rig.tick({0.1, 0.45, -0.3}).status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.1, 0.45, 0.5)), 1e-12);
  EXPECT_EQ(rig.tick({0.1, 0.45, 0.6}).status, LinkStatus::free);
}

TEST(Mesh, FreeBelowIsFreeInside) {
  Rig rig(mesh_link(make_mesh_from(box_soup()), R"(, "free": "below")"));
  expect_steps(rig, {{{0, 0, 0}, kFree}, {{0.7, 0.1, 0}, kOk}});
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.1, 0)), 1e-12);
  // along an edge, into a corner: all three walls hold
  EXPECT_EQ(rig.tick({0.7, 0.8, 0}).status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.5, 0)), 2e-12);
  Primitive primitive;
  ASSERT_TRUE(rig.constraint->primitive(rig.state.proxy, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, Primitive::Kind::line);
  EXPECT_NEAR(std::fabs(primitive.axis.z), 1, 1e-12);
  EXPECT_EQ(rig.tick({0.7, 0.8, -0.9}).status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.5, -0.5)), 2e-12);
  EXPECT_EQ(rig.tick({0.4, 0.4, -0.4}).status, LinkStatus::free);
}

TEST(Mesh, FirstProbeInsideIsHeldOrReleased) {
  Rig rig(mesh_link(make_mesh_from(box_soup())));
  EXPECT_EQ(rig.tick({0.3, 0.1, 0}).status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.1, 0)), 1e-12);
  Rig deep(mesh_link(make_mesh_from(box_soup()), R"(, "free": "above", "release": 0.1)"));
  expect_steps(deep, {{{0.3, 0.1, 0}, kReleased, {0.3, 0.1, 0}}});
}

TEST(Mesh, OneSidedReleaseAndReArm) {
  Rig rig(mesh_link(make_mesh_from(box_soup()), R"(, "free": "above", "release": 0.25)"));
  expect_steps(rig, {{{0, 0, 0.6}, kFree}, {{0, 0, 0.3}, kOk}});
  EXPECT_EQ(rig.state.limit, 0.25);
  expect_steps(rig, {{{0, 0, 0.24}, kReleased, {0, 0, 0.24}}, {{0, 0, 0.49}, kReleased}, {{0, 0, 0.51}, kFree}, {{0, 0, 0.49}, kOk}});
}

TEST(Mesh, TwoSidedReleaseAndReArm) {
  Rig rig(mesh_link(make_mesh_from(sheet_soup(4, 1, [](double, double) { return 0.0; })), R"(, "release": 0.25)"));
  expect_steps(rig, {
                        {{0.3, 0, 0.2}, kOk},
                        {{0.3, 0, 0.3}, kReleased},
                        {{0.3, 0, 0.026}, kReleased},
                        {{0.3, 0, 0.024}, kOk},  // within a tenth of release
                        {{0.3, 0, 0.3}, kReleased},
                        {{0.3, 0.2, -0.1}, kOk}  // crossed the surface
                    });
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.3, 0.2, 0)), 1e-12);
}

/// A plate of two faces 1e-3 apart; the hand moves through it at 0.02 L per tick, from many directions.
TEST(Mesh, ThinPlateIsNeverPassedThrough) {
  const auto plate = make_mesh_from(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
  Random random(5);
  for (const double step : {0.04, 0.013, 5e-4, 1e-4, 2.0}) {
    Rig rig(mesh_link(plate));
    Vec3 probe(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), step > 0.1 ? 1.0 : 10.3 * step);
    rig.tick(probe);
    Vec3 side = random.unit() * 0.3 * std::min(step, 0.04);
    side.z = 0;
    for (int i = 0; i < 20; ++i) {
      probe += Vec3(side.x, side.y, -step);
      rig.tick(probe);
      if (probe.z >= 5e-4) continue;
      ASSERT_EQ(rig.state.status, LinkStatus::ok) << step << " tick " << i;
      ASSERT_LE(norm(rig.state.proxy - Vec3(probe.x, probe.y, 5e-4)), 2e-12) << step << " tick " << i;
    }
    // the hand returns on the side of entry
    probe.z = 1;
    EXPECT_EQ(rig.tick(probe).status, LinkStatus::free);
  }
}

TEST(Mesh, FastHandsDoNotTunnel) {
  const auto plate = make_mesh_from(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
  Random random(6);
  for (int i = 0; i < 3000; ++i) {
    Rig rig(mesh_link(plate));
    const Vec3 from(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(0.001, 2)),
        to(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-2, 0));
    ASSERT_EQ(rig.tick(from).status, LinkStatus::free);
    ASSERT_EQ(rig.tick(to).status, LinkStatus::ok) << i;
    ASSERT_LE(norm(rig.state.proxy - Vec3(to.x, to.y, 5e-4)), 4e-12) << i;
  }
}

/// Two half planes that form a wedge with opening `angle`.
mesh::MeshPtr wedge(double angle) {
  mesh::TriangleSoup soup;
  const double c = std::sin(angle / 2), s = std::cos(angle / 2);
  add_quad(soup, {0, -1, 0}, {c, -1, s}, {c, 1, s}, {0, 1, 0});
  add_quad(soup, {0, -1, 0}, {0, 1, 0}, {-c, 1, s}, {-c, -1, s});
  return make_mesh_from(std::move(soup));
}

TEST(Mesh, SettlesInConcaveWedges) {
  for (const double angle : {0.1, 0.5, 1.0, 1.57, 2.2, 2.9, 3.1, 3.1415}) {
    Rig rig(mesh_link(wedge(angle)));
    ASSERT_EQ(rig.tick({0, 0, 0.5}).status, LinkStatus::free) << angle;
    Random random(7);
    for (int i = 0; i < 300; ++i) {
      const Vec3 probe(random.uniform(-0.05, 0.05), random.uniform(-0.5, 0.5), random.uniform(-0.3, -0.2));
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok) << angle;
      // the closest point of a convex set, in closed form
      const double c = std::sin(angle / 2), s = std::cos(angle / 2), side = probe.x < 0 ? -1 : 1;
      const double along = std::max(0.0, side * probe.x * c + probe.z * s);
      const Vec3 best(side * along * c, probe.y, along * s);
      ASSERT_LE(norm(rig.state.proxy - best), angle > 3.14 ? 1e-7 : 1e-12 / std::sin(angle / 2)) << angle << " " << i;
      // energy test: with a still probe the proxy is still, bit for bit
      const Vec3 rest = rig.state.proxy;
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(bitwise_equal(rig.tick(probe).proxy, rest));
      // a tiny step of the probe gives a tiny step of the proxy
      rig.tick(probe + Vec3(1e-9, 0, 0));
      ASSERT_LE(norm(rig.state.proxy - rest), angle > 3.14 ? 1e-7 : 3e-9) << angle;
    }
  }
}

TEST(Mesh, SlidesOverAConvexEdge) {
  // over the ridge of a roof, 1e-3 below it: the proxy's steps are bounded by the geometry
  for (const double slope : {0.001, 0.01, 0.1, 0.3, 0.6}) {
    const auto roof = make_mesh_from(sheet_soup(8, 1, [&](double x, double) { return -slope * std::fabs(x); }));
    Rig rig(mesh_link(roof));
    rig.tick({-0.5, 0.1, 0.1});
    rig.tick({-0.5, 0.1, -0.5 * slope - 0.01});
    Vec3 last = rig.state.proxy;
    const double depth = 1e-3, step = 1e-4;
    for (int i = 0; i < 10000; ++i) {
      const double x = -0.5 + step * i;
      const Vec3 probe(x, 0.1, -slope * std::fabs(x) - depth);
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok) << slope << " " << x;
      ASSERT_LE(off(*roof, rig.state.proxy), 1e-12);
      const double gap = norm(rig.state.proxy - probe);
      ASSERT_LE(gap, depth * std::sqrt(1 + slope * slope) / (1 - slope * slope) + step);
      const double moved = i > 0 ? norm(rig.state.proxy - last) : 0;
      ASSERT_LE(moved, (step + 2 * depth * slope / (1 - slope * slope)) * std::sqrt(1 + slope * slope)) << x;
      last = rig.state.proxy;
    }
    EXPECT_GT(last.x, 0.45);
  }
}

TEST(Mesh, SlidesOffTheBorderOfAnOpenSheet) {
  Rig rig(mesh_link(make_mesh_from(sheet_soup(3, 1, [](double, double) { return 0.0; }))));
  expect_steps(rig, {{{0, 0, 0.1}},
                     {{0.9, 0, -0.1}, kOk},
                     {{1.1, 0, -0.1}, kFree},
                     {{0.2, 0, -0.1}, kFree},  // free from behind
                     {{0.2, 0, 0.1}, kFree},
                     {{0.2, 0, -0.1}, kOk}});
}

/// 100 000 triangles.
TEST(Mesh, ForceOnAFineSphereIsRadial) {
  const auto sphere = make_mesh_from(sphere_soup(71));
  ASSERT_EQ(sphere->triangles().size(), 20u * 71 * 71);
  ASSERT_EQ(sphere->open_edges(), 0u);
  for (const char* side : {R"(, "free": "above")", ""}) {
    Rig rig(mesh_link(sphere, side));
    Random random(8);
    std::vector<double> errors;
    Vec3 way = random.unit();
    rig.tick(way * 1.1);
    for (int i = 0; i < 20000; ++i) {
      way = direction(way + 0.004 * random.unit());
      const Vec3 probe = way * (0.95 - 0.02 * std::fabs(std::sin(0.01 * i)));
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok) << i;
      errors.push_back(std::acos(std::min(1.0, dot(direction(rig.state.proxy - probe), way))) * 180 / 3.14159265358979);
      const double inner = norm(rig.state.proxy);
      ASSERT_LE(inner, 1 + 1e-12);
      ASSERT_GE(inner, 0.9998);
      if (i % 500 == 0) {
        ASSERT_LE(off(*sphere, rig.state.proxy), 1e-12);
      }
    }
    std::sort(errors.begin(), errors.end());
    double mean = 0;
    for (const double e : errors) mean += e / static_cast<double>(errors.size());
    EXPECT_LE(errors[errors.size() / 2], 0.36) << side;
    EXPECT_LE(mean, 0.36) << side;
    EXPECT_LE(errors.back(), 0.89) << side;
  }
}

TEST(Mesh, TwoSidedIsTheClosestPointOfConvexMeshes) {
  for (const auto& mesh : {make_mesh_from(sphere_soup(4)), make_mesh_from(box_soup({-1, -0.4, -0.7}, {0.6, 0.5, 1}))}) {
    Rig rig(mesh_link(mesh, ""));
    Random random(9);
    Vec3 probe(2, 0.3, 0.4), way = random.unit();
    for (int i = 0; i < 4000; ++i) {
      way = direction(way + 0.1 * random.unit());
      Vec3 next = probe + 0.01 * way;
      if (norm(next) < 1.7 || norm(next) > 3)
        way = -way;
      else
        probe = next;
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok);
      ASSERT_LE(norm(rig.state.proxy - closest_on_mesh(*mesh, probe)), 1e-12) << i;
    }
  }
}

TEST(Mesh, ScaledMeshesGiveScaledProxies) {
  // scaled by a power of two: bit-identical; by 1e-6 and 1e6: equal up to rounding
  const auto walk = [](double scale) {
    mesh::TriangleSoup soup = sphere_soup(8);
    for (Vec3& v : soup.vertices) v *= scale;
    Rig rig(mesh_link(make_mesh_from(std::move(soup))));
    Random random(12);
    std::vector<Vec3> out;
    Vec3 way = random.unit();
    rig.tick(1.2 * scale * way);
    for (int i = 0; i < 2000; ++i) {
      way = direction(way + 0.05 * random.unit());
      out.push_back(rig.tick(way * (scale * random.uniform(0.7, 1.1))).proxy / scale);
    }
    return out;
  };
  const auto one = walk(1), two = walk(1048576), tiny = walk(1e-6), large = walk(1e6);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_TRUE(bitwise_equal(one[i], two[i])) << i;
    ASSERT_LE(norm(one[i] - tiny[i]), 1e-11) << i;
    ASSERT_LE(norm(one[i] - large[i]), 1e-11) << i;
  }
}

TEST(Mesh, HostileProbesGiveFiniteProxies) {
  const auto box = make_mesh_from(box_soup());
  for (const char* side : {R"(, "free": "above")", R"(, "free": "below")", ""}) {
    Rig rig(mesh_link(box, side));
    const double list[] = {0.0, -0.0, 1e-300, 5e-324, 0.5, -0.5, 0.25, 1e6, -1e6, 1e150, 1e300, -1e300, 1.7e308, -1.7e308};
    Random random(13);
    for (int i = 0; i < 20000; ++i) {
      Vec3 probe(0.0);
      for (int k = 0; k < 3; ++k) probe[k] = list[random.engine() % std::size(list)];
      ASSERT_TRUE(is_finite(rig.tick(probe).proxy));
      ASSERT_TRUE(std::isfinite(rig.state.residual));
      if (rig.state.status == LinkStatus::free) {
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe));
      } else {
        ASSERT_LE(off(*box, rig.state.proxy), 1e-12) << probe.x << " " << probe.y << " " << probe.z;
      }
    }
  }
}

TEST(Mesh, RefusesBadKeys) {
  Fields fields;
  fields.meshes["m"] = make_mesh_from(box_soup());
  for (const char* bad :
       {"", R"(, "mesh": "n")", R"(, "mesh": "m", "free": "outside")", R"(, "mesh": "m", "release": -1)", R"(, "mesh": "m", "level": 1)"})
    EXPECT_FALSE(try_build(std::string(R"({"name": "a", "type": "mesh")") + bad + "}", fields)) << bad;
}

}  // namespace catena::haptics::tests::mesh_test
