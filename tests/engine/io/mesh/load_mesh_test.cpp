// SPDX-License-Identifier: MIT
#include "engine/io/mesh/load_mesh.h"

#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::mesh::load_mesh_test {

using namespace catena::test;

void expect_box(const TriangleSoup& soup) {
  const MeshPtr mesh = make_mesh_from(soup);
  EXPECT_EQ(mesh->triangles().size(), 12u);
  EXPECT_EQ(mesh->vertices().size(), 8u);
  EXPECT_EQ(mesh->open_edges() + mesh->misoriented_edges(), 0u);
  EXPECT_EQ(mesh->min_corner(), Vec3(-1, -2, -3));
  EXPECT_EQ(mesh->max_corner(), Vec3(1, 2, 3));
}

const TriangleSoup kBox = box_soup({-1, -2, -3}, {1, 2, 3});

TEST(Stl, ReadsBinaryAndText) {
  for (const std::string& bytes : {binary_stl(kBox), text_stl(kBox)}) expect_box(value_of(parse_stl(bytes, "a.stl")));
  // A binary file is read as such with any header. Text may have capitals, two solids and Windows line ends.
  std::string named = binary_stl(kBox);
  named.replace(0, 5, "solid");
  ASSERT_TRUE(parse_stl(named, "a.stl"));
  std::string loud = text_stl(kBox) + text_stl(kBox);
  for (char& c : loud) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  for (std::size_t at = 0; (at = loud.find('\n', at)) != std::string::npos; at += 2) loud.replace(at, 1, "\r\n");
  const auto twice = value_of(parse_stl(loud, "a.stl"));
  EXPECT_EQ(twice.triangles.size(), 24u);
}

TEST(Stl, ErrorsNameThePositionAndTheExpectation) {
  const std::string binary = binary_stl(kBox);
  EXPECT_EQ(message_of(parse_stl(binary.substr(0, 300), "a.stl")),
            "a.stl: byte 80: the number of triangles is 12, which takes 684 bytes, but the file has 300; a complete STL file was expected");
  EXPECT_TRUE(fails(parse_stl(binary + "x", "a.stl"), "684 bytes, but the file has 685"));
  EXPECT_TRUE(fails(parse_stl("", "a.stl"), "at least 84 bytes"));
  std::string nan = binary;
  const float bad = NAN;
  std::memcpy(nan.data() + 84 + 50 + 12 + 4, &bad, 4);
  EXPECT_EQ(message_of(parse_stl(nan, "a.stl")), "a.stl: byte 150: a corner of triangle 2 is not finite; finite numbers were expected");
  std::string lie = binary;
  const std::uint32_t count = 0xffffffff;
  std::memcpy(lie.data() + 80, &count, 4);
  EXPECT_TRUE(fails(parse_stl(lie, "a.stl"), "the number of triangles is 4294967295,"));

  EXPECT_EQ(message_of(parse_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "a.stl")),
            "a.stl:4: found \"x\"; a finite number was expected");
  EXPECT_EQ(message_of(parse_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", "a.stl")),
            "a.stl:4: found \"inf\"; a finite number was expected");
  EXPECT_TRUE(fails(parse_stl("solid a\nfacet normal 0 0 1\nouter loop\n", "a.stl"), "ends too early; \"vertex\""));
}

const std::string kObj = R"(# a box
mtllib box.mtl
o box
v -1 -2 -3
v 1 -2 -3 0.5 0.5 0.5
v 1 2 -3
v -1 2 -3
v -1 -2 3 1.0
v 1 -2 3
v 1 2 3
v -1 2 \
 3
vt 0 0
vn 0 0 1
usemtl red
s off
f 4 3 2 1
f 5/1 6/1 7/1 8/1   # with texture
f 1//1 2//1 6//1 5//1
f -6/1/1 -5/1/1 -1/1/1 -2/1/1
f 1 5 8 4
f 2 3 7 6
)";

TEST(Obj, ReadsPolygonsNegativeIndicesAndComments) { expect_box(value_of(parse_obj(kObj, "a.obj"))); }

TEST(Obj, ErrorsNameThePositionAndTheExpectation) {
  EXPECT_EQ(message_of(parse_obj("v 0 0 0\nf 1 2 3\n", "a.obj")),
            "a.obj:2: \"2\" refers to a vertex that does not exist; 1 to 1 was expected");
  EXPECT_EQ(message_of(parse_obj("v 0 0 nan\n", "a.obj")),
            "a.obj:1: \"nan\" is not a valid coordinate; three finite numbers were expected");
  EXPECT_EQ(message_of(parse_obj("v 0 0\n", "a.obj")), "a.obj:1: a vertex has too few coordinates; three finite numbers were expected");
  EXPECT_EQ(message_of(parse_obj("v 0 0 0\nv 1 0 0\nf 1 2\n", "a.obj")), "a.obj:3: a face has 2 corners; at least 3 were expected");
  EXPECT_TRUE(fails(parse_obj("v 0 0 0\nf 0 1 1\n", "a.obj"), "\"0\" is not a valid corner"));
  EXPECT_TRUE(fails(parse_obj("hello\n", "a.obj"), "a.obj:1: \"hello\" is not a statement"));
}

TEST(LoadMesh, LoadsAndPlacesFilesAndRefusesBadOnes) {
  TemporaryFolder folder;
  write_file(folder / "box.STL", binary_stl(kBox));
  write_file(folder / "box.obj", kObj);
  const auto stl = value_of(load_mesh(folder / "box.STL", {2, {10, 0, 0}})), obj = value_of(load_mesh(folder / "box.obj"));
  EXPECT_EQ(stl->min_corner(), Vec3(8, -4, -6));
  EXPECT_EQ(stl->domain_length(), 12);
  EXPECT_EQ(obj->domain_length(), 6);
  EXPECT_NE(stl->version(), obj->version());
  EXPECT_FALSE(load_mesh(folder / "none.stl"));
  EXPECT_FALSE(load_mesh(folder.path() + "/"));
  write_file(folder / "box.ply", kObj);
  EXPECT_FALSE(load_mesh(folder / "box.ply"));
  write_file(folder / "empty.obj", "# nothing\n");
  EXPECT_EQ(load_mesh(folder / "empty.obj").error().message, (folder / "empty.obj") + ": contains no triangles; at least one was expected");
}

// Memory for 3 million triangles is counted and limited.
TEST(Mesh, ReservesItsMemoryWhileItExists) {
  const TriangleSoup ball = sphere_soup(64);
  const std::string stl = binary_stl(ball), text = text_stl(ball);
  std::string obj;
  for (int i = 0; i < 20000; ++i) obj += "v 0 0 " + std::to_string(i) + "\n";
  set_memory_limit(1000000);
  for (const std::string& message :
       {message_of(parse_stl(stl, "a.stl")), message_of(parse_stl(text, "a.stl")), message_of(parse_obj(obj, "a.obj"))})
    EXPECT_TRUE(has(message, "MB of memory, expected at most 1 MB"));
  EXPECT_TRUE(fails(make_mesh(ball, "ball"), "ball: a mesh of " + std::to_string(ball.triangles.size()) + " triangles needs"));
  set_memory_limit(100000000);
  {
    const auto held = value_of(make_mesh(ball, "ball"));
    EXPECT_EQ(available_memory(), 100000000 - held->bytes());
  }
  EXPECT_EQ(available_memory(), 100000000u);
  set_memory_limit(std::nullopt);
}

}  // namespace catena::mesh::load_mesh_test
