// SPDX-License-Identifier: MIT
/// Text and legends in images: scenes and data files that request them, and a machine without a font.
#include <gtest/gtest.h>

#include <cstdlib>

#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace annotate_test {

using namespace catena;
using render::Image8;

/// The number of pixels in columns x0..x1 that differ between two images by more than rounding.
int changed(const Image8& a, const Image8& b, std::uint32_t x0, std::uint32_t x1) {
  int count = 0;
  for (std::uint32_t y = 0; y < a.height; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) {
      bool differs = false;
      for (int c = 0; c < 4; ++c) differs = differs || std::abs(int(a.pixel(x, y)[c]) - int(b.pixel(x, y)[c])) > 2;
      count += differs;
    }
  return count;
}

class AnnotateCommand : public testing::Test {
 protected:
  Image8 picture(const std::vector<std::string>& arguments, std::string* err = nullptr) {
    std::vector<std::string> all{"render"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    for (const char* more : {"--size", "256x192", "--validation", "--quality", "step=1"}) all.push_back(more);
    all.insert(all.end(), {"-o", folder_ / "o.png", "--stats", folder_ / "o.json"});
    const auto run = test::run_catena(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(test::read_file(folder_ / "o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
    if (err) *err = run.err;
    auto read = render::read_png(folder_ / "o.png");
    EXPECT_TRUE(read) << read.error().message;
    return *read;
  }
  test::TemporaryFolder folder_;
};

TEST_F(AnnotateCommand, ADataFileIsDrawnWithATitleAScalarBarAndAnOrientationMarker) {
  const auto made = test::run_catena({"generate", "gaussian", "-o", folder_ / "g.vdb", "--resolution", "24"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Image8 plain = picture({folder_ / "g.vdb", "--colormap", "magma"});
  const Image8 full = picture({folder_ / "g.vdb", "--colormap", "magma", "--title", "A Gaussian", "--scalar-bar", "--orientation-marker"});
  EXPECT_GT(changed(plain, full, 220, 256), 400) << "the bar at the right";
  EXPECT_GT(changed(plain, full, 0, 40), 50) << "the marker at the left";
  EXPECT_GT(changed(plain, full, 90, 166), 100) << "the title";
  EXPECT_EQ(changed(plain, full, 50, 80), 0) << "and nothing else";
}

TEST_F(AnnotateCommand, AScalarBarWithoutColoursIsRefused) {
  test::write_file(folder_ / "s.json", R"({"fields": {}})");
  const auto run = test::run_catena({"render", folder_ / "s.json", "-o", folder_ / "o.png", "--scalar-bar"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--scalar-bar: nothing in the scene is coloured by values"), std::string::npos) << run.err;
}

TEST_F(AnnotateCommand, WithoutAFontTextIsLeftOutWithOneNote) {
  test::write_file(folder_ / "s.json", R"({"fields": {}, "title": "unseen", "orientation_marker": true})");
  test::write_file(folder_ / "plain.json", R"({"fields": {}})");
  test::write_file(folder_ / "fonts.conf", "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig></fontconfig>");
  const Image8 plain = picture({folder_ / "plain.json"});
  ::setenv("FONTCONFIG_FILE", (folder_ / "fonts.conf").c_str(), 1);
  std::string err;
  const Image8 without = picture({folder_ / "s.json"}, &err);
  ::unsetenv("FONTCONFIG_FILE");
  EXPECT_NE(err.find("no font was found"), std::string::npos) << err;
  EXPECT_EQ(err.find("no font was found"), err.rfind("no font was found")) << "said once";
  EXPECT_EQ(changed(plain, without, 60, 256), 0) << "no title";
  EXPECT_GT(changed(plain, without, 0, 40), 50) << "the marker's arrows are there";
}

}  // namespace annotate_test
