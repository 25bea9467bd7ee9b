// SPDX-License-Identifier: MIT
// Edits of the points of a transfer function, without a window.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/base/json_edit.h"
#include "engine/scene/scene.h"
#include "engine/scene/to_json.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::transfer_editing_test {

constexpr PlotTransform kFrame{10, 0, 210, 100, 0, 1};

bool rises(const OpacityPoints& points) {
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(points[i - 1].value < points[i].value)) return false;
  return true;
}

TEST(PlotFrame, PositionsAndValuesAreInverse) {
  for (const double value : {0.0, 0.25, 0.9, 1.0}) EXPECT_NEAR(kFrame.value_at(kFrame.to_x(value)), value, 1e-14);
  for (const double alpha : {0.0, 0.01, 0.5, 1.0}) EXPECT_NEAR(kFrame.alpha_at(kFrame.to_y(alpha)), alpha, 1e-14);
  EXPECT_EQ(kFrame.value_at(-1e9), 0);
  EXPECT_EQ(kFrame.value_at(1e9), 1);
  EXPECT_EQ(kFrame.alpha_at(1e9), 0);
  EXPECT_EQ(kFrame.alpha_at(-1e9), 1);
}

TEST(PlotFrame, AnyRangeBecomesAPlottableRange) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const std::pair<double, double> ranges[] = {{nan, nan}, {nan, 3}, {2, nan}, {0, inf},         {-inf, inf},         {5, 5},
                                              {0, 0},     {-3, -3}, {7, 2},   {1e300, 1.7e308}, {-1.7e308, 1.7e308}, {1, 1 + 1e-15}};
  for (const auto& [lo, hi] : ranges) {
    const auto range = make_plot_range(lo, hi);
    EXPECT_TRUE(std::isfinite(range[1] - range[0]) && range[0] < range[1]) << lo << " " << hi << ": " << range[0] << " " << range[1];
    if (std::isfinite(lo) && std::isfinite(hi) && std::fabs(lo) < 1e300) {
      EXPECT_TRUE(range[0] <= std::max(lo, hi) && range[1] >= std::min(lo, hi));
    }
  }
  EXPECT_EQ(make_plot_range(-1, 2), (std::array<double, 2>{-1, 2}));
}

TEST(PlotFrame, RoundedNumbersAreShortAndClose) {
  EXPECT_EQ(scene::to_json(round_within(0.4234375000001, 0, 1)), "0.4234");
  EXPECT_EQ(scene::to_json(round_within(223.4567, -1000, 3000)), "223");
  EXPECT_EQ(scene::to_json(round_within(1.23456789e-7, 0, 1e-6)), "1.235e-07");
  EXPECT_EQ(round_within(0.3, 5, 5), 0.3);
  EXPECT_EQ(round_within(1e300, 0, 1e-300), 1e300);
}

TEST(PlotFrame, PositionsFollowTheLogarithmicScale) {
  const PlotTransform frame{10, 0, 210, 100, 0.01, 100, 0.01};
  EXPECT_NEAR(frame.to_x(1), 110, 1e-9);
  EXPECT_NEAR(frame.value_at(60), 0.1, 1e-12);
  for (const double x : {10.0, 37.0, 110.0, 210.0}) EXPECT_NEAR(frame.to_x(frame.value_at(x)), x, 1e-9);
  EXPECT_NEAR(frame.rounded_value_at(12) / frame.value_at(12), 1, 0.01) << "small values are not rounded away";
  OpacityPoints points{{0.01, 0}, {0.011, 0.1}, {100, 0.5}};
  move_point(points, frame, 1, 0.02, 0.1);
  EXPECT_EQ(points[1].value, 0.02);
  EXPECT_NEAR(std::log1p(-evaluate_alpha({{0.01, 0}, {100, 0.5}}, 1, 0.01)), 0.5 * std::log1p(-0.5), 1e-12);
  EXPECT_EQ(histogram_bars({0.15f, 0.2f, 1.5f, 50}, 0.01, 100, 4, 0.01),
            (std::vector<float>{0, 1, std::log1p(1.0f) / std::log1p(2.0f), std::log1p(1.0f) / std::log1p(2.0f)}));
}

