// SPDX-License-Identifier: MIT
/// The panel Measure without ImGui: its table of labels and the angle between rulers.
#include "engine/app/viewer/edit/label_statistics.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "engine/app/viewer/edit/ruler_angle.h"
#include "tests/support/results.h"

namespace catena::app::label_statistics_test {

LabelStatisticsCache::Table wait_for(LabelStatisticsCache& cache, const LabelStatisticsCache::Request& request) {
  const scene::LabelTable names{{3, "Left, upper", {}}};
  for (int n = 0; n < 10000; ++n) {
    if (const auto table = cache.find_or_request(request, names)) return *table;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return Error{"no table within 10 s"};
}

std::shared_ptr<const field::ScalarGrid> grid_of(const std::vector<float>& values) {
  return field::make_scalar_grid("g", field::Mapping::from_linear(Mat3(2.0), Vec3(0.0)), {2, 2, 2}, values);
}

TEST(LabelStatistics, TheTableIsComputedOnItsThreadAndKept) {
  const std::vector<float> labels{0, 3, 3, 3, 1, 1, 5, 0}, values{9, 1, 2, 3, 4, 4, 7, 9};
  LabelStatisticsCache cache;
  const LabelStatisticsCache::Request request{grid_of(labels), grid_of(values)};
  EXPECT_EQ(cache.find_or_request(request, {}), nullptr) << "it never waits";
  std::vector<LabelStatistics> rows = test::value_of(wait_for(cache, request));
  ASSERT_EQ(rows.size(), 3u);
  const auto names_of = [&] { return std::array{rows[0].label, rows[1].label, rows[2].label}; };
  EXPECT_EQ(names_of(), (std::array{1.0, 3.0, 5.0}));
  EXPECT_EQ(rows[1].volume, 24);
  EXPECT_EQ(rows[1].mean, 2);
  EXPECT_EQ(rows[1].deviation, 1);
  EXPECT_TRUE(std::isnan(rows[2].deviation));
  EXPECT_FALSE(cache.collect());

  sort_labels(rows, LabelColumn::voxels, true);
  EXPECT_EQ(names_of(), (std::array{3.0, 1.0, 5.0}));
  for (const bool descending : {false, true}) {
    sort_labels(rows, LabelColumn::deviation, descending);
    EXPECT_EQ(rows[2].label, 5) << "without a value: last";
  }
  EXPECT_EQ(rows[0].label, 3);

  const LabelStatisticsCache::Request alone{request.map, nullptr};
  EXPECT_TRUE(std::isnan(test::value_of(wait_for(cache, alone))[0].mean));
  EXPECT_FALSE(wait_for(cache, {request.values, nullptr})->empty());
  EXPECT_FALSE(wait_for(cache, {grid_of({0.5f, 1, 1, 1, 1, 1, 1, 1}), nullptr})) << "no label map";
}

TEST(LabelStatistics, TheCsvHasTheValuesOnlyIfAFieldIsChosen) {
  const std::vector<LabelStatistics> rows{{3, "Left, upper", 3, 24, 2, 1}, {5, "", 1, 8, 7, NAN}};
  EXPECT_EQ(labels_to_csv(rows, true), "label,name,voxels,volume,mean,deviation\n3,\"Left, upper\",3,24,2,1\n5,,1,8,7,\n");
  EXPECT_EQ(labels_to_csv(rows, false), "label,name,voxels,volume\n3,\"Left, upper\",3,24\n5,,1,8\n");
}

TEST(RulerAngle, IsThatAtASharedEndOrBetweenTheLines) {
  const std::array<Vec3, 2> a{Vec3(1, 1, 0), Vec3(3, 1, 0)};
  const auto obtuse = test::value_of(angle_between(a, {Vec3(0, 2, 0), Vec3(1.01, 1, 0)}));
  EXPECT_TRUE(obtuse.has_shared_end);
  EXPECT_NEAR(obtuse.degrees, 135, 0.5);
  const auto skew = test::value_of(angle_between(a, {Vec3(0, 2, 9), Vec3(1, 1, 9)}));
  EXPECT_FALSE(skew.has_shared_end);
  EXPECT_NEAR(skew.degrees, 45, 1e-9);
  EXPECT_FALSE(angle_between(a, {Vec3(1, 1, 0), Vec3(1, 1, 0)}));
}

}  // namespace catena::app::label_statistics_test
