// SPDX-License-Identifier: MIT
// Inputs that consist of several files: no part is overwritten, and no part that is a pipe blocks the program.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::app {
namespace multi_file_input_test {

namespace fs = std::filesystem;

const std::string kBytes = [] {
  std::string bytes;
  for (int i = 0; i < 64; ++i) bytes += static_cast<char>(i);
  return bytes;
}();

std::string piece(int from, int to) {
  std::string values;
  for (int i = 0; i < 16 * (to - from + 1); ++i) values += std::to_string(i + 16 * from) + " ";
  const std::string extent = "0 3 0 3 " + std::to_string(from) + " " + std::to_string(to);
  return "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"" + extent +
         "\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"" + extent +
         "\"><PointData Scalars=\"v\"><DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">" + values +
         "</DataArray></PointData></Piece></ImageData></VTKFile>\n";
}

std::string ensight(const std::string& description, const std::string& values) { return description + "\npart\n1\nblock\n" + values; }

/// The named file, and the other files that belong to it.
struct Data {
  std::string name;
  std::vector<std::string> parts;
};

std::vector<Data> make_data(const test::TemporaryFolder& folder) {
  const auto write = [&](const std::string& name, const std::string& bytes) {
    fs::create_directories(fs::path(folder / name).parent_path());
    test::write_file(folder / name, bytes);
  };
  write("a.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: a.bin\n");
  write("a.bin", kBytes);
  write("b.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = deep/b.bin\n");
  write("deep/b.bin", kBytes);
  write("c.pvti",
        "<VTKFile type=\"PImageData\" version=\"0.1\"><PImageData WholeExtent=\"0 3 0 3 0 3\" GhostLevel=\"0\" Origin=\"0 0 0\" "
        "Spacing=\"1 1 1\"><PPointData Scalars=\"v\"><PDataArray type=\"Float32\" Name=\"v\"/></PPointData><Piece Extent=\"0 3 0 3 0 2\" "
        "Source=\"c0.vti\"/><Piece Extent=\"0 3 0 3 2 3\" Source=\"c1.vti\"/></PImageData></VTKFile>\n");
  write("c0.vti", piece(0, 2));
  write("c1.vti", piece(2, 3));
  write("d.vtm",
        "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
        "file=\"d0.vti\"/></vtkMultiBlockDataSet></VTKFile>\n");
  write("d0.vti", piece(0, 3));
  // Two time steps, of which one is read.
  write("e.case",
        "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: e.geo\nVARIABLE\nscalar per node: v e.v**\nTIME\ntime set: 1\nnumber of steps: 2\n"
        "filename start number: 0\nfilename increment: 1\ntime values: 0 1\n");
  std::string coordinates, values;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 8; ++i) coordinates += std::to_string(i >> axis & 1) + ".0\n";
  for (int i = 0; i < 8; ++i) values += std::to_string(i) + ".0\n";
  write("e.geo", "a\nb\nnode id off\nelement id off\npart\n1\np\nblock\n2 2 2\n" + coordinates);
  write("e.v00", ensight("v", values));
  write("e.v01", ensight("v", values));
  return {{"a.nhdr", {"a.bin"}},
          {"b.mhd", {"deep/b.bin"}},
          {"c.pvti", {"c0.vti", "c1.vti"}},
          {"d.vtm", {"d0.vti"}},
          {"e.case", {"e.geo", "e.v00", "e.v01"}}};
}

test::ProgramResult import(const test::TemporaryFolder& folder, const std::string& name, const std::string& stats) {
  return test::run_catena({"render", folder / name, "-o", folder / "x.png", "--size", "16x16", "--stats", folder / stats});
}

TEST(MultiFileInput, AnOutputOnAPartIsRefused) {
  const test::TemporaryFolder folder;
  for (const Data& data : make_data(folder)) {
    test::write_file(folder / "own", "an earlier output");
    const auto fine = import(folder, data.name, "own");
    EXPECT_EQ(fine.exit_code, 0) << data.name << ": " << fine.err;
    fs::remove(folder / "x.png");
    for (const std::string& part : data.parts)
      for (const char* how : {"name", "hard", "link"}) {
        const std::string before = test::read_file(folder / part);
        std::string output = part;
        if (*how == 'h') fs::create_hard_link(folder / part, folder / (output = "hard"));
        if (*how == 'l') fs::create_symlink(folder / part, folder / (output = "link"));
        const auto run = import(folder, data.name, output);
        EXPECT_EQ(run.exit_code, 2) << part << " by " << how;
        EXPECT_NE(run.err.find("is also an input"), std::string::npos) << part << ": " << run.err;
        EXPECT_EQ(test::read_file(folder / part), before) << part << " by " << how;
        EXPECT_FALSE(fs::exists(folder / "x.png")) << part << " by " << how;
        if (output != part) fs::remove(folder / output);
      }
  }
}

