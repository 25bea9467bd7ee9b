// SPDX-License-Identifier: MIT
/// `catena render --stereo`: sizes, eyes, keys and errors.

#include <algorithm>

#include "render/image/image.h"
#include "tests/engine/app/program_in_folder.h"

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

class RenderStereo : public test::ProgramInFolder {
 protected:
  Image8 picture(const std::string& name) const {
    auto read = render::read_png(folder_ / name);
    EXPECT_TRUE(read);
    return read ? *read : Image8{};
  }
  Drawn draw(const std::string& more, const std::string& options) const {
    write("s.json", scene(more));
    const auto run = succeed("render {s.json} -o {o.png} --size 80x60 --validation --stats {o.json} " + options);
    EXPECT_NE(read("o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
    return {picture("o.png"), run.out};
  }
  Image8 draw_picture(const std::string& more, const std::string& options) const { return draw(more, options).picture; }
};

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

TEST_F(RenderStereo, SideBySideIsTheLeftAndTheRightImage) {
  const auto with = [&](const std::string& mode) { return draw("", "--stereo " + mode + " --eye-separation 0.8 --zero-parallax 5"); };
  const Image8 left = with("left").picture, right = with("right").picture;
  const Drawn pair = with("side-by-side");
  ASSERT_EQ(left.width, 80u);
  ASSERT_EQ(pair.picture.width, 160u);
  ASSERT_EQ(pair.picture.height, 60u);
  test::expect_parts(pair.out, {"160x60"});
  EXPECT_TRUE(same_columns(pair.picture, 0, left));
  EXPECT_TRUE(same_columns(pair.picture, 80, right));
  const Image8 crossed = with("cross-eyed").picture;
  EXPECT_TRUE(same_columns(crossed, 0, right));
  EXPECT_TRUE(same_columns(crossed, 80, left));
  // The sphere is beyond the zero-parallax distance: uncrossed disparity.
  EXPECT_GT(middle(right, 0, 80), middle(left, 0, 80) + 1);
  EXPECT_EQ(with("top-bottom").picture.height, 120u);
  EXPECT_EQ(with("side-by-side-half").picture.width, 80u);
  EXPECT_EQ(with("anaglyph").picture.width, 80u);
}

TEST_F(RenderStereo, ByDefaultTheTargetHasNoDisparity) {
  const Image8 pair = draw_picture("", "--stereo side-by-side");
  EXPECT_NEAR(middle(pair, 0, 80), middle(pair, 80, 160), 0.15);  // 3.7 pixels without zero parallax
}

TEST_F(RenderStereo, OptionsOverrideTheScene) {
  const std::string keys = R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5})";
  EXPECT_EQ(draw_picture(keys, "").rgba, draw_picture("", "--stereo side-by-side --eye-separation 0.8 --zero-parallax 5").rgba);
  EXPECT_EQ(draw_picture(keys, "--stereo mono").rgba, draw_picture("", "").rgba);
  const std::string swapped = R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5, "swap_eyes": true})";
  EXPECT_EQ(draw_picture(swapped, "").rgba, draw_picture(keys, "--stereo cross-eyed").rgba);
  // Three views.
  EXPECT_EQ(draw_picture(R"(, "stereo": {"mode": "side-by-side", "views": 3})", "").width, 240u);
}

TEST_F(RenderStereo, AnOrbitMovesBothEyes) {
  // The sphere looks the same from any side, so each eye's image stays the same.
  write("s.json", scene(R"(, "stereo": {"mode": "side-by-side", "separation": 0.8, "zero_parallax": 5})"));
  succeed("render {s.json} -o {o_%d.png} --size 80x60 --frames 2 --orbit 180");
  const Image8 a = picture("o_0.png"), b = picture("o_1.png");
  ASSERT_EQ(a.width, 160u);
  ASSERT_EQ(b.width, 160u);
  for (const std::uint32_t from : {0u, 80u}) EXPECT_NEAR(middle(a, from, from + 80), middle(b, from, from + 80), 0.1);
  EXPECT_GT(middle(b, 80, 160), middle(b, 0, 80) + 1);
}

TEST_F(RenderStereo, AQualityTargetIsMetForEachEye) {
  const std::string volume =
      R"(, "volumes": [{"field": "s", "color": [[0, 0.1, 0.2, 0.9], [1, 1, 0.6, 0]], "opacity": [[0.3, 0], [1, 0.1]]}])";
  for (const std::string quality : {"error=1", "time=100000"}) {
    const Drawn drawn = draw(volume, "--stereo top-bottom --quality " + quality);
    EXPECT_EQ(drawn.picture.height, 120u);
    test::expect_parts(drawn.out, {"error about 0."});
  }
}

TEST_F(RenderStereo, ATrackedHeadLooksThroughAScreen) {
  const std::string screens =
      R"(, "screens": [{"name": "desk", "lower_left": [-2, -2, -1.5], "lower_right": [2, -2, -1.5], "upper_left": [-2, -2, 1.5]}])";
  write("s.json", scene(screens));
  // The head moves from the camera's position to the right, in five frames.
  const std::string path = "t,x,y,z\n10,0,-8,2\n10.16,1.6,-8,2\n";
  write("head.csv", path);
  succeed("render {s.json} -o {o_%d.png} --size 80x60 --screen desk --head {head.csv}");
  EXPECT_FALSE(exists("o_5.png"));
  const Image8 first = picture("o_0.png"), last = picture("o_4.png");
  ASSERT_EQ(first.width, 80u);
  ASSERT_EQ(last.width, 80u);
  EXPECT_TRUE(same_columns(draw_picture(screens, "--screen desk"), 0, first)) << "the camera's own place";
  // The sphere is behind the screen and follows the head by a fraction of 1 - 6/8, with 20 pixels a unit.
  EXPECT_NEAR(middle(last, 0, 80) - middle(first, 0, 80), 1.6 * (1 - 6.0 / 8) * 20, 1);

  const std::string refused = "render {s.json} -o {x.png} --head {head.csv}";
  expect_refused(refused, {"a display screen was expected (--screen)"});
  write("head.csv", "t,x,y,z\n10,1e308,-8,2\n");
  expect_refused(refused + " --screen desk", {"is too far beside the screen"});
  write("head.csv", path);
  expect_refused(refused + " --screen desk --camera {c.csv}", {"excludes --camera"});
}

TEST_F(RenderStereo, BadInputIsOneLine) {
  write("s.json", scene(""));
  for (const auto& [options, part] : {std::pair{"--stereo both", "side-by-side"},
                                      {"--stereo left --eye-separation -1", "--eye-separation"},
                                      {"--stereo left --eye-separation nan", "--eye-separation"},
                                      {"--stereo left --zero-parallax 0", "--zero-parallax"},
                                      {"--size 9000x10 --stereo side-by-side", "18000"}})
    expect_refused(std::string("render {s.json} -o {o.png} ") + options, {part});
}

// An extreme eye separation must be an error, not a failed assertion.
TEST_F(RenderStereo, AnExtremeEyeSeparationIsOneErrorLine) {
  write("s.json", scene(R"(, "stereo": {"mode": "anaglyph", "separation": 1e12, "zero_parallax": 1e-9})"));
  expect_refused("render {s.json} -o {o.png} --size 80x60",
                 {"\"stereo\": the eyes are 1e+12 apart with a zero-parallax distance of 1e-09"});
}

}  // namespace stereo_test
