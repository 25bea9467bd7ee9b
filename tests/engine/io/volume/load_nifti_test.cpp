// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/engine/field/field_helpers.h"
#include "tests/support/nifti_file.h"

namespace catena::field::load_nifti_test {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Nifti : catena::test::NiftiFile {
  Nifti(int nx, int ny, int nz, std::int16_t datatype, std::int16_t bits) : NiftiFile({nx, ny, nz}, datatype, bits) {}
  void sform(const float (&rows)[12]) {
    put<std::int16_t>(254, 1);
    std::memcpy(header.data() + 280, rows, sizeof rows);
  }
};

/// Voxels 0, 1, 2, ... or all of one value.
template <class T>
Nifti numbers(std::int16_t datatype, int nx = 4, int ny = 3, int nz = 2, int volumes = 1, std::optional<T> all = {}) {
  Nifti n(nx, ny, nz, datatype, static_cast<std::int16_t>(8 * sizeof(T)));
  for (int i = 0; i < nx * ny * nz * volumes; ++i) n.append(all.value_or(static_cast<T>(i)));
  return n;
}

class LoadNifti : public FilesTest {
 protected:
  AnyField loaded(const Nifti& n) { return read(file("a.nii", n.bytes())); }
  Vec3 at_one(const Nifti& n) { return loaded(n).scalar->mapping().world_from_index(Vec3(1.0)); }
  template <class T>
  void expect_numbers(std::int16_t datatype, const std::string& word) {
    Nifti n = numbers<T>(datatype);
    n.put(112, 0.5f);
    n.put(116, 2.f);
    const AnyField field = loaded(n);
    EXPECT_EQ(field.scalar->name(), "a");
    std::vector<float> values(24);
    field.scalar->grid()->read_block({0, 0, 0}, {4, 3, 2}, values);
    for (int i = 0; i < 24; ++i) EXPECT_EQ(values[i], 2 + 0.5f * static_cast<float>(i)) << word;
    EXPECT_EQ(describe_grids(folder_ / "a.nii").value()[0].type, word);
  }
};

TEST_F(LoadNifti, ReadsEveryNumberTypeWithItsScaling) {
  expect_numbers<std::uint8_t>(2, "uint8");
  expect_numbers<std::int16_t>(4, "int16");
  expect_numbers<std::int32_t>(8, "int32");
  expect_numbers<float>(16, "float32");
  expect_numbers<double>(64, "float64");
  expect_numbers<std::int8_t>(256, "int8");
  expect_numbers<std::uint16_t>(512, "uint16");
  expect_numbers<std::uint32_t>(768, "uint32");
}

/// A file with a qform: half a turn about x, or none; with a voxel size and an offset.
Nifti with_qform(float half_turn) {
  Nifti n = numbers<float>(16);
  n.put<std::int16_t>(252, 1);
  n.put(80, 2.f), n.put(84, 3.f), n.put(88, 4.f);
  n.put(256, half_turn);  // quaternion (0, 1, 0, 0), or (1, 0, 0, 0)
  n.put(268, 5.f), n.put(272, 6.f), n.put(276, 7.f);
  return n;
}

TEST_F(LoadNifti, TheSformOverridesTheQform) {
  Nifti n = numbers<float>(16);
  n.put<std::int16_t>(252, 1);  // The file also has a qform: half a turn about x.
  n.put(76, 1.f);
  n.put(256, 1.f);
  n.sform({-2, 0, 0, 90, 0, 0, 3, -126, 0, 1, 0, -72});
  const Mapping m = loaded(n).scalar->mapping();
  EXPECT_EQ(m.world_from_index(Vec3(0.0)), Vec3(90, -126, -72));
  EXPECT_EQ(m.world_from_index(Vec3(1, 10, 100)), Vec3(88, 174, -62));
}

TEST_F(LoadNifti, ASingularSformIsIgnoredAndDifferencesHaveANote) {
  Nifti n = with_qform(0);
  const auto look = [&](const Nifti& nifti) {
    const AnyField field = loaded(nifti);
    return std::pair(field.scalar->mapping().world_from_index(Vec3(1.0)), field.notes.empty() ? "" : field.notes[0]);
  };
  // A singular or non-finite sform is ignored in favor of the qform.
  for (const float x : {0.f, kNan}) {
    n.sform({x, 0, 0, 1, 0, 3, 0, 1, 0, 0, 4, 1});
    EXPECT_EQ(look(n), std::pair(Vec3(7, 9, 11), std::string("the sform cannot be inverted: the qform is used")));
  }
  n.sform({2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7});
  EXPECT_EQ(look(n), std::pair(Vec3(7, 9, 11), std::string()));
  n.sform({2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 19});
  EXPECT_EQ(look(n).first, Vec3(7, 9, 23));
  EXPECT_TRUE(has(look(n).second, "differ by up to 12 at the corners: the sform is used"));
  // The library replaces a voxel size of 0 by 1.
  n.put<std::int16_t>(254, 0), n.put(84, 0.f);
  const std::string replaced =
      "the voxel size pixdim[2] is 0, expected a finite number other than 0: 1 of the file's unit of length is used instead";
  EXPECT_EQ(look(n), std::pair(Vec3(7, 7, 11), replaced));
  // Without a qform, the file is refused.
  n.put<std::int16_t>(252, 0);
  n.sform({0, 0, 0, 1, 0, 3, 0, 1, 0, 0, 4, 1});
  EXPECT_TRUE(has(error_of(file("a.nii", n.bytes())), "(sform) cannot be inverted"));
}

TEST_F(LoadNifti, WithoutASformTheQformOrTheVoxelSizesApply) {
  Nifti n = with_qform(1);
  EXPECT_NEAR(norm(at_one(n) - Vec3(7, 3, 3)), 0, 1e-6);
  n.put<std::int16_t>(252, 0);
  EXPECT_EQ(at_one(n), Vec3(2, 3, 4));
}

TEST_F(LoadNifti, ReadsTheOtherByteOrder) {
  Nifti n = numbers<float>(16);
  const auto swap = [](std::string& s, std::size_t at, std::size_t size) {
    std::reverse(s.begin() + static_cast<long>(at), s.begin() + static_cast<long>(at + size));
  };
  swap(n.header, 0, 4);
  for (std::size_t at = 40; at < 56; at += 2) swap(n.header, at, 2);
  swap(n.header, 70, 2), swap(n.header, 72, 2);
  for (std::size_t at = 76; at < 108; at += 4) swap(n.header, at, 4);
  swap(n.header, 108, 4);
  for (std::size_t at = 0; at < n.voxels.size(); at += 4) swap(n.voxels, at, 4);
  EXPECT_EQ(loaded(n).scalar->max_value(), 23);
}

/// Three volumes.
Nifti series() {
  Nifti n = numbers<float>(16, 4, 3, 2, 3);
  n.put<std::int16_t>(40, 4);
  n.put<std::int16_t>(48, 3);
  return n;
}

TEST_F(LoadNifti, LoadsTheFirstVolumeOfATimeSeries) {
  EXPECT_EQ(loaded(series()).scalar->max_value(), 23);
  EXPECT_EQ(describe_grids(folder_ / "a.nii").value()[0].type, "float32, one of 3 volumes");
}

TEST_F(LoadNifti, TheFourthAxisIsTimeOnlyIfTheHeaderStatesIt) {
  Nifti n = series();
  n.put(92, 500.f);  // a time step
  const auto at_step = [&](int step) { return read(file("a.nii", n.bytes()), {}, step); };
  const AnyField directions = at_step(1);
  EXPECT_TRUE(directions.times.empty());
  ASSERT_EQ(directions.notes.size(), 1u);
  EXPECT_TRUE(has_note(directions, "volume 1 of 3"));
  EXPECT_EQ(directions.scalar->min_value(), 24);
  n.put<std::uint8_t>(123, 2 | 16);  // millimeters, milliseconds
  const AnyField second = at_step(1);
  EXPECT_EQ(second.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(second.scalar->min_value(), 24);
  EXPECT_EQ(describe_grids(folder_ / "a.nii").value()[0].type, "float32, one of 3 volumes, 0.5 s apart, the first at 0 s");
  EXPECT_EQ(at_step(99).scalar->max_value(), 71);
  n.put(92, 0.f);
  const AnyField still = at_step(99);
  EXPECT_TRUE(still.times.empty());
  EXPECT_TRUE(has(still.notes.at(0), "the time between volumes, pixdim[4], is 0"));
}

TEST_F(LoadNifti, BadFilesAreOneErrorLine) {
  Nifti vectors = numbers<float>(16, 4, 3, 2, 3, 1.f), rgb(2, 2, 2, 128, 24), flat = numbers<float>(16), huge = numbers<float>(16);
  vectors.put<std::int16_t>(40, 5);
  vectors.put<std::int16_t>(50, 2);
  rgb.voxels.assign(24, 'x');
  flat.sform({1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  for (const std::size_t at : {42u, 44u, 46u}) huge.put<std::int16_t>(at, 32767);
  std::vector<std::pair<std::string, std::string>> cases{{std::string(600, 'x'), "NIfTI"},
                                                         {vectors.bytes(), "dimensions"},
                                                         {rgb.bytes(), "not supported"},
                                                         {flat.bytes(), "inverted"},
                                                         {huge.bytes(), "truncated"}};
  for (const float offset : {kNan, std::numeric_limits<float>::infinity(), -4.f, 1e30f}) {
    Nifti n = numbers<float>(16);
    n.put(108, offset);
    cases.emplace_back(n.bytes(), "vox_offset is");
  }
  const std::string path = folder_ / "a.nii";
  EXPECT_EQ(error_of(path).find(path), 0u);
  EXPECT_TRUE(has(error_of(path), "no such file"));
  for (const auto& [bytes, part] : cases) {
    const auto refused = load(request_for(file("a.nii", bytes)));
    EXPECT_TRUE(fails(refused, part));
    EXPECT_EQ(message_of(refused).find(path), 0u) << part;
  }
  const std::string whole = numbers<float>(16).bytes();
  EXPECT_NE(error_of(file("a.nii", whole), "density"), "loaded");
  for (std::size_t length = 0; length < whole.size(); length += 11) EXPECT_NE(error_of(file("a.nii", whole.substr(0, length))), "loaded");
}

TEST_F(LoadNifti, AVolumeOfNansIsRefused) {
  const std::string path = file("a.nii", numbers<float>(16, 4, 3, 2, 1, kNan).bytes());
  EXPECT_EQ(error_of(path), path + ": the volume has no finite value in any active voxel");
  EXPECT_FALSE(describe_grids(path));
}

TEST_F(LoadNifti, ATruncatedCompressedFileIsRefused) {
  const std::string path = "/usr/share/mricron/templates/JHU-WhiteMatter-labels-2mm.nii.gz";
  if (!exists(path)) GTEST_SKIP() << "package mricron-data is not installed";
  read(path);
  const std::string whole = read_file(path);
  for (const double part : {0.0, 0.001, 0.1, 0.5, 0.9, 0.999})
    EXPECT_NE(error_of(file("cut.nii.gz", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))))), "loaded");
  EXPECT_NE(error_of(file("cut.nii.gz", whole.substr(0, whole.size() - 20))), "loaded");
}

}  // namespace catena::field::load_nifti_test
