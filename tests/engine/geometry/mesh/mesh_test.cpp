// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/geometry/mesh/mesh.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/mesh_shapes.h"

namespace catena::mesh::mesh_test {

using namespace catena::test;

TEST(TriangleMesh, BoxIsWeldedAndClosed) {
  const MeshPtr box = make_mesh_from(box_soup({-1, -2, -3}, {1, 2, 3}));
  EXPECT_EQ(box->triangles().size(), 12u);
  EXPECT_EQ(box->vertices().size(), 8u);
  EXPECT_EQ(box->open_edges() + box->non_manifold_edges() + box->misoriented_edges() + box->dropped_triangles(), 0u);
  EXPECT_EQ(box->domain_length(), 6);
  EXPECT_EQ(box->scale(), 8);
  EXPECT_EQ(box->min_corner(), Vec3(-1, -2, -3));
  EXPECT_EQ(box->max_corner(), Vec3(1, 2, 3));
  for (std::uint32_t f = 0; f < 12; ++f) {
    const Vec3 middle = (box->corner(f, 0) + box->corner(f, 1) + box->corner(f, 2)) / 3.0;
    EXPECT_GT(dot(box->face(f).normal, middle), 0) << "outwards";
    EXPECT_NEAR(norm(box->face(f).normal), 1, 1e-15);
    EXPECT_TRUE(box->face(f).covers(middle, 0));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NE(box->adjacent_face(f, k), f);
      EXPECT_NEAR(box->face(f).signed_distance(box->corner(f, k)), 0, 1e-16);
    }
  }
  for (std::uint32_t v = 0; v < 8; ++v) {
    EXPECT_FALSE(box->is_boundary_vertex(v));
    EXPECT_GT(dot(box->vertex_normal(v), box->vertices()[v]), 0);
  }
}

TEST(TriangleMesh, CountsOpenNonManifoldAndMisorientedEdges) {
  EXPECT_EQ(make_mesh_from(sheet_soup(3, 1, [](double, double) { return 0.0; }))->open_edges(), 12u);
  TriangleSoup book;
  add_quad(book, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(book, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, -1, 0});
  add_quad(book, {0, -1, 0}, {0, -1, 1}, {0, 1, 1}, {0, 1, 0});
  const MeshPtr crowded = make_mesh_from(book);
  EXPECT_EQ(crowded->non_manifold_edges(), 1u);
  EXPECT_EQ(crowded->open_edges(), 9u);
  // The faces of the ring around the spine.
  for (std::uint32_t f = 0; f < crowded->triangles().size(); ++f)
    for (int k = 0; k < 3; ++k) {
      int others = 0;
      for_each_adjacent_face(*crowded, f, k, [&](std::uint32_t) { ++others; });
      const Vec3 a = crowded->vertices()[crowded->triangles()[f][static_cast<std::size_t>(k)]];
      const Vec3 b = crowded->vertices()[crowded->triangles()[f][static_cast<std::size_t>((k + 1) % 3)]];
      EXPECT_TRUE(others == 2 || a.x != 0 || b.x != 0 || a.z != 0 || b.z != 0) << others;
    }
  TriangleSoup turned = box_soup();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(make_mesh_from(turned)->misoriented_edges(), 3u);
}

TEST(TriangleMesh, DropsDegenerateTriangles) {
  TriangleSoup soup = box_soup();
  soup.triangles.push_back({0, 0, 1});
  soup.triangles.push_back({0, 1, 1});
  soup.vertices.push_back({-0.5, 0, -0.5});
  soup.triangles.push_back({0, static_cast<std::uint32_t>(soup.vertices.size() - 1), 1});  // three collinear vertices
  const MeshPtr mesh = make_mesh_from(soup);
  EXPECT_EQ(mesh->dropped_triangles(), 3u);
  EXPECT_EQ(mesh->triangles().size(), 12u);
  EXPECT_EQ(mesh->vertices().size(), 8u);
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, "line"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}}, {}}, "none"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {{0, 1, 2}}}, "nan"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1e200, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "huge"));
  EXPECT_FALSE(make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, "index"));
}

TEST(TriangleMesh, TheNearestPointIsTheNearestOfAllFaces) {
  const MeshPtr sphere = make_mesh_from(sphere_soup(9));
  Random random{1};
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(random.next() >> 11) * 0x1p-53); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(in(-1, 1), in(-1, 1), in(-1, 1));
    double least = 1e300;
    for (std::uint32_t f = 0; f < sphere->triangles().size(); ++f) least = std::min(least, closest_point_on_face(*sphere, f, p).distance2);
    int budget = 100000;
    const NearestResult nearest = nearest_point(*sphere, p, 10, budget);
    ASSERT_TRUE(nearest.found && nearest.is_complete);
    ASSERT_EQ(nearest.closest.distance2, least);
    // The sign: inside where the sphere is inside.
    const bool inside = dot(normal_at(*sphere, nearest.closest), p - nearest.closest.point) < 0;
    ASSERT_TRUE(inside ? norm(p) <= 0.501 : norm(p) >= 0.49);
    int little = 3;
    ASSERT_FALSE(nearest_point(*sphere, p, 10, little).is_complete);
  }
}

TEST(TriangleMesh, SegmentQueriesFindEveryBoxOnTheirWay) {
  const MeshPtr sphere = make_mesh_from(sphere_soup(9));
  Random random{2};
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(random.next() >> 11) * 0x1p-53); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a(in(-1, 1), in(-1, 1), in(-1, 1)), b(in(-1, 1), in(-1, 1), in(-1, 1));
    const auto crosses = [&](std::uint32_t f) {
      const double ha = sphere->face(f).signed_distance(a), hb = sphere->face(f).signed_distance(b);
      return (ha < 0) != (hb < 0) && sphere->face(f).covers(a + (ha / (ha - hb)) * (b - a), 0);
    };
    int all = 0, met = 0, budget = 100000;
    for (std::uint32_t f = 0; f < sphere->triangles().size(); ++f) all += crosses(f) ? 1 : 0;
    Vec3 to = b;
    ASSERT_TRUE(sphere->bvh().visit_segment(a, to, 1e-12, budget, [&](std::uint32_t f) { met += crosses(f) ? 1 : 0; }));
    ASSERT_EQ(met, all);
    ASSERT_GT(budget, 99000);
  }
}

TEST(TriangleMesh, ManyEqualTrianglesMakeABoundedTree) {
  TriangleSoup soup;
  for (int i = 0; i < 3000; ++i) add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  for (int i = 0; i < 60; ++i) {
    const double s = std::ldexp(1.0, -i / 2);
    add_quad(soup, {2, 0, 0}, {2 + s, 0, 0}, {2 + s, s, 0}, {2, s, 0});
  }
  const MeshPtr mesh = make_mesh_from(soup);
  int budget = 100000, met = 0;
  Vec3 to = mesh->local_from_world({0.5, 0.4, -1});
  EXPECT_TRUE(mesh->bvh().visit_segment(mesh->local_from_world({0.5, 0.4, 1}), to, 1e-12, budget, [&](std::uint32_t) { ++met; }));
  EXPECT_GE(met, 6000);
}

}  // namespace catena::mesh::mesh_test
