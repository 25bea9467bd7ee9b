// SPDX-License-Identifier: MIT
/// OpenFOAM cases: opened by folder and by file name, whole and decomposed, ASCII and binary, and with several regions.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/io/volume/data_files.h"
#include "engine/scene/scene.h"
#include "engine/scene/time_steps.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/files.h"

namespace catena::field::foam_test {

namespace fs = std::filesystem;

std::string head(const std::string& kind, const std::string& object, bool binary = false) {
  return fmt::format("FoamFile\n{{\n version 2.0;\n format {};\n arch \"LSB;label=32;scalar=64\";\n class {};\n object {};\n}}\n",
                     binary ? "binary" : "ascii", kind, object);
}

void write(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  test::write_file(path, text);
}

/// Writes a mesh: a row of cubes from x = first.
void write_mesh(const std::string& folder, int first, int cells) {
  std::string points, faces, owner, neighbour;
  int count = 0;
  for (int i = 0; i <= cells; ++i) points += fmt::format("({0} 0 0)\n({0} 1 0)\n({0} 1 1)\n({0} 0 1)\n", first + i);
  const auto face = [&](int a, int b, int c, int d, int cell) {
    faces += fmt::format("4({} {} {} {})\n", a, b, c, d);
    owner += fmt::format("{}\n", cell);
    ++count;
  };
  for (int i = 1; i < cells; ++i) {
    face(4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3, i - 1);
    neighbour += fmt::format("{}\n", i);
  }
  face(0, 3, 2, 1, 0);
  face(4 * cells, 4 * cells + 1, 4 * cells + 2, 4 * cells + 3, cells - 1);
  for (int i = 0; i < cells; ++i)
    for (int a = 0; a < 4; ++a) face(4 * i + a, 4 * i + (a + 1) % 4, 4 * i + 4 + (a + 1) % 4, 4 * i + 4 + a, i);
  const std::string at = folder + "/polyMesh/";
  write(at + "points", head("vectorField", "points") + fmt::format("{}\n(\n{})\n", 4 * (cells + 1), points));
  write(at + "faces", head("faceList", "faces") + fmt::format("{}\n(\n{})\n", count, faces));
  write(at + "owner", head("labelList", "owner") + fmt::format("{}\n(\n{})\n", count, owner));
  write(at + "neighbour", head("labelList", "neighbour") + fmt::format("{}\n(\n{})\n", cells - 1, neighbour));
  write(at + "boundary",
        head("polyBoundaryMesh", "boundary") +
            fmt::format("1\n(\nwalls\n{{\n type wall;\n nFaces {};\n startFace {};\n}}\n)\n", count - cells + 1, cells - 1));
}

/// Writes the values 100 times the time plus the number of the cube.
void write_values(const std::string& folder, const std::string& time, int first, int cells, bool binary) {
  std::string values;
  for (int i = 0; i < cells; ++i) {
    const double value = 100 * std::stod(time) + first + i;
    if (binary)
      values.append(reinterpret_cast<const char*>(&value), sizeof value);
    else
      values += fmt::format("{}\n", value);
  }
  write(folder + "/T", head("volScalarField", "T", binary) + "dimensions [0 0 0 1 0 0 0];\ninternalField nonuniform List<scalar> \n" +
                           fmt::format("{}\n({})\n;\nboundaryField\n{{\n walls {{ type zeroGradient; }}\n}}\n", cells, values));
}

constexpr const char* kTimes[] = {"0.5", "1", "10"};

void write_part(const std::string& folder, const std::string& region, int first, int cells, bool binary) {
  write_mesh(folder + "/constant" + region, first, cells);
  for (const char* time : kTimes) write_values(folder + "/" + time + region, time, first, cells, binary);
}

void write_control(const std::string& folder) {
  write(folder + "/system/controlDict",
        head("dictionary", "controlDict") +
            "application icoFoam;\nstartFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 10;\ndeltaT 0.5;\nwriteControl "
            "timeStep;\nwriteInterval 1;\nwriteFormat ascii;\n");
}

double value_at(const AnyField& field, double x) { return test::value_at(field, {x, 0.5, 0.5}); }

TEST(OpenFoam, ReadsWholeAndDecomposedCases) {
  for (const bool binary : {false, true}) {
    const test::TemporaryFolder folder;
    write_part(folder / "whole", "", 0, 8, binary);
    write_control(folder / "whole");
    write_part(folder / "pieces/processor0", "", 0, 3, binary);
    write_part(folder / "pieces/processor1", "", 3, 5, binary);
    write_control(folder / "pieces");
    test::write_file(folder / "whole/x.foam", "");
    const std::string paths[] = {folder / "whole", folder / "whole/", folder / "whole/x.foam", folder / "pieces"};
    for (int step = 0; step < 3; ++step) {
      const AnyField reference = test::read(paths[2], "T", step);
      EXPECT_EQ(reference.times, (std::vector<double>{0.5, 1, 10}));
      for (const std::string& path : paths) {
        const AnyField field = test::read(path, "T", step);
        for (const double x : {0.5, 2.9, 3.0, 3.1, 7.5}) EXPECT_NEAR(value_at(field, x), value_at(reference, x), 1e-3) << path << " " << x;
        EXPECT_NEAR(value_at(field, 4.5), 100 * std::stod(kTimes[step]) + 4, 0.05) << path;
      }
    }
    for (const std::string& path : paths) EXPECT_EQ(read_times(path).size(), 3u) << path;
    const std::vector<FileId> parts = find_data_files(folder / "whole");
    EXPECT_NE(std::find(parts.begin(), parts.end(), *find_file_id(folder / "whole/10/T")), parts.end());
  }
}

TEST(OpenFoam, TimesWithoutFieldsAreNoSteps) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "case";
  write_part(path, "", 0, 4, false);
  write_control(path);
  fs::create_directories(path + "/0/uniform");
  fs::create_directories(path + "/2");
  write(path + "/2/phi", head("surfaceScalarField", "phi"));
  fs::create_directories(path + "/1e400");
  std::string other = test::read_file(path + "/0.5/T");
  other.replace(other.find("object T"), 8, "object p");
  fs::remove(path + "/0.5/T");
  write(path + "/0.5/p", other);
  EXPECT_EQ(read_times(path), (std::vector<double>{0.5, 1, 10}));
  EXPECT_NEAR(value_at(test::read(path, "T", 2), 1.5), 1001, 0.05);
  test::expect_error(load(test::request_for(path, "T")), {"at step 0 (time 0.5) there is no grid \"T\"", "step 2 (time 10) has this grid"});
  EXPECT_EQ(test::value_of(describe_grids(path)).front().name, "p");
  EXPECT_EQ(test::value_of(describe_grids(path, 1)).front().name, "T");
  // A scene of a requested step.
  const auto scene = test::value_of(scene::scene_for_file(path, "T", {}, 2));
  EXPECT_EQ(scene.time.step, 2);
  EXPECT_EQ(scene::format_time(scene), "10");
}

TEST(OpenFoam, AllRegionsMakeOneField) {
  const test::TemporaryFolder folder;
  write_part(folder / "case", "/fluid", 0, 3, false);
  write_part(folder / "case", "/solid", 3, 5, false);
  write_control(folder / "case");
  const AnyField field = test::read(folder / "case", "T", 1);
  EXPECT_NEAR(value_at(field, 1.5), 101, 0.05);
  EXPECT_NEAR(value_at(field, 6.5), 106, 0.05);
}

TEST(OpenFoam, InvalidCasesAreRefused) {
  const test::TemporaryFolder folder;
  write_control(folder / "no_mesh");
  write_mesh(folder / "no_control/constant", 0, 2);
  write_control(folder / "collated");
  fs::create_directories(folder / "collated/processors4/constant");
  fs::create_directories(folder / "empty");
  for (const auto& [name, words] : {std::pair{"no_mesh", "without a mesh"},
                                    {"no_control", "without system/controlDict"},
                                    {"collated", "reconstructPar"},
                                    {"empty", "contains neither DICOM images nor an OpenFOAM case"}})
    EXPECT_TRUE(test::fails(load(test::request_for(folder / name, "T")), words)) << name;
}

}  // namespace catena::field::foam_test
