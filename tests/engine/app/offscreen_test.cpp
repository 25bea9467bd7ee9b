// SPDX-License-Identifier: MIT
/// `catena render` beyond one 8-bit image: 16 bits, EXR, depth, ids, tiles, antialiasing, sequences, cameras and refused outputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/json.h"
#include "engine/base/vec.h"
#include "render/image/image.h"
#include "tests/render/support/read_files.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace offscreen_test {

using namespace catena;
using render::Image8;

class Offscreen : public testing::Test {
 protected:
  void scene(const std::string& text) { test::write_file(folder_ / "s.json", text); }
  /// Runs `catena render s.json ...` with the validation layers.
  test::ProgramResult render(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", folder_ / "s.json", "--validation"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto run = test::run_catena(arguments);
    EXPECT_EQ(run.err.find("validation"), std::string::npos) << run.err;
    return run;
  }
  void rendered(const std::vector<std::string>& more) {
    const auto run = render(more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  /// Sets a scene with a shell about a sphere, in which values differ by `width` from the shell's radius.
  void shell(double width) {
    scene(R"({"fields": {"f": {"analytic": "sphere", "resolution": 32}}, "volumes": [{"field": "f", "shade": true, "extinction": [[)" +
          std::to_string(0.5 - width) + ", 0], [0.5, 60], [" + std::to_string(0.5 + width) + R"(, 0]],
      "color": [[0, 1, 1, 1], [1, 1, 1, 1]]}], "camera": {"position": [0, -4, 2], "target": [0, 0, 0]}})");
  }
  void refused(const std::vector<std::string>& more, const std::vector<std::string>& expects) {
    const int before = files();
    const auto run = render(more);
    // A full disk is an error of the machine: exit code 1.
    EXPECT_EQ(run.exit_code, run.err.find("No space left on device") != std::string::npos ? 1 : 2) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& part : expects) EXPECT_NE(run.err.find(part), std::string::npos) << "\"" << part << "\" in: " << run.err;
    EXPECT_EQ(files(), before) << "nothing is left behind";
  }
  Image8 picture(const std::string& name) {
    auto read = render::read_png(folder_ / name);
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : Image8();
  }
  int files() const { return int(std::distance(std::filesystem::directory_iterator(folder_.path()), {})); }
  /// Copies the image to the build folder, for review.
  void keep(const std::string& name, const std::string& as) {
    const std::string pictures = test::binary_dir() + "/pictures";
    std::filesystem::create_directories(pictures);
    std::filesystem::copy_file(folder_ / name, pictures + "/Offscreen." + as, std::filesystem::copy_options::overwrite_existing);
  }

  test::TemporaryFolder folder_;
};

int max_pixel_difference(const Image8& a, const Image8& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  int max_difference = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    max_difference = std::max(max_difference, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  return max_difference;
}

// A box of constant extinction, seen head-on by parallel rays: alpha = 1 - exp(-0.25 * 2).
constexpr const char* kSlab = R"({"fields": {"d": {"analytic": "constant", "resolution": 9, "box": [-1, 1]}},
  "volumes": [{"field": "d", "color": [[1, 0.8, 0.4, 0.2]], "extinction": [[1, 0.25]]}],
  "camera": {"position": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1], "projection": "orthographic", "height": 4}, "background": "transparent"})";
// The scene of the tile tests: a shaded volume.
constexpr const char* kLobes = R"({"fields": {"d": {"analytic": "marschner-lobb", "resolution": 40}},
  "volumes": [{"field": "d", "color": [[0, 0.1, 0.2, 0.9], [1, 1, 0.6, 0]], "opacity": [[0.3, 0], [1, 0.2]], "shade": true}],
  "camera": {"position": [3, -5, 2.5], "target": [0, 0, 0], "up": [0, 0, 1], "fovy_deg": 35}, "background": [0.1, 0.1, 0.15]})";
// A sphere of radius 0.75 in front of a translucent volume.
constexpr const char* kBalls =
    R"({"fields": {"near": {"analytic": "sphere", "resolution": 33}, "far": {"analytic": "sphere", "resolution": 33}},
  "isosurfaces": [{"field": "near", "level": 0.75, "color": [0.9, 0.5, 0.2]}],
  "volumes": [{"field": "far", "color": [[0, 0.2, 0.3, 0.9], [2, 0.2, 0.3, 0.9]], "extinction": [[0, 0.05], [2, 0.05]]}],
  "camera": {"position": [0, -6, 0], "target": [0, 0, 0], "up": [0, 0, 1], "fovy_deg": 40}, "background": [0, 0, 0]})";

