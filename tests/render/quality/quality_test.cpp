// SPDX-License-Identifier: MIT
/// Estimated against true errors, and quality goals.
#include "render/quality/quality.h"

#include "render/image/image_error.h"
#include "render/quality/refinement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include "render/vk/timestamp_query.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::quality_test {

using namespace catena::render;

class Quality : public ImageTest {
 protected:
  static FramePacket scene(bool shade = false) {
    const auto grid = make_grid(
        {64, 60, 56}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.42 * p.x + 0.1 * p.y) * std::cos(0.37 * p.y + 0.3 * p.z); });
    FramePacket packet = make_packet({130, -100, 90}, {31.5, 29.5, 27.5}, 32);
    packet.background = {0, 0, 0, 1};
    VolumeItem item = volume_item(grid, {{0, 0}, {0.4, 0}, {1, 0.15}});
    item.transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
    item.is_shaded = shade;
    packet.volumes = {item};
    return packet;
  }
  /// A few threads one voxel wide.
  static FramePacket threads() {
    FramePacket packet = scene();
    set_size(packet, 320, 240);
    const auto grid = make_grid({96, 96, 96}, [](const Vec3& p) {
      const double a = std::hypot(p.x - 40 - 0.2 * p.z, p.y - 30 - 0.1 * p.z), b = std::hypot(p.y - 70 + 0.3 * p.x, p.z - 60 + 0.1 * p.x);
      return 0.2 + 0.8 * std::max(std::exp(-0.5 * a * a), std::exp(-0.5 * b * b));
    });
    packet.volumes = {volume_item(grid, {{0, 0}, {0.3, 0}, {1, 0.8}})};
    packet.view = View{{250, -170, 140}, {47.5, 47.5, 47.5}, {0, 0, 1}, 32};
    return packet;
  }
  QualityChoice chosen(const FramePacket& packet, const QualityGoal& goal, const RenderTimeFn& timer = nullptr) {
    const auto choice = choose_quality(*renderer_, packet, goal, nullptr, timer);
    EXPECT_TRUE(choice);
    return choice.value();
  }
  QualityChoice for_error(const FramePacket& packet, double error, bool once = false) {
    return chosen(packet, {QualityGoal::Kind::error, error, once});
  }
  /// True RMS error over covered pixels; both images are drawn without a background.
  double true_rmse(FramePacket packet, const RenderSettings& settings) {
    const std::array<float, 4> b = packet.background;
    packet.background[3] = 0;
    const Image8 converged = draw(packet, reference_settings());
    return measure_error(draw(packet, settings), converged, {b[0], b[1], b[2]}).rmse;
  }
};

/// Random views, coarse and fine, plain and shaded, with large and small covered areas.
TEST_F(Quality, TheEstimateIsAtOrSlightlyAboveTheTrueError) {
  int below = 0, views = 0;
  std::mt19937 random(11);
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (double(random()) / 4294967296.0); };
  for (const bool shade : {false, true})
    for (int k = 0; k < 10; ++k) {
      FramePacket packet = scene(shade);
      const double turn = in(0, 6.28), height = in(-90, 90), distance = in(110, 400);
      packet.view.position = packet.view.target + Vec3(distance * std::cos(turn), distance * std::sin(turn), height);
      RenderSettings settings{.fast = FastSettings{in(1, 5), k % 2 == 0 ? 2u : 4u, -1, -1}};
      settings.fast->smooth_gradients = shade;
      const auto estimated = estimate_rmse(*renderer_, packet, settings);
      ASSERT_TRUE(estimated);
      const double truth = true_rmse(packet, settings);
      below += *estimated < truth;
      ++views;
      EXPECT_LT(truth, 1.5 * *estimated) << k << describe(settings);
      EXPECT_LT(*estimated, 1.6 * truth + 0.1) << k << describe(settings);
    }
  EXPECT_LE(below, views / 20);
}

TEST_F(Quality, AnErrorGoalIsReachedAndALooserOneIsCoarser) {
  const FramePacket packet = scene();
  double last_step = 0;
  for (const double e : {0.7, 1.5, 5.0}) {
    const QualityChoice choice = for_error(packet, e);
    EXPECT_TRUE(choice.goal_reached);
    EXPECT_LE(choice.estimated_rmse, e);
    EXPECT_LT(true_rmse(packet, choice.settings), 1.05 * e) << describe(choice.settings);
    ASSERT_TRUE(choice.settings.fast);
    EXPECT_GE(choice.settings.fast->step_voxels, last_step);
    last_step = choice.settings.fast->step_voxels;
  }
  EXPECT_GT(last_step, 1);
}