TEST(TransferEdits, AMappingIsSetWhereTheVolumesValuesAllowIt) {
  scene::Volume volume;
  volume.where.label = "volumes[0]";
  volume.transfer.colors = {{1, {0, 0, 0}}, {100, {1, 1, 1}}};
  volume.transfer.opacities = {{1, 0}, {100, 0.5}};
  const auto edit = test::value_of(make_transfer_edit(volume, 1));
  const auto find = [](const TextEdits& edits, const std::string& end) -> std::string {
    for (const auto& e : edits)
      if (e.pointer.ends_with(end)) return e.value.value_or("removed");
    return "none";
  };
  EXPECT_EQ(find(make_mapping_edits(volume, edit, {scene::ValueMapping::Kind::log, 0}), "/mapping"), "\"log\"");
  EXPECT_EQ(find(make_mapping_edits(volume, edit, {scene::ValueMapping::Kind::symlog, 2}), "/linear_below"), "2");
  EXPECT_EQ(find(make_mapping_edits(volume, edit, {}), "/mapping"), "removed");
  volume.transfer.opacities.front().value = 0;
  EXPECT_TRUE(make_mapping_edits(volume, *make_transfer_edit(volume, 1), {scene::ValueMapping::Kind::log, 0}).empty());
}

TEST(TransferPoints, TheNearestHandleWithinTheRadiusIsFound) {
  const OpacityPoints points{{0, 0}, {0.5, 0.25}, {0.52, 0.25}, {1, 0.5}};
  EXPECT_EQ(find_point(points, kFrame, kFrame.to_x(0.5) - 2, kFrame.to_y(0.25), 8), 1u);
  EXPECT_EQ(find_point(points, kFrame, kFrame.to_x(0.52) + 2, kFrame.to_y(0.25), 8), 2u);
  EXPECT_FALSE(find_point(points, kFrame, kFrame.to_x(0.5), kFrame.to_y(0.25) + 9, 8));
  EXPECT_FALSE(find_point(OpacityPoints{}, kFrame, 0, 0, 8));
  EXPECT_EQ(find_point(ColorPoints{{0, {}}, {1, {}}}, kFrame, 205, 8), 1u);
}

TEST(TransferPoints, APointStaysBetweenItsNeighboursAndWithinThePlot) {
  OpacityPoints points{{0, 0}, {0.5, 0.25}, {1, 0.5}};
  move_point(points, kFrame, 1, 7, 0.3);
  EXPECT_LT(points[1].value, 1);
  EXPECT_GT(points[1].value, 0.999);
  move_point(points, kFrame, 1, -7, 2);
  EXPECT_GT(points[1].value, 0);
  EXPECT_EQ(points[1].alpha, kMaxAlpha);
  move_point(points, kFrame, 0, -7, -1);
  EXPECT_EQ(points[0].value, 0);
  EXPECT_EQ(points[0].alpha, 0);
  move_point(points, kFrame, 2, 7, std::nan(""));
  EXPECT_EQ(points[2].value, 1);
  EXPECT_EQ(points[2].alpha, 0);
  move_point(points, kFrame, 2, std::nan(""), 0.1);
  EXPECT_EQ(points[2].value, 1);
  EXPECT_TRUE(rises(points));
}

TEST(TransferPoints, AHundredPointsAddedAtOneValueStayIncreasing) {
  OpacityPoints points{{0, 0}, {1, 0.5}};
  int refused = 0;
  for (int i = 0; i < 100; ++i)
    if (!add_point(points, kFrame, 0.5, 0.1)) ++refused;
  EXPECT_TRUE(rises(points));
  EXPECT_EQ(points.size() + static_cast<std::size_t>(refused), 102u);
  EXPECT_GT(points.size(), 20u);
  for (std::size_t i = 0; i < points.size(); ++i) move_point(points, kFrame, i, 0.5, 0.2);
  EXPECT_TRUE(rises(points));
  while (remove_point(points, points.size() / 2)) {
  }
  EXPECT_EQ(points.size(), 1u);
}

TEST(TransferPoints, WithoutRoomNoPointIsAddedOrMoved) {
  const double next = std::nextafter(0.5, 1.0);
  OpacityPoints points{{0.5, 0}, {next, 0.5}};
  EXPECT_FALSE(add_point(points, kFrame, next, 0.1));
  EXPECT_FALSE(add_point(points, kFrame, std::nan(""), 0.1));
  EXPECT_EQ(points.size(), 2u);
  points.push_back({std::nextafter(next, 1.0), 0.2});
  move_point(points, kFrame, 1, 0.9, 0.3);
  EXPECT_EQ(points[1].value, next);
  EXPECT_TRUE(rises(points));
}

