// SPDX-License-Identifier: MIT
/// Color maps in the program: a ramp of values shows the map, and data files have the requested colors.
#include "engine/scene/color_maps.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::color_map_test {

using render::Image8;

class ColorMapTest : public test::ProgramInFolder {
 protected:
  /// Renders to o.png, and copies the image to the build folder, for review.
  Image8 draw(const std::string& more, const std::string& keep) {
    Image8 picture = drawn(more);
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-" + keep + ".png", picture, false));
    std::filesystem::remove(folder_ / "o.png");
    return picture;
  }
};
using ColorMapImage = ColorMapTest;
using ColorMapProgram = ColorMapTest;

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

TEST_F(ColorMapImage, ARampShowsTheMapInOrder) {
  const std::pair<const char*, std::vector<Entry>> maps[] = {
      {"viridis", {{26, {72.0, 37.2, 117.7}}, {77, {52.3, 95.8, 141.2}}, {128, {32.5, 144.6, 140.4}}, {203, {119.4, 208.8, 82.6}}}},
      {"inferno", {{26, {23.7, 11.6, 59.8}}, {77, {107.7, 23.6, 110.3}}, {128, {187.6, 55.1, 84.2}}, {203, {251.8, 162.7, 8.9}}}},
      {"grey", {{26, {26, 26, 26}}, {77, {77, 77, 77}}, {128, {128, 128, 128}}, {203, {203, 203, 203}}}}};
  for (const auto& [name, entries] : maps) {
    write("s.json", ramp("\"color\": \"" + std::string(name) + "\""));
    const Image8 picture = draw("{s.json} --size 64x256 --quality reference", std::string("ramp-") + name);
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
      const double expected[] = {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(32, y)[c], 255 * expected[c], 2) << name << " row " << y;
    }
  }
}

TEST_F(ColorMapImage, ARangeMapsANamedMapAndATransferFileAlike) {
  write("s.json", ramp(R"("color": "grey", "range": [-1, 1])"));
  write("t.json", R"([{"RGBPoints": [0, 0, 0, 0, 8, 1, 1, 1], "Points": [0, 1, 0.5, 0, 8, 1, 0.5, 0]}])");
  std::string by_file = ramp(R"("transfer": "t.json", "opacity_unit": 0.005, "range": [-1, 1])");
  by_file.erase(by_file.find("\"extinction\""), std::string("\"extinction\": [[0, 1000]], ").size());
  write("f.json", by_file);
  const Image8 named = draw("{s.json} --size 64x128 --quality reference", "ramp-range");
  const Image8 filed = draw("{f.json} --size 64x128 --quality reference", "ramp-file");
  for (std::uint32_t y = 1; y < 127; ++y) {
    const double z = 2 - 4 * (y + 0.5) / 128, grey = 255 * std::min(1.0, std::max(0.0, 0.5 + 0.5 * z));
    EXPECT_NEAR(named.pixel(32, y)[0], grey, 2) << y;
    EXPECT_NEAR(filed.pixel(32, y)[1], grey, 2) << y;
  }
}

TEST_F(ColorMapProgram, ListsItsMaps) {
  test::expect_parts(succeed("info --colormaps").out,
                     {"viridis\n", "cividis\n", "inferno\n", "magma\n", "plasma\n", "cool-warm\n", "grey\n", "viridis_r\n"});
}

TEST_F(ColorMapProgram, DataFilesHaveTheRequestedColours) {
  succeed("generate gaussian -o {g.vdb} --resolution 24");
  const Image8 plain = draw("{g.vdb} --size 64x48", "bare");
  const Image8 red = draw("{g.vdb} --size 64x48 --colormap grey --range 0 1", "bare-grey");
  // A note after rendering states the chosen presentation and the reason.
  const std::string note = "\"gaussian\" looks like a simulation: ";
  test::expect_parts(run("render {g.vdb} -o {note.png} --size 16x12").err, {note});
  test::expect_parts(run("info {g.vdb}").out, {note});
  EXPECT_NE(plain.rgba, red.rgba);
  const auto bluer = [](const Image8& picture, std::uint32_t x, std::uint32_t y) {
    return int(picture.pixel(x, y)[2]) - int(picture.pixel(x, y)[0]);
  };
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) EXPECT_NEAR(bluer(red, x, y), 0, 1) << "grey all over";
  EXPECT_GT(red.pixel(32, 24)[0], red.pixel(1, 1)[0] + 30);
  int greener = 0;
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) greener = std::max(greener, int(plain.pixel(x, y)[1]) - int(plain.pixel(x, y)[0]));
  EXPECT_GT(greener, 20) << "not grey without the map";
  const Image8 clear = draw("{g.vdb} --size 64x48 --opacity -1,0,2,0", "clear"),
               dense = draw("{g.vdb} --size 64x48 --opacity 0,0,0.5,0.9", "dense");
  EXPECT_EQ(std::memcmp(clear.pixel(32, 24), clear.pixel(1, 1), 4), 0) << "alpha 0 everywhere";
  EXPECT_NE(std::memcmp(dense.pixel(32, 24), dense.pixel(1, 1), 4), 0);
  // Lines are colored by speed.
  succeed("generate circle -o {c.vdb} --resolution 16");
  const Image8 lines = draw("{c.vdb} --size 64x48 --colormap grey_r", "bare-lines");
  bool any = false;
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) {
      any = any || lines.pixel(x, y)[0] > 60;
      EXPECT_NEAR(bluer(lines, x, y), 6.5, 7.5);
    }
  EXPECT_TRUE(any);
}

TEST_F(ColorMapProgram, RefusesBadMapsAndRangesAndScenes) {
  succeed("generate gaussian -o {g.vdb} --resolution 8");
  succeed("generate circle -o {c.vdb} --resolution 8");
  write("s.json", "{}");
  write("t.json", "{\n\"color\": \"jett\"}");
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("f.json", R"({"fields": {"s": {"analytic": "sphere", "resolution": 8}}, "volumes": [{"field": "s", "transfer": "t.json"}]})");
  const std::pair<const char*, const char*> bad[] = {{"{g.vdb} --opacity 0,0,1", "pairs of a rising value and an alpha"},
                                                     {"{g.vdb} --opacity 1,0,0,1", "pairs of a rising value and an alpha"},
                                                     {"{g.vdb} --opacity 0,0,1,2", "pairs of a rising value and an alpha"},
                                                     {"{g.vdb} --preset ct-bon", "did you mean \"ct-bone\"?"},
                                                     {"{c.vdb} --preset mr", "a scalar field was expected"},
                                                     {"{s.json} --preset mr", "a scene states its colours"},
                                                     {"{g.vdb} --colormap virdis", "did you mean \"viridis\"?"},
                                                     {"{g.vdb} --range 1 0", "two increasing numbers LO HI were expected"},
                                                     {"{g.vdb} --range a 0", "two increasing numbers LO HI were expected"},
                                                     {"{g.vdb} --range 1", "--range"},
                                                     {"{s.json} --colormap viridis", "a scene states its colours"},
                                                     {"{m.obj} --colormap viridis", "a mesh has no values"},
                                                     {"{f.json}", "t.json:2: "}};
  for (const auto& [more, part] : bad) expect_refused("render " + std::string(more) + " -o {o.png}", {part});
}

}  // namespace catena::color_map_test
