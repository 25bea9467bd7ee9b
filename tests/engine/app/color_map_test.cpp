// SPDX-License-Identifier: MIT
/// Color maps in the program: a ramp of values shows the map, and data files have the requested colors.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/color_maps.h"
#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace color_map_test {

using namespace catena;
using render::Image8;

test::ProgramResult program(const std::vector<std::string>& arguments) { return test::run_catena(arguments); }

Image8 draw(std::vector<std::string> arguments, const std::string& keep) {
  const test::TemporaryFolder folder;
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"-o", folder / "o.png", "--validation", "--stats", folder / "o.json"});
  const auto run = program(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
  auto picture = render::read_png(folder / "o.png");
  EXPECT_TRUE(picture) << picture.error().message;
  EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-" + keep + ".png", *picture, false));
  return *picture;
}

/// A field z from -2 to 2, upwards in the image: an opaque slab seen along y.
std::string ramp(const std::string& keys) {
  return R"({"fields": {"z": {"analytic": "plane", "resolution": 33}}, "volumes": [{"field": "z", "extinction": [[0, 1000]], )" + keys +
         R"(}],
    "camera": {"position": [0, -9, 0], "target": [0, 0, 0], "up": [0, 0, 1], "projection": "orthographic", "height": 4}})";
}

/// Published entries of the maps (matplotlib), sRGB in 1/255.
struct Entry {
  int at;
  double rgb[3];
};

TEST(ColorMapImage, ARampShowsTheMapInOrder) {
  const test::TemporaryFolder folder;
  const std::pair<const char*, std::vector<Entry>> maps[] = {
      {"viridis", {{26, {72.0, 37.2, 117.7}}, {77, {52.3, 95.8, 141.2}}, {128, {32.5, 144.6, 140.4}}, {203, {119.4, 208.8, 82.6}}}},
      {"inferno", {{26, {23.7, 11.6, 59.8}}, {77, {107.7, 23.6, 110.3}}, {128, {187.6, 55.1, 84.2}}, {203, {251.8, 162.7, 8.9}}}},
      {"grey", {{26, {26, 26, 26}}, {77, {77, 77, 77}}, {128, {128, 128, 128}}, {203, {203, 203, 203}}}}};
  for (const auto& [name, entries] : maps) {
    test::write_file(folder / "s.json", ramp("\"color\": \"" + std::string(name) + "\""));
    const Image8 picture = draw({folder / "s.json", "--size", "64x256", "--quality", "reference"}, std::string("ramp-") + name);
    for (const Entry& entry : entries) {
      // The center of row y is at the fraction (255.5 - y) / 256 of the map, entry i at i / 255.
      const double y = 255.5 - 256 * entry.at / 255.0;
      const auto above = static_cast<std::uint32_t>(y);
      for (int c = 0; c < 3; ++c) {
        const double shown = (1 - (y - above)) * picture.pixel(32, above)[c] + (y - above) * picture.pixel(32, above + 1)[c];
        EXPECT_NEAR(shown, entry.rgb[c], 2) << name << " " << entry.at << " component " << c;
      }
    }
    // Compares each row with the map's own points.
    const auto table = scene::make_color_map(name, -2, 2);
    for (std::uint32_t y = 1; y < 255; ++y) {
      const double z = 2 - 4 * (y + 0.5) / 256;
      std::size_t i = 1;
      while (table[i].value < z) ++i;
      const double t = (z - table[i - 1].value) / (table[i].value - table[i - 1].value);
      const auto &a = table[i - 1].color, &b = table[i].color;
      EXPECT_NEAR(picture.pixel(32, y)[0], 255 * (a.r + t * (b.r - a.r)), 2) << name << " row " << y;
      EXPECT_NEAR(picture.pixel(32, y)[1], 255 * (a.g + t * (b.g - a.g)), 2) << name << " row " << y;
      EXPECT_NEAR(picture.pixel(32, y)[2], 255 * (a.b + t * (b.b - a.b)), 2) << name << " row " << y;
    }
  }
}

TEST(ColorMapImage, ARangeMapsANamedMapAndATransferFileAlike) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", ramp(R"("color": "grey", "range": [-1, 1])"));
  test::write_file(folder / "t.json", R"([{"RGBPoints": [0, 0, 0, 0, 8, 1, 1, 1], "Points": [0, 1, 0.5, 0, 8, 1, 0.5, 0]}])");
  std::string by_file = ramp(R"("transfer": "t.json", "opacity_unit": 0.005, "range": [-1, 1])");
  by_file.erase(by_file.find("\"extinction\""), std::string("\"extinction\": [[0, 1000]], ").size());
  test::write_file(folder / "f.json", by_file);
  const Image8 named = draw({folder / "s.json", "--size", "64x128", "--quality", "reference"}, "ramp-range");
  const Image8 filed = draw({folder / "f.json", "--size", "64x128", "--quality", "reference"}, "ramp-file");
  for (std::uint32_t y = 1; y < 127; ++y) {
    const double z = 2 - 4 * (y + 0.5) / 128, grey = 255 * std::min(1.0, std::max(0.0, 0.5 + 0.5 * z));
    EXPECT_NEAR(named.pixel(32, y)[0], grey, 2) << y;
    EXPECT_NEAR(filed.pixel(32, y)[1], grey, 2) << y;
  }
}

