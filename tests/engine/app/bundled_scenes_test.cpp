// SPDX-License-Identifier: MIT
/// The scenes of assets/scenes work in a fresh clone: each is drawn with the folder `assets` alone, and refers only to files in that folder
/// and to files of packages that `./run` installs.
#include <map>

#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::bundled_scenes_test {

namespace fs = std::filesystem;

/// The names of the scenes that need no measured data, without folder and extension.
std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/assets/scenes"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The packages that `./run` installs.
std::vector<std::string> packages() {
  std::istringstream words(test::run_program(test::source_dir() + "/run", {"packages"}).out);
  return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

/// Finds each object of the scene that names a file.
void find_files(const json::Node& node, std::vector<std::pair<const json::Node*, std::string>>& found) {
  for (const char* key : {"file", "transfer", "firmware"})
    if (const json::Node* file = node.find(key)) found.push_back({&node, file->string});
  for (const auto& [key, member] : node.members) find_files(member, found);
  for (const json::Node& item : node.items) find_files(item, found);
}

/// The fraction of pixels that differ from the image's most frequent color.
double covered(const render::Image8& picture) {
  std::map<std::array<std::uint8_t, 3>, int> count;
  int max_count = 0;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = picture.pixel(x, y);
      max_count = std::max(max_count, ++count[{p[0], p[1], p[2]}]);
    }
  return 1 - static_cast<double>(max_count) / (picture.width * picture.height);
}

class BundledScenes : public test::ProgramInFolder, public testing::WithParamInterface<std::string> {};

INSTANTIATE_TEST_SUITE_P(Assets, BundledScenes, testing::ValuesIn(scene_names()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(BundledScenes, IsDrawnFromTheAssetsFolderAlone) {
  fs::copy(test::source_dir() + "/assets", folder_ / "assets", fs::copy_options::recursive);
  const std::string assets = folder_ / "assets/", scene = assets + "scenes/" + GetParam() + ".json";

  const auto root = json::read(scene);
  ASSERT_TRUE(root) << root.error().message;
  std::vector<std::pair<const json::Node*, std::string>> files;
  find_files(*root, files);
  const std::vector<std::string> installed = packages();
  for (const auto& [node, file] : files) {
    if (!fs::path(file).is_absolute()) {
      const std::string at = fs::path(assets + "scenes/" + file).lexically_normal().string();
      EXPECT_TRUE(at.starts_with(assets) && fs::exists(at)) << file << " is not among the assets";
      continue;
    }
    const json::Node* package = node->find("package");
    ASSERT_NE(package, nullptr) << file << ": a \"package\" was expected beside it";
    EXPECT_TRUE(std::count(installed.begin(), installed.end(), package->string)) << "./run does not install " << package->string;
    if (!fs::exists(file)) GTEST_SKIP() << package->string << " is not installed";
  }

  const std::string probe = assets + "probes/" + GetParam() + ".csv";
  succeed("render -o {o.png} --size 96x72 --quality draft " + scene + (fs::exists(probe) ? " --probe " + probe : ""));
  EXPECT_GT(covered(picture("o.png")), 0.1);
}

using MissingPackages = test::ProgramInFolder;

TEST_F(MissingPackages, AMissingFileErrorNamesItsPackage) {
  write("s.json", R"({"fields": {"mr": {"file": "/nowhere/brain.nii.gz", "package": "mricron-data"}}})");
  expect_refused("render {s.json} -o {o.png}", {"the Debian package \"mricron-data\" contains it"});
}

}  // namespace catena::bundled_scenes_test
