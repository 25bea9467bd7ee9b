#include "tests/haptics/constraints/rig.h"
#include "tests/support/mesh_shapes.h"

namespace catena::haptics::test {
namespace {

using catena::test::add_box;
using catena::test::add_quad;
using catena::test::box_soup;
using catena::test::mesh_of;
using catena::test::sheet_soup;
using catena::test::sphere_soup;

ConstraintPtr felt(mesh::MeshPtr mesh, const std::string& more = R"(, "free": "above")") {
  Fields fields;
  fields.meshes["m"] = std::move(mesh);
  return build(R"({"name": "a", "type": "mesh", "mesh": "m")" + more + "}", fields);
}

/// The closest point of a triangle, on its own: over its plane, its edges, its corners.
Vec3 closest_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 n = cross(b - a, c - a);
  const Vec3 p = x - n * (dot(n, x - a) / dot(n, n));
  if (dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0) return p;
  Vec3 best = a;
  for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const double t = std::clamp(dot(x - u, v - u) / dot(v - u, v - u), 0.0, 1.0);
    const Vec3 q = u + t * (v - u);
    if (norm(q - x) < norm(best - x)) best = q;
  }
  return best;
}

Vec3 brute_force(const mesh::TriangleMesh& mesh, const Vec3& x) {
  Vec3 best(1e300);
  double least = 1e300;
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 p = closest_on(mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]], x);
    if (norm(p - x) < least) {
      least = norm(p - x);
      best = p;
    }
  }
  return best;
}

/// Inside a closed mesh: by the number of crossings of a ray in an odd direction.
bool is_inside(const mesh::TriangleMesh& mesh, const Vec3& x) {
  const Vec3 way = direction(Vec3(0.5377, 0.8339, -0.2259));
  int crossings = 0;
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 a = mesh.vertices()[t[0]] - x, b = mesh.vertices()[t[1]] - x, c = mesh.vertices()[t[2]] - x;
    const double u = dot(way, cross(a, b)), v = dot(way, cross(b, c)), w = dot(way, cross(c, a));
    const bool through = (u > 0) == (v > 0) && (v > 0) == (w > 0);
    if (through && (dot(a, cross(b, c)) > 0) == (u > 0)) ++crossings;
  }
  return crossings % 2 == 1;
}

double off(const mesh::TriangleMesh& mesh, const Vec3& p) { return norm(brute_force(mesh, p) - p) / mesh.length(); }

TEST(Mesh, BoxIsFreeOutsideAndHoldsInside) {
  Rig rig(felt(mesh_of(box_soup())));
  EXPECT_EQ(rig.tick({0.1, 0.2, 0.8}).status, Status::free);
  EXPECT_TRUE(same_bits(rig.state.proxy, Vec3(0.1, 0.2, 0.8)));
  EXPECT_EQ(rig.tick({0.1, 0.2, 0.5}).status, Status::free);
  EXPECT_EQ(rig.tick({0.1, 0.2, 0.3}).status, Status::ok);  // within the tick that crosses
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.1, 0.2, 0.5)), 1e-12);
  EXPECT_EQ(rig.state.evaluations, 0);
  // deep, nearer to a side wall by now: still on the face that it met
  EXPECT_EQ(rig.tick({0.1, 0.45, -0.3}).status, Status::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.1, 0.45, 0.5)), 1e-12);
  EXPECT_EQ(rig.tick({0.1, 0.45, 0.6}).status, Status::free);
}

TEST(Mesh, InsideOutIsFreeInside) {
  Rig rig(felt(mesh_of(box_soup()), R"(, "free": "below")"));
  EXPECT_EQ(rig.tick({0, 0, 0}).status, Status::free);
  EXPECT_EQ(rig.tick({0.7, 0.1, 0}).status, Status::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.1, 0)), 1e-12);
  // along an edge, into a corner: all three walls hold
  EXPECT_EQ(rig.tick({0.7, 0.8, 0}).status, Status::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.5, 0)), 2e-12);
  Primitive primitive;
  ASSERT_TRUE(rig.constraint->primitive(rig.state.proxy, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, Primitive::Kind::line);
  EXPECT_NEAR(std::fabs(primitive.axis.z), 1, 1e-12);
  EXPECT_EQ(rig.tick({0.7, 0.8, -0.9}).status, Status::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.5, -0.5)), 2e-12);
  EXPECT_EQ(rig.tick({0.4, 0.4, -0.4}).status, Status::free);
}

