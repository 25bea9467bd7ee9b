// SPDX-License-Identifier: MIT
/// Plans: the choice on curves with known answers, the slider, the store against damage and malice.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>

#include "engine/app/tuning/choose/tune.h"
#include "engine/app/viewer/window/live_tuning.h"
#include "tests/engine/app/tuning_fixtures.h"
#include "tests/support/support.h"

namespace plan_test {

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

TEST(TuningChoice, NeverAsksForMoreThanTheDataHold) {
  Curve curve = four_point_curve();
  curve.discretization_error = 2.5;
  const PickedPoint picked = pick_point(curve, {0.5, {}});
  EXPECT_EQ(picked.point, 1);
  EXPECT_TRUE(picked.at_floor && picked.meets_target);
  // nor does time buy it
  EXPECT_EQ(pick_point(curve, {{}, 100.0}).point, 1);
  EXPECT_FALSE(pick_point(curve, {4.0, {}}).at_floor);
  curve.discretization_error = app::tuning::kNotMeasured, curve.reference_error = 1;
  EXPECT_EQ(pick_point(curve, {0.5, {}}).point, 2);
}

TEST(TuningChoice, TakesTheLeastErrorWithinTheTime) {
  const Curve curve = four_point_curve();
  EXPECT_EQ(pick_point(curve, {{}, 11.0}).point, 2);
  EXPECT_EQ(pick_point(curve, {{}, 1.0}).point, 0);
  const PickedPoint none = pick_point(curve, {{}, 0.5});
  EXPECT_EQ(none.point, 0);
  EXPECT_FALSE(none.meets_target);
}

TEST(TuningSlider, GoesFromTheFastestToTheMostExact) {
  app::LiveTuning live;
  live.image_tuning.emplace(image_curve(), parse_target("error=2"));
  live.tick_tuning.emplace(two_link_curves(), parse_target("max_proxy_error=1"));
  EXPECT_EQ(live.target_at(0).max_image_error, 8);
  EXPECT_DOUBLE_EQ(*live.target_at(1).max_image_error, 0.1);
  EXPECT_GT(*live.target_at(0).max_proxy_error, *live.target_at(1).max_proxy_error);
  EXPECT_NEAR(live.slider_position(), 1.0 / 3, 1e-12);
  // what a place wants is chosen
  live.image_tuning->set_targets(live.target_at(2.0 / 3));
  EXPECT_EQ(live.image_tuning->settings().step_voxels, 1);
  EXPECT_TRUE(live.update_target(parse_target("error=0.1")));
  EXPECT_FALSE(live.update_target(parse_target("error=0.1")));
  EXPECT_EQ(live.slider_position(), 1);
  // a place stays where it was put, also where what is chosen is better than what it wants
  for (const double place : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    live.update_target(live.target_at(place));
    EXPECT_NEAR(live.slider_position(), place, 1e-12);
  }
  live.update_target(parse_target("error=7.9"));
  EXPECT_NEAR(live.slider_position(), 1.0 / 3, 1e-12);
}

TEST(CurveCache, KeepsCurvesAndBelievesNoOther) {
  const test::TemporaryFolder folder;
  const CurveCache store(folder / "plans");
  const auto always = [](const std::vector<Curve>&) { return true; };
  std::string told;
  EXPECT_FALSE(store.find("k", always, told));
  EXPECT_TRUE(told.empty());  // nothing there is nothing to tell
  Curve curve = four_point_curve();
  curve.discretization_error = 0.5;
  ASSERT_TRUE(store.store("k", "/a/s.json", {curve}));
  const auto back = store.find("k", always, told);
  ASSERT_TRUE(back && told.empty()) << told;
  EXPECT_EQ(back->front().points.size(), curve.points.size());
  EXPECT_EQ(back->front().points[2].time.median, 10);
  EXPECT_EQ(back->front().discretization_error, 0.5);

  const std::string good = test::read_file(store.path_of("k"));
  const auto refused = [&](const std::string& text, const std::string& why) {
    test::write_file(store.path_of("k"), text);
    told.clear();
    EXPECT_FALSE(store.find("k", always, told)) << text.substr(0, 80);
    EXPECT_NE(told.find(why), std::string::npos) << told;
    EXPECT_NE(told.find("measured anew"), std::string::npos);
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 0);
  };
  refused("", "damaged");
  refused(good.substr(0, good.size() / 2), "damaged");
  refused("[" + std::string(100000, '['), "damaged");
  refused(R"({"curves": []})", "damaged");
  refused(std::string(5u << 20, ' '), "larger");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  refused(with(R"("median": 10)", R"("median": -10)"), "no measurement");
  refused(with(R"("median": 10)", R"("median": 0)"), "no measurement");
  refused(with(R"("error": 8)", R"("error": -8)"), "no measurement");
  test::write_file(store.path_of("other"), good);
  EXPECT_FALSE(store.find("other", always, told));
  EXPECT_NE(told.find("another scene or machine"), std::string::npos) << told;
  std::filesystem::remove(store.path_of("k"));
  ASSERT_EQ(::mkfifo(store.path_of("k").c_str(), 0600), 0);  // is not waited for
  EXPECT_FALSE(store.find("k", always, told));
  // a file in the folder's place: nothing is kept, and that is all
  test::write_file(folder / "file", "x");
  EXPECT_FALSE(CurveCache(folder / "file").store("k", "s", {curve}));
}

TEST(CurveCache, KeysFollowWhatDeterminesCurves) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "d.raw", "1234");
  scene::Scene scene;
  scene.path = folder / "s.json";
  scene.referenced_files = {folder / "d.raw"};
  const auto key = [&](const char* text) { return CurveKey("eye").add(scene, text).text(); };
  const std::string before = key(R"({"a": 1, "coupling": {"max_proxy_error": 2}})");
  EXPECT_EQ(key(R"({"a": 1,  "coupling": {"max_tick_us": 3}, "quality": "draft"})"), before);  // what is wanted changes no curve
  EXPECT_NE(key(R"({"a": 2})"), before);
  EXPECT_NE(CurveKey("hand").add(scene, R"({"a": 1})").text(), before);
  test::write_file(folder / "d.raw", "1235");
  EXPECT_NE(key(R"({"a": 1})"), before);
}

}  // namespace plan_test