TEST_F(Offscreen, SixteenBitImagesEqualTheClosedForm) {
  scene(kSlab);
  rendered({"-o", folder_ / "o.png", "--size", "64x64", "--bits", "16", "--quality", "reference"});
  const test::DeepPng png = test::read_deep_png(folder_ / "o.png");
  ASSERT_EQ(png.bits, 16);
  ASSERT_EQ(png.channels, 4);
  const std::uint16_t* middle = png.values.data() + 4 * (32 * 64 + 32);
  const double alpha = 65535 * (1 - std::exp(-0.5));
  EXPECT_NEAR(middle[3], alpha, 3) << "8 bits would be off by up to 128";
  EXPECT_NEAR(middle[0], 0.8 * 65535, 3);
  EXPECT_NEAR(middle[1], 0.4 * 65535, 3);
  EXPECT_NEAR(middle[2], 0.2 * 65535, 3);
  const std::uint16_t* corner = png.values.data();
  EXPECT_EQ(corner[3], 0);
  // The same image in 8 bits.
  rendered({"-o", folder_ / "o8.png", "--size", "64x64", "--quality", "reference"});
  const Image8 eight = picture("o8.png");
  for (std::size_t i = 0; i < eight.rgba.size(); ++i) ASSERT_LE(std::abs(eight.rgba[i] - png.values[i] / 257.0), 1) << i;
}

TEST_F(Offscreen, ExrIsLinearAndPremultiplied) {
  scene(kSlab);
  rendered({"-o", folder_ / "o.exr", "--size", "64x64", "--quality", "reference"});
  const test::ExrImage exr = test::read_exr(folder_ / "o.exr");
  const double alpha = 1 - std::exp(-0.5);
  const std::size_t middle = 32 * 64 + 32;
  EXPECT_NEAR(exr.channels.at("A")[middle], alpha, 1e-4);
  const auto linear = [](double x) { return std::pow((x + 0.055) / 1.055, 2.4); };
  EXPECT_NEAR(exr.channels.at("R")[middle], alpha * linear(0.8), 1e-4);
  EXPECT_NEAR(exr.channels.at("G")[middle], alpha * linear(0.4), 1e-4);
  EXPECT_NEAR(exr.channels.at("B")[middle], alpha * linear(0.2), 1e-4);
  EXPECT_EQ(exr.channels.at("R")[0], 0);
  // An image with an opaque background has no alpha channel.
  scene(R"({"background": [0.1, 0.1, 0.15]})");
  rendered({"-o", folder_ / "b.exr", "--size", "32x24"});
  EXPECT_EQ(test::read_exr(folder_ / "b.exr").channels.count("A"), 0u);
  EXPECT_NEAR(test::read_exr(folder_ / "b.exr").channels.at("R")[0], linear(0.1), 1e-6);
}

TEST_F(Offscreen, DepthIsTheDistanceAlongTheViewAxisAndInfiniteForTheBackground) {
  scene(kBalls);
  rendered({"-o", folder_ / "o.png", "--depth", folder_ / "z.exr", "--size", "96x64", "--quality", "reference"});
  const test::ExrImage exr = test::read_exr(folder_ / "z.exr");
  ASSERT_EQ(exr.channels.size(), 1u);
  EXPECT_NE(exr.comments.find("view axis"), std::string::npos);
  const double half = std::tan(20 * M_PI / 180);
  int hits = 0, misses = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      // The sphere's intersection with a ray of unit depth: |o + t d| = 0.75.
      const Vec3 o(0.0, -6.0, 0.0), d((2 * (x + 0.5) / 96 - 1) * half * 1.5, 1.0, (1 - 2 * (y + 0.5) / 64) * half);
      const double b = dot(o, d) / dot(d, d), c = (dot(o, o) - 0.75 * 0.75) / dot(d, d), disc = b * b - c;
      const float z = exr.channels.at("Z")[std::size_t(y) * 96 + std::size_t(x)];
      if (disc > 0.05) {
        ++hits;
        EXPECT_NEAR(z, -b - std::sqrt(disc), 0.02) << x << " " << y;  // tolerance for a trilinear sphere of 33 nodes
      } else if (disc < -0.005) {
        ++misses;
        EXPECT_TRUE(std::isinf(z) && z > 0) << x << " " << y;
      }
    }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 3000) << "the translucent volume has no depth";
}

