// SPDX-License-Identifier: MIT
/// The gallery: the commands of docs/user/gallery.md draw the images above them.
#include <gtest/gtest.h>

#include <numeric>
#include <regex>

#include "render/image/image_error.h"
#include "tests/package/installed.h"

namespace gallery_test {

namespace fs = std::filesystem;
namespace test = catena::test;

/// Compares each image of docs/user/gallery.md with the output of the command below it: RMS difference at most 4/255, and at most one
/// pixel in fifty differs by more than 32 (edges of thin lines on other drivers).
TEST(Gallery, TheCommandsDrawTheirImages) {
  test::TemporaryFolder folder;
  fs::create_directory_symlink(test::source_dir() + "/assets", folder / "assets");
  fs::create_directories(folder / "out");
  const std::string text = test::read_file(test::source_dir() + "/docs/user/gallery.md");
  const std::regex entry("!\\[[^\\]]+\\]\\((?:\\.\\./)+(assets/pictures/gallery/([\\w-]+\\.png))\\)\\n\\n```sh\\n([^`]+)```");
  int compared = 0;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), entry); it != std::sregex_iterator(); ++it) {
    const std::string committed = test::source_dir() + "/" + (*it)[1].str(), drawn = folder / "out/" + (*it)[2].str();
    const test::ProgramResult result = test::run_shell(folder.path(), (*it)[3]);
    ASSERT_EQ(result.exit_code, 0) << (*it)[3] << result.out;
    const auto a = catena::render::read_png(committed), b = catena::render::read_png(drawn);
    ASSERT_TRUE(a && b) << committed << ", " << drawn;
    ASSERT_EQ(a->width, b->width) << committed;
    ASSERT_EQ(a->height, b->height) << committed;
    const auto errors = catena::render::compute_covered_errors(*a, *b);
    const std::size_t pixels = a->width * a->height;
    ASSERT_EQ(errors.squared.size(), pixels) << committed << ": images without transparent pixels were expected";
    EXPECT_LE(std::accumulate(errors.squared.begin(), errors.squared.end(), 0.0), 16 * double(pixels)) << committed;
    EXPECT_LE(std::ranges::count_if(errors.max_channel, [](double d) { return d > 32; }), pixels / 50) << committed;
    ++compared;
  }
  EXPECT_GE(compared, 6);
  for (const auto& file : fs::directory_iterator(test::source_dir() + "/assets/pictures/gallery"))
    EXPECT_NE(text.find(file.path().filename().string()), std::string::npos) << file.path() << " is in no page";
}

}  // namespace gallery_test
