// SPDX-License-Identifier: MIT
/// Notes about a file's values are printed once by every command that loads the file; the range of a resampled field is that of the file.
#include "engine/base/vec.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/engine/io/vtk/files.h"

namespace catena::app::load_notes_test {

std::size_t count_of(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

using LoadNotes = test::ProgramInFolder;

TEST_F(LoadNotes, ArePrintedOnceByEveryCommandThatLoads) {
  // One missing value among radii of 0.5 to 1.5.
  const auto radius = [](const Vec3& p) {
    const double r = std::hypot(p.x, p.y);
    return norm(p - Vec3(0, 1, 0)) < 1e-9 ? -9999.0 : r;
  };
  write("ring.vts", test::vtk_files::vts_ring(21, 31, 6, radius));
  write("s.json", R"({"fields": {"f": {"file": "ring.vts"}}, "isosurfaces": [{"field": "f", "level": 1.2}],
    "chain": [{"name": "skin", "type": "isosurface", "field": "f", "level": 1.2}]})");
  write("p.csv", "t,x,y,z\n0,1,0.5,0.5\n0.001,1,0.5,0.5\n");
  for (const char* line :
       {"info {s.json}", "info {s.json} --json", "export {s.json} --isosurface 0 -o {i.ply}", "export {ring.vts} --field v -o {o.vdb}",
        "replay {s.json} --probe {p.csv} -o {o.csv}", "render {s.json} -o {o.png} --size 64x48",
        "render {ring.vts} -o {o.png} --size 64x48", "view {ring.vts} --screenshot {v.png} --frames 1 --size 64x48",
        "view {s.json} --screenshot {v.png} --frames 1 --size 64x48"}) {
    const auto done = succeed(line);
    EXPECT_EQ(count_of(done.err, "cells were resampled to"), 1u) << line << ": " << done.err;
    EXPECT_EQ(count_of(done.err, "the minimum, -9999, is lost"), 1u) << line << ": " << done.err;
  }
  // The reported range is that of the file's values.
  for (const char* line : {"info {ring.vts}", "info {s.json}"}) test::expect_parts(run(line).out, {"0.5 .. 1.5 (1 value of -9999 beyond)"});
}

TEST_F(LoadNotes, FormatsOf32BitsReportRoundedPositionsFarFromTheOrigin) {
  for (const double far : {0.0, 6e6 + 0.033}) {
    write("s.json", fmt::format(R"({{"fields": {{"f": {{"file": "f.raw", "shape": [8, 8, 8], "spacing": [0.1, 0.1, 0.1],
      "origin": [{0}, {0}, {0}], "type": "float32"}}}}, "isosurfaces": [{{"field": "f", "level": 3.5}}]}})",
                                far));
    std::string bytes;
    for (int n = 0; n < 512; ++n) {
      const auto v = static_cast<float>(n % 8 + 0.1 * (n / 8 % 8));
      bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    write("f.raw", bytes);
    for (const auto& [more, words] :
         {std::pair{"-o {a.stl} --isosurface 0", "two coincident corners"}, {"-o {a.nii} --field f", "32-bit positions displace voxels"}}) {
      const auto done = succeed("export {s.json} " + std::string(more));
      EXPECT_EQ(done.err.find(words) != std::string::npos, far > 0) << more << ": " << done.err;
    }
  }
}

}  // namespace catena::app::load_notes_test
