// SPDX-License-Identifier: MIT
// Items that the panels add to a scene, levels shared by surfaces and links, and the values of histograms.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/edit/label_opacity.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/document.h"
#include "render/extract/extract.h"
#include "tests/support/nifti_file.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::scene_items_test {

TEST(Histogram, BarsCountEveryValueOnceIncludingBothEnds) {
  const std::vector<float> sorted{0, 0, 0.5f, 1, 1, 1, 2};
  const auto bars = histogram_bars(sorted, 0, 1, 2);
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_FLOAT_EQ(bars[1], 1) << "0.5, 1, 1, 1";
  EXPECT_FLOAT_EQ(bars[0], std::log1p(2.0f) / std::log1p(4.0f));
  EXPECT_EQ(histogram_bars(sorted, 3, 4, 2), (std::vector<float>{0, 0}));
  EXPECT_EQ(histogram_bars({}, 0, 1, 2), (std::vector<float>{0, 0}));
  EXPECT_EQ(histogram_bars(sorted, 1, 1, 2), (std::vector<float>{0, 0}));
  EXPECT_EQ(histogram_bars(sorted, std::nan(""), 1, 2), (std::vector<float>{0, 0}));
  EXPECT_TRUE(histogram_bars(sorted, 0, 1, 0).empty());
  EXPECT_EQ(quantile_of_sorted(sorted, 0.5), 1);
  EXPECT_EQ(quantile_of_sorted({}, 0.5), 0);
}

constexpr const char* kFields =
    R"({"fields": {"ball": {"analytic": "sphere", "resolution": 17}, "flow": {"analytic": "circle", "resolution": 17},
                   "flat": {"analytic": "constant", "resolution": 5}, "exact": {"analytic": "torus"}},
        "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1.25},
                  {"name": "other", "type": "isosurface", "field": "exact", "level": 1.25},
                  {"name": "deep", "type": "isosurface", "field": "ball", "level": 0.5}],
        "isosurfaces": [{"field": "ball", "level": 1.25}, {"field": "ball", "level": 1}]})";

class EditedScene : public testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "s.json", kFields);
    auto document = test::value_of(scene::Document::open(folder_ / "s.json"));
    document_ = std::move(document);
    auto scene = test::value_of(document_->read());
    scene_ = std::move(scene);
  }
  SortedSamples values_of(scene::Entity field) {
    SortedSamples values;
    for (int i = 0; i < 2000 && !values; ++i) {
      values = values_.find_or_request(scene_, field);
      if (!values) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return values;
  }
  test::TemporaryFolder folder_;
  std::optional<scene::Document> document_;
  scene::Scene scene_;
  HistogramCache values_;
};

TEST_F(EditedScene, HistogramValuesAreCachedUntilTheirFieldIsRemoved) {
  const scene::Entity ball = scene::find_field(scene_, "ball"), flow = scene::find_field(scene_, "flow");
  EXPECT_EQ(values_.find_or_request(scene_, ball), nullptr) << "nothing is loaded";
  EXPECT_FALSE(values_.is_busy());
  ASSERT_TRUE(scene::resolve_rendered_field(scene_, ball, {}));
  ASSERT_TRUE(scene::resolve_rendered_field(scene_, flow, {}));
  const SortedSamples of_ball = values_of(ball), of_flow = values_of(flow);
  ASSERT_TRUE(of_ball && of_flow);
  EXPECT_EQ(of_ball->size(), 17u * 17 * 17);
  EXPECT_TRUE(std::is_sorted(of_flow->begin(), of_flow->end()));
  EXPECT_NEAR(of_flow->back(), 2 * std::sqrt(2.0), 1e-6) << "the magnitude in the corner";
  EXPECT_EQ(values_.find_or_request(scene_, ball), of_ball);
  EXPECT_EQ(values_.find_or_request(scene_, flow), of_flow);
  values_.prune(scene::Scene());
  EXPECT_EQ(values_.find_or_request(scene_, flow), nullptr) << "made anew";
}

