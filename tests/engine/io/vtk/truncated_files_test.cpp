// SPDX-License-Identifier: MIT
/// Files that are truncated, as by an interrupted copy or a program that is still writing: they are refused, and never read as
/// uninitialized memory.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <bit>
#include <cstring>

#include "engine/io/mesh/load_mesh.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::truncated_files_test {

constexpr int kEdge = 12, kAll = kEdge * kEdge * kEdge;

int counted(int n) { return n + 1; }

/// `number` of 0, 1, 2, ... as the bytes of floats.
std::string floats(int count, bool big_endian, int (*number)(int) = counted) {
  std::string bytes;
  for (int n = 0; n < count; ++n) {
    auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number(n)));
    if (big_endian) bits = __builtin_bswap32(bits);
    bytes.append(reinterpret_cast<const char*>(&bits), 4);
  }
  return bytes;
}

std::string words(int count) {
  std::string text;
  for (int n = 0; n < count; ++n) text += fmt::format("{} ", n + 1);
  return text;
}

std::string legacy(bool ascii) {
  return fmt::format(
             "# vtk DataFile Version 3.0\nv\n{2}\nDATASET STRUCTURED_POINTS\nDIMENSIONS {0} {0} {0}\nORIGIN 0 0 0\nSPACING 1 1 "
             "1\nPOINT_DATA {1}\nSCALARS v float 1\nLOOKUP_TABLE default\n",
             kEdge, kAll, ascii ? "ASCII" : "BINARY") +
         (ascii ? words(kAll) : floats(kAll, true)) + "\n";
}

std::string appended() {
  std::string file = fmt::format(
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><ImageData WholeExtent=\"0 {0} 0 {0} "
      "0 {0}\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"0 {0} 0 {0} 0 {0}\"><PointData><DataArray type=\"Float32\" Name=\"v\" "
      "format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData><AppendedData encoding=\"raw\">_",
      kEdge - 1);
  const std::uint32_t bytes = 4 * kAll;
  file.append(reinterpret_cast<const char*>(&bytes), 4);
  file += floats(kAll, false);
  return file + "</AppendedData></VTKFile>";
}

std::string meta_image() {
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\nDimSize = {0} {0} "
             "{0}\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n",
             kEdge) +
         floats(kAll, false);
}

std::string netcdf(const test::TemporaryFolder& folder, int format) {
  const std::string path = folder / "made.nc";
  int file = 0, dims[3], v = 0;
  EXPECT_EQ(nc_create(path.c_str(), NC_CLOBBER | format, &file), NC_NOERR);
  for (int d = 0; d < 3; ++d) nc_def_dim(file, d == 0 ? "z" : d == 1 ? "y" : "x", d == 0 ? NC_UNLIMITED : kEdge, &dims[d]);
  nc_def_var(file, "v", NC_FLOAT, 3, dims, &v);
  nc_put_att_text(file, v, "units", 3, "m/s");
  nc_enddef(file);
  std::vector<float> values(kAll);
  std::memcpy(values.data(), floats(kAll, false).data(), 4 * kAll);
  const std::size_t from[3] = {0, 0, 0}, count[3] = {kEdge, kEdge, kEdge};
  nc_put_vara_float(file, v, from, count, values.data());
  EXPECT_EQ(nc_close(file), NC_NOERR);
  return test::read_file(path);
}

TEST(TruncatedFiles, AreRefused) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "its allocator has no filling of one's own";
#endif
  const test::TemporaryFolder folder;
  for (const auto& [name, whole] : {std::pair<std::string, std::string>{"b.vtk", legacy(false)},
                                    {"a.vtk", legacy(true)},
                                    {"x.vti", appended()},
                                    {"i.mha", meta_image()},
                                    {"c1.nc", netcdf(folder, 0)},
                                    {"c2.nc", netcdf(folder, NC_64BIT_OFFSET)},
                                    {"c5.nc", netcdf(folder, NC_64BIT_DATA)}}) {
    test::write_file(folder / name, whole);
    const AnyField all = test::read(folder / name);
    EXPECT_EQ(test::sample_at(all, all.scalar->grid()->mapping().world_from_index(Vec3(kEdge - 1))).value, kAll) << name;
    for (const double part : {0.3, 0.61, 0.9, 0.98}) {
      test::write_file(folder / name, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
      EXPECT_NE(test::error_of(folder / name), "loaded") << name << " " << part;
    }
  }
}

/// Complete files whose last values equal the fill pattern are read twice, and accepted.
TEST(TruncatedFiles, CompleteFilesThatResembleTruncatedOnesAreRead) {
  const test::TemporaryFolder folder;
  for (const unsigned fill : {0x5au, 0xa5u, 0x3cu, 0xc3u}) {
    std::string file = appended();
    file.replace(file.find('_') + 5 + 4 * (kAll - 1), 4, std::string(4, static_cast<char>(fill)));
    test::write_file(folder / "f.vti", file);
    EXPECT_EQ(test::error_of(folder / "f.vti"), "loaded") << fill;
  }
}

int scattered(int n) { return n * 7919 % 1009 + 1; }

TEST(TruncatedFiles, ATruncatedMeshIsRefused) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "its allocator has no filling of one's own";
#endif
  const test::TemporaryFolder folder;
  std::string file = "# vtk DataFile Version 3.0\nm\nBINARY\nDATASET POLYDATA\nPOINTS 900 float\n" + floats(2700, true, scattered) +
                     "\nPOLYGONS 300 1200\n";
  for (int t = 0; t < 300; ++t)
    for (const int n : {3, 3 * t, 3 * t + 1, 3 * t + 2}) {
      const std::uint32_t bits = __builtin_bswap32(static_cast<std::uint32_t>(n));
      file.append(reinterpret_cast<const char*>(&bits), 4);
    }
  test::write_file(folder / "m.vtk", file + "\n");
  ASSERT_TRUE(mesh::load_mesh(folder / "m.vtk"));
  for (const double part : {0.4, 0.6}) {
    test::write_file(folder / "m.vtk", file.substr(0, static_cast<std::size_t>(part * static_cast<double>(file.size()))));
    EXPECT_FALSE(mesh::load_mesh(folder / "m.vtk")) << part;
  }
}

}  // namespace catena::field::truncated_files_test
