// SPDX-License-Identifier: MIT
/// Transforms of fields: a transformed field has at M p the value that the file has at p; files of ITK and FSL against matrices by hand.
#include "engine/io/volume/transform.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::transform_test {

AffineMap some_map() { return {Mat3(Vec3(0.8, 0.5, -0.1), Vec3(-0.6, 0.9, 0.2), Vec3(0.1, -0.3, 1.3)), {7, -20, 3}}; }

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

/// Largest difference of two maps on the corners of a cube of edge 100.
double difference(const AffineMap& a, const AffineMap& b) {
  double most = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p(i & 1 ? 100 : 0, i & 2 ? 100 : 0, i & 4 ? 100 : 0);
    most = std::max(most, norm(a(p) - b(p)));
  }
  return most;
}

TEST(Transform, MovesValuesGradientsAndVectors) {
  const test::TemporaryFolder folder;
  const test::Block block = test::random_block({9, 12, 10}, 4), vectors = test::random_block({9, 12, 30}, 5);
  for (const Mapping& mapping : test::mappings()) {
    const AnyField scalar{make_scalar_grid("g", mapping, block.size, block.values), nullptr};
    const AnyField vector{nullptr, make_vector_grid("v", mapping, block.size, vectors.values)};
    ASSERT_TRUE(write_vdb(folder / "f.vdb", {{scalar, "g"}, {vector, "v"}}));
    const AffineMap map = some_map();
    LoadRequest request = test::request_for(folder / "f.vdb");
    request.transform = FieldTransform{map, {}};
    request.grid = "g";
    const AnyField moved = test::value_of(load(request));
    request.grid = "v";
    const AnyField moved_vector = test::value_of(load(request));
    test::Random random(3);
    Cursor a, b;
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = mapping.world_from_index(random.in_box(Vec3(0.0), Vec3(8, 11, 9)));
      const ScalarSample here = scalar.scalar->sample(p, a), there = moved.scalar->sample(map(p), b);
      ASSERT_TRUE(there.inside);
      EXPECT_NEAR(there.value, here.value, 1e-9);
      EXPECT_LT(norm(there.gradient * map.linear - here.gradient), 1e-8 * (1 + norm(here.gradient)));
    }
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = mapping.world_from_index(random.in_box(Vec3(0.0), Vec3(8, 11, 9)));
      const VectorSample here = vector.vector->sample(p, a), there = moved_vector.vector->sample(map(p), b);
      ASSERT_TRUE(there.inside);
      EXPECT_LT(norm(there.value - map.linear * here.value), 1e-6 * (1 + norm(here.value)));
    }
    // the crop box is in the scene's world, also for a .vdb, which its reader crops otherwise
    request.grid = "g";
    const Vec3 middle = map(mapping.world_from_index({4, 6, 5})), reach(0.4 * moved.get()->max_voxel_edge());
    request.crop = Box{middle - reach, middle + reach};
    const AnyField part = test::value_of(load(request));
    const ScalarSample near = part.scalar->sample(middle, a), whole = moved.scalar->sample(middle, b);
    EXPECT_TRUE(near.inside);
    EXPECT_NEAR(near.value, whole.value, 1e-9);
    EXPECT_LT(part.scalar->bytes(), 10 * moved.scalar->bytes());
  }
}

