// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/mesh/load_mesh.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/mesh_shapes.h"

namespace catena::mesh_fuzz_test {

const std::string kObj =
    "# a\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 \\\n 0\nvt 0 0\nvn 0 0 1\ng part\nf 1 2 3 4\nf 1/1 2/1/1 3//1\nf -1 -2 -3\n";
const std::string kBinary = test::binary_stl(test::box_soup()), kText = test::text_stl(test::box_soup());

bool check(const Result<mesh::TriangleSoup>& soup, const std::string& text) {
  const auto mesh = soup ? mesh::make_mesh(*soup, "file.mesh") : Result<mesh::MeshPtr>(soup.error());
  if (!mesh) {
    test::expect_error_line(mesh.error().message, "file.mesh:", text);
    return false;
  }
  EXPECT_FALSE((*mesh)->triangles().empty());
  for (const Vec3& v : (*mesh)->vertices()) EXPECT_TRUE(is_finite(v)) << text;
  EXPECT_TRUE((*mesh)->domain_length() > 0) << text;
  return true;
}

bool stl(const std::string& text) { return check(mesh::parse_stl(text, "file.mesh"), text); }
bool obj(const std::string& text) { return check(mesh::parse_obj(text, "file.mesh"), text); }

TEST(MeshFuzz, EveryTruncationAndEveryByteFlip) {
  EXPECT_TRUE(stl(kBinary) && stl(kText) && obj(kObj));
  test::truncate_and_flip(kBinary, stl, kBinary.size());
  test::truncate_and_flip(kText, stl);
  test::truncate_and_flip(kObj, obj);
  // a truncated text is invalid until its last solid has ended
  EXPECT_FALSE(stl(kText.substr(0, kText.find("endsolid"))));
}

TEST(MeshFuzz, Mutations) {
  const auto accepted = [](test::Random& random, std::uint64_t n) {
    int read = obj(test::mutate(kObj, random));
    if (n % 4 != 0) return read;
    read += stl(test::mutate(kText, random));
    return read + stl(test::mutate(kBinary, random));
  };
  test::fuzz(20000, 4, accepted, 1.5);
}

TEST(MeshFuzz, LongTexts) {
  for (const std::string& text :
       {"f " + std::string(1000000, '1'), std::string(1000000, '\\'), std::string(1000000, '\n'), "v 0 0 0\n" + std::string(300000, '/')})
    EXPECT_FALSE(obj(text)) << text.substr(0, 20);
  for (const std::string& text : {"solid " + std::string(1000000, 'x'), "solid a\n" + std::string(1000000, '\n') + "facet"})
    EXPECT_FALSE(stl(text)) << text.substr(0, 20);
  std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 100000; ++i) polygon += " " + std::to_string(1 + i % 3);
  EXPECT_TRUE(obj(polygon));
}

}  // namespace catena::mesh_fuzz_test