TEST(Mesh, FirstProbeInsideIsHeldOrReleased) {
  Rig rig(felt(mesh_of(box_soup())));
  EXPECT_EQ(rig.tick({0.3, 0.1, 0}).status, Status::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.5, 0.1, 0)), 1e-12);
  Rig deep(felt(mesh_of(box_soup()), R"(, "free": "above", "release": 0.1)"));
  EXPECT_EQ(deep.tick({0.3, 0.1, 0}).status, Status::released);
  EXPECT_TRUE(same_bits(deep.state.proxy, Vec3(0.3, 0.1, 0)));
}

TEST(Mesh, OneSidedReleaseAndReArm) {
  Rig rig(felt(mesh_of(box_soup()), R"(, "free": "above", "release": 0.25)"));
  EXPECT_EQ(rig.tick({0, 0, 0.6}).status, Status::free);
  EXPECT_EQ(rig.tick({0, 0, 0.3}).status, Status::ok);
  EXPECT_EQ(rig.state.limit, 0.25);
  EXPECT_EQ(rig.tick({0, 0, 0.24}).status, Status::released);
  EXPECT_TRUE(same_bits(rig.state.proxy, Vec3(0, 0, 0.24)));
  EXPECT_EQ(rig.tick({0, 0, 0.49}).status, Status::released);
  EXPECT_EQ(rig.tick({0, 0, 0.51}).status, Status::free);
  EXPECT_EQ(rig.tick({0, 0, 0.49}).status, Status::ok);
}

TEST(Mesh, TwoSidedReleaseAndReArm) {
  Rig rig(felt(mesh_of(sheet_soup(4, 1, [](double, double) { return 0.0; })), R"(, "release": 0.25)"));
  EXPECT_EQ(rig.tick({0.3, 0, 0.2}).status, Status::ok);
  EXPECT_EQ(rig.tick({0.3, 0, 0.3}).status, Status::released);
  EXPECT_EQ(rig.tick({0.3, 0, 0.026}).status, Status::released);
  EXPECT_EQ(rig.tick({0.3, 0, 0.024}).status, Status::ok);  // within a tenth
  EXPECT_EQ(rig.tick({0.3, 0, 0.3}).status, Status::released);
  EXPECT_EQ(rig.tick({0.3, 0.2, -0.1}).status, Status::ok);  // passed through
  EXPECT_LE(norm(rig.state.proxy - Vec3(0.3, 0.2, 0)), 1e-12);
}