TEST(Transform, ReadsTheTypesOfItk) {
  const test::TemporaryFolder folder;
  const auto file = [&](const std::string& type, const std::string& parameters, const std::string& fixed) {
    write(folder / "t.tfm", "#Insight Transform File V1.0\n#Transform 0\nTransform: " + type + "_double_3_3\nParameters: " + parameters +
                                "\nFixedParameters: " + fixed + "\n");
    return test::value_of(read_itk_transform(folder / "t.tfm"));
  };
  // ITK: q = M (p - c) + c + t in LPS, from the fixed to the moving image; the field moves the other way, in RAS
  const auto expected = [](const Mat3& m, const Vec3& t, const Vec3& c) {
    const Mat3 back = glm::inverse(m), flip(Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1));
    return AffineMap{flip * back * flip, flip * (c - back * (c + t))};
  };
  const Mat3 matrix(Vec3(1.1, 0.2, 0), Vec3(-0.3, 0.9, 0.1), Vec3(0.05, 0, 1.2));  // columns
  const std::string rows = "1.1 -0.3 0.05 0.2 0.9 0 0 0.1 1.2 ";
  EXPECT_LT(difference(file("AffineTransform", rows + "5 -6 7", "10 20 30"), expected(matrix, {5, -6, 7}, {10, 20, 30})), 1e-11);
  EXPECT_LT(difference(file("MatrixOffsetTransformBase", rows + "5 -6 7", "10 20 30"), expected(matrix, {5, -6, 7}, {10, 20, 30})), 1e-11);
  EXPECT_LT(difference(file("TranslationTransform", "1 2 3", ""), AffineMap{Mat3(1.0), {1, 2, -3}}), 1e-12);
  // a quarter turn about z takes x to y
  const Mat3 quarter(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  EXPECT_LT(difference(file("Euler3DTransform", "0 0 1.5707963267948966 1 2 3", "4 5 6"), expected(quarter, {1, 2, 3}, {4, 5, 6})), 1e-11);
  const double half = std::sqrt(0.5);
  EXPECT_LT(difference(file("VersorRigid3DTransform", "0 0 " + std::to_string(half) + " 1 2 3", "4 5 6"),
                       expected(quarter, {1, 2, 3}, {4, 5, 6})),
            1e-3);
  EXPECT_LT(difference(file("Similarity3DTransform", "0 0 0 1 2 3 2", "4 5 6"), expected(Mat3(2.0), {1, 2, 3}, {4, 5, 6})), 1e-11);
  for (const char* text :
       {"", "hello", "#Insight Transform File V1.0\nTransform: BSplineTransform_double_3_3\nParameters: 1\n",
        "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: 1 2\nFixedParameters: 0 0 0\n",
        "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: 0 0 0 0 0 0 0 0 0 1 2 3\n",
        "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: nan 0 0 0 1 0 0 0 1 1 2 3\n"}) {
    write(folder / "bad.tfm", text);
    const auto read = read_itk_transform(folder / "bad.tfm");
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message.find("was expected"), std::string::npos) << read.error().message;
  }
}

TEST(Transform, FlirtMapsMillimetersOfVoxelAxes) {
  const test::TemporaryFolder folder;
  // moving: left-handed voxel axes, as in most files of FSL; reference: right-handed, whose x is reversed
  const Mapping moving = Mapping::from_linear(Mat3(Vec3(-2, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)), {90, -126, -72});
  const Mapping reference = Mapping::from_linear(Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)), {-20, -30, -40});
  const test::Block block = test::random_block({41, 50, 60}, 4);
  ASSERT_TRUE(write_vdb(folder / "ref.vdb", {{AnyField{make_scalar_grid("g", reference, block.size, block.values), nullptr}, "g"}}));
  write(folder / "m.mat", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  const AffineMap matrix = test::value_of(read_matrix_file(folder / "m.mat"));
  const AffineMap map = test::value_of(world_map_of_flirt(matrix, moving, {30, 30, 30}, folder / "ref.vdb"));
  // voxel (3, 4, 5) of the moving image is at (6, 8, 15) mm, goes to (11, 14, 22), which is voxel (40 - 11, 14, 22) of the reference
  EXPECT_LT(norm(map(moving.world_from_index({3, 4, 5})) - reference.world_from_index({29, 14, 22})), 1e-12);
  for (const char* text : {"1 0 0 5\n0 1 0 6\n0 0 1 7\n", "1 0 0 5 0 1 0 6 0 0 1 7 0 0 1 1", "1 0 0 x 0 1 0 6 0 0 1 7 0 0 0 1"}) {
    write(folder / "m.mat", text);
    EXPECT_FALSE(read_matrix_file(folder / "m.mat")) << text;
  }
}

}  // namespace catena::field::transform_test
