// SPDX-License-Identifier: MIT
/// Difficult meshes for the god-object method: seams, intersecting parts, rough and stepped bodies.
#include "tests/haptics/constraints/mesh_fixture.h"

namespace catena::haptics::tests::mesh_edge_cases_test {

/// Two halves of a sheet with a seam of width 1e-8 and without shared vertices.
TEST(Mesh, NarrowSeamsAreCrossed) {
  mesh::TriangleSoup soup;
  add_quad(soup, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
  add_quad(soup, {1e-8, -1, 0}, {1, -1, 0}, {1, 0.3, 0}, {1e-8, 0.3, 0});
  add_quad(soup, {1e-8, 0.3, 0}, {1, 0.3, 0}, {1, 1, 0}, {1e-8, 1, 0});
  const auto sheet = make_mesh_from(std::move(soup));
  for (const char* side : {R"(, "free": "above")", ""}) {
    Rig rig(mesh_link(sheet, side));
    rig.tick({-0.5, 0.2, 0.1});
    for (int i = 0; i < 1000; ++i) {
      const Vec3 probe(-0.5 + 1e-3 * i, 0.2, -0.05);
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok) << side << i;
      ASSERT_LE(norm(rig.state.proxy - Vec3(probe.x, 0.2, 0)), 1.1e-8) << side << i;
    }
  }
}

TEST(Mesh, TwoSidedStaysOnItsSideOfAThinPlate) {
  Rig rig(mesh_link(make_mesh_from(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4})), ""));
  rig.tick({0, 0, 0.5});
  for (int i = 0; i < 40; ++i) {
    const Vec3 probe(0.3, 0.2, 0.5 - 0.04 * i);
    ASSERT_LE(norm(rig.tick(probe).proxy - Vec3(0.3, 0.2, 5e-4)), 1e-12);
  }
}

/// Intersecting boxes: the faces do not share edges where they intersect.
TEST(Mesh, HoldsOnIntersectingParts) {
  mesh::TriangleSoup soup;
  add_box(soup, {-1, -1, -0.2}, {1, 1, 0});
  add_box(soup, {0.3, -0.5, -0.1}, {0.5, 0.5, 0.4});
  const auto parts = make_mesh_from(std::move(soup));
  Rig rig(mesh_link(parts));
  rig.tick({0, 0, 0.2});
  Random random(10);
  for (int i = 0; i < 500; ++i) {
    const Vec3 probe(random.uniform(0.31, 0.5), random.uniform(-0.4, 0.4), random.uniform(-0.3, -0.01));
    ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok);
    ASSERT_LE(norm(rig.state.proxy - Vec3(0.3, probe.y, 0)), 2e-12) << i;
  }
}

/// Random walks deep inside random bodies: the proxy stays on the mesh and is locally the closest point outside of the body.
TEST(Mesh, StaysOutsideARoughBody) {
  Random random(11);
  mesh::TriangleSoup soup = sphere_soup(6);
  for (Vec3& v : soup.vertices) {
    // one bump per direction, equal for coincident corners
    v *= 1 + 0.25 * std::sin(5 * v.x) * std::sin(4 * v.y + 1) * std::sin(6 * v.z + 2);
  }
  const auto body = make_mesh_from(std::move(soup));
  ASSERT_EQ(body->open_edges(), 0u);
  Rig rig(mesh_link(body));
  Vec3 probe(0, 0, 2), way = random.unit();
  int held = 0;
  for (int i = 0; i < 30000; ++i) {
    way = direction(way + 0.3 * random.unit() - 0.02 * probe);
    probe += 0.02 * way;
    ASSERT_NE(rig.tick(probe).status, LinkStatus::budget) << i;
    if (rig.state.status != LinkStatus::ok) {
      ASSERT_FALSE(is_inside(*body, probe)) << i;
      continue;
    }
    ++held;
    if (i % 10 != 0) continue;
    ASSERT_LE(off(*body, rig.state.proxy), 1e-12) << i;
    // no point nearby and outside the body is nearer to the probe
    const double gap = norm(probe - rig.state.proxy);
    for (int k = 0; k < 40 && gap > 1e-3; ++k) {
      const Vec3 other = rig.state.proxy + 1e-6 * random.unit();
      if (norm(probe - other) < gap - 2e-8) {
        ASSERT_TRUE(is_inside(*body, other)) << i << " nearer by " << gap - norm(probe - other);
      }
    }
  }
  EXPECT_GT(held, 5000);
}

/// Stairs and a pit of cubes, with probes on the lattice of their corners: every hit is on an edge, a vertex or a seam.
TEST(Mesh, NoProbePassesThroughSeams) {
  const auto solid = [](int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x > 3 || y > 3 || z > 3) return false;
    return z <= x && !(x == 2 && y == 2 && z >= 1);
  };
  mesh::TriangleSoup soup;
  for (int x = -1; x < 4; ++x)
    for (int y = -1; y < 4; ++y)
      for (int z = -1; z < 4; ++z) {
        const Vec3 o(x, y, z);
        const auto wall = [&](bool here, bool there, const Vec3& at, const Vec3& u, const Vec3& v) {
          if (here == there) return;
          here ? add_quad(soup, at, at + u, at + u + v, at + v) : add_quad(soup, at, at + v, at + u + v, at + u);
        };
        wall(solid(x, y, z), solid(x + 1, y, z), o + Vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1});
        wall(solid(x, y, z), solid(x, y + 1, z), o + Vec3(0, 1, 0), {0, 0, 1}, {1, 0, 0});
        wall(solid(x, y, z), solid(x, y, z + 1), o + Vec3(0, 0, 1), {1, 0, 0}, {0, 1, 0});
      }
  const auto stairs = make_mesh_from(std::move(soup));
  ASSERT_EQ(stairs->open_edges(), 0u);
  Random random(14);
  int held = 0;
  for (int run = 0; run < 400; ++run) {
    Rig rig(mesh_link(stairs));
    Vec3 probe(0.5, 1.5, 1.5);
    for (int i = 0; i < 60; ++i) {
      ASSERT_NE(rig.tick(probe).status, LinkStatus::budget) << run << " " << i;
      if (rig.state.status == LinkStatus::ok) {
        ++held;
        ASSERT_LE(off(*stairs, rig.state.proxy), 1e-12) << run << " " << i;
      } else {
        bool inside = true;
        for (int k = 0; k < 8; ++k)
          inside = inside && is_inside(*stairs, probe + 1e-7 * Vec3(k & 1 ? 1 : -1, k & 2 ? 2 : -2, k & 4 ? 3 : -3));
        ASSERT_FALSE(inside) << run << " " << i;
      }
      const Vec3 rest = rig.state.proxy;
      ASSERT_TRUE(bitwise_equal(rig.tick(probe).proxy, rest));
      const double step = run % 2 == 0 ? 0.5 : 0.125;
      for (int k = 0; k < 3; ++k)
        probe[k] = std::clamp(probe[k] + step * static_cast<double>(static_cast<int>(random.engine() % 3) - 1), -0.5, 4.5);
    }
  }
  EXPECT_GT(held, 3000);
}

}  // namespace catena::haptics::tests::mesh_edge_cases_test