TEST_F(EditedScene, EveryPresentationOfAFieldIsDrawn) {
  int items = 0;
  for (const char* name : {"ball", "flow", "flat", "exact"}) {
    const auto drawn = test::value_of(scene::resolve_rendered_field(scene_, scene::find_field(scene_, name), {}));
    for (const ShowAs as : {ShowAs::volume, ShowAs::isosurface, ShowAs::slice, ShowAs::streamlines, ShowAs::glyphs}) {
      if (!can_show(drawn, as)) continue;
      ++items;
      const Outcome done = document_->apply(make_item_edits(scene_, scene::find_field(scene_, name), drawn, as, {}), to_string(as));
      ASSERT_TRUE(done) << name << " as " << to_string(as) << ": " << done.error().message;
    }
  }
  EXPECT_EQ(items, 3 + 3 + 3 + 3);
  auto scene = test::value_of(document_->read());
  const auto packet = test::value_of(render::make_frame(scene, 32, 32));
  EXPECT_EQ(packet.volumes.size(), 3u);
  EXPECT_EQ(packet.isosurfaces.size(), 2u + 3);
  EXPECT_EQ(packet.slices.size(), 4u);
  int colored = 0;
  scene.entities.each<scene::Slice>(
      [&](scene::Entity, const scene::Slice& slice) { colored += slice.color_by.named.map == scene::kDefaultLineColorMap; });
  EXPECT_GE(colored, 3) << "slices that were added state their colour map";
  EXPECT_GT(packet.tubes.size(), 20u);
  ASSERT_EQ(packet.glyphs.size(), 1u);
  EXPECT_GT(packet.glyphs[0].glyphs.size(), 100u) << "on the first slice";
}

TEST_F(EditedScene, LinkLevelsOfASurfaceHaveItsFieldAndLevel) {
  std::vector<std::vector<std::string>> link_levels;
  scene_.entities.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    link_levels.push_back(find_link_levels(scene_, entity_name(scene_, surface.field), surface.level));
  });
  ASSERT_EQ(link_levels.size(), 2u);
  EXPECT_EQ(link_levels[0], std::vector<std::string>{"/chain/0/level"}) << "not the other field's, not the other level's";
  EXPECT_TRUE(link_levels[1].empty());
}

TEST_F(EditedScene, ANewIsosurfaceHasTheLevelOfTheFirstLink) {
  const auto drawn = test::value_of(scene::resolve_rendered_field(scene_, scene::find_field(scene_, "ball"), {}));
  const std::string level = first_link_level(scene_, "ball");
  EXPECT_EQ(level, "1.25") << "the first link's";
  EXPECT_EQ(*make_item_edits(scene_, scene::find_field(scene_, "ball"), drawn, ShowAs::isosurface, {}).front().value,
            R"({"field": "ball", "level": 1.25})");
  EXPECT_TRUE(first_link_level(scene_, "flow").empty());
  auto without_links = test::value_of(scene::parse_scene(R"({"fields": {"ball": {"analytic": "sphere"}}})", "s.json"));
  const std::string item =
      *make_item_edits(without_links, scene::find_field(without_links, "ball"), drawn, ShowAs::isosurface, {}).front().value;
  EXPECT_EQ(item.find("1.25"), std::string::npos) << "else of its own range: " << item;
}

TEST(LabelOpacity, ALabelLeavesTheSurfaceThatItSharesAndIsFoundAgain) {
  const test::TemporaryFolder folder;
  test::NiftiFile labels({6, 6, 6}, 2, 8);
  for (int i = 0; i < 216; ++i) labels.append(static_cast<std::uint8_t>(i % 6 < 2 ? 1 : i % 6 < 4 ? 2 : i < 108 ? 7 : 0));
  test::write_file(folder / "l.nii", labels.bytes());
  test::write_file(folder / "s.json", R"({"fields": {"l": {"file": "l.nii", "interpolation": "nearest"}, "all": {"label": "*", "of": "l"}},
    "isosurfaces": [{"field": "all", "level": 0.5, "opacity": 0.9}]})");
  auto document = test::value_of(scene::Document::open(folder / "s.json"));
  const auto opacities = [&] {
    auto scene = test::value_of(document.read());
    test::value_of(render::make_frame(scene, 16, 16));
    return std::array{label_opacity(scene, "l", 1), label_opacity(scene, "l", 2), label_opacity(scene, "l", 7)};
  };
  EXPECT_EQ(opacities(), (std::array{0.9, 0.9, 0.9}));
  for (const double opacity : {0.25, 0.5}) {
    auto scene = test::value_of(document.read());
    test::value_of(render::make_frame(scene, 16, 16));
    const TextEdits edits = make_label_opacity_edits(scene, "l", 2, opacity);
    EXPECT_EQ(edits.size(), opacity == 0.25 ? 3u : 1u) << "the second change is of the label's own surface";
    test::value_of(document.apply(edits, "opacity"));
    EXPECT_EQ(opacities(), (std::array{0.9, opacity, 0.9}));
  }
  EXPECT_NE(document.text().find("\"label\": [1, 7]"), std::string::npos) << document.text();
}

}  // namespace catena::app::scene_items_test
