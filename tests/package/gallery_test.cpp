// SPDX-License-Identifier: MIT
/// The gallery: the commands of docs/user/gallery.md draw the images above them.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>

#include "render/image/image.h"
#include "tests/package/installed.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

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
    double squares = 0;
    std::size_t off = 0, pixels = std::size_t(a->width) * a->height;
    for (std::size_t p = 0; p < pixels; ++p) {
      int maximum = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const int d = std::abs(int(a->rgba[4 * p + c]) - int(b->rgba[4 * p + c]));
        squares += d * d;
        maximum = std::max(maximum, d);
      }
      off += maximum > 32;
    }
    EXPECT_LE(std::sqrt(squares / double(3 * pixels)), 4) << committed;
    EXPECT_LE(off, pixels / 50) << committed;
    ++compared;
  }
  EXPECT_GE(compared, 6);
  for (const auto& file : fs::directory_iterator(test::source_dir() + "/assets/pictures/gallery"))
    EXPECT_NE(text.find(file.path().filename().string()), std::string::npos) << file.path() << " is in no page";
}

}  // namespace gallery_test
