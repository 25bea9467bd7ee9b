// SPDX-License-Identifier: MIT
/// Notes about a file's values are printed once by every command that loads the file; the range of a resampled field is that of the file.
#include <gtest/gtest.h>

#include "engine/base/vec.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::app {
namespace load_notes_test {

std::size_t count_of(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST(LoadNotes, ArePrintedOnceByEveryCommandThatLoads) {
  const test::TemporaryFolder folder;
  // One missing value among radii of 0.5 to 1.5.
  const auto radius = [](const Vec3& p) {
    const double r = std::hypot(p.x, p.y);
    return norm(p - Vec3(0, 1, 0)) < 1e-9 ? -9999.0 : r;
  };
  test::write_file(folder / "ring.vts", test::vtk_files::vts_ring(21, 31, 6, radius));
  test::write_file(folder / "s.json", R"({"fields": {"f": {"file": "ring.vts"}}, "isosurfaces": [{"field": "f", "level": 1.2}],
    "chain": [{"name": "skin", "type": "isosurface", "field": "f", "level": 1.2}]})");
  test::write_file(folder / "p.csv", "t,x,y,z\n0,1,0.5,0.5\n0.001,1,0.5,0.5\n");
  const std::string scene = folder / "s.json";
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info", scene},
           {"info", scene, "--json"},
           {"export", scene, "--isosurface", "0", "-o", folder / "i.ply"},
           {"export", folder / "ring.vts", "--field", "v", "-o", folder / "o.vdb"},
           {"replay", scene, "--probe", folder / "p.csv", "-o", folder / "o.csv"},
           {"render", scene, "-o", folder / "o.png", "--size", "64x48"},
           {"render", folder / "ring.vts", "-o", folder / "o.png", "--size", "64x48"},
           {"view", folder / "ring.vts", "--screenshot", folder / "v.png", "--frames", "1", "--size", "64x48"},
           {"view", scene, "--screenshot", folder / "v.png", "--frames", "1", "--size", "64x48"}}) {
    const auto run = test::run_catena(command);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(count_of(run.err, "cells were resampled to"), 1u) << command[0] << ": " << run.err;
    EXPECT_EQ(count_of(run.err, "the minimum, -9999, is lost"), 1u) << command[0] << ": " << run.err;
  }
  // The reported range is that of the file's values.
  const std::string range = "0.5 .. 1.5 (1 value of -9999 beyond)";
  for (const std::string& of : {folder / "ring.vts", scene}) {
    const auto run = test::run_catena({"info", of});
    EXPECT_NE(run.out.find(range), std::string::npos) << run.out;
  }
}

TEST(LoadNotes, FormatsOf32BitsReportRoundedPositionsFarFromTheOrigin) {
  const test::TemporaryFolder folder;
  for (const double far : {0.0, 6e6 + 0.033}) {
    test::write_file(folder / "s.json", fmt::format(R"({{"fields": {{"f": {{"file": "f.raw", "shape": [8, 8, 8], "spacing": [0.1, 0.1, 0.1],
      "origin": [{0}, {0}, {0}], "type": "float32"}}}}, "isosurfaces": [{{"field": "f", "level": 3.5}}]}})",
                                                    far));
    std::string bytes;
    for (int n = 0; n < 512; ++n) {
      const auto v = static_cast<float>(n % 8 + 0.1 * (n / 8 % 8));
      bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    test::write_file(folder / "f.raw", bytes);
    for (const auto& [output, words] : {std::pair{"a.stl", "two coincident corners"}, {"a.nii", "32-bit positions displace voxels"}}) {
      std::vector<std::string> command{"export", folder / "s.json", "-o", folder / output};
      if (std::string(output) == "a.stl")
        command.insert(command.end(), {"--isosurface", "0"});
      else
        command.insert(command.end(), {"--field", "f"});
      const auto run = test::run_catena(command);
      EXPECT_EQ(run.exit_code, 0) << run.err;
      EXPECT_EQ(run.err.find(words) != std::string::npos, far > 0) << output << ": " << run.err;
    }
  }
}

}  // namespace load_notes_test
}  // namespace catena::app
