// SPDX-License-Identifier: MIT
#include "engine/io/curves/load_curves.h"

#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "engine/io/formats.h"
#include "tests/support/curve_files.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::curves::load_curves_test {

using namespace catena::test;

const Polylines kLines{{{1, 2, 3}, {1.5, 2.25, -3}, {8, 0, 0}}, {{-1, 0, 0.125}, {-1, 4, 0.125}}};

void expect_lines(const Result<CurveSet>& set, const Polylines& lines, double error = 0) {
  ASSERT_TRUE(set) << message_of(set);
  ASSERT_EQ(set->line_count(), lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    ASSERT_EQ(set->line_offsets[k + 1] - set->line_offsets[k], lines[k].size());
    for (std::size_t i = 0; i < lines[k].size(); ++i) {
      const std::uint32_t point = set->line_offsets[k] + static_cast<std::uint32_t>(i);
      EXPECT_LE(max_abs(Vec3(set->points[point]) - lines[k][i]), error) << k << " " << i;
      EXPECT_EQ(set->line_of(point), k);
    }
  }
}

/// The lines with all points moved.
template <class F>
Polylines moved(const F& move) {
  Polylines lines = kLines;
  for (auto& line : lines)
    for (Vec3& p : line) p = move(p);
  return lines;
}

TEST(Tck, ReadsEveryDatatype) {
  for (const char* type : {"Float32LE", "Float32BE", "Float64LE", "Float64BE"}) {
    const auto set = parse_tck(tck_bytes(kLines, type), "a.tck");
    expect_lines(set, kLines);
    EXPECT_TRUE(set->is_patient_space);
    EXPECT_EQ(set->unit, "mm");
    EXPECT_EQ(set->min_corner, Vec3(-1, 0, -3));
    EXPECT_EQ(set->max_corner, Vec3(8, 4, 3));
    EXPECT_EQ(set->note, "");
  }
}

TEST(Tck, LeavesOutLinesWithoutLength) {
  auto lines = kLines;
  lines.push_back({{5, 5, 5}});
  lines.push_back({{5, 5, 5}, {5, 5, 5}});
  lines[0].insert(lines[0].begin() + 1, lines[0][0]);
  const auto set = parse_tck(tck_bytes(lines, "Float32LE"), "a.tck");
  expect_lines(set, kLines);
  EXPECT_EQ(set->note, "2 lines without a length left out");
  EXPECT_EQ(message_of(parse_tck(tck_bytes({{{5, 5, 5}}}, "Float32LE"), "a.tck")),
            "a.tck: contains no line with two different points (1 without a length); one or more were expected");
}

TEST(Tck, ErrorsNameThePositionAndTheExpectation) {
  const std::string good = tck_bytes(kLines, "Float32LE");
  EXPECT_EQ(message_of(parse_tck(good.substr(0, good.size() - 1), "a.tck")),
            "a.tck: the file ends before the end of the lines; a triple of infinities was expected at the end");
  EXPECT_EQ(message_of(parse_tck("mrtrix image\nEND\n", "a.tck")),
            "a.tck: line 1: the first line is \"mrtrix image\"; \"mrtrix tracks\" was expected");
  EXPECT_EQ(message_of(parse_tck(tck_bytes(kLines, "Int16LE"), "a.tck")),
            "a.tck: line 3: the datatype is \"Int16LE\"; one of Float32LE, Float32BE, Float64LE, Float64BE was expected");
  EXPECT_EQ(message_of(parse_tck("mrtrix tracks\ndatatype: Float32LE\nfile: . 99999\nEND\n", "a.tck")),
            "a.tck: line 4: the data begin at byte 99999; an offset from 52 to 52 was expected");
  EXPECT_EQ(message_of(parse_tck("mrtrix tracks\ndatatype: Float32LE\nfile: other.dat 0\nEND\n", "a.tck")),
            "a.tck: line 3: the data are in \"other.dat 0\"; \". OFFSET\", an offset in this file, was expected");
  EXPECT_TRUE(fails(parse_tck("mrtrix tracks\ndatatype: Float32LE\n", "a.tck"), "a line END was expected"));
  auto far = kLines;
  far[1][1].y = 1e16;
  EXPECT_TRUE(fails(parse_tck(tck_bytes(far, "Float64LE"), "a.tck"), "of line 1 is not finite or too far away"));
}

// Conversion from voxmm to world by hand: 10 x 20 x 30 voxels of 2 x 3 x 4 mm.
TEST(Trk, ConvertsCoordinatesByTheHeader) {
  TrkFile file;
  file.lines = kLines;
  file.voxel = {2, 3, 4};
  file.dim = {10, 20, 30};
  file.order = "RAS";
  file.vox_to_ras = {{{2, 0, 0, -5}, {0, 3, 0, 7}, {0, 0, 4, 100}, {0, 0, 0, 1}}};
  // The matrix has voxel size and shift: world = voxmm - half a voxel + shift.
  for (const bool big : {false, true}) {
    file.big_endian = big;
    expect_lines(parse_trk(file.bytes(), "a.trk"), moved([](const Vec3& p) { return p + Vec3(-6, 5.5, 98); }), 1e-5);
  }
  // LPS: the first two axes are counted from the other end of 10 and 20 voxels: 2 * 9 - (x - 1), 3 * 19 - (y - 1.5).
  for (const char* order : {"LPS", ""}) {  // LPS is the default
    file.order = order;
    expect_lines(parse_trk(file.bytes(), "a.trk"),
                 moved([](const Vec3& p) { return Vec3(18 - (p.x - 1) - 5, 57 - (p.y - 1.5) + 7, p.z - 2 + 100); }), 1e-5);
  }
  // Exchanged axes: the file's first voxel axis is the matrix's second axis.
  file.order = "ARS";
  const auto swapped = [](const Vec3& p) {
    const Vec3 voxel = Vec3(p.x / 2, p.y / 3, p.z / 4) - Vec3(0.5);
    return Vec3(2 * voxel.y - 5, 3 * voxel.x + 7, 4 * voxel.z + 100);
  };
  expect_lines(parse_trk(file.bytes(), "a.trk"), moved(swapped), 1e-5);
}

