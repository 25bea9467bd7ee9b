// SPDX-License-Identifier: MIT
// Default ranges of colours, contours, lines and glyphs in the packet are equal with and without an outlier.
#include <cmath>

#include "engine/io/volume/load_field.h"
#include "tests/render/support/scene_packet.h"
#include "tests/support/support.h"

namespace catena::render::outliers_test {

constexpr int kSize = 24;

void write(const std::string& path, bool spoiled) {
  std::vector<float> values, vectors;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const bool outlier = spoiled && x == 3 && y == 20 && z == 21;
        values.push_back(outlier ? 1e20f : std::sin(0.2f * static_cast<float>(x)) + 0.01f * static_cast<float>(y));
        vectors.insert(vectors.end(), {outlier ? 1e20f : 1 + 0.05f * static_cast<float>(z), 0.02f * static_cast<float>(x), 0});
      }
  const field::AnyField s{field::make_scalar_grid("s", {}, {kSize, kSize, kSize}, values), nullptr},
      v{nullptr, field::make_vector_grid("v", {}, {kSize, kSize, kSize}, vectors)};
  ASSERT_TRUE(field::write_vdb(path, {{s, "s"}, {v, "v"}}));
}

constexpr const char* kScene = R"({"fields": {"s": {"file": "f.vdb", "grid": "s"}, "v": {"file": "f.vdb", "grid": "v"}},
  "volumes": [{"field": "s", "color": "viridis"}],
  "isosurfaces": [{"field": "s", "level": 0.5, "color_by": {"field": "s"}}],
  "slices": [{"field": "s", "axis": "z", "at": 10, "contours": {"count": 4}}, {"field": "v", "axis": "y", "at": 10}],
  "streamlines": [{"field": "v", "seeds": [[1, 5, 5], [3, 19.5, 20.6]], "color_by": {"quantity": "speed"}}],
  "glyphs": [{"field": "v", "on": {"box": {"min": [0, 0, 0], "max": [23, 23, 23]}}, "spacing": 3, "color_by": {"quantity": "speed"}}],
  "scalar_bars": [{"streamlines": 0}, {"glyphs": 0}, {"slice": 1}, {"volume": 0}]})";

struct Ranges {
  std::vector<std::vector<std::array<double, 4>>> bars;
  std::vector<double> levels, lengths;
};

Ranges ranges_of(bool spoiled) {
  const test::TemporaryFolder folder;
  write(folder / "f.vdb", spoiled);
  const FramePacket packet = test::packet_from(kScene, folder / "s.json", 64, 48);
  Ranges ranges;
  for (const auto& bar : packet.overlay.scalar_bars) ranges.bars.push_back(bar.colors);
  ranges.levels = packet.slices[0].contour_levels;
  for (const Glyph& glyph : packet.glyphs[0].glyphs.list()) ranges.lengths.push_back(norm(glyph.tip - glyph.tail));
  return ranges;
}

TEST(Outliers, DoNotChangeDefaultRanges) {
  const Ranges clean = ranges_of(false), spoiled = ranges_of(true);
  ASSERT_EQ(clean.bars.size(), 4u);
  ASSERT_EQ(spoiled.bars.size(), clean.bars.size());
  for (std::size_t i = 0; i < clean.bars.size(); ++i) {
    ASSERT_FALSE(clean.bars[i].empty() || spoiled.bars[i].empty()) << i;
    // lines that start beside the outlier end there and are shorter
    const double near = i == 0 ? 0.1 : 0.02;
    EXPECT_NEAR(spoiled.bars[i].front()[0], clean.bars[i].front()[0], near) << i;
    EXPECT_NEAR(spoiled.bars[i].back()[0], clean.bars[i].back()[0], near) << i;
  }
  ASSERT_EQ(clean.levels.size(), 4u);
  ASSERT_EQ(spoiled.levels.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(spoiled.levels[i], clean.levels[i], 1e-6);
  ASSERT_EQ(spoiled.lengths.size(), clean.lengths.size());
  for (std::size_t i = 0; i < clean.lengths.size(); ++i) EXPECT_LE(spoiled.lengths[i], 3 + 1e-6);
  EXPECT_NEAR(spoiled.lengths.front(), clean.lengths.front(), 0.1);
}

}  // namespace catena::render::outliers_test