TEST_F(Offscreen, IdsEqualThoseOfTheLegend) {
  scene(kBalls);
  rendered({"-o", folder_ / "o.png", "--ids", folder_ / "i.png", "--stats", folder_ / "o.json", "--size", "96x64"});
  const test::DeepPng ids = test::read_deep_png(folder_ / "i.png");
  ASSERT_EQ(ids.bits, 16);
  ASSERT_EQ(ids.channels, 1);
  const auto stats = json::read(folder_ / "o.json");
  ASSERT_TRUE(stats);
  const json::Node* objects = stats->find("objects");
  ASSERT_NE(objects, nullptr);
  int ball = -1;
  for (const auto& object : objects->items)
    if (object.find("kind")->string == "isosurface") ball = int(object.find("id")->number);
  ASSERT_GT(ball, 0);
  EXPECT_EQ(ids.values[32 * 96 + 48], ball);
  EXPECT_EQ(ids.values[0], 0);
  const auto legend = json::parse(ids.text.at("Objects"), "legend");
  ASSERT_TRUE(legend);
  EXPECT_EQ(legend->items.size(), objects->items.size());
  // The sphere's area in the id image equals the area of its projection.
  const auto area = std::count(ids.values.begin(), ids.values.end(), std::uint16_t(ball));
  const double radius = 0.75 / std::sqrt(36 - 0.75 * 0.75) / std::tan(20 * M_PI / 180) * 32;
  EXPECT_NEAR(double(area), M_PI * radius * radius, 0.04 * M_PI * radius * radius);
}

TEST_F(Offscreen, TilesMakeTheSameImage) {
  const std::string o = folder_ / "o.png", t = folder_ / "t.png";
  for (const char* text : {kLobes, kBalls}) {
    scene(text);
    for (const char* quality : {"step=0.5", "balanced", "draft", "reference"}) {
      rendered({"-o", o, "--depth", folder_ / "o.exr", "--ids", folder_ / "oi.png", "--size", "200x150", "--quality", quality});
      rendered({"-o", t, "--depth", folder_ / "t.exr", "--ids", folder_ / "ti.png", "--size", "200x150", "--quality", quality, "--tile",
                "64", "--stats", folder_ / "t.json"});
      EXPECT_NE(test::read_file(folder_ / "t.json").find("\"tiles\": 12,"), std::string::npos);
      EXPECT_LE(max_pixel_difference(picture("o.png"), picture("t.png")), 1) << quality;
      EXPECT_EQ(test::read_deep_png(folder_ / "oi.png").values, test::read_deep_png(folder_ / "ti.png").values) << quality;
      const auto whole = test::read_exr(folder_ / "o.exr").channels.at("Z"), tiled = test::read_exr(folder_ / "t.exr").channels.at("Z");
      for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_EQ(std::isinf(whole[i]), std::isinf(tiled[i])) << i;
        if (!std::isinf(whole[i])) {
          ASSERT_NEAR(whole[i], tiled[i], 1e-4) << i;
        }
      }
    }
    keep("t.png", text == kLobes ? "tiled-lobes.png" : "tiled-balls.png");
  }
}

/// An image of few pixels, but longer than the maximum of many devices: the settings are chosen on a tile.
TEST_F(Offscreen, AnImageLongerThanTheDevicesMaximumIsRendered) {
  scene(kLobes);
  rendered({"-o", folder_ / "o.png", "--size", "16400x6"});
  const auto strip = picture("o.png");
  EXPECT_EQ(strip.width, 16400U);
  const auto red = [&](std::size_t x) { return int(strip.rgba[4 * (3 * 16400 + x)]); };
  EXPECT_EQ(red(100), red(16300));
  EXPECT_GT(std::abs(red(8200) - red(100)), 20);
}

