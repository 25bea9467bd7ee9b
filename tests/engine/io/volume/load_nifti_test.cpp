// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/io/volume/load_field.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/support.h"

namespace catena::field {
namespace load_nifti_test {

using catena::test::TemporaryFolder;

/// A hand-written NIfTI-1 file: 348 bytes of header, 4 bytes of padding, and the voxels.
struct Nifti {
  std::string header = std::string(352, '\0');
  std::string voxels;

  template <class T>
  void put(std::size_t at, T v) {
    std::memcpy(header.data() + at, &v, sizeof v);
  }
  Nifti(int nx, int ny, int nz, std::int16_t datatype, std::int16_t bits) {
    put<std::int32_t>(0, 348);
    put<std::int16_t>(40, 3);
    put<std::int16_t>(42, static_cast<std::int16_t>(nx));
    put<std::int16_t>(44, static_cast<std::int16_t>(ny));
    put<std::int16_t>(46, static_cast<std::int16_t>(nz));
    for (std::size_t d = 4; d < 8; ++d) put<std::int16_t>(40 + 2 * d, 1);
    put(70, datatype);
    put(72, bits);
    for (std::size_t d = 0; d < 8; ++d) put(76 + 4 * d, 1.f);
    put(108, 352.f);
    std::memcpy(header.data() + 344, "n+1", 4);
  }
  void sform(const float (&rows)[12]) {
    put<std::int16_t>(254, 1);
    std::memcpy(header.data() + 280, rows, sizeof rows);
  }
  template <class T>
  void append(T v) {
    voxels.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  std::string save(const std::string& path) const {
    catena::test::write_file(path, header + voxels);
    return path;
  }
};

Result<AnyField> load_path(const std::string& path) {
  LoadRequest r;
  r.path = path;
  return load(r);
}

template <class T>
Nifti numbers(std::int16_t datatype) {
  Nifti n(4, 3, 2, datatype, static_cast<std::int16_t>(8 * sizeof(T)));
  for (int i = 0; i < 24; ++i) n.append(static_cast<T>(i));
  return n;
}

template <class T>
void expect_numbers(const TemporaryFolder& folder, std::int16_t datatype, const std::string& word) {
  Nifti n = numbers<T>(datatype);
  n.put(112, 0.5f);
  n.put(116, 2.f);
  const std::string path = n.save(folder / "a.nii");
  const auto field = load_path(path);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->scalar->name(), "a");
  std::vector<float> values(24);
  field->scalar->grid()->read_block({0, 0, 0}, {4, 3, 2}, values);
  for (int i = 0; i < 24; ++i) EXPECT_EQ(values[i], 2 + 0.5f * static_cast<float>(i)) << word;
  EXPECT_EQ(describe_grids(path).value()[0].type, word);
}

TEST(LoadNifti, ReadsEveryNumberTypeWithItsScaling) {
  TemporaryFolder folder;
  expect_numbers<std::uint8_t>(folder, 2, "uint8");
  expect_numbers<std::int16_t>(folder, 4, "int16");
  expect_numbers<std::int32_t>(folder, 8, "int32");
  expect_numbers<float>(folder, 16, "float32");
  expect_numbers<double>(folder, 64, "float64");
  expect_numbers<std::int8_t>(folder, 256, "int8");
  expect_numbers<std::uint16_t>(folder, 512, "uint16");
  expect_numbers<std::uint32_t>(folder, 768, "uint32");
}

TEST(LoadNifti, TheSformOverridesTheQform) {
  TemporaryFolder folder;
  Nifti n = numbers<float>(16);
  n.put<std::int16_t>(252, 1);  // The file also has a qform: half a turn about x.
  n.put(76, 1.f);
  n.put(256, 1.f);
  n.sform({-2, 0, 0, 90, 0, 0, 3, -126, 0, 1, 0, -72});
  const Mapping m = load_path(n.save(folder / "s.nii")).value().scalar->mapping();
  EXPECT_EQ(m.world_from_index(Vec3(0.0)), Vec3(90, -126, -72));
  EXPECT_EQ(m.world_from_index(Vec3(1, 10, 100)), Vec3(88, 174, -62));
}

TEST(LoadNifti, ASingularSformIsIgnoredAndDifferencesHaveANote) {
  TemporaryFolder folder;
  Nifti n = numbers<float>(16);
  n.put<std::int16_t>(252, 1);
  n.put(80, 2.f), n.put(84, 3.f), n.put(88, 4.f);
  n.put(268, 5.f), n.put(272, 6.f), n.put(276, 7.f);
  const auto at_one = [&](const Nifti& file) {
    const auto field = load_path(file.save(folder / "a.nii"));
    EXPECT_TRUE(field) << field.error().message;
    return field ? std::pair(field->scalar->mapping().world_from_index(Vec3(1.0)), field->notes.empty() ? "" : field->notes[0])
                 : std::pair(Vec3(0.0), field.error().message);
  };
  // A singular or non-finite sform is ignored in favor of the qform.
  for (const float x : {0.f, std::numeric_limits<float>::quiet_NaN()}) {
    n.sform({x, 0, 0, 1, 0, 3, 0, 1, 0, 0, 4, 1});
    EXPECT_EQ(at_one(n), std::pair(Vec3(7, 9, 11), std::string("the sform cannot be inverted: the qform is used")));
  }
  n.sform({2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7});
  EXPECT_EQ(at_one(n), std::pair(Vec3(7, 9, 11), std::string()));
  n.sform({2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 19});
  EXPECT_EQ(at_one(n).first, Vec3(7, 9, 23));
  EXPECT_NE(at_one(n).second.find("differ by up to 12 at the corners: the sform is used"), std::string::npos) << at_one(n).second;
  // The library replaces a voxel size of 0 by 1.
  n.put<std::int16_t>(254, 0), n.put(84, 0.f);
  EXPECT_EQ(
      at_one(n),
      std::pair(
          Vec3(7, 7, 11),
          std::string(
              "the voxel size pixdim[2] is 0, expected a finite number other than 0: 1 of the file's unit of length is used instead")));
  // Without a qform, the file is refused.
  n.put<std::int16_t>(252, 0);
  n.sform({0, 0, 0, 1, 0, 3, 0, 1, 0, 0, 4, 1});
  const auto refused = load_path(n.save(folder / "a.nii"));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("(sform) cannot be inverted"), std::string::npos) << refused.error().message;
}

TEST(LoadNifti, WithoutASformTheQformOrTheVoxelSizesApply) {
  TemporaryFolder folder;
  Nifti n = numbers<float>(16);
  n.put<std::int16_t>(252, 1);
  n.put(80, 2.f), n.put(84, 3.f), n.put(88, 4.f);
  n.put(256, 1.f);  // quaternion (0, 1, 0, 0): half a turn about x
  n.put(268, 5.f), n.put(272, 6.f), n.put(276, 7.f);
  const Mapping q = load_path(n.save(folder / "q.nii")).value().scalar->mapping();
  EXPECT_NEAR(norm(q.world_from_index(Vec3(1.0)) - Vec3(7, 3, 3)), 0, 1e-6);
  n.put<std::int16_t>(252, 0);
  const Mapping p = load_path(n.save(folder / "p.nii")).value().scalar->mapping();
  EXPECT_EQ(p.world_from_index(Vec3(1.0)), Vec3(2, 3, 4));
}

TEST(LoadNifti, ReadsTheOtherByteOrder) {
  TemporaryFolder folder;
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
  const auto field = load_path(n.save(folder / "big.nii"));
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->scalar->max_value(), 23);
}

