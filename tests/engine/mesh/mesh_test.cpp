#include <gtest/gtest.h>

#include "engine/mesh/mesh.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/mesh_shapes.h"

namespace catena::mesh {
namespace mesh_test {

using namespace catena::test;

TEST(TriangleMesh, BoxIsWeldedAndClosed) {
  const MeshPtr box = mesh_of(box_soup({-1, -2, -3}, {1, 2, 3}));
  EXPECT_EQ(box->triangles().size(), 12u);
  EXPECT_EQ(box->vertices().size(), 8u);
  EXPECT_EQ(box->open_edges() + box->non_manifold_edges() + box->misoriented_edges() + box->dropped(), 0u);
  EXPECT_EQ(box->length(), 6);
  EXPECT_EQ(box->scale(), 8);
  EXPECT_EQ(box->lowest(), Vec3(-1, -2, -3));
  EXPECT_EQ(box->highest(), Vec3(1, 2, 3));
  for (std::uint32_t f = 0; f < 12; ++f) {
    const Vec3 middle = (box->corner(f, 0) + box->corner(f, 1) + box->corner(f, 2)) / 3.0;
    EXPECT_GT(dot(box->face(f).normal, middle), 0) << "outwards";
    EXPECT_NEAR(norm(box->face(f).normal), 1, 1e-15);
    EXPECT_TRUE(box->face(f).covers(middle, 0));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NE(box->across(f, k), f);
      EXPECT_NEAR(box->face(f).height(box->corner(f, k)), 0, 1e-16);
    }
  }
  for (std::uint32_t v = 0; v < 8; ++v) {
    EXPECT_FALSE(box->on_border(v));
    EXPECT_GT(dot(box->vertex_normal(v), box->vertices()[v]), 0);
  }
}

TEST(TriangleMesh, CountsOpenCrowdedAndTurnedEdges) {
  EXPECT_EQ(mesh_of(sheet_soup(3, 1, [](double, double) { return 0.0; }))->open_edges(), 12u);
  Soup book;
  add_quad(book, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(book, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, -1, 0});
  add_quad(book, {0, -1, 0}, {0, -1, 1}, {0, 1, 1}, {0, 1, 0});
  const MeshPtr crowded = mesh_of(book);
  EXPECT_EQ(crowded->non_manifold_edges(), 1u);
  EXPECT_EQ(crowded->open_edges(), 9u);
  // around the spine in a ring
  for (std::uint32_t f = 0; f < crowded->triangles().size(); ++f)
    for (int k = 0; k < 3; ++k) {
      int others = 0;
      each_across(*crowded, f, k, [&](std::uint32_t) { ++others; });
      const Vec3 a = crowded->vertices()[crowded->triangles()[f][static_cast<std::size_t>(k)]];
      const Vec3 b = crowded->vertices()[crowded->triangles()[f][static_cast<std::size_t>((k + 1) % 3)]];
      if (a.x == 0 && b.x == 0 && a.z == 0 && b.z == 0) {
        EXPECT_EQ(others, 2);
      }
    }
  Soup turned = box_soup();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(mesh_of(turned)->misoriented_edges(), 3u);
}

TEST(TriangleMesh, DropsTrianglesWithoutAnArea) {
  Soup soup = box_soup();
  soup.triangles.push_back({0, 0, 1});
  soup.triangles.push_back({0, 1, 1});
  soup.vertices.push_back({-0.5, 0, -0.5});
  soup.triangles.push_back({0, static_cast<std::uint32_t>(soup.vertices.size() - 1), 1});  // three on a line
  const MeshPtr mesh = mesh_of(soup);
  EXPECT_EQ(mesh->dropped(), 3u);
  EXPECT_EQ(mesh->triangles().size(), 12u);
  EXPECT_EQ(mesh->vertices().size(), 8u);
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, "line"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}}, {}}, "none"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {{0, 1, 2}}}, "nan"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1e200, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "huge"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, "index"));
}

TEST(TriangleMesh, NearestPointIsThatOfAllFaces) {
  const MeshPtr sphere = mesh_of(sphere_soup(9));
  Random random{1};
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(random.next() >> 11) * 0x1p-53); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(in(-1, 1), in(-1, 1), in(-1, 1));
    double least = 1e300;
    for (std::uint32_t f = 0; f < sphere->triangles().size(); ++f) least = std::min(least, closest_on_face(*sphere, f, p).distance2);
    int budget = 100000;
    const Nearest nearest = nearest_point(*sphere, p, 10, budget);
    ASSERT_TRUE(nearest.found && nearest.complete);
    ASSERT_EQ(nearest.at.distance2, least);
    // the sign: inside where the sphere is
    const bool inside = dot(normal_at(*sphere, nearest.at), p - nearest.at.point) < 0;
    if (norm(p) < 0.49) {
      ASSERT_TRUE(inside);
    }
    if (norm(p) > 0.501) {
      ASSERT_FALSE(inside);
    }
    int little = 3;
    ASSERT_FALSE(nearest_point(*sphere, p, 10, little).complete);
  }
}

TEST(TriangleMesh, SegmentsMeetEveryBoxOnTheirWay) {
  const MeshPtr sphere = mesh_of(sphere_soup(9));
  Random random{2};
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(random.next() >> 11) * 0x1p-53); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a(in(-1, 1), in(-1, 1), in(-1, 1)), b(in(-1, 1), in(-1, 1), in(-1, 1));
    const auto crosses = [&](std::uint32_t f) {
      const double ha = sphere->face(f).height(a), hb = sphere->face(f).height(b);
      return (ha < 0) != (hb < 0) && sphere->face(f).covers(a + (ha / (ha - hb)) * (b - a), 0);
    };
    int all = 0, met = 0, budget = 100000;
    for (std::uint32_t f = 0; f < sphere->triangles().size(); ++f) all += crosses(f) ? 1 : 0;
    Vec3 to = b;
    ASSERT_TRUE(sphere->bvh().segment(a, to, 1e-12, budget, [&](std::uint32_t f) { met += crosses(f) ? 1 : 0; }));
    ASSERT_EQ(met, all);
    ASSERT_GT(budget, 99000);
  }
}

TEST(TriangleMesh, ManyEqualBoxesMakeABoundedTree) {
  Soup soup;
  for (int i = 0; i < 3000; ++i) add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  for (int i = 0; i < 60; ++i) {
    const double s = std::ldexp(1.0, -i / 2);
    add_quad(soup, {2, 0, 0}, {2 + s, 0, 0}, {2 + s, s, 0}, {2, s, 0});
  }
  const MeshPtr mesh = mesh_of(soup);
  int budget = 100000, met = 0;
  Vec3 to = mesh->own({0.5, 0.4, -1});
  EXPECT_TRUE(mesh->bvh().segment(mesh->own({0.5, 0.4, 1}), to, 1e-12, budget, [&](std::uint32_t) { ++met; }));
  EXPECT_GE(met, 6000);
}

}  // namespace mesh_test
}  // namespace catena::mesh