TEST_F(Offscreen, TheOverlayCoversTheWholeImageNotEachTile) {
  std::string text = kBalls;
  text.insert(text.rfind('}'),
              R"(, "title": "Two balls, one of them seen through", "orientation_marker": true, "scalar_bars": [{"field": "far"}],
    "labels": [{"at": [0, -0.75, 0], "text": "the nearest point"}])");
  scene(text);
  const std::vector<std::string> size{"--size", "220x160", "--quality", "reference"};
  const auto draw = [&](const char* name, std::vector<std::string> more) {
    more.insert(more.begin(), {"-o", folder_ / name});
    more.insert(more.end(), size.begin(), size.end());
    rendered(more);
  };
  draw("o.png", {});
  draw("t.png", {"--tile", "64"});
  EXPECT_LE(max_pixel_difference(picture("o.png"), picture("t.png")), 1);
  // The same in 16 bits: the overlay is blended into floats.
  draw("d.png", {"--bits", "16"});
  const Image8 eight = picture("o.png");
  const test::DeepPng deep = test::read_deep_png(folder_ / "d.png");
  ASSERT_EQ(deep.channels, 3);
  for (std::size_t i = 0; i < deep.values.size(); ++i) ASSERT_LE(std::abs(eight.rgba[i / 3 * 4 + i % 3] - deep.values[i] / 257.0), 1) << i;
  keep("t.png", "tiled-overlay.png");
}

TEST_F(Offscreen, AntialiasingIsTheMeanOfTheSamples) {
  scene(kBalls);
  const std::string size = "60x40";
  rendered({"-o", folder_ / "big.png", "--size", "180x120", "--quality", "reference"});
  rendered({"-o", folder_ / "small.png", "--size", "60x40", "--antialias", "3", "--quality", "reference"});
  rendered({"-o", folder_ / "tiled.png", "--size", "60x40", "--antialias", "3", "--quality", "reference", "--tile", "48"});
  rendered({"-o", folder_ / "rough.png", "--size", "60x40", "--quality", "reference"});
  const Image8 big = picture("big.png"), small = picture("small.png"), rough = picture("rough.png");
  int max_difference = 0, edge = 0;
  for (std::uint32_t y = 0; y < 40; ++y)
    for (std::uint32_t x = 0; x < 60; ++x)
      for (int c = 0; c < 3; ++c) {
        double mean = 0;
        for (std::uint32_t j = 0; j < 3; ++j)
          for (std::uint32_t i = 0; i < 3; ++i) mean += big.pixel(3 * x + i, 3 * y + j)[c] / 9.0;
        max_difference = std::max(max_difference, int(std::ceil(std::fabs(small.pixel(x, y)[c] - mean) - 1e-9)));
        edge = std::max(edge, std::abs(small.pixel(x, y)[c] - rough.pixel(x, y)[c]));
      }
  EXPECT_LE(max_difference, 1);
  EXPECT_GT(edge, 15) << "the ball's edge is smooth now";
  EXPECT_LE(max_pixel_difference(small, picture("tiled.png")), 1);
  keep("small.png", "antialias-3.png");
  keep("rough.png", "antialias-1.png");
  // Depth and id are those of the nearest sample.
  rendered({"-o", folder_ / "a.png", "--size", size, "--antialias", "3", "--depth", folder_ / "a.exr", "--ids", folder_ / "ai.png"});
  rendered({"-o", folder_ / "b.png", "--size", "180x120", "--depth", folder_ / "b.exr"});
  const auto a = test::read_exr(folder_ / "a.exr").channels.at("Z"), b = test::read_exr(folder_ / "b.exr").channels.at("Z");
  const auto ids = test::read_deep_png(folder_ / "ai.png").values;
  for (std::size_t y = 0; y < 40; ++y)
    for (std::size_t x = 0; x < 60; ++x) {
      float nearest = HUGE_VALF;
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) nearest = std::min(nearest, b[(3 * y + j) * 180 + 3 * x + i]);
      if (std::isinf(nearest)) {
        ASSERT_TRUE(std::isinf(a[y * 60 + x]));
      } else {
        ASSERT_NEAR(a[y * 60 + x], nearest, 1e-4);
      }
      ASSERT_EQ(ids[y * 60 + x] != 0, !std::isinf(nearest));
    }
}

