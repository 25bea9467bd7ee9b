// SPDX-License-Identifier: MIT
/// Patterns of file names, and time steps that are added while a scene is open.
#include "engine/scene/follow_files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <filesystem>

#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::time_step_patterns_test {

TEST(SeriesPattern, FilesOfASeriesInAnyOrderMakeAPattern) {
  const test::TemporaryFolder folder;
  for (const char* name :
       {"w_1.vti", "w_2.vti", "w_10.vti", "w_mean.vti", "t0.001.vtu", "t0.0015.vtu", "t0.01.vtu", "3.nii.gz", "20.nii.gz"})
    test::write_file(folder / name, "");
  std::filesystem::create_directory(folder / "other");
  test::write_file(folder / "other/w_1.vti", "");
  const struct {
    std::vector<const char*> files;
    const char* pattern;  // or a part of the error message
    std::vector<const char*> order;
  } kCases[] = {
      {{"w_10.vti", "w_2.vti", "w_1.vti"}, "w_{1,2,10}.vti", {"w_1.vti", "w_2.vti", "w_10.vti"}},
      {{"w_10.vti", "w_1.vti", "w_10.vti"}, "w_{1,10}.vti", {"w_1.vti", "w_10.vti"}},
      {{"t0.01.vtu", "t0.001.vtu", "t0.0015.vtu"}, "t*.vtu", {"t0.001.vtu", "t0.0015.vtu", "t0.01.vtu"}},
      {{"20.nii.gz", "3.nii.gz"}, "*.nii.gz", {"3.nii.gz", "20.nii.gz"}},
      {{"w_mean.vti"}, "w_mean.vti", {}},
      {{"w_mean.vti", "w_1.vti"}, "are not a series", {}},
      {{"w_1.vti", "t0.01.vtu"}, "are not a series", {}},
      {{"w_1.vti", "other/w_1.vti"}, "different folders", {}},
      {{"w_1.vti", "w_3.vti"}, "there is no such file", {}},
      {{"w_1.vti", "other/../w_2.vti"}, "w_{1,2}.vti", {"w_1.vti", "w_2.vti"}},
      {{"w_?.vti"}, "there is no such file; a pattern for several files has a *", {}},
      {{"w_{1..3}.vti"}, "there is no such file; a pattern for several files has a *", {}},
  };
  for (const auto& one : kCases) {
    std::vector<std::string> files, order;
    for (const char* file : one.files) files.push_back(folder / file);
    for (const char* file : one.order) order.push_back(folder / file);
    const auto pattern = make_pattern(files);
    if (!pattern) {
      EXPECT_NE(pattern.error().message.find(one.pattern), std::string::npos) << pattern.error().message;
      continue;
    }
    EXPECT_EQ(*pattern, folder / one.pattern);
    if (!order.empty()) {
      EXPECT_EQ(expand_pattern(*pattern), order);
    }
  }
  EXPECT_EQ(expand_pattern(folder / "w_{1,1,2}.vti").size(), 2u);
  EXPECT_FALSE(find_followable_path(folder / "missing_1.vti"));
  // A file whose name has the pattern's characters.
  test::write_file(folder / "x_*.vti", "");
  EXPECT_FALSE(is_pattern(folder / "x_*.vti"));
}

void settle(const std::string& path) {
  const timespec past[2] = {{::time(nullptr) - 60, 0}, {::time(nullptr) - 60, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), past, 0), 0);
}

class GrowingSeries : public InFolder {
 protected:
  ~GrowingSeries() override { field::clear_cache(); }
  void write(int step, bool half = false) {
    const std::string path = file(step);
    std::vector<float> values(64, static_cast<float>(step));
    values[5] += 0.5f;
    field::AnyField field;
    field.scalar = field::make_scalar_grid("r", field::Mapping::from_linear(Mat3(1.0), Vec3(0.0)), {4, 4, 4}, values);
    EXPECT_TRUE(field::write_vdb(folder_ / "whole.vdb", {{field, "r"}}));
    const std::string bytes = test::read_file(folder_ / "whole.vdb");
    test::write_file(path, half ? bytes.substr(0, bytes.size() / 2) : bytes);
  }
  std::string file(int step) { return folder_ / ("f_" + std::to_string(step) + ".vdb"); }
};

TEST_F(GrowingSeries, AStepIsAddedOnceCompleteAndUnchanged) {
  for (const int step : {8, 9}) write(step), settle(file(step));
  Scene scene = parsed(R"({"fields": {"r": {"file": "f_*.vdb"}}})", folder_ / "s.json");
  EXPECT_EQ(step_count(scene), 2);
  ASSERT_TRUE(start_following(scene));
  EXPECT_EQ(step_count(scene), 1) << "the newest may be half written";
  ASSERT_TRUE(resolve_field(scene, find_field(scene, "r"), {}));
  const auto look = [&] {
    std::vector<FollowedSource> all = followed_sources(scene);
    for (FollowedSource& one : all) poll_steps(one);
    return apply_steps(scene, all);
  };
  EXPECT_TRUE(look());
  EXPECT_EQ(step_count(scene), 2);
  // A partial file, whether old or new; and a file of another series.
  write(10, /*half=*/true);
  EXPECT_FALSE(look());
  settle(file(10));
  EXPECT_FALSE(look());
  std::filesystem::copy_file(file(9), folder_ / "f_mean.vdb");
  settle(folder_ / "f_mean.vdb");
  EXPECT_FALSE(look());
  // A complete file that was changed just now.
  write(10);
  EXPECT_FALSE(look());
  settle(file(10));
  EXPECT_TRUE(look());
  EXPECT_EQ(step_count(scene), 3);
  set_step(scene, 2);
  EXPECT_TRUE(field::is_cached(*scene.entities.get<FieldSource>(find_field(scene, "r")).file));
  EXPECT_EQ(value_of(resolve_field(scene, find_field(scene, "r"), {})).scalar->min_value(), 10);
}

TEST_F(GrowingSeries, FindsTheFollowedPatternOfAName) {
  for (const int step : {1, 2}) write(step);
  EXPECT_EQ(*find_followable_path(file(1)), folder_ / "f_*.vdb");
  EXPECT_EQ(*find_followable_path(folder_ / "f_{1,2}.vdb"), folder_ / "f_*.vdb");
  EXPECT_EQ(*find_followable_path(folder_ / "f_*.vdb"), folder_ / "f_*.vdb");
  EXPECT_EQ(*find_followable_path(folder_ / "run.pvd"), folder_ / "run.pvd");
  EXPECT_FALSE(find_followable_path(folder_ / "whole.vdb"));
}

}  // namespace catena::scene::time_step_patterns_test