TEST(MultiFileInput, APipeIsRefused) {
  const test::TemporaryFolder folder;
  for (const Data& data : make_data(folder)) {
    const std::string& part = data.parts.front();
    fs::remove(folder / part);
    ASSERT_EQ(::mkfifo((folder / part).c_str(), 0600), 0);
    const auto run = test::run_program("/usr/bin/env", {"timeout", "30", test::program_path(), "info", folder / data.name});
    EXPECT_EQ(run.exit_code, 2) << data.name << ": " << run.err;
    EXPECT_NE(run.err.find("is a pipe, a socket or a device"), std::string::npos) << data.name << ": " << run.err;
  }
}

TEST(MultiFileInput, AnOutputPipeWithoutAReaderIsRefused) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto run = test::run_program("/usr/bin/env", {"timeout", "30", test::program_path(), "render", folder / make_data(folder)[0].name,
                                                      "-o", folder / "x.png", "--size", "16x16", "--stats", folder / "pipe"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("nothing reads"), std::string::npos) << run.err;
}

/// Declared sizes in a header must not cost processor time.
TEST(MultiFileInput, AHugeDeclaredSizeFailsInTime) {
  const test::TemporaryFolder folder;
  const std::string many = "2000000000", head = "<?xml version=\"1.0\"?>\n<VTKFile version=\"1.0\" byte_order=\"LittleEndian\" type=\"";
  const std::string extent = "\"0 " + many + " 0 " + many + " 0 " + many + "\"";
  for (const auto& [name, text] : {
           std::pair<const char*, std::string>{
               "a.mha", "ObjectType = Image\nNDims = -1\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"},
           {"a.mhd", "NDims = 3\nDimSize = " + many + " 2 2\nElementType = MET_FLOAT\nElementDataFile = a_%d.raw 1 " + many + " 1\n"},
           {"a.vtu", head + "UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" + many + "\" NumberOfCells=\"" + many +
                         "\"/></UnstructuredGrid></VTKFile>"},
           {"a.vts",
            head + "StructuredGrid\"><StructuredGrid WholeExtent=" + extent + "><Piece Extent=" + extent + "/></StructuredGrid></VTKFile>"},
           {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a*.geo\nTIME\ntime set: 1\nnumber of steps: " + many +
                          "\nfilename start number: 0\nfilename increment: 1\ntime values: 0\n"},
       }) {
    test::write_file(folder / name, text);
    const auto run = test::run_catena({"info", folder / name});
    EXPECT_EQ(run.exit_code, 2) << name << run.err;
    EXPECT_EQ(run.err.find("20 s of processor time"), std::string::npos) << name << run.err;
  }
}

/// A sparse file of 4 GB must not be loaded.
TEST(MultiFileInput, SparseFilesAreNotRead) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.obj", "a.trk", "a.tck"}) {
    test::write_file(folder / name, "");
    fs::resize_file(folder / name, std::uintmax_t{4000} << 20);
    const auto run = test::run_catena({"info", folder / name});
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_NE(run.err.find("on the disk"), std::string::npos) << name << ": " << run.err;
  }
}

/// A message must not list thousands of names.
TEST(MultiFileInput, ErrorMessagesAreBounded) {
  const test::TemporaryFolder folder;
  std::string fields;
  for (int i = 0; i < 2000; ++i) fields += std::string(i == 0 ? "" : ", ") + "\"f" + std::to_string(i) + "\": {\"analytic\": \"sphere\"}";
  test::write_file(folder / "s.json", "{\"fields\": {" + fields + "}, \"volumes\": [{\"field\": \"none\"}]}");
  const auto run = test::run_catena({"info", folder / "s.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("and 1990 more"), std::string::npos) << run.err;
  EXPECT_LT(run.err.size(), 2001u);
}

}  // namespace multi_file_input_test
}  // namespace catena::app