/// GPU timestamps measure only the work of an image, not the processor's time.
TEST_F(Quality, TheGpuClockTimesOnlyTheGpusWork) {
  if (!renderer_->device().timestamps().is_supported()) GTEST_SKIP() << "this device has no timestamps";
  const FramePacket packet = scene();
  ASSERT_TRUE(renderer_->draw(packet, exact_level(1)));
  const RenderTimer idle(*renderer_, RenderTimer::ClockSource::gpu), wall(*renderer_, RenderTimer::ClockSource::wall);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(idle.elapsed_ms(), 0);
  const auto ms_of = [&](double step) {
    const RenderTimer clock(*renderer_, RenderTimer::ClockSource::gpu);
    EXPECT_TRUE(renderer_->draw(packet, exact_level(step)));
    return clock.elapsed_ms();
  };
  const double coarse = ms_of(4), fine = ms_of(0.1);
  EXPECT_GT(coarse, 0);
  EXPECT_GT(fine, 2 * coarse);
  EXPECT_NEAR(idle.elapsed_ms(), coarse + fine, 1e-6);
  EXPECT_LE(idle.elapsed_ms() + 19, wall.elapsed_ms()) << "the pause was none of its work";
}

/// A thin shell in a small image: all error is in a few pixels, which a sparse lattice misses.
TEST_F(Quality, SmallImagesOfThinFeaturesAreMeasured) {
  FramePacket packet = scene();
  set_size(packet, 64, 48);
  packet.background = {0.9f, 0.5f, 0.2f, 1};
  packet.volumes[0].transfer.extinctions = {{0.60, 0}, {0.65, 0.4}, {0.70, 0}};
  for (const auto& [e, once] : {std::pair{0.5, false}, {1.0, false}, {0.5, true}, {1.0, true}}) {
    const QualityChoice choice = for_error(packet, e, once);
    const double truth = true_rmse(packet, choice.settings);
    EXPECT_LT(truth, e) << describe(choice.settings);
    EXPECT_NEAR(choice.estimated_rmse, truth, 0.3 * e) << describe(choice.settings);
  }
}

/// Threads of a voxel's width, bright over haze: interpolation between rays of every 4th pixel loses most of them.
TEST_F(Quality, ThinFeaturesAreKept) {
  const FramePacket packet = threads();
  FramePacket alone = packet;
  alone.background[3] = 0;
  const Image8 converged = draw(alone, reference_settings(), "converged");
  const QualityChoice once = for_error(packet, 2, true);
  const QualityChoice choice = for_error(packet, 2);
  for (const QualityChoice& one : {choice, once}) {
    const ImageError error = measure_error(draw(alone, one.settings, "chosen"), converged);
    EXPECT_GE(error.thin_feature_count, 1);
    EXPECT_GT(error.min_thin_retained, 0.6) << describe(one.settings);
    EXPECT_LE(error.rmse, 2.2);
  }
  RenderSettings coarse{.fast = FastSettings{1, 4, -1, -1}};
  EXPECT_LT(measure_error(draw(alone, coarse, "coarse"), converged).min_thin_retained, 0.5);  // coarse settings lose the threads
  // a stricter goal does not cost less
  const QualityChoice stricter = for_error(packet, 1);
  EXPECT_LE(relative_cost(choice.settings, false), 1.01 * relative_cost(stricter.settings, false))
      << describe(choice.settings) << "; " << describe(stricter.settings);
}

/// Black smoke over black hides errors of its opacity.
TEST_F(Quality, TransparentImagesAreMeasuredOverAnyBackground) {
  FramePacket packet = scene();
  packet.background = {0, 0, 0, 0};
  packet.volumes[0].transfer.colors = {{0, 0, 0, 0}, {1, 0, 0, 0}};
  packet.volumes[0].transfer.extinctions = {{0, 0}, {0.60, 0}, {0.65, 0.4}, {0.70, 0}};
  const QualityChoice once = for_error(packet, 2, true);
  const QualityChoice choice = for_error(packet, 2);
  const Image8 converged = draw(packet, reference_settings());
  const auto over_white = [&](const RenderSettings& settings) { return measure_error(draw(packet, settings), converged, {1, 1, 1}).rmse; };
  EXPECT_GT(over_white(fast_level(8, 4, -1, -1)), 4);  // coarse settings have a large error over white
  for (const QualityChoice& one : {choice, once}) {
    EXPECT_LT(over_white(one.settings), 2.1) << describe(one.settings);
    EXPECT_GE(1.05 * one.estimated_rmse, over_white(one.settings)) << describe(one.settings);
  }
}

