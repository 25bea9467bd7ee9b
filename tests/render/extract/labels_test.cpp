// SPDX-License-Identifier: MIT
/// Label maps in a packet: colours, legend, hidden labels, order of coplanar slices.
#include "tests/render/support/scene_packet.h"
#include "tests/support/support.h"

namespace catena::render::labels_test {

/// 26^3 voxels with label x: labels 1 to 25 and 0; labels 1 to 20 have twice as many voxels as 21 to 25.
class LabelPacket : public testing::Test {
 protected:
  FramePacket packet_of(const std::string& parts) {
    std::string bytes, names, values;
    for (int z = 0; z < 26; ++z)
      for (int y = 0; y < 26; ++y)
        for (int x = 0; x < 26; ++x) bytes += static_cast<char>(z < (x < 21 ? 26 : 13) ? x : 0);
    test::write_file(folder_ / "m.raw", bytes);
    return test::packet_from(R"({"fields": {"m": {"file": "m.raw", "shape": [26, 26, 26], "type": "uint8",
        "labels": {"values": [1, 2], "names": ["one", "a name that is far too long for a legend"], "colors": [[1, 0, 0], [0, 1, 0]]}},
        "all": {"label": "*", "of": "m"}, "ball": {"analytic": "sphere", "box": [-2, 30]}}, )" +
                                 parts + "}",
                             folder_ / "s.json");
  }
  test::TemporaryFolder folder_;
};

TEST_F(LabelPacket, TheLegendListsTheTwentyLargestLabels) {
  const FramePacket packet =
      packet_of(R"("isosurfaces": [{"field": "all", "level": 0.5, "color_by": {"field": "m"}}], "scalar_bars": [{"field": "m"}])");
  ASSERT_EQ(packet.overlay.scalar_bars.size(), 1u);
  const ScalarBarItem& bar = packet.overlay.scalar_bars[0];
  EXPECT_EQ(bar.band_count, 20);
  EXPECT_EQ(bar.overflow_text, "and 5 more");
  ASSERT_EQ(bar.ticks.size(), 20u);
  EXPECT_EQ(bar.ticks.back().text, "one") << "numbers rise from above";
  EXPECT_EQ(bar.ticks[18].text, "a name that is f…a legend");
  EXPECT_EQ(bar.ticks[17].text, "3");
  EXPECT_EQ(bar.colors.back(), (std::array<double, 4>{20, 1, 0, 0}));
  ASSERT_TRUE(packet.isosurfaces[0].color_by);
  EXPECT_TRUE(packet.isosurfaces[0].color_by->is_categorical);
  EXPECT_TRUE(packet.isosurfaces[0].color_by->spread_labels) << "the surface is that of the labels";
}

TEST_F(LabelPacket, ASurfaceMayBeColoredByLabels) {
  const FramePacket packet = packet_of(R"("isosurfaces": [{"field": "ball", "level": 5, "color_by": {"field": "m"}}])");
  EXPECT_TRUE(packet.isosurfaces.at(0).color_by->is_categorical);
  EXPECT_FALSE(packet.isosurfaces.at(0).color_by->spread_labels);
}

TEST_F(LabelPacket, OfTwoSlicesInOnePlaneTheLaterIsOnTop) {
  const FramePacket packet =
      packet_of(R"("slices": [{"field": "ball", "axis": "z", "at": 4}, {"field": "m", "axis": "z", "at": 4, "opacity": 0.5},
                 {"field": "m", "point": [3, 1, 4], "normal": [0, 0, -2]}, {"field": "m", "axis": "z", "at": 5}])");
  ASSERT_EQ(packet.slices.size(), 4u);
  const int wanted[] = {0, 1, 2, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(packet.slices[i].stack_order, wanted[i]) << i;
    EXPECT_EQ(packet.slices[i].hidden_label, i == 0 ? std::nullopt : std::optional(0.0)) << i;
  }
}

TEST_F(LabelPacket, AVolumeHasTheLabelsColors) {
  const FramePacket packet = packet_of(R"("volumes": [{"field": "m"}])");
  const TransferTable& table = packet.volumes.at(0).transfer;
  EXPECT_TRUE(table.is_categorical);
  ASSERT_EQ(table.colors.size(), 50u);
  EXPECT_EQ(table.colors[0], (std::array<double, 4>{0.5, 1, 0, 0}));
  EXPECT_EQ(interpolate_piecewise(table.extinctions, 0, 1), 0);
  EXPECT_GT(interpolate_piecewise(table.extinctions, 1, 1), 0);
}

}  // namespace catena::render::labels_test
