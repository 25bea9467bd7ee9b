// SPDX-License-Identifier: MIT
/// Files that Catena writes as .vti and .nrrd, read back by VTK and ITK.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::write_test {

using namespace test;

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
  std::vector<Mapping> frames = mappings();
  frames.push_back(kTurned);
  for (const Mapping& mapping : frames)
    for (const std::string ending : {".vti", ".nrrd"})
      for (const bool masked : {false, true}) {
        SCOPED_TRACE(ending + (masked ? ", masked" : ""));
        AnyField scalar, vector;
        const auto mask = masked ? std::span<const std::uint8_t>(valid) : std::span<const std::uint8_t>{};
        scalar.scalar = make_scalar_grid("density <1>", mapping, n, block.values, mask);
        vector.vector = make_vector_grid("wind", mapping, n, many.values, mask);
        const bool is_refused = ending == ".vti" && is_sheared(mapping);
        const auto written = write_field(folder / ((is_refused ? "sheared" : "s") + ending), scalar, "density <1>", {});
        if (is_refused) {
          EXPECT_TRUE(fails(written, "sheared"));
          EXPECT_FALSE(exists(folder / "sheared.vti"));
          continue;
        }
        ASSERT_TRUE(written) << written.error().message;
        ASSERT_TRUE(write_field(folder / ("v" + ending), vector, "wind", {}));
        const AnyField s = read(folder / ("s" + ending)), v = read(folder / ("v" + ending));
        ASSERT_TRUE(s.scalar && v.vector);
        EXPECT_TRUE(ending != ".vti" || s.scalar->name() == "density <1>") << s.scalar->name();
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
          EXPECT_TRUE(!was.inside || std::fabs(was.value - is.value) <= 1e-12) << was.value << " " << is.value;
          const VectorSample wind = vector.vector->sample(p, c), read_wind = v.vector->sample(p, d);
          EXPECT_EQ(wind.inside, read_wind.inside);
          EXPECT_TRUE(!wind.inside || norm(wind.value - read_wind.value) < 1e-12);
        }
      }
}

TEST(Write, PatientAxesReadBackAsPatientAxes) {
  const TemporaryFolder folder;
  const AnyField field{make_scalar_grid("ct", kTurned, {7, 6, 9}, random_block({7, 6, 9}, 3).values), nullptr};
  Units units;
  units.is_patient_space = true;
  units.length = "mm";
  ASSERT_TRUE(write_field(folder / "a.nrrd", field, "ct", units));
  EXPECT_TRUE(read_units(folder / "a.nrrd", "").is_patient_space);
  expect_same_frame(*field.scalar, *read(folder / "a.nrrd").scalar);
  ASSERT_TRUE(write_field(folder / "b.nrrd", field, "ct", {}));
  EXPECT_FALSE(read_units(folder / "b.nrrd", "").is_patient_space);
}

}  // namespace catena::field::write_test
