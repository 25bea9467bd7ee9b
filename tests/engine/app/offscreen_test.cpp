// SPDX-License-Identifier: MIT
/// `catena render` beyond one 8-bit image: 16 bits, EXR, depth, ids, tiles, antialiasing, sequences, cameras and refused outputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/json.h"
#include "engine/base/vec.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/render/support/read_files.h"

namespace catena::offscreen_test {

using render::Image8;

class Offscreen : public test::ProgramInFolder {
 protected:
  void scene(const std::string& text) { write("s.json", text); }
  /// Runs `catena render s.json ...` with the validation layers.
  test::ProgramResult rendered(const std::string& more) {
    const auto run = succeed("render {s.json} --validation " + more);
    EXPECT_EQ(run.err.find("validation"), std::string::npos) << run.err;
    return run;
  }
  void refused(const std::string& more, const std::vector<std::string>& parts) {
    const auto run = expect_refused("render {s.json} --validation " + more, parts);
    EXPECT_EQ(run.err.find("validation"), std::string::npos) << run.err;
  }
  std::vector<float> depths(const std::string& name) { return test::read_exr(folder_ / name).channels.at("Z"); }
  /// Copies the image to the build folder, for review.
  void keep(const std::string& name, const std::string& as) {
    const std::string pictures = test::binary_dir() + "/pictures";
    std::filesystem::create_directories(pictures);
    std::filesystem::copy_file(folder_ / name, pictures + "/Offscreen." + as, std::filesystem::copy_options::overwrite_existing);
  }
};

int max_pixel_difference(const Image8& a, const Image8& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  int max_difference = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    max_difference = std::max(max_difference, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  return max_difference;
}

/// True if both are the background's infinite depth, or equal up to rounding.
bool equal_depths(float a, float b) { return a == b || std::abs(a - b) <= 1e-4f; }

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
  rendered("-o {o.png} --size 64x64 --bits 16 --quality reference");
  const test::DeepPng png = test::read_deep_png(folder_ / "o.png");
  ASSERT_EQ(png.bits, 16);
  ASSERT_EQ(png.channels, 4);
  const std::uint16_t* middle = png.values.data() + 4 * (32 * 64 + 32);
  const double expected[] = {0.8, 0.4, 0.2, 1 - std::exp(-0.5)};
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(middle[c], 65535 * expected[c], 3) << c << ": 8 bits would be off by up to 128";
  EXPECT_EQ(png.values[3], 0) << "the corner is transparent";
  // The same image in 8 bits.
  rendered("-o {o8.png} --size 64x64 --quality reference");
  const Image8 eight = picture("o8.png");
  for (std::size_t i = 0; i < eight.rgba.size(); ++i) ASSERT_LE(std::abs(eight.rgba[i] - png.values[i] / 257.0), 1) << i;
}

TEST_F(Offscreen, ExrIsLinearAndPremultiplied) {
  scene(kSlab);
  rendered("-o {o.exr} --size 64x64 --quality reference");
  const test::ExrImage exr = test::read_exr(folder_ / "o.exr");
  const double alpha = 1 - std::exp(-0.5);
  const std::size_t middle = 32 * 64 + 32;
  EXPECT_NEAR(exr.channels.at("A")[middle], alpha, 1e-4);
  const auto linear = [](double x) { return std::pow((x + 0.055) / 1.055, 2.4); };
  for (const auto& [channel, color] : {std::pair{"R", 0.8}, {"G", 0.4}, {"B", 0.2}})
    EXPECT_NEAR(exr.channels.at(channel)[middle], alpha * linear(color), 1e-4) << channel;
  EXPECT_EQ(exr.channels.at("R")[0], 0);
  // An image with an opaque background has no alpha channel.
  scene(R"({"background": [0.1, 0.1, 0.15]})");
  rendered("-o {b.exr} --size 32x24");
  EXPECT_EQ(test::read_exr(folder_ / "b.exr").channels.count("A"), 0u);
  EXPECT_NEAR(test::read_exr(folder_ / "b.exr").channels.at("R")[0], linear(0.1), 1e-6);
}

TEST_F(Offscreen, DepthIsTheDistanceAlongTheViewAxisAndInfiniteForTheBackground) {
  scene(kBalls);
  rendered("-o {o.png} --depth {z.exr} --size 96x64 --quality reference");
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
  rendered("-o {o.png} --ids {i.png} --stats {o.json} --size 96x64");
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
  for (const char* text : {kLobes, kBalls}) {
    scene(text);
    for (const char* quality : {"step=0.5", "balanced", "draft", "reference"}) {
      const std::string size = " --size 200x150 --antialias 1 --quality " + std::string(quality);
      rendered("-o {o.png} --depth {o.exr} --ids {oi.png}" + size);
      rendered("-o {t.png} --depth {t.exr} --ids {ti.png} --tile 64 --stats {t.json}" + size);
      test::expect_parts(read("t.json"), {"\"tiles\": 12,"});
      EXPECT_LE(max_pixel_difference(picture("o.png"), picture("t.png")), 1) << quality;
      EXPECT_EQ(test::read_deep_png(folder_ / "oi.png").values, test::read_deep_png(folder_ / "ti.png").values) << quality;
      const auto whole = depths("o.exr"), tiled = depths("t.exr");
      for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_TRUE(equal_depths(whole[i], tiled[i])) << i;
    }
    keep("t.png", text == kLobes ? "tiled-lobes.png" : "tiled-balls.png");
  }
}

/// An image of few pixels, but longer than the maximum of many devices: the settings are chosen on a tile.
TEST_F(Offscreen, AnImageLongerThanTheDevicesMaximumIsRendered) {
  scene(kLobes);
  rendered("-o {o.png} --size 16400x6");
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
  const std::string size = " --size 220x160 --antialias 1 --quality reference";
  rendered("-o {o.png}" + size);
  rendered("-o {t.png} --tile 64" + size);
  EXPECT_LE(max_pixel_difference(picture("o.png"), picture("t.png")), 1);
  // The same in 16 bits: the overlay is blended into floats.
  rendered("-o {d.png} --bits 16" + size);
  const Image8 eight = picture("o.png");
  const test::DeepPng deep = test::read_deep_png(folder_ / "d.png");
  ASSERT_EQ(deep.channels, 3);
  for (std::size_t i = 0; i < deep.values.size(); ++i) ASSERT_LE(std::abs(eight.rgba[i / 3 * 4 + i % 3] - deep.values[i] / 257.0), 1) << i;
  keep("t.png", "tiled-overlay.png");
}

TEST_F(Offscreen, AntialiasingIsTheMeanOfTheSamples) {
  scene(kBalls);
  rendered("-o {big.png} --size 180x120 --antialias 1 --quality reference");
  rendered("-o {small.png} --size 60x40 --antialias 3 --quality reference");
  rendered("-o {tiled.png} --size 60x40 --antialias 3 --quality reference --tile 48");
  rendered("-o {rough.png} --size 60x40 --antialias 1 --quality reference");
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
  rendered("-o {a.png} --size 60x40 --antialias 3 --depth {a.exr} --ids {ai.png}");
  rendered("-o {b.png} --size 180x120 --depth {b.exr}");
  const auto a = depths("a.exr"), b = depths("b.exr");
  const auto ids = test::read_deep_png(folder_ / "ai.png").values;
  for (std::size_t y = 0; y < 40; ++y)
    for (std::size_t x = 0; x < 60; ++x) {
      float nearest = HUGE_VALF;
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) nearest = std::min(nearest, b[(3 * y + j) * 180 + 3 * x + i]);
      ASSERT_TRUE(equal_depths(a[y * 60 + x], nearest));
      ASSERT_EQ(ids[y * 60 + x] != 0, !std::isinf(nearest));
    }
}

