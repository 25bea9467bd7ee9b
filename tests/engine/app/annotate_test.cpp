// SPDX-License-Identifier: MIT
/// Text and legends in images: scenes and data files that request them, and a machine without a font.
#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::annotate_test {

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

class AnnotateCommand : public test::ProgramInFolder {
 protected:
  Image8 draw(const std::string& line, const test::Words& more = {}, std::string* err = nullptr) {
    return drawn(line + " --size 256x192 --quality step=1", more, err);
  }
};

TEST_F(AnnotateCommand, ADataFileIsDrawnWithATitleAScalarBarAndAnOrientationMarker) {
  succeed("generate gaussian -o {g.vdb} --resolution 24");
  const Image8 plain = draw("{g.vdb} --colormap magma");
  const Image8 full = draw("{g.vdb} --colormap magma --scalar-bar --orientation-marker", {"--title", "A Gaussian"});
  EXPECT_GT(changed(plain, full, 220, 256), 400) << "the bar at the right";
  EXPECT_GT(changed(plain, full, 0, 40), 50) << "the marker at the left";
  EXPECT_GT(changed(plain, full, 90, 166), 100) << "the title";
  EXPECT_EQ(changed(plain, full, 50, 80), 0) << "and nothing else";
}

TEST_F(AnnotateCommand, AScalarBarWithoutColoursIsRefused) {
  write("s.json", R"({"fields": {}})");
  expect_refused("render {s.json} -o {o.png} --scalar-bar", {"--scalar-bar: nothing in the scene is coloured by values"});
}

TEST_F(AnnotateCommand, WithoutAFontTextIsLeftOutWithOneNote) {
  write("s.json", R"({"fields": {}, "title": "unseen", "orientation_marker": true})");
  write("plain.json", R"({"fields": {}})");
  write("fonts.conf", "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig></fontconfig>");
  const Image8 plain = draw("{plain.json}");
  const test::EnvironmentVariable fonts("FONTCONFIG_FILE", folder_ / "fonts.conf");
  std::string err;
  const Image8 without = draw("{s.json}", {}, &err);
  test::expect_parts(err, {"no font was found"});
  EXPECT_EQ(err.find("no font was found"), err.rfind("no font was found")) << "said once";
  EXPECT_EQ(changed(plain, without, 60, 256), 0) << "no title";
  EXPECT_GT(changed(plain, without, 0, 40), 50) << "the marker's arrows are there";
}

}  // namespace catena::annotate_test
