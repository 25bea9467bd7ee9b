// SPDX-License-Identifier: MIT
/// `catena render --stereo`: sizes, eyes, keys and errors.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace stereo_test {

using namespace catena;
using render::Image8;

std::string scene(const std::string& more) {
  return R"({"fields": {"s": {"analytic": "sphere", "resolution": 24, "box": [-1.2, 1.2]}},
    "isosurfaces": [{"field": "s", "level": 0.8}], "background": [0.1, 0.1, 0.2],
    "camera": {"position": [0, -8, 2], "target": [0, 0, 0]})" +
         more + "}";
}

struct Drawn {
  Image8 picture;
  std::string out;
};

Drawn draw(const std::string& more, const std::vector<std::string>& options) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene(more));
  std::vector<std::string> arguments{"render", folder / "s.json", "-o",      folder / "o.png", "--size",
                                     "80x60",  "--validation",    "--stats", folder / "o.json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto run = test::run_catena(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
  auto picture = render::read_png(folder / "o.png");
  EXPECT_TRUE(picture);
  return {picture ? *picture : Image8{}, run.out};
}

/// The mean column of the pixels of the sphere.
double middle(const Image8& p, std::uint32_t from, std::uint32_t to) {
  double sum = 0, count = 0;
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = from; x < to; ++x)
      if (p.pixel(x, y)[0] > 60) {
        sum += x - from + 0.5;
        ++count;
      }
  return sum / count;
}

bool same_columns(const Image8& whole, std::uint32_t from, const Image8& part) {
  for (std::uint32_t y = 0; y < part.height; ++y)
    if (!std::equal(part.pixel(0, y), part.pixel(0, y) + 4 * part.width, whole.pixel(from, y))) return false;
  return true;
}

TEST(RenderStereo, SideBySideIsTheLeftAndTheRightImage) {
  const std::vector<std::string> apart{"--eye-separation", "0.8", "--zero-parallax", "5"};
  const auto with = [&](const char* mode) {
    std::vector<std::string> options{"--stereo", mode};
    options.insert(options.end(), apart.begin(), apart.end());
    return draw("", options);
  };
  const Image8 left = with("left").picture, right = with("right").picture;
  const Drawn pair = with("side-by-side");
  ASSERT_EQ(left.width, 80u);
  ASSERT_EQ(pair.picture.width, 160u);
  ASSERT_EQ(pair.picture.height, 60u);
  EXPECT_NE(pair.out.find("160x60"), std::string::npos) << pair.out;
  EXPECT_TRUE(same_columns(pair.picture, 0, left));
  EXPECT_TRUE(same_columns(pair.picture, 80, right));
  const Image8 crossed = with("cross-eyed").picture;
  EXPECT_TRUE(same_columns(crossed, 0, right));
  EXPECT_TRUE(same_columns(crossed, 80, left));
  // The sphere is beyond the zero-parallax distance: uncrossed disparity.
  EXPECT_GT(middle(right, 0, 80), middle(left, 0, 80) + 1);
  const Image8 top = with("top-bottom").picture, half = with("side-by-side-half").picture, anaglyph = with("anaglyph").picture;
  EXPECT_EQ(top.height, 120u);
  EXPECT_EQ(half.width, 80u);
  EXPECT_EQ(anaglyph.width, 80u);
}

TEST(RenderStereo, ByDefaultTheTargetHasNoDisparity) {
  const Image8 pair = draw("", {"--stereo", "side-by-side"}).picture;
  EXPECT_NEAR(middle(pair, 0, 80), middle(pair, 80, 160), 0.15);  // 3.7 pixels without zero parallax
}

TEST(RenderStereo, OptionsOverrideTheScene) {
  const std::string keys = R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5})";
  const Image8 by_scene = draw(keys, {}).picture;
  const Image8 by_option = draw("", {"--stereo", "side-by-side", "--eye-separation", "0.8", "--zero-parallax", "5"}).picture;
  EXPECT_EQ(by_scene.rgba, by_option.rgba);
  EXPECT_EQ(draw(keys, {"--stereo", "mono"}).picture.rgba, draw("", {}).picture.rgba);
  const std::string swapped = R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5, "swap_eyes": true})";
  EXPECT_EQ(draw(swapped, {}).picture.rgba, draw(keys, {"--stereo", "cross-eyed"}).picture.rgba);
  // Three views.
  const std::string three = R"(, "stereo": {"mode": "side-by-side", "views": 3})";
  EXPECT_EQ(draw(three, {}).picture.width, 240u);
}

