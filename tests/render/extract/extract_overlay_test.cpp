// SPDX-License-Identifier: MIT
/// The scene's annotations in the image's overlay: colours, ticks and texts.
#include <cmath>

#include "engine/scene/prepare.h"
#include "render/extract/extract_internal.h"
#include "tests/render/support/scene_packet.h"

namespace catena::render::extract_overlay_test {

using test::packet_from, test::scene_from;

/// The texts of a scalar bar's ticks.
std::string ticks_of(double lo, double hi, int count, const std::string& format = "", double linear_below = 0) {
  const ScalarBarTicks scale = make_scalar_bar_ticks(lo, hi, count, format, linear_below);
  std::string all;
  for (const BarTick& tick : scale.ticks) all += (all.empty() ? "" : " ") + tick.text;
  return all + (scale.factor.empty() ? "" : " | " + scale.factor);
}

TEST(BarTicks, AreRoundNumbersWithTheirExponent) {
  EXPECT_EQ(ticks_of(0, 1, 5), "0.0 0.2 0.4 0.6 0.8 1.0");
  EXPECT_EQ(ticks_of(-0.97, 1.1, 5), "−0.5 0.0 0.5 1.0");
  EXPECT_EQ(ticks_of(0, 100, 5), "0 20 40 60 80 100");
  EXPECT_EQ(ticks_of(101325, 101425, 3), "1.0135 1.0140 | ×10⁵");
  EXPECT_EQ(ticks_of(0, 4e-7, 5), "0 1 2 3 4 | ×10⁻⁷");
  EXPECT_EQ(ticks_of(0, 3.1e12, 4), "0 1 2 3 | ×10¹²");
  EXPECT_EQ(ticks_of(0, 1, 3, "%.2f K"), "0.00 K 0.50 K 1.00 K");
  EXPECT_EQ(ticks_of(-1e-3, 1e-3, 3, "%.0e"), "−1e−03 0e+00 1e−03");
  EXPECT_EQ(ticks_of(5, 5, 5), "5");
  EXPECT_TRUE(make_scalar_bar_ticks(0, INFINITY, 5, "").ticks.empty());
}

TEST(BarTicks, OfALogarithmicScaleArePowersOfTen) {
  EXPECT_EQ(ticks_of(1e-3, 1e3, 7, "", 1e-3), "0.001 0.01 0.1 1 10 100 1000");
  EXPECT_EQ(ticks_of(2e-7, 3e5, 5, "", 2e-7), "10⁻⁴ 0.1 100 10⁵") << "every third";
  EXPECT_EQ(ticks_of(2, 60, 5, "", 2), "2 5 10 20 50") << "few decades";
  EXPECT_EQ(ticks_of(1, 1e6, 3, "%.0e", 1), "1e+00 1e+02 1e+04 1e+06");
  EXPECT_EQ(ticks_of(-100, 100, 7, "", 1), "−100 −10 −1 0 1 10 100");
  EXPECT_EQ(ticks_of(-1e6, 10, 5, "", 1), "−10⁶ −1000 −1 0 1");
  EXPECT_EQ(ticks_of(2, 2.9, 3, "", 2), "2.0 2.5") << "less than a decade";
}

TEST(BarTicks, AreWithinTheRangeAtEqualSteps) {
  for (const double lo : {-7.3e5, -1.0, 0.0, 1e-9, 3.3, 1e6})
    for (const double width : {1e-8, 0.37, 1.0, 86.0, 2.2e7})
      for (const int count : {2, 5, 12}) {
        const double hi = lo + width;
        if (!(width > 1e-9 * std::fabs(lo))) continue;
        const ScalarBarTicks scale = make_scalar_bar_ticks(lo, hi, count, "");
        ASSERT_GE(scale.ticks.size(), 1u) << lo << " " << hi;
        ASSERT_LE(scale.ticks.size(), std::size_t(2 * count));
        for (std::size_t i = 0; i < scale.ticks.size(); ++i) {
          EXPECT_GE(scale.ticks[i].value, lo - 1e-8 * width - 1e-15 * std::fabs(lo));
          EXPECT_LE(scale.ticks[i].value, hi + 1e-8 * width + 1e-15 * std::fabs(hi));
          if (i < 2) continue;
          EXPECT_NEAR(scale.ticks[i].value - scale.ticks[i - 1].value, scale.ticks[1].value - scale.ticks[0].value, 1e-6 * width);
        }
      }
}

TEST(ExtractOverlay, ASlicesBarSpansTheRangeOfItsField) {
  const FramePacket packet =
      packet_from(R"({"fields": {"p": {"analytic": "plane", "resolution": 9}, "v": {"analytic": "uniform", "resolution": 9}},
    "slices": [{"field": "v", "axis": "y", "at": 0}, {"field": "p", "axis": "x", "at": 0, "color": [[-1, 0, 0, 1], [1, 1, 0, 0]]}],
    "scalar_bars": [{"slice": 1, "title": "height"}, {"field": "v"}]})");
  ASSERT_EQ(packet.overlay.scalar_bars.size(), 2u);
  const ScalarBarItem& height = packet.overlay.scalar_bars[0];
  EXPECT_EQ(height.title, "height");
  EXPECT_EQ(height.colors, (std::vector<std::array<double, 4>>{{-1, 0, 0, 1}, {1, 1, 0, 0}}));
  // the magnitude of a uniform field is 1 everywhere
  EXPECT_EQ(packet.overlay.scalar_bars[1].title, "v");
  EXPECT_NEAR(packet.overlay.scalar_bars[1].colors.front()[0], 1, 1e-6);
}