TEST_F(Offscreen, AVeryWideImageIsWrittenInBands) {
  scene(kBalls);
  // The image is wider than the CPU device's maximum.
  rendered({"-o", folder_ / "o.png", "--size", "20000x4", "--stats", folder_ / "o.json", "--quality", "draft", "--zoom", "3"});
  const Image8 wide = picture("o.png");
  EXPECT_EQ(wide.width, 20000u);
  EXPECT_EQ(wide.height, 4u);
  EXPECT_GT(wide.pixel(10000, 2)[0], 60);
  EXPECT_LT(wide.pixel(0, 2)[0], 5);
  EXPECT_NEAR(wide.pixel(9999, 1)[0], wide.pixel(10000, 1)[0], 2) << "left and right of the middle";
}

TEST_F(Offscreen, ASequenceNumbersItsOutputs) {
  scene(kBalls);
  rendered({"-o", folder_ / "p_%02d.png", "--depth", folder_ / "z_%d.exr", "--ids", folder_ / "i.png", "--frames", "3", "--orbit", "90",
            "--size", "32x24"});
  for (const char* name : {"p_00.png", "p_01.png", "p_02.png", "z_0.exr", "z_1.exr", "z_2.exr", "i.png"})
    EXPECT_TRUE(test::exists(folder_ / name)) << name;
  EXPECT_EQ(files(), 8);
}

TEST_F(Offscreen, ACameraPathIsFollowed) {
  // The path passes the same camera positions as an orbit.
  scene(kBalls);
  test::write_file(folder_ / "c.csv", "t,px,py,pz,tx,ty,tz\n0,0,-6,0,0,0,0\n1,6,0,0,0,0,0\n2,0,6,0,0,0,0\n");
  rendered({"-o", folder_ / "c_%d.png", "--camera", folder_ / "c.csv", "--frames", "3", "--size", "64x48", "--quality", "reference"});
  rendered({"-o", folder_ / "o_%d.png", "--orbit", "270", "--frames", "3", "--size", "64x48", "--quality", "reference"});
  for (const char* k : {"0", "1", "2"})
    EXPECT_LE(max_pixel_difference(picture(std::string("c_") + k + ".png"), picture(std::string("o_") + k + ".png")), 1) << k;
  // The default number of frames follows from the path's duration.
  const auto run = render({"-o", folder_ / "d_%d.png", "--camera", folder_ / "c.csv", "--fps", "2", "--size", "16x12"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(test::exists(folder_ / "d_4.png"));
  EXPECT_FALSE(test::exists(folder_ / "d_5.png"));
  test::write_file(folder_ / "bad.csv", "t,px,py,pz,tx,ty,tz\n0,0,0,0,0,0,0\n");
  refused({"-o", folder_ / "n.png", "--camera", folder_ / "bad.csv"}, {"bad.csv:2"});
  refused({"-o", folder_ / "n.png", "--camera", folder_ / "c.csv", "--fit"}, {"--fit"});
  refused({"-o", folder_ / "c.csv", "--camera", folder_ / "c.csv"}, {"c.csv", ".png"});
}

TEST_F(Offscreen, AxisViewsShowTheirSide) {
  // Red below and blue above: a view upwards from below shows red.
  scene(R"({"fields": {"z": {"analytic": "plane", "resolution": 17, "box": [-1, 1]}},
    "volumes": [{"field": "z", "color": [[-0.01, 1, 0, 0], [0.01, 0, 0, 1]], "extinction": [[-1, 8], [1, 8]]}], "background": [0, 0, 0]})");
  const auto seen = [&](const char* view, std::uint32_t row) {
    rendered({"-o", folder_ / "o.png", "--view", view, "--size", "48x48"});
    const Image8 p = picture("o.png");
    return p.pixel(24, row)[0] > 200 && p.pixel(24, row)[2] < 50 ? 'r' : p.pixel(24, row)[0] < 50 && p.pixel(24, row)[2] > 200 ? 'b' : '?';
  };
  EXPECT_EQ(seen("+z", 24), 'r');
  EXPECT_EQ(seen("-z", 24), 'b');
  for (const char* side : {"+x", "-x", "+y", "-y"}) {
    EXPECT_EQ(seen(side, 14), 'b') << side;
    EXPECT_EQ(seen(side, 34), 'r') << side;
  }
  EXPECT_EQ(seen("iso", 18), 'b');
  refused({"-o", folder_ / "n.png", "--view", "up"}, {"--view up", "+x"});
}

TEST_F(Offscreen, ZoomElevationAndFitMoveTheCamera) {
  scene(kBalls);
  const auto area = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"-o", folder_ / "o.png", "--ids", folder_ / "i.png", "--size", "120x120"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    rendered(arguments);
    const auto ids = test::read_deep_png(folder_ / "i.png").values;
    return double(std::count_if(ids.begin(), ids.end(), [](std::uint16_t id) { return id != 0; }));
  };
  const double plain = area({});
  EXPECT_NEAR(area({"--zoom", "1.5"}), 2.25 * plain, 0.05 * plain);
  EXPECT_NEAR(area({"--elevation", "50"}), plain, 0.03 * plain) << "a ball is a ball from above";
  EXPECT_GT(area({"--fit", "--zoom", "1.2"}), 1.2 * area({"--fit"}));
  refused({"-o", folder_ / "n.png", "--zoom", "0"}, {"--zoom"});
  refused({"-o", folder_ / "n.png", "--elevation", "91"}, {"--elevation"});
}