TEST(RenderStereo, AnOrbitMovesBothEyes) {
  // The sphere looks the same from any side, so each eye's image stays the same.
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene(R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5})"));
  const auto run =
      test::run_catena({"render", folder / "s.json", "-o", folder / "o_%d.png", "--size", "80x60", "--frames", "2", "--orbit", "180"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto a = render::read_png(folder / "o_0.png"), b = render::read_png(folder / "o_1.png");
  ASSERT_TRUE(a && b);
  for (const std::uint32_t from : {0u, 80u}) EXPECT_NEAR(middle(*a, from, from + 80), middle(*b, from, from + 80), 0.1);
  EXPECT_GT(middle(*b, 80, 160), middle(*b, 0, 80) + 1);
}

TEST(RenderStereo, AQualityTargetIsMetForEachEye) {
  const std::string volume =
      R"(, "volumes": [{"field": "s", "color": [[0, 0.1, 0.2, 0.9], [1, 1, 0.6, 0]], "opacity": [[0.3, 0], [1, 0.1]]}])";
  for (const char* quality : {"error=1", "time=100000"}) {
    const Drawn drawn = draw(volume, {"--stereo", "top-bottom", "--quality", quality});
    EXPECT_EQ(drawn.picture.height, 120u);
    EXPECT_NE(drawn.out.find("error about 0."), std::string::npos) << drawn.out;
  }
}

TEST(RenderStereo, ATrackedHeadLooksThroughAScreen) {
  const std::string screens =
      R"(, "screens": [{"name": "desk", "lower_left": [-2, -2, -1.5], "lower_right": [2, -2, -1.5], "upper_left": [-2, -2, 1.5]}])";
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene(screens));
  // The head moves from the camera's position to the right, in five frames.
  test::write_file(folder / "head.csv", "t,x,y,z\n10,0,-8,2\n10.16,1.6,-8,2\n");
  const auto run = test::run_catena(
      {"render", folder / "s.json", "-o", folder / "o_%d.png", "--size", "80x60", "--screen", "desk", "--head", folder / "head.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(test::exists(folder / "o_5.png"));
  const auto first = render::read_png(folder / "o_0.png"), last = render::read_png(folder / "o_4.png");
  ASSERT_TRUE(first && last);
  EXPECT_TRUE(same_columns(draw(screens, {"--screen", "desk"}).picture, 0, *first)) << "the camera's own place";
  // The sphere is behind the screen and follows the head by a fraction of 1 - 6/8, with 20 pixels a unit.
  EXPECT_NEAR(middle(*last, 0, 80) - middle(*first, 0, 80), 1.6 * (1 - 6.0 / 8) * 20, 1);

  const auto wrong = [&](std::vector<std::string> options, const char* part) {
    std::vector<std::string> arguments{"render", folder / "s.json", "-o", folder / "x.png", "--head", folder / "head.csv"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto bad = test::run_catena(arguments);
    EXPECT_EQ(bad.exit_code, 2);
    EXPECT_NE(bad.err.find(part), std::string::npos) << bad.err;
  };
  wrong({}, "a display screen was expected (--screen)");
  test::write_file(folder / "head.csv", "t,x,y,z\n10,1e308,-8,2\n");
  wrong({"--screen", "desk"}, "is too far beside the screen");
  test::write_file(folder / "head.csv", "t,x,y,z\n10,0,-8,2\n10.16,1.6,-8,2\n");
  wrong({"--screen", "desk", "--camera", folder / "c.csv"}, "excludes --camera");
}

TEST(RenderStereo, BadInputIsOneLine) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene(""));
  const auto expect = [&](const std::vector<std::string>& options, const char* part) {
    std::vector<std::string> arguments{"render", folder / "s.json", "-o", folder / "o.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto run = test::run_catena(arguments);
    EXPECT_EQ(run.exit_code, 2) << options[1];
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_FALSE(test::exists(folder / "o.png"));
  };
  expect({"--stereo", "both"}, "side-by-side");
  expect({"--stereo", "left", "--eye-separation", "-1"}, "--eye-separation");
  expect({"--stereo", "left", "--eye-separation", "nan"}, "--eye-separation");
  expect({"--stereo", "left", "--zero-parallax", "0"}, "--zero-parallax");
  expect({"--size", "9000x10", "--stereo", "side-by-side"}, "18000");
}

// An extreme eye separation must be an error, not a failed assertion.
TEST(RenderStereo, AnExtremeEyeSeparationIsOneErrorLine) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene(R"(, "stereo": {"mode": "anaglyph", "separation": 1e12, "zero_parallax": 1e-9})"));
  const auto run = test::run_catena({"render", folder / "s.json", "-o", folder / "o.png", "--size", "80x60"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("\"stereo\": the eyes are 1e+12 apart with a zero-parallax distance of 1e-09"), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_FALSE(test::exists(folder / "o.png"));
}

}  // namespace stereo_test
