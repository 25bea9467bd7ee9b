// SPDX-License-Identifier: MIT
/// Files that Catena writes as .vti and .nrrd, read back by VTK and ITK.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/support.h"

namespace catena::field {
namespace write_test {

using catena::test::TemporaryFolder;
using test::Block;
using test::Random;
using test::random_block;
using test::read;

void expect_same_frame(const Field& a, const Field& b) {
  for (int i = 0; i < 8; ++i)
    EXPECT_LT(norm(a.corner(i) - b.corner(i)), 1e-12 * (1 + norm(a.corner(i)))) << i << ": " << norm(a.corner(i) - b.corner(i));
}

bool is_sheared(const Mapping& m) {
  const Mat3& j = m.world_from_index_linear;
  return std::fabs(dot(j[0], j[1])) + std::fabs(dot(j[1], j[2])) + std::fabs(dot(j[2], j[0])) > 1e-9;
}

const Mapping kTurned = Mapping::from_linear(Mat3(0.4, 0.3, 0, -0.6, 0.8, 0, 0, 0, 2), Vec3(10, -20, 30));

TEST(Write, ScalarsVectorsAndMasksReadBackInEveryFrame) {
  const TemporaryFolder folder;
  const Index3 n{7, 6, 9};
  const Block block = random_block(n, 3);
  const Block many = random_block({21, 6, 9}, 4);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  valid[5 + 7 * (2 + 6 * 8)] = 0;
  std::vector<Mapping> frames = test::mappings();
  frames.push_back(kTurned);
  for (const Mapping& mapping : frames)
    for (const std::string ending : {".vti", ".nrrd"})
      for (const bool masked : {false, true}) {
        SCOPED_TRACE(ending + (masked ? ", masked" : ""));
        AnyField scalar, vector;
        const auto mask = masked ? std::span<const std::uint8_t>(valid) : std::span<const std::uint8_t>{};
        scalar.scalar = make_scalar_grid("density <1>", mapping, n, block.values, mask);
        vector.vector = make_vector_grid("wind", mapping, n, many.values, mask);
        const auto written = write_field(folder / ("s" + ending), scalar, "density <1>", {});
        if (ending == ".vti" && is_sheared(mapping)) {
          ASSERT_FALSE(written);
          EXPECT_NE(written.error().message.find("sheared"), std::string::npos);
          EXPECT_FALSE(catena::test::exists(folder / "sheared.vti"));
          continue;
        }
        ASSERT_TRUE(written) << written.error().message;
        ASSERT_TRUE(write_field(folder / ("v" + ending), vector, "wind", {}));
        const AnyField s = read(folder / ("s" + ending)), v = read(folder / ("v" + ending));
        ASSERT_TRUE(s.scalar && v.vector);
        if (ending == ".vti") {
          EXPECT_EQ(s.scalar->name(), "density <1>");
        }

        expect_same_frame(*scalar.scalar, *s.scalar);
        expect_same_frame(*vector.vector, *v.vector);
        EXPECT_EQ(s.scalar->grid()->has_mask(), masked);
        EXPECT_EQ(v.vector->grid()->has_mask(), masked);
        Cursor a, b, c, d;
        Random random(1);
        for (int i = 0; i < 300; ++i) {
          const Vec3 p = mapping.world_from_index(random.in_box(Vec3(-0.5), Vec3(6.5, 5.5, 8.5)));
          const ScalarSample was = scalar.scalar->sample(p, a), is = s.scalar->sample(p, b);
          EXPECT_EQ(was.inside, is.inside);
          if (was.inside) {
            EXPECT_NEAR(was.value, is.value, 1e-12);
          }

          const VectorSample wind = vector.vector->sample(p, c), read_wind = v.vector->sample(p, d);
          EXPECT_EQ(wind.inside, read_wind.inside);
          if (wind.inside) {
            EXPECT_LT(norm(wind.value - read_wind.value), 1e-12);
          }
        }
      }
}

TEST(Write, PatientAxesReadBackAsPatientAxes) {
  const TemporaryFolder folder;
  AnyField field;
  field.scalar = make_scalar_grid("ct", kTurned, {7, 6, 9}, random_block({7, 6, 9}, 3).values);
  Units units;
  units.is_patient_space = true;
  units.length = "mm";
  ASSERT_TRUE(write_field(folder / "a.nrrd", field, "ct", units));
  EXPECT_TRUE(read_units(folder / "a.nrrd", "").is_patient_space);
  expect_same_frame(*field.scalar, *read(folder / "a.nrrd").scalar);
  ASSERT_TRUE(write_field(folder / "b.nrrd", field, "ct", {}));
  EXPECT_FALSE(read_units(folder / "b.nrrd", "").is_patient_space);
}

}  // namespace write_test
}  // namespace catena::field
