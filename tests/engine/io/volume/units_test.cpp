// SPDX-License-Identifier: MIT
#include "engine/io/volume/units.h"

#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include <cstring>

#include "tests/support/support.h"

namespace catena::field::units_test {

TEST(Units, ANiftiHeaderStatesTheLengthUnit) {
  const catena::test::TemporaryFolder folder;
  std::string header(360, '\0');
  const auto put = [&](std::size_t at, auto v) { std::memcpy(header.data() + at, &v, sizeof v); };
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (std::size_t d = 1; d < 8; ++d) put(40 + 2 * d, std::int16_t{1});
  put(70, std::int16_t{2});
  put(72, std::int16_t{8});
  put(108, 352.f);
  std::memcpy(header.data() + 344, "n+1", 4);
  int i = 0;
  for (const auto& [code, unit] : {std::pair{0, ""}, {1, "m"}, {2, "mm"}, {3, "µm"}}) {
    put(123, static_cast<char>(code | 8));  // and seconds
    const std::string path = folder / (std::to_string(i++) + ".nii");
    catena::test::write_file(path, header);
    EXPECT_EQ(read_units(path, "").length, unit);
    EXPECT_EQ(read_units(path, "").value, "");
  }
  catena::test::write_file(folder / "bad.nii", "no header");
  EXPECT_EQ(read_units(folder / "bad.nii", "").length, "");
  EXPECT_EQ(read_units(folder / "none.nii", "").length, "");
}

openvdb::FloatGrid::Ptr make_grid(const std::string& name) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  grid->setName(name);
  return grid;
}

void save(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& about = {}) {
  openvdb::io::File file(path);
  file.write(grids, about);
  file.close();
}

TEST(Units, AVdbGridStatesItsUnit) {
  const catena::test::TemporaryFolder folder;
  const auto speed = make_grid("speed"), other = make_grid("other");
  speed->insertMeta("unit", openvdb::StringMetadata("m/s"));
  openvdb::MetaMap about;
  about.insertMeta("units", openvdb::StringMetadata("HU, mm"));
  save(folder / "a.vdb", {speed, other}, about);
  EXPECT_EQ(read_units(folder / "a.vdb", "speed").value, "m/s");
  EXPECT_EQ(read_units(folder / "a.vdb", "speed").length, "mm");
  EXPECT_EQ(read_units(folder / "a.vdb", "other").value, "") << "the file's word may belong to either field";
}

TEST(Units, LevelSetsAndPatientSpaceAreRecognized) {
  const catena::test::TemporaryFolder folder;
  const auto distance = make_grid("distance"), fog = make_grid("fog");
  distance->setGridClass(openvdb::GRID_LEVEL_SET);
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  save(folder / "a.vdb", {distance, fog});
  EXPECT_TRUE(read_units(folder / "a.vdb", "distance").is_level_set);
  EXPECT_FALSE(read_units(folder / "a.vdb", "fog").is_level_set);
  EXPECT_FALSE(read_units(folder / "a.vdb", "distance").is_patient_space);
  distance->insertMeta("unit", openvdb::StringMetadata("HU"));
  save(folder / "b.vdb", {distance, fog});
  EXPECT_TRUE(read_units(folder / "b.vdb", "distance").is_patient_space);
  EXPECT_FALSE(read_units(folder / "b.vdb", "fog").is_patient_space);
}

TEST(Units, FreeTextIsParsedOnlyIfUnambiguous) {
  EXPECT_EQ(parse_units("HU, mm", true).value, "HU");
  EXPECT_EQ(parse_units("HU, mm", true).length, "mm");
  EXPECT_EQ(parse_units("HU, mm", false).value, "");
  EXPECT_EQ(parse_units("mm", true).value, "");
  EXPECT_EQ(parse_units("T1w a.u., mm", true).value, "");
  EXPECT_EQ(parse_units("K (file says C), m/s; x=lon deg", true).value, "");
  EXPECT_FALSE(is_unit_name(std::string(25, 'x')));
  EXPECT_FALSE(is_unit_name("m\ns"));
  EXPECT_TRUE(is_unit_name("µm"));
}

}  // namespace catena::field::units_test
