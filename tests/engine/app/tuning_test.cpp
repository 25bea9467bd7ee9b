// SPDX-License-Identifier: MIT
/// Tuning: the choice on curves with known answers, the slider, and the cache against damaged and forged files.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "engine/app/tuning/choose/tune.h"
#include "engine/app/viewer/window/live_tuning.h"
#include "tests/engine/app/tuning_fixtures.h"
#include "tests/support/support.h"

namespace tuning_test {

using app::tuning::pick_point;
using app::tuning::PickedPoint;

TEST(TuningChoice, TakesTheCheapestThatMeetsTheError) {
  const Curve curve = four_point_curve();
  EXPECT_EQ(pick_point(curve, {10.0, {}}).point, 0);
  EXPECT_EQ(pick_point(curve, {2.0, {}}).point, 1);
  EXPECT_EQ(pick_point(curve, {1.0, {}}).point, 2);
  EXPECT_TRUE(pick_point(curve, {1.0, {}}).meets_target);
  const PickedPoint none = pick_point(curve, {0.01, {}});
  EXPECT_EQ(none.point, 3);
  EXPECT_FALSE(none.meets_target);
  EXPECT_EQ(pick_point(Curve(), {1.0, {}}).point, -1);
}

TEST(TuningChoice, NeverGoesBelowTheDiscretizationError) {
  Curve curve = four_point_curve();
  curve.discretization_error = 2.5;
  const PickedPoint picked = pick_point(curve, {0.5, {}});
  EXPECT_EQ(picked.point, 1);
  EXPECT_TRUE(picked.at_floor && picked.meets_target);
  // A generous time does not choose a smaller error either.
  EXPECT_EQ(pick_point(curve, {{}, 100.0}).point, 1);
  EXPECT_FALSE(pick_point(curve, {4.0, {}}).at_floor);
  curve.discretization_error = app::tuning::kNotMeasured, curve.reference_error = 1;
  EXPECT_EQ(pick_point(curve, {0.5, {}}).point, 2);
}

TEST(TuningChoice, TakesTheSmallestErrorWithinTheTime) {
  const Curve curve = four_point_curve();
  EXPECT_EQ(pick_point(curve, {{}, 11.0}).point, 2);
  EXPECT_EQ(pick_point(curve, {{}, 1.0}).point, 0);
  const PickedPoint none = pick_point(curve, {{}, 0.5});
  EXPECT_EQ(none.point, 0);
  EXPECT_FALSE(none.meets_target);
}

TEST(TuningSlider, RangesFromTheFastestToTheMostExact) {
  app::LiveTuning live;
  live.image_tuning.emplace(image_curve(), parse_target("error=2"));
  live.tick_tuning.emplace(two_link_curves(), parse_target("max_proxy_error=1"));
  EXPECT_EQ(live.target_at(0).max_image_error, 8);
  EXPECT_DOUBLE_EQ(*live.target_at(1).max_image_error, 0.1);
  EXPECT_GT(*live.target_at(0).max_proxy_error, *live.target_at(1).max_proxy_error);
  EXPECT_NEAR(live.slider_position(), 1.0 / 3, 1e-12);
  // The target at a slider position is applied.
  live.image_tuning->set_targets(live.target_at(2.0 / 3));
  EXPECT_EQ(live.image_tuning->settings().step_voxels, 1);
  EXPECT_TRUE(live.update_target(parse_target("error=0.1")));
  EXPECT_FALSE(live.update_target(parse_target("error=0.1")));
  EXPECT_EQ(live.slider_position(), 1);
  // The slider keeps its position, even if the chosen setting is better than the target.
  for (const double place : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    live.update_target(live.target_at(place));
    EXPECT_NEAR(live.slider_position(), place, 1e-12);
  }
  live.update_target(parse_target("error=7.9"));
  EXPECT_NEAR(live.slider_position(), 1.0 / 3, 1e-12);
}

TEST(CurveCache, StoresCurvesAndRefusesDamagedFiles) {
  const test::TemporaryFolder folder;
  const CurveCache store(folder / "plans");
  const auto always = [](const std::vector<Curve>&) { return true; };
  std::string note;
  EXPECT_FALSE(store.find("k", always, note));
  EXPECT_TRUE(note.empty());  // a missing cache has no note
  Curve curve = four_point_curve();
  curve.discretization_error = 0.5;
  ASSERT_TRUE(store.store("k", "/a/s.json", {curve}));
  const auto back = store.find("k", always, note);
  ASSERT_TRUE(back && note.empty()) << note;
  EXPECT_EQ(back->front().points.size(), curve.points.size());
  EXPECT_EQ(back->front().points[2].time.median, 10);
  EXPECT_EQ(back->front().discretization_error, 0.5);

  const std::string good = test::read_file(store.path_of("k"));
  const auto refused = [&](const std::string& text, const std::string& why) {
    test::write_file(store.path_of("k"), text);
    note.clear();
    EXPECT_FALSE(store.find("k", always, note)) << text.substr(0, 80);
    EXPECT_NE(note.find(why), std::string::npos) << note;
    EXPECT_NE(note.find("measured anew"), std::string::npos);
    EXPECT_EQ(std::count(note.begin(), note.end(), '\n'), 0);
  };
  refused("", "damaged");
  refused(good.substr(0, good.size() / 2), "damaged");
  refused("[" + std::string(100000, '['), "damaged");
  refused(R"({"curves": []})", "damaged");
  refused(std::string(5u << 20, ' '), "too large");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  refused(with(R"("median": 10)", R"("median": -10)"), "impossible values");
  refused(with(R"("median": 10)", R"("median": 0)"), "impossible values");
  refused(with(R"("error": 8)", R"("error": -8)"), "impossible values");
  test::write_file(store.path_of("other"), good);
  EXPECT_FALSE(store.find("other", always, note));
  EXPECT_NE(note.find("another scene or machine"), std::string::npos) << note;
  std::filesystem::remove(store.path_of("k"));
  ASSERT_EQ(::mkfifo(store.path_of("k").c_str(), 0600), 0);  // must not block
  EXPECT_FALSE(store.find("k", always, note));
  // A file in place of the folder: nothing is cached.
  test::write_file(folder / "file", "x");
  EXPECT_FALSE(CurveCache(folder / "file").store("k", "s", {curve}));
}

TEST(CurveCache, KeysDependOnTheInputsOfCurves) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "d.raw", "1234");
  scene::Scene scene;
  scene.path = folder / "s.json";
  scene.referenced_files = {folder / "d.raw"};
  const auto key = [&](const char* text) { return CurveKey("eye").add(scene, text).text(); };
  const std::string before = key(R"({"a": 1, "coupling": {"max_proxy_error": 2}})");
  EXPECT_EQ(key(R"({"a": 1,  "coupling": {"max_tick_us": 3}, "quality": "draft"})"), before);  // targets change no curve
  EXPECT_NE(key(R"({"a": 2})"), before);
  EXPECT_NE(CurveKey("hand").add(scene, R"({"a": 1})").text(), before);
  test::write_file(folder / "d.raw", "1235");
  EXPECT_NE(key(R"({"a": 1})"), before);
}

}  // namespace tuning_test
