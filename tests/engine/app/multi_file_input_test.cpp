// SPDX-License-Identifier: MIT
// Inputs that consist of several files: no part is overwritten, and no part that is a pipe blocks the program.
#include <sys/stat.h>

#include "tests/engine/app/program_in_folder.h"

namespace catena::app::multi_file_input_test {

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
  return R"(<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian"><ImageData WholeExtent=")" + extent +
         R"(" Origin="0 0 0" Spacing="1 1 1"><Piece Extent=")" + extent +
         R"("><PointData Scalars="v"><DataArray type="Float32" Name="v" format="ascii">)" + values +
         "</DataArray></PointData></Piece></ImageData></VTKFile>\n";
}

/// The named file, and the other files that belong to it.
struct Data {
  std::string name;
  std::vector<std::string> parts;
};

class MultiFileInput : public test::ProgramInFolder {
 protected:
  std::vector<Data> make_data() const;
  test::ProgramResult draw(const std::string& name, const std::string& stats) {
    return run("render {" + name + "} -o {x.png} --size 16x16 --stats {" + stats + "}");
  }
};

std::vector<Data> MultiFileInput::make_data() const {
  fs::create_directory(folder_ / "deep");
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
  for (const char* name : {"e.v00", "e.v01"}) write(name, "v\npart\n1\nblock\n" + values);
  return {{"a.nhdr", {"a.bin"}},
          {"b.mhd", {"deep/b.bin"}},
          {"c.pvti", {"c0.vti", "c1.vti"}},
          {"d.vtm", {"d0.vti"}},
          {"e.case", {"e.geo", "e.v00", "e.v01"}}};
}

TEST_F(MultiFileInput, AnOutputOnAPartIsRefused) {
  for (const Data& data : make_data()) {
    write("own", "an earlier output");
    EXPECT_EQ(draw(data.name, "own").exit_code, 0) << data.name;
    fs::remove(folder_ / "x.png");
    for (const std::string& part : data.parts)
      for (const char* how : {"name", "hard", "link"}) {
        SCOPED_TRACE(part + " by " + how);
        const std::string before = read(part);
        std::string output = part;
        if (*how == 'h') fs::create_hard_link(folder_ / part, folder_ / (output = "hard"));
        if (*how == 'l') fs::create_symlink(folder_ / part, folder_ / (output = "link"));
        const auto done = draw(data.name, output);
        EXPECT_EQ(done.exit_code, 2);
        test::expect_parts(done.err, {"is also an input"});
        EXPECT_EQ(read(part), before);
        EXPECT_FALSE(exists("x.png"));
        if (output != part) fs::remove(folder_ / output);
      }
  }
}

TEST_F(MultiFileInput, APipeIsRefused) {
  for (const Data& data : make_data()) {
    const std::string& part = data.parts.front();
    fs::remove(folder_ / part);
    ASSERT_EQ(::mkfifo((folder_ / part).c_str(), 0600), 0);
    const auto run = test::run_program("/usr/bin/env", {"timeout", "30", test::program_path(), "info", folder_ / data.name});
    EXPECT_EQ(run.exit_code, 2) << data.name << ": " << run.err;
    test::expect_parts(run.err, {"is a pipe, a socket or a device"});
  }
}

TEST_F(MultiFileInput, AnOutputPipeWithoutAReaderIsRefused) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  make_data();
  std::vector<std::string> words = test::words_of(folder_, "render {a.nhdr} -o {x.png} --size 16x16 --stats {pipe}");
  words.insert(words.begin(), {"timeout", "30", test::program_path()});
  const auto run = test::run_program("/usr/bin/env", words);
  EXPECT_EQ(run.exit_code, 2) << run.err;
  test::expect_parts(run.err, {"nothing reads"});
}

/// Declared sizes in a header must not cost processor time.
TEST_F(MultiFileInput, AHugeDeclaredSizeFailsInTime) {
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
    write(name, text);
    const auto done = run("info {" + std::string(name) + "}");
    EXPECT_EQ(done.exit_code, 2) << name << done.err;
    EXPECT_EQ(done.err.find("20 s of processor time"), std::string::npos) << name << done.err;
  }
}

/// A sparse file of 4 GB must not be loaded.
TEST_F(MultiFileInput, SparseFilesAreNotRead) {
  for (const std::string name : {"a.stl", "a.obj", "a.trk", "a.tck"}) {
    write(name, "");
    fs::resize_file(folder_ / name, std::uintmax_t{4000} << 20);
    expect_refused("info {" + name + "}", {"on the disk"});
  }
}

/// A message must not list thousands of names.
TEST_F(MultiFileInput, ErrorMessagesAreBounded) {
  std::string fields;
  for (int i = 0; i < 2000; ++i) fields += std::string(i == 0 ? "" : ", ") + "\"f" + std::to_string(i) + "\": {\"analytic\": \"sphere\"}";
  write("s.json", "{\"fields\": {" + fields + "}, \"volumes\": [{\"field\": \"none\"}]}");
  EXPECT_LT(expect_refused("info {s.json}", {"and 1990 more"}).err.size(), 2001u);
}

}  // namespace catena::app::multi_file_input_test