TEST_F(Offscreen, AVeryWideImageIsWrittenInBands) {
  scene(kBalls);
  // The image is wider than the CPU device's maximum.
  rendered("-o {o.png} --size 20000x4 --stats {o.json} --quality draft --zoom 3");
  const Image8 wide = picture("o.png");
  EXPECT_EQ(wide.width, 20000u);
  EXPECT_EQ(wide.height, 4u);
  EXPECT_GT(wide.pixel(10000, 2)[0], 60);
  EXPECT_LT(wide.pixel(0, 2)[0], 5);
  EXPECT_NEAR(wide.pixel(9999, 1)[0], wide.pixel(10000, 1)[0], 2) << "left and right of the middle";
}

TEST_F(Offscreen, ASequenceNumbersItsOutputs) {
  scene(kBalls);
  rendered("-o {p_%02d.png} --depth {z_%d.exr} --ids {i.png} --frames 3 --orbit 90 --size 32x24");
  for (const char* name : {"p_00.png", "p_01.png", "p_02.png", "z_0.exr", "z_1.exr", "z_2.exr", "i.png"}) EXPECT_TRUE(exists(name)) << name;
  EXPECT_EQ(files(), 8);
}

TEST_F(Offscreen, ACameraPathIsFollowed) {
  // The path passes the same camera positions as an orbit.
  scene(kBalls);
  write("c.csv", "t,px,py,pz,tx,ty,tz\n0,0,-6,0,0,0,0\n1,6,0,0,0,0,0\n2,0,6,0,0,0,0\n");
  rendered("-o {c_%d.png} --camera {c.csv} --frames 3 --size 64x48 --quality reference");
  rendered("-o {o_%d.png} --orbit 270 --frames 3 --size 64x48 --quality reference");
  for (const char* k : {"0", "1", "2"})
    EXPECT_LE(max_pixel_difference(picture(std::string("c_") + k + ".png"), picture(std::string("o_") + k + ".png")), 1) << k;
  // The default number of frames follows from the path's duration.
  rendered("-o {d_%d.png} --camera {c.csv} --fps 2 --size 16x12");
  EXPECT_TRUE(exists("d_4.png") && !exists("d_5.png"));
  write("bad.csv", "t,px,py,pz,tx,ty,tz\n0,0,0,0,0,0,0\n");
  refused("-o {n.png} --camera {bad.csv}", {"bad.csv:2"});
  refused("-o {n.png} --camera {c.csv} --fit", {"--fit"});
  refused("-o {c.csv} --camera {c.csv}", {"c.csv", ".png"});
}