TEST(ColorMapProgram, ListsItsMaps) {
  const auto run = program({"info", "--colormaps"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* name : {"viridis\n", "cividis\n", "inferno\n", "magma\n", "plasma\n", "cool-warm\n", "grey\n", "viridis_r\n"})
    EXPECT_NE(run.out.find(name), std::string::npos) << name;
}

TEST(ColorMapProgram, DataFilesHaveTheRequestedColours) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(program({"generate", "gaussian", "-o", folder / "g.vdb", "--resolution", "24"}).exit_code, 0);
  const Image8 plain = draw({folder / "g.vdb", "--size", "64x48"}, "bare");
  const Image8 red = draw({folder / "g.vdb", "--size", "64x48", "--colormap", "grey", "--range", "0", "1"}, "bare-grey");
  // A note after rendering states the chosen presentation and the reason.
  const auto render = program({"render", folder / "g.vdb", "-o", folder / "note.png", "--size", "16x12"});
  EXPECT_NE(render.err.find("\"gaussian\" looks like a simulation: "), std::string::npos) << render.err;
  EXPECT_NE(program({"info", folder / "g.vdb"}).out.find("\"gaussian\" looks like a simulation: "), std::string::npos);
  EXPECT_NE(plain.rgba, red.rgba);
  // Grey over the background, which is bluer by 13 of 255, and pure grey where the volume is dense.
  const auto bluer = [](const Image8& picture, std::uint32_t x, std::uint32_t y) {
    return int(picture.pixel(x, y)[2]) - int(picture.pixel(x, y)[0]);
  };
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) EXPECT_NEAR(bluer(red, x, y), 6.5, 7.5) << "grey all over";
  EXPECT_EQ(bluer(red, 1, 1), 13);
  EXPECT_LT(bluer(red, 32, 24), 5);
  EXPECT_GT(red.pixel(32, 24)[0], red.pixel(1, 1)[0] + 30);
  int greener = 0;
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) greener = std::max(greener, int(plain.pixel(x, y)[1]) - int(plain.pixel(x, y)[0]));
  EXPECT_GT(greener, 20) << "not grey without the map";
  // Lines are colored by speed.
  ASSERT_EQ(program({"generate", "circle", "-o", folder / "c.vdb", "--resolution", "16"}).exit_code, 0);
  const Image8 lines = draw({folder / "c.vdb", "--size", "64x48", "--colormap", "grey_r"}, "bare-lines");
  bool any = false;
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) {
      any = any || lines.pixel(x, y)[0] > 60;
      EXPECT_NEAR(bluer(lines, x, y), 6.5, 7.5);
    }
  EXPECT_TRUE(any);
}

TEST(ColorMapProgram, RefusesBadMapsAndRangesAndScenes) {
  const test::TemporaryFolder folder;
  const std::string g = folder / "g.vdb", o = folder / "o.png";
  ASSERT_EQ(program({"generate", "gaussian", "-o", g, "--resolution", "8"}).exit_code, 0);
  test::write_file(folder / "s.json", "{}");
  test::write_file(folder / "t.json", "{\n\"color\": \"jett\"}");
  test::write_file(folder / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  test::write_file(folder / "f.json",
                   R"({"fields": {"s": {"analytic": "sphere", "resolution": 8}}, "volumes": [{"field": "s", "transfer": "t.json"}]})");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    std::vector<std::string> all{"render"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", o});
    const auto run = program(all);
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(test::read_file(o).empty());
  };
  refused({g, "--colormap", "virdis"}, "did you mean \"viridis\"?");
  refused({g, "--range", "1", "0"}, "two increasing numbers LO HI were expected");
  refused({g, "--range", "a", "0"}, "two increasing numbers LO HI were expected");
  refused({g, "--range", "1"}, "--range");
  refused({folder / "s.json", "--colormap", "viridis"}, "a scene states its colours");
  refused({folder / "m.obj", "--colormap", "viridis"}, "a mesh has no values");
  refused({folder / "f.json"}, "t.json:2: ");
  // An output never overwrites the transfer file.
  test::write_file(folder / "t.json", "{\"color\": \"grey\"}");
  const auto run = program({"render", folder / "f.json", "-o", folder / "o.png", "--stats", folder / "t.json"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_EQ(test::read_file(folder / "t.json"), "{\"color\": \"grey\"}");
}

}  // namespace color_map_test