TEST(ExtractOverlay, BarsShowTheColorsOfTheirObjects) {
  const FramePacket packet = packet_from(R"({"fields": {"d": {"analytic": "sphere", "resolution": 9}, "v": {"analytic": "circle"}},
    "volumes": [{"field": "d", "color": [[0, 0, 0, 0], [1, 1, 0, 0.5], [2, 1, 1, 1]]}],
    "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0]], "color_by": {"quantity": "speed"}}],
    "scalar_bars": [{"volume": 0}, {"streamlines": 0, "title": "m/s", "position": "bottom", "format": "%.1f"}]})");
  ASSERT_EQ(packet.overlay.scalar_bars.size(), 2u);
  const ScalarBarItem& volume = packet.overlay.scalar_bars[0];
  EXPECT_EQ(volume.colors, packet.volumes[0].transfer.colors);
  EXPECT_EQ(volume.title, "d");
  EXPECT_EQ(volume.side, Side::right);
  ASSERT_EQ(volume.ticks.size(), 5u);
  EXPECT_EQ(volume.ticks[1].value, 0.5);
  EXPECT_EQ(volume.ticks[1].text, "0.5");
  // streamlines with their own range: speeds 0.5 to 1
  const ScalarBarItem& lines = packet.overlay.scalar_bars[1];
  EXPECT_NEAR(lines.colors.front()[0], 0.5, 1e-5);
  EXPECT_NEAR(lines.colors.back()[0], 1, 1e-5);
  EXPECT_EQ(lines.title, "m/s");
  EXPECT_EQ(lines.side, Side::bottom);
  EXPECT_EQ(lines.ticks.at(1).text, "0.6");
}

TEST(ExtractOverlay, ABarShowsTheColorsOfADefaultTransferFunction) {
  const FramePacket packet = packet_from(
      R"({"fields": {"d": {"analytic": "gaussian", "resolution": 17}}, "volumes": [{"field": "d"}], "scalar_bars": [{"field": "d"}]})");
  ASSERT_EQ(packet.overlay.scalar_bars.size(), 1u);
  EXPECT_EQ(packet.overlay.scalar_bars[0].colors, packet.volumes[0].transfer.colors);
}

TEST(ExtractOverlay, TheStatusReportsForcesAndLinks) {
  scene::Scene scene = scene_from(R"({"coupling": {"max_force": 4}, "status": true})");
  EXPECT_FALSE(packet_from(scene).overlay.status) << "no hand, nothing to say";
  HapticState state;
  state.force_n = {0, 3, 4};
  state.link_count = 2;
  state.links[0].active = true;
  state.links[1].status = LinkStatus::released;
  scene::update_cursor(scene, state);
  scene.entities.get<scene::Cursor>(scene.cursor).names = {"curve"};
  const FramePacket packet = packet_from(scene);
  ASSERT_TRUE(packet.overlay.status);
  const StatusItem& status = *packet.overlay.status;
  EXPECT_EQ(status.force_n, 5);
  EXPECT_EQ(status.max_force_n, 4);
  ASSERT_EQ(status.rows.size(), 2u);
  EXPECT_EQ(status.rows[0].name + " " + status.rows[0].status_text, "curve OK");
  EXPECT_TRUE(status.rows[0].is_active);
  EXPECT_EQ(status.rows[1].name + " " + status.rows[1].status_text, "link 2 RELEASED");
  EXPECT_FALSE(status.rows[1].is_active);
}

TEST(ExtractOverlay, TitleLabelsAndMarkerReachTheOverlay) {
  const FramePacket packet = packet_from(R"({"title": "T", "labels": [{"at": [1, 2, 3], "text": "a", "occluded": true}],
    "orientation_marker": {"position": "top-left"}, "overlay": {"scale": 2, "font": "F"}})");
  const Overlay& overlay = packet.overlay;
  ASSERT_EQ(overlay.texts.size(), 1u);
  EXPECT_EQ(overlay.texts[0].text, "T");
  EXPECT_EQ(overlay.texts[0].anchor, Anchor::top);
  ASSERT_EQ(overlay.labels.size(), 1u);
  EXPECT_EQ(overlay.labels[0].position, Vec3(1, 2, 3));
  EXPECT_TRUE(overlay.labels[0].hide_if_occluded);
  ASSERT_TRUE(overlay.orientation_marker);
  EXPECT_EQ(overlay.orientation_marker->anchor, Anchor::top_left);
  EXPECT_EQ(overlay.scale, 2);
  EXPECT_EQ(overlay.font, "F");
  EXPECT_TRUE(packet_from("{}").overlay.empty());
}

}  // namespace catena::render::extract_overlay_test