/// A plate of two faces 1e-3 apart; the hand goes right through it at 0.02 L a tick, from many sides.
TEST(Mesh, ThinPlateIsNeverPassedThrough) {
  const auto plate = mesh_of(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
  Random random(5);
  for (const double step : {0.04, 0.013, 5e-4, 1e-4, 2.0}) {
    Rig rig(felt(plate));
    Vec3 probe(random.in(-0.5, 0.5), random.in(-0.5, 0.5), step > 0.1 ? 1.0 : 10.3 * step);
    rig.tick(probe);
    Vec3 side = random.unit() * 0.3 * std::min(step, 0.04);
    side.z = 0;
    for (int i = 0; i < 20; ++i) {
      probe += Vec3(side.x, side.y, -step);
      rig.tick(probe);
      if (probe.z >= 5e-4) continue;
      ASSERT_EQ(rig.state.status, Status::ok) << step << " tick " << i;
      ASSERT_LE(norm(rig.state.proxy - Vec3(probe.x, probe.y, 5e-4)), 2e-12) << step << " tick " << i;
    }
    // and back out on the side where it came in
    probe.z = 1;
    EXPECT_EQ(rig.tick(probe).status, Status::free);
  }
}

TEST(Mesh, FastHandsDoNotTunnel) {
  const auto plate = mesh_of(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
  Random random(6);
  for (int i = 0; i < 3000; ++i) {
    Rig rig(felt(plate));
    const Vec3 from(random.in(-0.9, 0.9), random.in(-0.9, 0.9), random.in(0.001, 2)),
        to(random.in(-0.9, 0.9), random.in(-0.9, 0.9), random.in(-2, 0));
    ASSERT_EQ(rig.tick(from).status, Status::free);
    ASSERT_EQ(rig.tick(to).status, Status::ok) << i;
    ASSERT_LE(norm(rig.state.proxy - Vec3(to.x, to.y, 5e-4)), 4e-12) << i;
  }
}

/// Two half planes that meet at the bottom: the floor of a wedge of opening `angle`.
mesh::MeshPtr wedge(double angle) {
  mesh::Soup soup;
  const double c = std::sin(angle / 2), s = std::cos(angle / 2);
  add_quad(soup, {0, -1, 0}, {c, -1, s}, {c, 1, s}, {0, 1, 0});
  add_quad(soup, {0, -1, 0}, {0, 1, 0}, {-c, 1, s}, {-c, -1, s});
  return mesh_of(std::move(soup));
}

TEST(Mesh, SettlesInConcaveWedges) {
  for (const double angle : {0.1, 0.5, 1.0, 1.57, 2.2, 2.9, 3.1, 3.1415}) {
    Rig rig(felt(wedge(angle)));
    ASSERT_EQ(rig.tick({0, 0, 0.5}).status, Status::free) << angle;
    Random random(7);
    for (int i = 0; i < 300; ++i) {
      const Vec3 probe(random.in(-0.05, 0.05), random.in(-0.5, 0.5), random.in(-0.3, -0.2));
      rig.tick(probe);
      ASSERT_EQ(rig.state.status, Status::ok) << angle;
      // the closest point of a convex set, by closed form
      const double c = std::sin(angle / 2), s = std::cos(angle / 2), side = probe.x < 0 ? -1 : 1;
      const double along = std::max(0.0, side * probe.x * c + probe.z * s);
      const Vec3 best(side * along * c, probe.y, along * s);
      ASSERT_LE(norm(rig.state.proxy - best), angle > 3.14 ? 1e-7 : 1e-12 / std::sin(angle / 2)) << angle << " " << i;
      // the energy test: a still probe gets a still proxy, bit for bit
      const Vec3 rest = rig.state.proxy;
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(same_bits(rig.tick(probe).proxy, rest));
      // and a probe that hardly moves a proxy that hardly moves
      rig.tick(probe + Vec3(1e-9, 0, 0));
      ASSERT_LE(norm(rig.state.proxy - rest), angle > 3.14 ? 1e-7 : 3e-9) << angle;
    }
  }
}

TEST(Mesh, SlidesOverAConvexEdge) {
  // over the ridge of a roof, 1e-3 below it: the proxy moves no faster than geometry says, the force turns once
  for (const double slope : {0.001, 0.01, 0.1, 0.3, 0.6}) {
    const auto roof = mesh_of(sheet_soup(8, 1, [&](double x, double) { return -slope * std::fabs(x); }));
    Rig rig(felt(roof));
    rig.tick({-0.5, 0.1, 0.1});
    rig.tick({-0.5, 0.1, -0.5 * slope - 0.01});
    Vec3 last = rig.state.proxy;
    const double depth = 1e-3, step = 1e-4;
    for (int i = 0; i < 10000; ++i) {
      const double x = -0.5 + step * i;
      const Vec3 probe(x, 0.1, -slope * std::fabs(x) - depth);
      rig.tick(probe);
      ASSERT_EQ(rig.state.status, Status::ok) << slope << " " << x;
      ASSERT_LE(off(*roof, rig.state.proxy), 1e-12);
      const double gap = norm(rig.state.proxy - probe);
      ASSERT_LE(gap, depth * std::sqrt(1 + slope * slope) / (1 - slope * slope) + step);
      if (i > 0) {
        ASSERT_LE(norm(rig.state.proxy - last), (step + 2 * depth * slope / (1 - slope * slope)) * std::sqrt(1 + slope * slope)) << x;
      }
      last = rig.state.proxy;
    }
    EXPECT_GT(last.x, 0.45);
  }
}

TEST(Mesh, SlidesOffTheBorderOfAnOpenSheet) {
  Rig rig(felt(mesh_of(sheet_soup(3, 1, [](double, double) { return 0.0; }))));
  rig.tick({0, 0, 0.1});
  EXPECT_EQ(rig.tick({0.9, 0, -0.1}).status, Status::ok);
  EXPECT_EQ(rig.tick({1.1, 0, -0.1}).status, Status::free);
  EXPECT_EQ(rig.tick({0.2, 0, -0.1}).status, Status::free);  // from behind it lets pass
  EXPECT_EQ(rig.tick({0.2, 0, 0.1}).status, Status::free);
  EXPECT_EQ(rig.tick({0.2, 0, -0.1}).status, Status::ok);
}

/// 100 k triangles: the accuracy that the issue asks for.
TEST(Mesh, ForceOnAFineSphereIsRadial) {
  const auto sphere = mesh_of(sphere_soup(71));
  ASSERT_EQ(sphere->triangles().size(), 20u * 71 * 71);
  ASSERT_EQ(sphere->open_edges(), 0u);
  for (const char* side : {R"(, "free": "above")", ""}) {
    Rig rig(felt(sphere, side));
    Random random(8);
    std::vector<double> errors;
    Vec3 way = random.unit();
    rig.tick(way * 1.1);
    for (int i = 0; i < 20000; ++i) {
      way = direction(way + 0.004 * random.unit());
      const Vec3 probe = way * (0.95 - 0.02 * std::fabs(std::sin(0.01 * i)));
      rig.tick(probe);
      ASSERT_EQ(rig.state.status, Status::ok) << i;
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
    RecordProperty(*side ? "one_sided" : "two_sided",
                   std::to_string(errors[errors.size() / 2]) + " " + std::to_string(mean) + " " + std::to_string(errors.back()));
  }
}

TEST(Mesh, TwoSidedIsTheClosestPointOfConvexMeshes) {
  for (const auto& mesh : {mesh_of(sphere_soup(4)), mesh_of(box_soup({-1, -0.4, -0.7}, {0.6, 0.5, 1}))}) {
    Rig rig(felt(mesh, ""));
    Random random(9);
    Vec3 probe(2, 0.3, 0.4), way = random.unit();
    for (int i = 0; i < 4000; ++i) {
      way = direction(way + 0.1 * random.unit());
      Vec3 next = probe + 0.01 * way;
      if (norm(next) < 1.7 || norm(next) > 3)
        way = -way;
      else
        probe = next;
      rig.tick(probe);
      ASSERT_EQ(rig.state.status, Status::ok);
      ASSERT_LE(norm(rig.state.proxy - brute_force(*mesh, probe)), 1e-12) << i;
    }
  }
}

/// Two halves of a sheet whose seam does not share vertices, and is 1e-8 wide.
TEST(Mesh, SeamsThatDoNotQuiteMeetAreCrossed) {
  mesh::Soup soup;
  add_quad(soup, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
  add_quad(soup, {1e-8, -1, 0}, {1, -1, 0}, {1, 0.3, 0}, {1e-8, 0.3, 0});
  add_quad(soup, {1e-8, 0.3, 0}, {1, 0.3, 0}, {1, 1, 0}, {1e-8, 1, 0});
  const auto sheet = mesh_of(std::move(soup));
  for (const char* side : {R"(, "free": "above")", ""}) {
    Rig rig(felt(sheet, side));
    rig.tick({-0.5, 0.2, 0.1});
    for (int i = 0; i < 1000; ++i) {
      const Vec3 probe(-0.5 + 1e-3 * i, 0.2, -0.05);
      rig.tick(probe);
      ASSERT_EQ(rig.state.status, Status::ok) << side << i;
      ASSERT_LE(norm(rig.state.proxy - Vec3(probe.x, 0.2, 0)), 1.1e-8) << side << i;
    }
  }
}

TEST(Mesh, TwoSidedStaysOnItsSideOfAThinPlate) {
  Rig rig(felt(mesh_of(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4})), ""));
  rig.tick({0, 0, 0.5});
  for (int i = 0; i < 40; ++i) {
    const Vec3 probe(0.3, 0.2, 0.5 - 0.04 * i);
    rig.tick(probe);
    ASSERT_LE(norm(rig.state.proxy - Vec3(0.3, 0.2, 5e-4)), 1e-12);
  }
}

/// A soup of boxes that cut each other: no pair of faces shares an edge where they meet.
TEST(Mesh, HoldsWherePartsCutEachOther) {
  mesh::Soup soup;
  add_box(soup, {-1, -1, -0.2}, {1, 1, 0});
  add_box(soup, {0.3, -0.5, -0.1}, {0.5, 0.5, 0.4});
  const auto parts = mesh_of(std::move(soup));
  Rig rig(felt(parts));
  rig.tick({0, 0, 0.2});
  Random random(10);
  for (int i = 0; i < 500; ++i) {
    const Vec3 probe(random.in(0.31, 0.5), random.in(-0.4, 0.4), random.in(-0.3, -0.01));
    rig.tick(probe);
    ASSERT_EQ(rig.state.status, Status::ok);
    ASSERT_LE(norm(rig.state.proxy - Vec3(0.3, probe.y, 0)), 2e-12) << i;
  }
}

/// Random walks deep inside random bodies: on the mesh, outside of it, no further from the probe than any move could be.
TEST(Mesh, StaysOutsideARoughBody) {
  Random random(11);
  mesh::Soup soup = sphere_soup(6);
  for (Vec3& v : soup.vertices) {
    // a bump a direction, the same for corners that coincide
    v *= 1 + 0.25 * std::sin(5 * v.x) * std::sin(4 * v.y + 1) * std::sin(6 * v.z + 2);
  }
  const auto body = mesh_of(std::move(soup));
  ASSERT_EQ(body->open_edges(), 0u);
  Rig rig(felt(body));
  Vec3 probe(0, 0, 2), way = random.unit();
  int held = 0;
  for (int i = 0; i < 30000; ++i) {
    way = direction(way + 0.3 * random.unit() - 0.02 * probe);
    probe += 0.02 * way;
    rig.tick(probe);
    ASSERT_NE(rig.state.status, Status::budget) << i;
    if (rig.state.status != Status::ok) {
      ASSERT_FALSE(is_inside(*body, probe)) << i;
      continue;
    }
    ++held;
    if (i % 10 != 0) continue;
    ASSERT_LE(off(*body, rig.state.proxy), 1e-12) << i;
    // no place outside the body and close by is nearer to the probe: settled in valleys, past saddles
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

/// Stairs and a pit out of cubes, probes on the lattice of their corners: every hit is on an edge, a vertex or a seam.
TEST(Mesh, NothingLeaksThroughSeams) {
  const auto solid = [](int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x > 3 || y > 3 || z > 3) return false;
    return z <= x && !(x == 2 && y == 2 && z >= 1);
  };
  mesh::Soup soup;
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
  const auto stairs = mesh_of(std::move(soup));
  ASSERT_EQ(stairs->open_edges(), 0u);
  Random random(14);
  int held = 0;
  for (int run = 0; run < 400; ++run) {
    Rig rig(felt(stairs));
    Vec3 probe(0.5, 1.5, 1.5);
    for (int i = 0; i < 60; ++i) {
      rig.tick(probe);
      ASSERT_NE(rig.state.status, Status::budget) << run << " " << i;
      if (rig.state.status == Status::ok) {
        ++held;
        ASSERT_LE(off(*stairs, rig.state.proxy), 1e-12) << run << " " << i;
      } else {
        bool inside = true;
        for (int k = 0; k < 8; ++k)
          inside = inside && is_inside(*stairs, probe + 1e-7 * Vec3(k & 1 ? 1 : -1, k & 2 ? 2 : -2, k & 4 ? 3 : -3));
        ASSERT_FALSE(inside) << run << " " << i;
      }
      const Vec3 rest = rig.state.proxy;
      ASSERT_TRUE(same_bits(rig.tick(probe).proxy, rest));
      const double step = run % 2 == 0 ? 0.5 : 0.125;
      for (int k = 0; k < 3; ++k)
        probe[k] = std::clamp(probe[k] + step * static_cast<double>(static_cast<int>(random.engine() % 3) - 1), -0.5, 4.5);
    }
  }
  EXPECT_GT(held, 3000);
}

TEST(Mesh, HugeAndTinyMeshesBehaveTheSame) {
  // scaled by a power of two: the same bits; by 1e-6 and 1e6: the same to rounding
  const auto walk = [](double scale) {
    mesh::Soup soup = sphere_soup(8);
    for (Vec3& v : soup.vertices) v *= scale;
    Rig rig(felt(mesh_of(std::move(soup))));
    Random random(12);
    std::vector<Vec3> out;
    Vec3 way = random.unit();
    rig.tick(1.2 * scale * way);
    for (int i = 0; i < 2000; ++i) {
      way = direction(way + 0.05 * random.unit());
      out.push_back(rig.tick(way * (scale * random.in(0.7, 1.1))).proxy / scale);
    }
    return out;
  };
  const auto one = walk(1), two = walk(1048576), tiny = walk(1e-6), large = walk(1e6);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_TRUE(same_bits(one[i], two[i])) << i;
    ASSERT_LE(norm(one[i] - tiny[i]), 1e-11) << i;
    ASSERT_LE(norm(one[i] - large[i]), 1e-11) << i;
  }
}

TEST(Mesh, HostileProbes) {
  const auto box = mesh_of(box_soup());
  for (const char* side : {R"(, "free": "above")", R"(, "free": "below")", ""}) {
    Rig rig(felt(box, side));
    const double list[] = {0.0, -0.0, 1e-300, 5e-324, 0.5, -0.5, 0.25, 1e6, -1e6, 1e150, 1e300, -1e300, 1.7e308, -1.7e308};
    Random random(13);
    for (int i = 0; i < 20000; ++i) {
      Vec3 probe(0.0);
      for (int k = 0; k < 3; ++k) probe[k] = list[random.engine() % std::size(list)];
      rig.tick(probe);
      ASSERT_TRUE(is_finite(rig.state.proxy));
      ASSERT_TRUE(std::isfinite(rig.state.residual));
      if (rig.state.status == Status::free) {
        ASSERT_TRUE(same_bits(rig.state.proxy, probe));
      } else {
        ASSERT_LE(off(*box, rig.state.proxy), 1e-12) << probe.x << " " << probe.y << " " << probe.z;
      }
    }
  }
}

TEST(Mesh, RefusesBadKeys) {
  Fields fields;
  fields.meshes["m"] = mesh_of(box_soup());
  const std::string head = R"({"name": "a", "type": "mesh")";
  EXPECT_FALSE(try_build(head + "}", fields));
  EXPECT_FALSE(try_build(head + R"(, "mesh": "n"})", fields));
  EXPECT_FALSE(try_build(head + R"(, "mesh": "m", "free": "outside"})", fields));
  EXPECT_FALSE(try_build(head + R"(, "mesh": "m", "release": -1})", fields));
  EXPECT_FALSE(try_build(head + R"(, "mesh": "m", "level": 1})", fields));
}

}  // namespace
}  // namespace catena::haptics::test
