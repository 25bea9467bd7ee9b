// SPDX-License-Identifier: MIT
/// `catena measure`: tables, JSON, CSV, time steps and refused input.
#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/support/nifti_file.h"

namespace catena::measure_test {

class Measure : public test::ProgramInFolder {
 protected:
  /// A label map of 4 x 3 x 2 voxels of 1 x 2 x 3 mm, with the labels 0, 1 and 7, and files of values.
  void SetUp() override {
    test::NiftiFile map({4, 3, 2}, 2, 8);
    for (std::size_t d = 0; d < 3; ++d) map.put(80 + 4 * d, static_cast<float>(d + 1));
    map.put(123, char{2});  // millimeters
    test::NiftiFile values({4, 3, 2}, 16, 32);
    for (std::size_t d = 0; d < 3; ++d) values.put(80 + 4 * d, static_cast<float>(d + 1));
    values.put(123, char{2});
    for (int i = 0; i < 24; ++i) {
      map.append(static_cast<std::uint8_t>(i < 2 ? 1 : i == 23 ? 7 : 0));
      values.append(static_cast<float>(i));
    }
    write("map.nii", map.bytes());
    write("map.txt", "1 Left, \"upper\"\n");
    for (const char* name : {"v1.nii", "v2.nii"}) write(name, values.bytes());
  }
};

TEST_F(Measure, LabelsHaveVolumesNamesAndStatistics) {
  const std::string json = succeed("measure {map.nii} --values {v1.nii} --json -o {t.csv}").out;
  test::expect_parts(json, {R"("kind":"labels")", R"("voxel_volume":6)", R"("unlabeled_voxels":21)", R"("volume":"mm3")",
                            R"("voxels":2,"volume":12)", R"("valued_voxels":2,"mean":0.5,"deviation":0.7071067811865476,"min":0,"max":1)",
                            R"("label":7,"name":null,"voxels":1,"volume":6)", R"("deviation":null)"});
  EXPECT_TRUE(json::parse(json, "out"));
  test::expect_parts(read("t.csv"),
                     {"label,name,voxels,volume,surface,valued_voxels,mean,deviation,min,max,x,y,z\n", "1,\"Left, \"\"upper\"\"\",2,12,"});
  test::expect_parts(succeed("measure {map.nii}").out, {"voxel_volume", "6 mm3", "surface [mm2]", "note: the surface"});
}

TEST_F(Measure, LevelPointsLineAndHistogram) {
  const std::string level = succeed("measure {v1.nii} --level 22 --json").out;
  test::expect_parts(
      level, {R"("voxels_above":2)", R"("volume_above":12)", R"("closed":false)", R"("enclosed_volume":null)", R"("neighbors":26)"});
  test::expect_parts(succeed("measure {v1.nii} --histogram 4 -o {h.csv}").out, {"4 rows"});
  EXPECT_EQ(read("h.csv"), "lower,upper,count\n0,5.75,6\n5.75,11.5,6\n11.5,17.25,6\n17.25,23,6\n");
  succeed("measure {v1.nii} {v2.nii} --point 0.5,0,0 --point -9,0,0 -o {p.csv}");
  EXPECT_EQ(read("p.csv"), "step,time,point,x,y,z,value\n0,,1,0.5,0,0,0.5\n0,,2,-9,0,0,\n1,,1,0.5,0,0,0.5\n1,,2,-9,0,0,\n");
  succeed("measure {v1.nii} --line 0,0,0:6,0,0 --samples 3 -o {l.csv}");
  EXPECT_EQ(read("l.csv"), "length,x,y,z,value\n0,0,0,0,0\n3,3,0,0,3\n6,6,0,0,\n");
}

TEST_F(Measure, DistancesAndAnglesNeedNoFile) {
  test::expect_parts(succeed("measure --distance 1,2,3:4,6,3 --json").out, {R"("distance":5,"dx":3,"dy":4,"dz":0)", R"("units":{})"});
  test::expect_parts(succeed("measure {v1.nii} --distance 1,2,3:4,6,3 --json").out, {R"("distance":"mm")"});
  test::expect_parts(succeed("measure --angle 1,0,0:0,0,0:0,2,0 --json").out, {R"("angle":90)"});
}

TEST_F(Measure, BadInputIsRefused) {
  expect_refused("measure", {"expected a data file"});
  expect_refused("measure {v1.nii} --level 99", {"v1.nii: no voxel reaches the level 99"});
  expect_refused("measure {v1.nii} --level nan", {"--level"});
  expect_refused("measure {v1.nii} --level 1 --histogram 3", {"exclude each other"});
  expect_refused("measure {v1.nii} --point 1,2", {"--point \"1,2\": expected x,y,z"});
  expect_refused("measure {v1.nii} --line 0,0,0:1,1,1:2,2,2", {"expected x,y,z:x,y,z"});
  expect_refused("measure {v1.nii} --line -1e308,0,0:1e308,0,0", {"--line", "no finite number"});
  expect_refused("measure {v1.nii} --histogram 1000 --range 0 1e-322", {"v1.nii: the range is too narrow for so many bins"});
  expect_refused("measure --angle 0,0,0:0,0,0:1,0,0", {"two of the points coincide"});
  expect_refused("measure {v1.nii} --histogram 3 --range 2 1", {"--range: LO < HI"});
  expect_refused("measure {map.nii} -o {map.nii}", {"map.nii"});
  expect_refused("measure {map.nii} -o {t.txt}", {"ends in .csv"});
  expect_refused("measure {map.nii} --neighbors 18", {"--neighbors"});
  expect_refused("measure {map.nii} --step 3 -o {t.csv}", {"--step 3"});
  expect_refused("measure {none.nii}", {"none.nii"});
}

}  // namespace catena::measure_test