TEST_F(Offscreen, InvalidOutputsAreRefused) {
  scene(kBalls);
  const std::string o = folder_ / "o.png";
  refused({"-o", folder_ / "o.jpg"}, {"o.jpg", ".png, .exr"});
  refused({"-o", o, "--depth", folder_ / "z.png"}, {"z.png", "--depth", ".exr"});
  refused({"-o", o, "--ids", folder_ / "i.exr"}, {"i.exr", "--ids", ".png"});
  refused({"-o", folder_ / "o.exr", "--bits", "16"}, {"--bits 16"});
  refused({"-o", o, "--bits", "12"}, {"--bits"});
  refused({"-o", o, "--ids", folder_ / "./o.png"}, {"-o and --ids name one file"});
  refused({"-o", folder_ / "o.exr", "--depth", folder_ / "o.exr"}, {"-o and --depth name one file"});
  refused({"-o", folder_ / "a_%d.png", "--ids", folder_ / "a_1.png", "--frames", "3"}, {"a_1.png", "name one file"});
  refused({"-o", folder_ / "v.mp4", "--size", "16x16"}, {"v.mp4"});
  refused({"-o", o, "--antialias", "0"}, {"--antialias"});
  refused({"-o", o, "--tile", "4"}, {"--tile"});
  refused({"-o", o, "--size", "70000x10"}, {"65536"});
  refused({"-o", o, "--fps", "nan"}, {"--fps"});
  refused({"-o", o, "--depth", "/dev/full", "--size", "16x16"}, {"/dev/full", "space"});
  // An input is never overwritten, not even through a numbered name.
  test::write_file(folder_ / "p_1.png", "t,x,y,z\n0,0,0,0\n");
  refused({"-o", folder_ / "p_%d.png", "--frames", "2", "--probe", folder_ / "p_1.png"}, {"p_1.png", "input"});
}

TEST_F(Offscreen, AReferenceThatHasNotConvergedHasANote) {
  const std::vector<std::string> options{"-o",        folder_ / "o.png", "--size",  "160x120",
                                         "--quality", "reference",       "--stats", folder_ / "o.json"};
  for (const double width : {0.2, 0.0005}) {
    shell(width);
    const auto run = render(options);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const bool steep = width < 0.1;
    EXPECT_EQ(run.err.find("note: reference has not converged") != std::string::npos, steep) << run.err;
    const auto stats = json::read(folder_ / "o.json");
    ASSERT_TRUE(stats);
    const double stated = stats->find("quality")->find("estimated_rmse")->number;
    EXPECT_TRUE(steep ? stated > 1 : stated < 0.5) << stated;
  }
}

TEST_F(Offscreen, StandardOutputContainsOnlyTheImage) {
  scene(kBalls);
  rendered({"-o", folder_ / "o.png", "--size", "32x24"});
  const auto run = render({"-o", "/dev/stdout", "--size", "32x24"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, test::read_file(folder_ / "o.png"));
  EXPECT_NE(run.err.find("32x24"), std::string::npos);
  const auto depth = render({"-o", "/dev/null", "--depth", "/dev/stdout", "--size", "32x24"});
  ASSERT_EQ(depth.exit_code, 0) << depth.err;
  test::write_file(folder_ / "z.exr", depth.out);
  EXPECT_EQ(test::read_exr(folder_ / "z.exr").width, 32);
}

}  // namespace offscreen_test