/// The settings of a single image are chosen from few rays, with at most one rendered image, and the estimate is accurate.
TEST_F(Quality, ASingleImageNeedsNoSearch) {
  for (const bool shaded : {false, true}) {
    const FramePacket packet = scene(shaded);
    for (const double e : {0.7, 2.0, 5.0}) {
      const QualityChoice choice = for_error(packet, e, true);
      EXPECT_TRUE(choice.goal_reached);
      EXPECT_LE(choice.images_rendered, 1);
      EXPECT_LE(choice.estimated_rmse, e);
      const double truth = true_rmse(packet, choice.settings);
      EXPECT_LT(truth, 1.05 * choice.estimated_rmse + 0.05) << describe(choice.settings);
      EXPECT_GT(truth, 0.4 * choice.estimated_rmse - kMinReportedRmse) << describe(choice.settings);
    }
  }
}

TEST_F(Quality, EmptyImagesAreReported) {
  for (const bool once : {false, true}) {
    const QualityGoal goal{QualityGoal::Kind::error, 2, once};
    FramePacket packet = scene();
    EXPECT_FALSE(choose_quality(*renderer_, packet, goal).value().is_empty);
    packet.view.position = {5e3, -5e3, 0};  // the volume covers a few pixels
    EXPECT_FALSE(choose_quality(*renderer_, packet, goal).value().is_empty);
    packet.view.target = {2e5, 0, 0};
    EXPECT_TRUE(choose_quality(*renderer_, packet, goal).value().is_empty);
    packet = scene();
    packet.volumes[0].transfer.extinctions = {{0, 0}, {1, 0}};
    EXPECT_TRUE(choose_quality(*renderer_, packet, goal).value().is_empty);
  }
}

TEST_F(Quality, SearchesReportTheirProgress) {
  for (const QualityGoal& goal : {QualityGoal{QualityGoal::Kind::error, 2}, QualityGoal{QualityGoal::Kind::time, 1e6}}) {
    std::vector<double> progress;
    ASSERT_TRUE(choose_quality(*renderer_, scene(), goal, [&](double done) { progress.push_back(done); }));
    EXPECT_GT(progress.size(), 3U);
    EXPECT_TRUE(std::ranges::is_sorted(progress));
    EXPECT_GT(progress.front(), 0);
    EXPECT_LE(progress.back(), 1);
  }
}

/// Opacity that rises within a tenth of a voxel: exact rays with default steps have not converged and cannot be the reference.
TEST_F(Quality, SteepTransferFunctionsAreMeasuredAgainstConvergedRays) {
  FramePacket packet = scene(true);
  packet.volumes[0].transfer.extinctions = {{0, 0}, {0.5, 0}, {0.51, 3}, {1, 4}};
  const QualityChoice choice = for_error(packet, 2);
  const QualityChoice once = for_error(packet, 2, true);
  EXPECT_TRUE(choice.settings.fast) << describe(choice.settings);
  packet.background[3] = 0;
  RenderSettings converged = reference_settings();
  converged.step_voxels = 0.02;
  const Image8 truth = draw(packet, converged);
  EXPECT_LE(measure_error(draw(packet, choice.settings), truth).rmse, 2.2) << describe(choice.settings);
  EXPECT_LE(measure_error(draw(packet, once.settings), truth).rmse, 2.2) << describe(once.settings);
}

/// The gradient of the cell costs half of central differences and is as accurate where the field is smooth.
TEST_F(Quality, CellGradientsAreUsedWhereTheyAreAccurateEnough) {
  const FramePacket smooth = scene(true);
  FramePacket rough = smooth;
  std::mt19937 random(3);
  rough.volumes[0].grid = make_grid(
      {64, 60, 56}, [&](const Vec3& p) { return 1 - length(p - Vec3(31.5, 29.5, 27.5)) / 40 + 0.03 * double(random()) / 4294967296.0; });
  rough.volumes[0].transfer.extinctions = {{0, 0}, {0.5, 0}, {0.6, 0.5}, {1, 0.5}};
  for (const FramePacket& packet : {smooth, rough}) {
    const QualityChoice choice = for_error(packet, 3);
    ASSERT_TRUE(choice.settings.fast);
    EXPECT_EQ(choice.settings.fast->smooth_gradients, packet.volumes[0].grid == rough.volumes[0].grid) << describe(choice.settings);
    EXPECT_LT(true_rmse(packet, choice.settings), 1.05 * 3) << describe(choice.settings);
  }
}