TEST_F(Offscreen, AxisViewsShowTheirSide) {
  // Red below and blue above: a view upwards from below shows red.
  scene(R"({"fields": {"z": {"analytic": "plane", "resolution": 17, "box": [-1, 1]}},
    "volumes": [{"field": "z", "color": [[-0.01, 1, 0, 0], [0.01, 0, 0, 1]], "extinction": [[-1, 8], [1, 8]]}], "background": [0, 0, 0]})");
  const auto seen = [&](const char* view, std::uint32_t row) {
    rendered("-o {o.png} --size 48x48 --view " + std::string(view));
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
  refused("-o {n.png} --view up", {"--view up", "+x"});
}

TEST_F(Offscreen, ZoomElevationAndFitMoveTheCamera) {
  scene(kBalls);
  const auto area = [&](const std::string& more) {
    rendered("-o {o.png} --ids {i.png} --size 120x120 " + more);
    const auto ids = test::read_deep_png(folder_ / "i.png").values;
    return double(std::count_if(ids.begin(), ids.end(), [](std::uint16_t id) { return id != 0; }));
  };
  const double plain = area("");
  EXPECT_NEAR(area("--zoom 1.5"), 2.25 * plain, 0.05 * plain);
  EXPECT_NEAR(area("--elevation 50"), plain, 0.03 * plain) << "a ball is a ball from above";
  EXPECT_GT(area("--fit --zoom 1.2"), 1.2 * area("--fit"));
  refused("-o {n.png} --zoom 0", {"--zoom"});
  refused("-o {n.png} --elevation 91", {"--elevation"});
}

TEST_F(Offscreen, InvalidOutputsAreRefused) {
  scene(kBalls);
  // An input is never overwritten, not even through a numbered name.
  write("p_1.png", "t,x,y,z\n0,0,0,0\n");
  const std::pair<const char*, std::vector<std::string>> kInvalid[] = {
      {"-o {o.jpg}", {"o.jpg", ".png, .exr"}},
      {"-o {o.png} --depth {z.png}", {"z.png", "--depth", ".exr"}},
      {"-o {o.png} --ids {i.exr}", {"i.exr", "--ids", ".png"}},
      {"-o {o.exr} --bits 16", {"--bits 16"}},
      {"-o {o.png} --bits 12", {"--bits"}},
      {"-o {o.exr} --depth {o.exr}", {"-o and --depth name one file"}},
      {"-o {a_%d.png} --ids {a_1.png} --frames 3", {"a_1.png", "name one file"}},
      {"-o {v.mp4} --size 16x16", {"v.mp4"}},
      {"-o {o.png} --antialias 0", {"--antialias"}},
      {"-o {o.png} --tile 4", {"--tile"}},
      {"-o {o.png} --size 70000x10", {"65536"}},
      {"-o {o.png} --fps nan", {"--fps"}},
      {"-o {o.png} --depth /dev/full --size 16x16", {"/dev/full", "space"}},
      {"-o {p_%d.png} --frames 2 --probe {p_1.png}", {"p_1.png", "input"}}};
  for (const auto& [line, parts] : kInvalid) refused(line, parts);
}

TEST_F(Offscreen, AReferenceThatHasNotConvergedHasANote) {
  for (const double width : {0.2, 0.0005}) {
    // A shell about a sphere, in which values differ by the width from the shell's radius.
    scene(R"({"fields": {"f": {"analytic": "sphere", "resolution": 32}}, "volumes": [{"field": "f", "shade": true, "extinction": [[)" +
          std::to_string(0.5 - width) + ", 0], [0.5, 60], [" + std::to_string(0.5 + width) + R"(, 0]],
      "color": [[0, 1, 1, 1], [1, 1, 1, 1]]}], "camera": {"position": [0, -4, 2], "target": [0, 0, 0]}})");
    const auto run = rendered("-o {o.png} --size 160x120 --quality reference --stats {o.json}");
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
  rendered("-o {o.png} --size 32x24");
  const auto run = rendered("-o /dev/stdout --size 32x24");
  EXPECT_EQ(run.out, read("o.png"));
  test::expect_parts(run.err, {"32x24"});
  write("z.exr", rendered("-o /dev/null --depth /dev/stdout --size 32x24").out);
  EXPECT_EQ(test::read_exr(folder_ / "z.exr").width, 32);
}

}  // namespace catena::offscreen_test