// The expected values are those of NiBabel 5.0.0 for the same bytes: an oblique matrix whose axes run P, L, S, in a file of order RAS.
// (Where axes are exchanged and differ in length, NiBabel counts from the other axis' end.)
TEST(Trk, ReadsAnObliqueMatrixAsNibabelDoes) {
  TrkFile file;
  file.lines = {{{1, 2, 3}, {10, 20, 30}}};
  file.voxel = {2, 2, 3};
  file.dim = {12, 12, 13};
  file.order = "RAS";
  file.vox_to_ras = {{{0.1f, -1.9f, 0.2f, 30}, {-1.9f, -0.1f, 0.3f, 40}, {0.2f, 0.3f, 2.9f, -50}, {0, 0, 0, 1}}};
  const auto set = parse_trk(file.bytes(), "a.trk");
  expect_lines(set, {{{10.25000, 19.10000, -43.15000}, {19.70000, 39.35000, -20.20000}}}, 1e-4);
}

TEST(Trk, VersionOneHasNoMatrix) {
  TrkFile file;
  file.lines = kLines;
  file.version = 1;
  file.order = "RAS";
  const auto set = parse_trk(file.bytes(), "a.trk");
  expect_lines(set, moved([](const Vec3& p) { return p - Vec3(0.5); }), 1e-6);
  EXPECT_FALSE(set->is_patient_space);
}

TEST(Trk, ScalarsAreValuesAndPropertiesAreSkipped) {
  TrkFile file;
  file.lines = kLines;
  file.order = "RAS";
  file.scalars = {"FA", ""};
  file.properties = 2;
  for (const int count : {0, 2}) {  // 0: up to the end of the file
    file.count = count;
    const auto set = value_of(parse_trk(file.bytes(), "a.trk"));
    ASSERT_EQ(set.values.size(), 2u);
    ASSERT_NE(set.find_values("FA"), nullptr);
    EXPECT_EQ(set.find_values("FA")->values, (std::vector<float>{0, 1, 2, 100, 101}));
    EXPECT_EQ(set.find_values("scalar_1")->values, (std::vector<float>{0.5, 1.5, 2.5, 100.5, 101.5}));
    EXPECT_EQ(set.note, "the 2 properties of each line skipped");
  }
}

TEST(Trk, ErrorsNameThePositionAndTheExpectation) {
  TrkFile file;
  file.lines = kLines;
  const std::string good = file.bytes();
  EXPECT_EQ(message_of(parse_trk(good.substr(0, 999), "a.trk")),
            "a.trk: is not a TrackVis file; a header of 1000 bytes that begins with \"TRACK\" was expected");
  EXPECT_TRUE(fails(parse_trk(good.substr(0, good.size() - 1), "a.trk"), "a.trk: line 1, byte 1040: the line has"));
  file.count = 3;
  EXPECT_EQ(message_of(parse_trk(file.bytes(), "a.trk")),
            "a.trk: line 2, byte 1068: the file ends before this line; a number of points was expected");
  file.count = 2;
  file.order = "RLS";
  EXPECT_EQ(message_of(parse_trk(file.bytes(), "a.trk")), "a.trk: the voxel order is \"RLS\"; three letters such as \"LPS\" were expected");
  file.order = "RAS";
  file.voxel.y = 0;
  EXPECT_EQ(message_of(parse_trk(file.bytes(), "a.trk")), "a.trk: the voxel size is (1, 0, 1); three numbers > 0 were expected");
  file.voxel.y = 1;
  file.version = 7;
  EXPECT_EQ(message_of(parse_trk(file.bytes(), "a.trk")), "a.trk: has version 7; 1, 2 or 3 was expected");
  file.version = 2;
  file.vox_to_ras[0] = {0, 0, 0, 0};
  EXPECT_TRUE(fails(parse_trk(file.bytes(), "a.trk"), "cannot be inverted"));
}

TEST(CurveFiles, MemoryIsCheckedBeforeReading) {
  const std::vector<Vec3> line(200000, Vec3(1, 2, 3));
  set_memory_limit(std::uint64_t{1} << 20);
  const auto set = parse_tck(tck_bytes({line}, "Float32LE"), "a.tck");
  set_memory_limit(std::nullopt);
  EXPECT_TRUE(fails(set, "a.tck: 200002 points needs"));
}

TEST(CurveFiles, TheFormatFollowsFromTheExtension) {
  TemporaryFolder folder;
  write_file(folder / "a.TCK", tck_bytes(kLines, "Float32LE"));
  const auto set = value_of(load_curves(folder / "a.TCK"));
  EXPECT_EQ(set->line_count(), 2u);
  EXPECT_NE(io::find_reader("x.trk", io::DataKind::curves), nullptr);
  EXPECT_EQ(io::find_reader("x.obj", io::DataKind::curves), nullptr);
  EXPECT_TRUE(
      fails(load_curves(folder / "none.trk"), "a file of curves (.tck, .trk, .vtu, .vtp, .pvtp, .vtk, .pvd or .series) was expected"));
}

}  // namespace catena::curves::load_curves_test