TEST(TransferPoints, PointsOutsideThePlotAreKept) {
  OpacityPoints points{{-5, 0.1}, {5, 0.2}};
  ASSERT_EQ(add_point(points, kFrame, 0.5, 0.3), 1u);
  move_point(points, kFrame, 1, 3, 0.3);
  EXPECT_TRUE(rises(points));
  EXPECT_EQ(points[0].value, -5);
  EXPECT_EQ(points[2].value, 5);
  points = {{2, 0.1}, {3, 0.2}};
  move_point(points, kFrame, 1, 0.5, 0.2);
  EXPECT_TRUE(rises(points));
}

TEST(TransferPoints, ExtinctionIsLinearBetweenPoints) {
  const OpacityPoints points{{0, 0.1}, {1, 0.9}};
  const double half = 1 - std::exp(0.5 * (std::log(0.9) + std::log(0.1)));
  EXPECT_NEAR(evaluate_alpha(points, 0.5), half, 1e-12);
  EXPECT_DOUBLE_EQ(evaluate_alpha(points, -1), 0.1);
  EXPECT_DOUBLE_EQ(evaluate_alpha(points, 2), 0.9);
  EXPECT_EQ(evaluate_alpha({}, 2), 0);
  EXPECT_FLOAT_EQ(evaluate_color({{0, {0, 0, 1}}, {2, {1, 0, 0}}}, 0.5).r, 0.25f);
  EXPECT_FLOAT_EQ(evaluate_color({{0, {0, 0, 1}}}, 0.5).b, 1);
}

TEST(TransferPoints, ANewColourPointHasTheInterpolatedColour) {
  ColorPoints points{{0, {0, 0, 1}}, {1, {1, 0, 0}}};
  ASSERT_EQ(add_point(points, kFrame, 0.25), 1u);
  EXPECT_FLOAT_EQ(points[1].color.r, 0.25f);
  EXPECT_FLOAT_EQ(points[1].color.b, 0.75f);
}

TEST(TransferPoints, FittingToARangeMovesAllPointsOrNone) {
  ColorPoints colors{{0, {}}, {2, {}}};
  OpacityPoints opacities{{1, 0.1}, {4, 0.2}};
  ASSERT_TRUE(fit_to_range(colors, opacities, 10, 12));
  EXPECT_EQ(colors[1].value, 11);
  EXPECT_EQ(opacities[0].value, 10.5);
  EXPECT_FALSE(fit_to_range(colors, opacities, 3, 3));
  EXPECT_FALSE(fit_to_range(colors, opacities, 3, std::nan("")));
  EXPECT_FALSE(fit_to_range(colors, opacities, 1, std::nextafter(1.0, 2.0))) << "they would fall together";
  EXPECT_EQ(colors[1].value, 11);
}

TEST(Pointers, AreJsonPointersOfListItems) {
  const auto root = json::parse("{\"volumes\": [{\"a\": [[1, \"x\\\"y\"], null, true]}, 5]}", "s.json");
  ASSERT_TRUE(root);
  EXPECT_EQ(item_pointer(root->find("volumes")->items[1]), "/volumes/1");
  EXPECT_EQ(item_pointer(*root), "");
  EXPECT_EQ(item_pointer(*root->find("volumes")), "");
  EXPECT_EQ(item_pointer(json::Node{}), "");
  EXPECT_EQ(json::serialize_node(*root), "{\"volumes\": [{\"a\": [[1, \"x\\\"y\"], null, true]}, 5]}");
}