TEST_F(Quality, ATinyErrorFallsBackToExactRays) {
  const QualityChoice choice = for_error(scene(true), 0.02);
  EXPECT_FALSE(choice.settings.fast);
  EXPECT_LT(choice.settings.step_voxels, 1);
}

TEST_F(Quality, ATimeGoalTakesTheBestSettingsWithinIt) {
  const FramePacket packet = scene();
  const QualityChoice plenty = chosen(packet, {QualityGoal::Kind::time, 1e6});
  const QualityChoice none = chosen(packet, {QualityGoal::Kind::time, 1e-6});
  EXPECT_TRUE(plenty.goal_reached);
  EXPECT_FALSE(none.goal_reached);
  EXPECT_EQ(none.images_rendered, 1);
  EXPECT_LT(plenty.estimated_rmse, 0.6);
  EXPECT_LT(plenty.estimated_rmse, none.estimated_rmse);
}

TEST_F(Quality, ALongerTimeGoalIsNeverWorse) {
  // times by the levels' relative costs, equal on every machine
  for (const bool shade : {false, true}) {
    const FramePacket packet = scene(shade);
    const RenderTimeFn timer = [&](const RenderSettings& s) -> Result<double> { return 100 * relative_cost(s, shade); };
    double last = 1e9;
    for (const double ms : {8.0, 14.0, 30.0, 400.0}) {
      const QualityChoice choice = chosen(packet, {QualityGoal::Kind::time, ms}, timer);
      EXPECT_TRUE(choice.goal_reached) << ms;
      EXPECT_LE(choice.expected_ms, ms);
      EXPECT_DOUBLE_EQ(choice.expected_ms, 100 * relative_cost(choice.settings, shade));
      EXPECT_LE(choice.estimated_rmse, last) << ms;
      last = choice.estimated_rmse;
    }
    EXPECT_LT(last, 0.8);
  }
}

/// With thin features, refinement may take longer than a ray per pixel.
TEST_F(Quality, RemainingTimeIsSpentOnRaysPerPixel) {
  const RenderTimeFn timer = [](const RenderSettings& s) -> Result<double> {
    if (!s.fast) return 500.0;
    if (s.fast->spacing == 1) return 30 + 20 / s.fast->step_voxels;
    return s.fast->refine_full_255 >= 0 ? 200.0 : 20.0;
  };
  const QualityChoice choice = chosen(threads(), {QualityGoal::Kind::time, 55}, timer);
  ASSERT_TRUE(choice.settings.fast);
  EXPECT_EQ(choice.settings.fast->spacing, 1U) << describe(choice.settings);
  EXPECT_EQ(choice.settings.fast->step_voxels, 1) << describe(choice.settings);
  const auto coarse = estimate_rmse(*renderer_, threads(), fast_level(1, 2, 0, -1));
  ASSERT_TRUE(coarse);
  EXPECT_LT(choice.estimated_rmse, 0.5 * *coarse);
}

TEST(QualityWithin, TheSmallestErrorWithinTheTimeElseTheFastest) {
  const std::vector<SettingsTrial> tried{{10, 3}, {20, 1}, {15, 2}, {40, 0.5}, {60, 0.6}};
  EXPECT_EQ(best_within(tried, 5), 0u);
  EXPECT_EQ(best_within(tried, 16), 2u);
  EXPECT_EQ(best_within(tried, 39), 1u);
  EXPECT_EQ(best_within(tried, 100), 3u);
}

TEST_F(Quality, ScenesWithoutVolumesHaveZeroError) {
  FramePacket packet = make_packet({20, -20, 20}, {4, 4, 4});
  packet.isosurfaces = {{make_grid({8, 8, 8}, [](const Vec3& p) { return p.x; }), 3.5, {1, 1, 1}, 1}};
  const QualityChoice choice = for_error(packet, 0.5);
  EXPECT_EQ(choice.estimated_rmse, 0);
}

}  // namespace catena::test::quality_test
