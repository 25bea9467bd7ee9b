// SPDX-License-Identifier: MIT
/// The keys "projection" and "color_by" in rendered images.
#include <gtest/gtest.h>

#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace render_appearance_test {

using namespace catena;

render::Image8 picture_of(const std::string& drawn) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"d": {"analytic": "constant", "resolution": 9, "box": [-1, 1]}},)" + drawn +
                                          R"(, "background": "transparent",
    "camera": {"position": [0, -8, 0], "target": [0, 0, 0], "up": [0, 0, 1], "projection": "orthographic", "height": 3}})");
  const auto run = test::run_catena(
      {"render", folder / "s.json", "-o", folder / "o.png", "--size", "64x64", "--validation", "--stats", folder / "o.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
  auto picture = render::read_png(folder / "o.png");
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? *picture : render::Image8{64, 64, std::vector<std::uint8_t>(4 * 64 * 64)};
}

TEST(RenderAppearance, AProjectionsOpacityDoesNotDependOnTheThickness) {
  // Composite: opacity 1 - 0.5^(2 / 0.25) for a thickness of 2. Projected: opacity 0.5.
  const std::string volume = R"("volumes": [{"field": "d", "color": [[1, 0, 0, 1]], "opacity": [[1, 0.5]], "opacity_unit": 0.25)";
  EXPECT_NEAR(picture_of(volume + "}]").pixel(32, 32)[3], 254, 1);
  for (const char* projection : {"maximum", "minimum", "average"}) {
    const auto picture = picture_of(volume + ", \"projection\": \"" + projection + "\"}]");
    EXPECT_NEAR(picture.pixel(32, 32)[3], 127.5, 1) << projection;
    EXPECT_NEAR(picture.pixel(32, 32)[2], 255, 1) << projection;
    EXPECT_EQ(picture.pixel(2, 2)[3], 0);
  }
}

TEST(RenderAppearance, AVolumeIsColouredByAnotherField) {
  const auto picture = picture_of(R"("volumes": [{"field": "d", "color": [[1, 0, 0, 1]], "extinction": [[1, 1]],
                                                  "color_by": {"field": "d", "color": [[1, 1, 0.5, 0]]}}])");
  EXPECT_NEAR(picture.pixel(32, 32)[0], 255, 1);
  EXPECT_NEAR(picture.pixel(32, 32)[1], 127.5, 1.5);
  EXPECT_EQ(picture.pixel(32, 32)[2], 0);
}

}  // namespace render_appearance_test