/// A document with one volume of a small sphere, resolved as for rendering.
class EditedVolume : public testing::Test {
 protected:
  void open(const std::string& keys, const std::string& transfer_file = {}) {
    if (!transfer_file.empty()) test::write_file(folder_ / "t.json", transfer_file);
    open_text("{\"fields\": {\"ball\": {\"analytic\": \"sphere\", \"resolution\": 17}},\n \"volumes\": [{\"field\": \"ball\"" + keys +
              "}]}\n");
  }
  void open_text(const std::string& text) {
    test::write_file(folder_ / "s.json", text);
    auto document = test::value_of(scene::Document::open(folder_ / "s.json"));
    document_ = std::move(document);
    read();
  }
  void read() {
    auto scene = test::value_of(document_->read());
    scene_ = std::move(scene);
    const scene::Entity field = scene::find_field(scene_, "ball");
    const auto drawn = test::value_of(scene::resolve_rendered_field(scene_, field, {}));
    edge_ = drawn.get()->mapping().min_voxel_edge();
    scene_.entities.each<scene::Volume>([&](scene::Entity, const scene::Volume& volume) { volume_ = volume; });
    const auto edit = test::value_of(make_transfer_edit(volume_, edge_));
    edit_ = edit;
  }
  void apply(const TextEdits& edits) {
    const Outcome done = document_->apply(edits, "test");
    ASSERT_TRUE(done) << done.error().message;
    read();
  }
  /// The extinction at a value.
  double sigma_at(double value) const {
    const auto& t = volume_.transfer;
    const double unit = t.opacities.empty() || t.opacity_unit > 0 ? t.opacity_unit : edge_;
    if (!t.opacities.empty()) return -std::log1p(-evaluate_alpha(t.opacities, value)) / unit;
    for (std::size_t i = 1; i < t.extinctions.size(); ++i)
      if (value <= t.extinctions[i].value) {
        const auto &a = t.extinctions[i - 1], &b = t.extinctions[i];
        return std::lerp(a.sigma, b.sigma, std::clamp((value - a.value) / (b.value - a.value), 0.0, 1.0));
      }
    return t.extinctions.back().sigma;
  }
  std::vector<double> sigmas() const {
    std::vector<double> all;
    for (double v = 0; v < 3.5; v += 0.1) all.push_back(sigma_at(v));
    return all;
  }
  void expect_same(const std::vector<double>& before) {
    const auto after = sigmas();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-9 * (1 + before[i])) << i;
  }
  test::TemporaryFolder folder_;
  std::optional<scene::Document> document_;
  scene::Scene scene_;
  scene::Volume volume_;
  TransferEdit edit_;
  double edge_ = 0;
};

TEST_F(EditedVolume, AutomaticOpacitiesBecomeEqualStatedPoints) {
  open("");
  const auto before = sigmas();
  const ColorPoints colors = edit_.colors;
  double max_alpha = 0;
  for (const auto& p : edit_.opacities) max_alpha = std::max(max_alpha, p.alpha);
  EXPECT_NEAR(max_alpha, 0.6, 0.02);
  apply(make_opacity_edits(volume_, edit_));
  EXPECT_TRUE(volume_.transfer.extinctions.empty());
  EXPECT_EQ(volume_.transfer.opacities.size(), edit_.opacities.size());
  ASSERT_EQ(volume_.transfer.colors.size(), colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    EXPECT_EQ(volume_.transfer.colors[i].value, colors[i].value);
    EXPECT_EQ(volume_.transfer.colors[i].color.g, colors[i].color.g);
  }
  expect_same(before);
  // A second edit changes one key only.
  EXPECT_EQ(make_opacity_edits(volume_, edit_).size(), 1u);
}

TEST_F(EditedVolume, AnEditedFileKeepsItsOpacitiesAndGradientFactors) {
  open(
      ", \"transfer\": \"t.json\", \"range\": [0.5, 3] // mine\n",
      R"({"color": [[0, 1, 0, 0], [1, 0, 0.1, 0.3]], "opacity": [[0, 0.02], [0.5, 0.9999999], [1, 0.3]], "gradient_opacity": [[0, 0.1], [2, 1]]})");
  const auto before = sigmas();
  apply(make_color_edits(volume_, edit_));
  expect_same(before);
  EXPECT_TRUE(volume_.transfer.file.empty());
  ASSERT_EQ(volume_.transfer.gradient_factors.size(), 2u);
  EXPECT_EQ(volume_.transfer.gradient_factors[0].factor, 0.1);
  EXPECT_EQ(volume_.transfer.colors[1].color.b, 0.3f);
  EXPECT_EQ(volume_.transfer.opacities[1].alpha, 0.9999999) << "points that are not touched are not clamped";
  EXPECT_NE(document_->text().find("// mine"), std::string::npos);
}