TEST(LoadNifti, NansAreKeptAndCounted) {
  TemporaryFolder folder;
  Nifti n(2, 2, 2, 16, 32);
  for (int i = 0; i < 8; ++i) n.append(i == 3 ? std::nanf("") : static_cast<float>(i));
  EXPECT_EQ(load_path(n.save(folder / "n.nii")).value().scalar->grid()->stats().nan_count, 1u);
}

TEST(LoadNifti, LoadsTheFirstVolumeOfATimeSeries) {
  TemporaryFolder folder;
  Nifti n(4, 3, 2, 16, 32);
  n.put<std::int16_t>(40, 4);
  n.put<std::int16_t>(48, 3);
  for (int i = 0; i < 72; ++i) n.append(static_cast<float>(i));
  const std::string path = n.save(folder / "t.nii");
  EXPECT_EQ(load_path(path).value().scalar->max_value(), 23);
  EXPECT_EQ(describe_grids(path).value()[0].type, "float32, one of 3 volumes");
}

TEST(LoadNifti, TheFourthAxisIsTimeOnlyIfTheHeaderStatesIt) {
  TemporaryFolder folder;
  Nifti n(4, 3, 2, 16, 32);
  n.put<std::int16_t>(40, 4);
  n.put<std::int16_t>(48, 3);
  n.put(92, 500.f);  // a time step
  for (int i = 0; i < 72; ++i) n.append(static_cast<float>(i));
  LoadRequest request;
  request.path = n.save(folder / "directions.nii");
  request.step = 1;
  const auto directions = load(request);
  ASSERT_TRUE(directions) << directions.error().message;
  EXPECT_TRUE(directions->times.empty());
  ASSERT_EQ(directions->notes.size(), 1u);
  EXPECT_NE(directions->notes[0].find("volume 1 of 3"), std::string::npos) << directions->notes[0];
  EXPECT_EQ(directions->scalar->min_value(), 24);
  n.put<std::uint8_t>(123, 2 | 16);  // millimeters, milliseconds
  request.path = n.save(folder / "time.nii");
  const auto series = load(request);
  ASSERT_TRUE(series) << series.error().message;
  EXPECT_EQ(series->times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(series->scalar->min_value(), 24);
  EXPECT_EQ(describe_grids(request.path).value()[0].type, "float32, one of 3 volumes, 0.5 s apart, the first at 0 s");
  request.step = 99;
  EXPECT_EQ(load(request).value().scalar->max_value(), 71);
  n.put(92, 0.f);
  request.path = n.save(folder / "still.nii");
  const auto still = load(request);
  EXPECT_TRUE(still.value().times.empty());
  EXPECT_NE(still.value().notes.at(0).find("the time between volumes, pixdim[4], is 0"), std::string::npos) << still.value().notes[0];
}

TEST(LoadNifti, BadFilesAreOneErrorLine) {
  TemporaryFolder folder;
  const auto message = [&](const std::string& path) {
    const auto r = load_path(path);
    EXPECT_FALSE(r) << path;
    return r ? std::string() : r.error().message;
  };
  const auto expect = [&](const std::string& path, const std::string& part) {
    const std::string m = message(path);
    EXPECT_NE(m.find(part), std::string::npos) << m;
    EXPECT_EQ(m.find(path), 0u);
  };
  expect(folder / "absent.nii", "no such file");
  catena::test::write_file(folder / "text.nii", std::string(600, 'x'));
  expect(folder / "text.nii", "NIfTI");
  Nifti v(4, 3, 2, 16, 32);
  v.put<std::int16_t>(40, 5);
  v.put<std::int16_t>(50, 3);
  for (int i = 0; i < 72; ++i) v.append(1.f);
  expect(v.save(folder / "v.nii"), "dimensions");
  Nifti rgb(2, 2, 2, 128, 24);
  rgb.voxels.assign(24, 'x');
  expect(rgb.save(folder / "rgb.nii"), "not supported");
  Nifti flat = numbers<float>(16);
  flat.sform({1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  expect(flat.save(folder / "flat.nii"), "inverted");
  Nifti nan(2, 2, 2, 16, 32);
  for (int i = 0; i < 8; ++i) nan.append(std::nanf(""));
  expect(nan.save(folder / "nan.nii"), "finite");
  Nifti huge = numbers<float>(16);
  for (const std::size_t at : {42u, 44u, 46u}) huge.put<std::int16_t>(at, 32767);
  expect(huge.save(folder / "huge.nii"), "truncated");
  LoadRequest named;
  named.path = numbers<float>(16).save(folder / "one.nii");
  named.grid = "density";
  EXPECT_FALSE(load(named));
  const std::string whole = numbers<float>(16).header + numbers<float>(16).voxels;
  for (std::size_t length = 0; length < whole.size(); length += 11) {
    catena::test::write_file(folder / "cut.nii", whole.substr(0, length));
    message(folder / "cut.nii");
  }
}

TEST(LoadNifti, AnInvalidVoxelOffsetIsRefused) {
  TemporaryFolder folder;
  for (const float offset : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -4.f, 1e30f}) {
    Nifti n = numbers<float>(16);
    n.put(108, offset);
    const auto field = load_path(n.save(folder / "a.nii"));
    ASSERT_FALSE(field) << offset;
    EXPECT_NE(field.error().message.find("vox_offset is"), std::string::npos) << field.error().message;
  }
}

TEST(LoadNifti, AVolumeOfNansIsRefused) {
  TemporaryFolder folder;
  Nifti n(4, 3, 2, 16, 32);
  for (int i = 0; i < 24; ++i) n.append(std::numeric_limits<float>::quiet_NaN());
  const std::string path = n.save(folder / "a.nii");
  const auto field = load_path(path);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().message, path + ": the volume has no finite value in any active voxel");
  EXPECT_FALSE(describe_grids(path));
}

TEST(LoadNifti, ATruncatedCompressedFileIsRefused) {
  const std::string path = "/usr/share/mricron/templates/JHU-WhiteMatter-labels-2mm.nii.gz";
  if (!catena::test::exists(path)) GTEST_SKIP() << "package mricron-data is not installed";
  ASSERT_TRUE(load_path(path));
  TemporaryFolder folder;
  const std::string whole = catena::test::read_file(path);
  for (const double part : {0.0, 0.001, 0.1, 0.5, 0.9, 0.999}) {
    catena::test::write_file(folder / "cut.nii.gz", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    EXPECT_FALSE(load_path(folder / "cut.nii.gz")) << part;
  }
  catena::test::write_file(folder / "cut.nii.gz", whole.substr(0, whole.size() - 20));
  EXPECT_FALSE(load_path(folder / "cut.nii.gz"));
}

}  // namespace load_nifti_test
}  // namespace catena::field
