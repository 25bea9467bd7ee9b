// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/mesh/load_mesh.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/mesh_shapes.h"

namespace catena {
namespace mesh_fuzz_test {

const std::string kObj =
    "# a\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 \\\n 0\nvt 0 0\nvn 0 0 1\ng part\nf 1 2 3 4\nf 1/1 2/1/1 3//1\nf -1 -2 -3\n";
const std::string kBinary = test::binary_stl(test::box_soup()), kText = test::text_stl(test::box_soup());

bool check(const Result<mesh::TriangleSoup>& soup, const std::string& text) {
  std::string message;
  bool good = false;
  if (soup) {
    const auto mesh = mesh::make_mesh(*soup, "file.mesh");
    good = static_cast<bool>(mesh);
    if (!good) message = mesh.error().message;
    if (good) {
      EXPECT_FALSE((*mesh)->triangles().empty());
      for (const Vec3& v : (*mesh)->vertices()) EXPECT_TRUE(is_finite(v)) << text;
      EXPECT_TRUE((*mesh)->domain_length() > 0) << text;
    }
  } else {
    message = soup.error().message;
  }
  if (good) return true;
  EXPECT_TRUE(message.starts_with("file.mesh:")) << message << "\nfor\n" << text;
  EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message << "\nfor\n" << text;
  EXPECT_NE(message.find("expected"), std::string::npos) << message;
  EXPECT_LT(message.size(), 500u) << message;
  return false;
}

bool stl(const std::string& text) { return check(mesh::parse_stl(text, "file.mesh"), text); }
bool obj(const std::string& text) { return check(mesh::parse_obj(text, "file.mesh"), text); }

TEST(MeshFuzz, EveryTruncationAndEveryByteFlip) {
  EXPECT_TRUE(stl(kBinary) && stl(kText) && obj(kObj));
  for (const std::string* whole : {&kBinary, &kText, &kObj})
    for (std::size_t n = 0; n < whole->size(); ++n) {
      const bool part = whole == &kObj ? obj(whole->substr(0, n)) : stl(whole->substr(0, n));
      if (whole == &kBinary) {
        EXPECT_FALSE(part) << n;
      }
      std::string turned = *whole;
      turned[n] = static_cast<char>(turned[n] ^ 0x81);
      whole == &kObj ? obj(turned) : stl(turned);
    }
  // a truncated text is invalid until its last solid has ended
  EXPECT_FALSE(stl(kText.substr(0, kText.find("endsolid"))));
}

TEST(MeshFuzz, Mutations) {
  test::FuzzInputs inputs(20000, 4);
  test::Random& random = inputs.random;
  std::uint64_t read = 0;
  while (inputs.next() && !HasFailure()) {
    read += obj(test::mutate(kObj, random)) ? 1 : 0;
    if (inputs.count() % 4 == 0) {
      read += stl(test::mutate(kText, random)) ? 1 : 0;
      read += stl(test::mutate(kBinary, random)) ? 1 : 0;
    }
  }
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, 3 * inputs.count() / 2);
}

TEST(MeshFuzz, LongTexts) {
  EXPECT_FALSE(obj("f " + std::string(1000000, '1')));
  EXPECT_FALSE(obj(std::string(1000000, '\\')));
  EXPECT_FALSE(obj(std::string(1000000, '\n')));
  EXPECT_FALSE(obj("v 0 0 0\n" + std::string(300000, '/')));
  EXPECT_FALSE(stl("solid " + std::string(1000000, 'x')));
  EXPECT_FALSE(stl("solid a\n" + std::string(1000000, '\n') + "facet"));
  std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 100000; ++i) polygon += " " + std::to_string(1 + i % 3);
  EXPECT_TRUE(obj(polygon));
}

}  // namespace mesh_fuzz_test
}  // namespace catena