TEST_F(EditedVolume, StatedExtinctionsBecomeEqualOpacities) {
  open(", \"extinction\": [[0, 0], [1, 250], [2, 4]], \"color\": \"viridis\"");
  const auto before = sigmas();
  apply(make_opacity_edits(volume_, edit_));
  expect_same(before);
  EXPECT_EQ(volume_.transfer.named.map, "viridis") << "the colours keep their name";
}

TEST_F(EditedVolume, PointsAreWrittenAndReadBackExactly) {
  open(", \"color\": [[0, 0, 0, 0], [3, 1, 1, 1]], \"opacity\": [[0, 0], [3, 0.5]]");
  for (int i = 0; i < 100; ++i) {
    edit_.opacities.insert(edit_.opacities.end() - 1, {0.01 * i + 0.0123456789, std::fabs(std::sin(i)) * 0.99});
    edit_.colors.insert(edit_.colors.end() - 1, {0.02 * i + 1 / 3.0, {static_cast<float>(i) / 101.0f, 0.1f, 1.0f / 3.0f}});
  }
  const TransferEdit wanted = edit_;
  apply(make_opacity_edits(volume_, wanted));
  apply(make_color_edits(volume_, wanted));
  ASSERT_EQ(edit_.opacities.size(), 102u);
  ASSERT_EQ(edit_.colors.size(), 102u);
  for (std::size_t i = 0; i < 102; ++i) {
    EXPECT_EQ(edit_.opacities[i].value, wanted.opacities[i].value);
    EXPECT_EQ(edit_.opacities[i].alpha, wanted.opacities[i].alpha);
    EXPECT_EQ(edit_.colors[i].color.r, wanted.colors[i].color.r);
    EXPECT_EQ(edit_.colors[i].color.b, wanted.colors[i].color.b);
  }
  EXPECT_EQ(edit_.opacity_unit, edge_) << "an unstated unit stays unstated";
  EXPECT_EQ(document_->text().find("opacity_unit"), std::string::npos);
}

TEST_F(EditedVolume, ANamedMapTakesTheRangeOfThePreviousColours) {
  open(", \"color\": [[0.5, 0, 0, 0], [2.5, 1, 1, 1]], \"opacity\": [[0, 0], [3, 0.5]], \"opacity_unit\": 0.5");
  apply(make_color_map_edits(volume_, edit_, "cividis_r"));
  EXPECT_EQ(edit_.color_map, "cividis_r");
  ASSERT_TRUE(volume_.transfer.named.range);
  EXPECT_EQ(*volume_.transfer.named.range, (std::array<double, 2>{0.5, 2.5}));
  apply(make_color_map_edits(volume_, edit_, "magma"));
  EXPECT_EQ(*volume_.transfer.named.range, (std::array<double, 2>{0.5, 2.5}));
  apply(make_range_edits(volume_, edit_, 0, 6));
  EXPECT_EQ(edit_.opacities.back().value, 6);
  EXPECT_EQ(*volume_.transfer.named.range, (std::array<double, 2>{1, 5}));
  // The map is converted to points.
  const ColorPoints shown = edit_.colors;
  apply(make_color_edits(volume_, edit_));
  EXPECT_TRUE(edit_.color_map.empty());
  EXPECT_EQ(edit_.colors.size(), shown.size());
  EXPECT_EQ(document_->text().find("range"), std::string::npos);
  EXPECT_TRUE(make_range_edits(volume_, edit_, 3, 3).empty());
}

TEST_F(EditedVolume, AConstantFieldHasOnePointAndCanBeEdited) {
  open_text(R"({"fields": {"ball": {"analytic": "constant", "resolution": 5}}, "volumes": [{"field": "ball"}]})");
  ASSERT_EQ(edit_.opacities.size(), 1u);
  const auto range = make_plot_range(edit_.opacities[0].value, edit_.opacities[0].value);
  const PlotTransform frame{0, 0, 100, 100, range[0], range[1]};
  ASSERT_TRUE(add_point(edit_.opacities, frame, range[0], 0.5));
  apply(make_opacity_edits(volume_, edit_));
  EXPECT_EQ(edit_.opacities.size(), 2u);
}

}  // namespace catena::app::transfer_editing_test
