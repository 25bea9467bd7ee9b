// SPDX-License-Identifier: MIT
#include "engine/io/volume/write_field.h"

#include <gtest/gtest.h>
#include <nifti1_io.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/base/memory_limit.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::write_field_test {

using namespace test;

TEST(Write, NiftiKeepsValuesFramesAndHoles) {
  const TemporaryFolder folder;
  const Index3 n{7, 6, 9};
  const auto block = random_block(n, 3);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  valid[100] = 0;
  for (const Mapping& mapping : mappings())
    for (const std::string ending : {".nii", ".nii.gz"}) {
      const AnyField field{make_scalar_grid("density", mapping, n, block.values, valid), nullptr};
      Units units;
      units.length = "mm";
      value_of(write_field(folder / ("a" + ending), field, "density", units));
      const AnyField back = read(folder / ("a" + ending));
      ASSERT_TRUE(back.scalar);
      // The axes are stored in single precision.
      for (int i = 0; i < 8; ++i) EXPECT_LT(norm(field.scalar->corner(i) - back.scalar->corner(i)), 1e-4);
      EXPECT_EQ(read_units(folder / ("a" + ending), "").length, "mm");
      std::vector<float> values(block.values.size());
      back.scalar->grid()->read_block({0, 0, 0}, n, values);
      for (std::size_t i = 0; i < values.size(); ++i) EXPECT_TRUE(i == 100 ? std::isnan(values[i]) : values[i] == block.values[i]) << i;
    }
}

TEST(Write, NiftiVectorsAreThreeVolumesWithAnIntent) {
  const TemporaryFolder folder;
  const AnyField field{nullptr, make_vector_grid("wind", {}, {4, 3, 2}, random_block({12, 3, 2}, 5).values)};
  ASSERT_TRUE(write_field(folder / "v.nii", field, "wind", {}));
  nifti_image* image = nifti_image_read((folder / "v.nii").c_str(), 1);
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->intent_code, NIFTI_INTENT_VECTOR);
  EXPECT_EQ(image->ndim, 5);
  EXPECT_EQ(image->nu, 3);
  std::vector<float> values(4 * 3 * 2 * 3);
  field.vector->grid()->read_block({0, 0, 0}, {4, 3, 2}, values);
  const auto* data = static_cast<const float*>(image->data);
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(data[24 * c + i], values[3 * i + c]);
  nifti_image_free(image);
  for (const char* name : {"w.nii", "w.nii.gz"}) {
    ASSERT_TRUE(write_field(folder / name, field, "wind", {}));
    const AnyField read = value_of(load(request_for(folder / name)));
    ASSERT_TRUE(read.vector);
    std::vector<float> again(values.size());
    read.vector->grid()->read_block({0, 0, 0}, {4, 3, 2}, again);
    EXPECT_EQ(again, values) << name;
  }
}

/// Three distant voxels: the written box between them has the background value and the right position.
TEST(Write, ASparseGridBecomesTheBoxOfItsVoxels) {
  const TemporaryFolder folder;
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(0.25f);
  grid->setName("density");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->getAccessor().setValue({-5, -3, 2}, 1);
  grid->getAccessor().setValue({10, 4, 7}, 2);
  openvdb::io::File(folder / "sparse.vdb").write({grid});
  LoadRequest request = request_for(folder / "sparse.vdb");
  const auto name = value_of(convert_file(request, folder / "box.nii", ""));
  EXPECT_EQ(name, "density");
  const AnyField box = read(folder / "box.nii");
  const Box& index = box.scalar->index_box();
  EXPECT_EQ(index.hi - index.lo, Vec3(15, 7, 5));
  EXPECT_EQ(box.scalar->corner(0), Vec3(-2.5, -1.5, 1));
  std::vector<float> values(16 * 8 * 6);
  box.scalar->grid()->read_block({0, 0, 0}, {16, 8, 6}, values);
  EXPECT_EQ(values.front(), 1);
  EXPECT_EQ(values.back(), 2);
  for (std::size_t i = 1; i + 1 < values.size(); ++i) ASSERT_EQ(values[i], 0.25f);
  // Memory is checked before it is used.
  set_memory_limit(16'000'000);
  grid->getAccessor().setValue({2000, 2000, 2000}, 1);
  openvdb::io::File(folder / "far.vdb").write({grid});
  request.path = folder / "far.vdb";
  const auto far = convert_file(request, folder / "far.nrrd", "");
  set_memory_limit(std::nullopt);
  EXPECT_TRUE(fails(far, "2006 x 2004 x 1999 voxels, needs"));
  EXPECT_FALSE(exists(folder / "far.nrrd"));
}

TEST(Write, HeadersFollowTheFormats) {
  const TemporaryFolder folder;
  const AnyField field{
      nullptr, make_vector_grid("wind", Mapping::from_linear(Mat3(2), Vec3(1, 2, 3)), {2, 1, 1}, std::vector<float>{1, 2, 3, 4, 5, 6})};
  Units patient;
  patient.is_patient_space = true;
  ASSERT_TRUE(write_field(folder / "a.nrrd", field, "wind", patient));
  const std::string nrrd = read_file(folder / "a.nrrd");
  for (const char* line : {"NRRD0005\n", "\ndimension: 4\n", "\nspace: right-anterior-superior\n", "\nsizes: 3 2 1 1\n",
                           "\nspace directions: none (2,0,0) (0,2,0) (0,0,2)\n", "\nkinds: vector domain domain domain\n",
                           "\nspace origin: (1,2,3)\n", "\nendian: little\n", "\nencoding: raw\n"})
    EXPECT_TRUE(has(nrrd, line)) << line;
  EXPECT_EQ(nrrd.size() - nrrd.find("\n\n") - 2, 24u);
  EXPECT_EQ(std::memcmp(nrrd.data() + nrrd.size() - 4, "\0\0\xc0\x40", 4), 0) << "6 as a little-endian float";
  ASSERT_TRUE(write_field(folder / "a.vti", field, "a<b>&\"c\"", {}));
  EXPECT_TRUE(has(read_file(folder / "a.vti"), "Name=\"a&lt;b&gt;&amp;&quot;c&quot;\""));
}

TEST(Write, UnknownExtensionsAreRefusedAndLinksAreFollowed) {
  const TemporaryFolder folder;
  const AnyField field{make_scalar_grid("a", {}, {2, 2, 2}, std::vector<float>(8, 1)), nullptr};
  const auto unknown = write_field(folder / "a.tif", field, "a", {});
  EXPECT_TRUE(fails(unknown, ".vdb, .nii, .nii.gz, .vti, .nrrd or .zarr"));
  std::ofstream(folder / "real.nii") << "old";
  std::filesystem::create_symlink(folder / "real.nii", folder / "link.nii");
  ASSERT_TRUE(write_field(folder / "link.nii", field, "a", {}));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.nii"));
  EXPECT_EQ(read_file(folder / "real.nii").size(), 352u + 32);
  const auto missing = write_field(folder / "nowhere/a.nii", field, "a", {});
  EXPECT_TRUE(fails(missing, "nowhere/a.nii: cannot write"));
}

}  // namespace catena::field::write_field_test
