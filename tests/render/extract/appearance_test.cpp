// SPDX-License-Identifier: MIT
/// Projections, colours by another field, and jitter in the packet.
#include "tests/render/support/scene_packet.h"

namespace catena::render::appearance_test {

const std::string kFields = R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}, "t": {"analytic": "torus", "resolution": 9},
                                           "v": {"analytic": "circle"}},)";

TEST(ExtractAppearance, AppearanceKeysReachThePacket) {
  const FramePacket packet = test::packet_from(kFields + R"("jitter": false,
    "volumes": [{"field": "s", "projection": "minimum", "opacity": [[0, 0], [1, 0.5]], "opacity_unit": 0.25}],
    "isosurfaces": [{"field": "s", "level": 1, "color_by": {"field": "t", "color": [[0, 1, 0, 0], [0.5, 0, 0, 1]]}},
                    {"field": "s", "level": 1.5, "opacity": 0.5, "color_by": {"field": "t"}}]})");
  EXPECT_EQ(packet.jitter, false);
  ASSERT_EQ(packet.volumes.size(), 1u);
  EXPECT_EQ(packet.volumes[0].projection, Projection::minimum);
  EXPECT_EQ(packet.volumes[0].transfer.opacity_length, 0.25);
  EXPECT_FALSE(packet.volumes[0].color_by);
  ASSERT_EQ(packet.isosurfaces.size(), 2u);
  const IsosurfaceItem& stated = packet.isosurfaces[0];
  ASSERT_TRUE(stated.color_by);
  EXPECT_NE(stated.color_by->grid, stated.grid);
  EXPECT_EQ(stated.color_by->colors[1], (std::array<double, 4>{0.5, 0, 0, 1}));
  // default: viridis over all values of the other field
  const IsosurfaceItem& unstated = packet.isosurfaces[1];
  ASSERT_TRUE(unstated.color_by);
  EXPECT_DOUBLE_EQ(unstated.color_by->colors.front()[0], unstated.color_by->grid->min_value());
  EXPECT_DOUBLE_EQ(unstated.color_by->colors.back()[0], unstated.color_by->grid->max_value());
}

TEST(ExtractAppearance, AVectorFieldForColorsIsRefused) {
  const std::string error = test::packet_error(kFields + "\n" + R"("volumes": [{"field": "s", "color_by": {"field": "v"}}]})");
  EXPECT_NE(error.find("is a vector field"), std::string::npos) << error;
  EXPECT_EQ(error.find("s.json:"), 0u);
}

}  // namespace catena::render::appearance_test
