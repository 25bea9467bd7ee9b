// SPDX-License-Identifier: MIT
/// Time steps in the haptic chain: a series of files, of which the next one replaces the current one.
#include "engine/scene/time_steps.h"

#include "engine/io/field_cache.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/unsteady_lines.h"
#include "tests/haptics/build/build_fixture.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::time_steps_test {

/// Three balls of radius 1, 1.15 and 1.3; their file names sort numerically (2 before 10).
class GrowingTimeSeries : public testing::Test {
 protected:
  GrowingTimeSeries() {
    const char* names[] = {"ball_2.vdb", "ball_10.vdb", "ball_11.vdb"};
    for (int s = 0; s < 3; ++s) {
      field::AnyField field;
      field.scalar = haptics::tests::cube_grid(49, [&](const Vec3& p) { return norm(p) - 0.15 * s; });
      EXPECT_TRUE(field::write_vdb(folder_ / names[s], {{field, "r"}}));
    }
  }
  ~GrowingTimeSeries() override { field::clear_cache(); }
  scene::Scene read(const std::string& more = {}) {
    return build_tests::scene_of(
        R"({"fields": {"r": {"file": "ball_*.vdb"}},
            "chain": [{"name": "skin", "type": "isosurface", "field": "r", "level": 1, "free": "above"}],
            "coupling": {"stiffness": 300, "max_force": 8, "ramp_s": 0.02}, "workspace": {"metres_per_unit": 0.05})" +
            more + "}",
        folder_ / "s.json");
  }
  static double radius_at(scene::Scene& scene) {
    const auto field = scene::resolve_field(scene, scene::find_field(scene, "r"), {});
    EXPECT_TRUE(field) << field.error().message;
    field::Cursor cursor;
    return 1 + 1 - field->scalar->sample({1, 0, 0}, cursor).value;
  }
  test::TemporaryFolder folder_;
};

TEST_F(GrowingTimeSeries, AFieldFollowsTheScenesStep) {
  scene::Scene scene = read();
  EXPECT_EQ(scene::step_count(scene), 3);
  EXPECT_NEAR(radius_at(scene), 1, 1e-5);
  EXPECT_TRUE(scene::set_step(scene, 1));
  EXPECT_NEAR(radius_at(scene), 1.15, 1e-5);
  EXPECT_TRUE(scene::set_step(scene, 7));  // beyond the last step
  EXPECT_NEAR(radius_at(scene), 1.3, 1e-5);
  scene::Scene third = read(R"(, "time": {"step": 2})");
  EXPECT_NEAR(radius_at(third), 1.3, 1e-5);
}

TEST_F(GrowingTimeSeries, APrefetchedStepIsNotLoadedTwice) {
  scene::Scene scene = read();
  radius_at(scene);
  field::prefetch(scene::prefetch_requests(scene, 1));
  for (int i = 0; i < 1000 && !field::is_cached(scene::prefetch_requests(scene, 1).front()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const std::uint64_t before = field::load_counters().files;
  scene::set_step(scene, 1);
  EXPECT_NEAR(radius_at(scene), 1.15, 1e-5);
  scene::set_step(scene, 0);
  EXPECT_NEAR(radius_at(scene), 1, 1e-5);
  EXPECT_EQ(field::load_counters().files, before);
}

TEST_F(GrowingTimeSeries, TheForceDoesNotJumpAtATimeStep) {
  scene::Scene scene = read();
  test::ChainDriver hand(*build_tests::program_of(scene));
  Vec3 force(0.0);
  double largest_step = 0;
  const auto ticks = [&](int n, const auto& place) {
    for (int k = 0; k < n; ++k) {
      hand.step(place(k));
      if (hand.t > 0.1) largest_step = std::max(largest_step, norm(hand.out.force_n - force));
      force = hand.out.force_n;
    }
  };
  ticks(300, [](int k) { return Vec3(1.2 - 0.3 * std::min(k, 200) / 200, 0, 0); });
  EXPECT_NEAR(norm(force), 300 * 0.05 * 0.1, 0.02);
  for (int step = 1; step <= 2; ++step) {
    scene::set_step(scene, step);
    hand.replace(*build_tests::program_of(scene));
    ticks(200, [](int) { return Vec3(0.9, 0, 0); });
    EXPECT_NEAR(norm(force), 300 * 0.05 * (0.1 + 0.15 * step), 0.02) << "the new surface is felt";
  }
  // a step adds 2.25 N; the ramp admits max_force over 20 ticks, and the hand's motion adds K |dx|
  EXPECT_LE(largest_step, 8.0 / 20 + 300 * 0.05 * 0.3 / 200 + 1e-9);
  EXPECT_GT(largest_step, 0.01);
}

TEST_F(GrowingTimeSeries, APatternWithoutFilesIsRefused) {
  const auto scene = scene::parse_scene("{\"fields\": {\n\"r\": {\"file\": \"none_*.vdb\"}}}", folder_ / "s.json");
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("s.json:2: field \"r\": no file matches the pattern"), std::string::npos) << scene.error().message;
}

/// A uniform flow that turns: along x, between x and y, along y; with a step a unit of time.
class TurningFlow : public testing::Test {
 protected:
  TurningFlow() {
    constexpr int kNodes = 9;
    const auto mapping = field::Mapping::from_linear(Mat3(0.5), Vec3(-2.0));
    const Vec3 velocities[] = {{0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
    for (int s = 0; s < 3; ++s) {
      std::vector<float> xyz;
      for (int k = 0; k < kNodes * kNodes * kNodes; ++k)
        for (int a = 0; a < 3; ++a) xyz.push_back(static_cast<float>(velocities[s][a]));
      field::AnyField field;
      field.vector = field::make_vector_grid("v", mapping, {kNodes, kNodes, kNodes}, xyz);
      EXPECT_TRUE(field::write_vdb(folder_ / fmt::format("flow_{}.vdb", s), {{field, "v"}}));
    }
  }
  ~TurningFlow() override { field::clear_cache(); }
  scene::Scene read(const std::string& link) {
    return build_tests::scene_of(
        R"({"fields": {"v": {"file": "flow_*.vdb"}}, "chain": [{"name": "line", "field": "v", "seed": [0, 0, 0], )" + link +
            R"(}], "coupling": {"stiffness": 300, "max_force": 8, "ramp_s": 0.02},
                                     "workspace": {"metres_per_unit": 0.05}})",
        folder_ / "s.json");
  }
  /// Forces at a still hand over 100 ticks before each step and after the last one.
  static std::vector<Vec3> forces(scene::Scene& scene, const Vec3& probe) {
    test::ChainDriver hand(*build_tests::program_of(scene));
    std::vector<Vec3> forces;
    for (int step = 0; step < 3; ++step) {
      scene::set_step(scene, step);
      if (step > 0) hand.replace(*build_tests::program_of(scene));
      for (int k = 0; k < 100; ++k) {
        hand.step(probe);
        forces.push_back(hand.out.force_n);
      }
    }
    return forces;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TurningFlow, AStreamlineFollowsTheTimeWithoutAStepInForce) {
  scene::Scene scene = read(R"("type": "streamline")");
  const std::vector<Vec3> felt = forces(scene, {0.3, 0.1, 0});
  const double newtons = 300 * 0.05;
  EXPECT_NEAR(norm(felt[99] - newtons * Vec3(0, -0.1, 0)), 0, 1e-9);
  EXPECT_NEAR(norm(felt[199] - newtons * Vec3(-0.1, 0.1, 0)), 0, 1e-9);
  EXPECT_NEAR(norm(felt[299] - newtons * Vec3(-0.3, 0, 0)), 0, 1e-9);
  for (std::size_t k = 100; k < felt.size(); ++k) ASSERT_LE(norm(felt[k] - felt[k - 1]), 0.05 * 8 + 1e-9) << k;
}

TEST_F(TurningFlow, APathLineIsTheSameAtAllTimes) {
  scene::Scene scene = read(R"("type": "pathline")");
  // x = 0.5 t up to t = 1, then 0.5 (t - (t - 1)^2 / 2); y = 0.25 t^2, then 0.25 + 0.5 (t - 1)
  const auto curve = scene::resolve_pathline(scene, "v", Vec3(0.0), {}, {});
  ASSERT_TRUE(curve) << curve.error().message;
  EXPECT_NEAR(norm((*curve)->knots().back().p - Vec3(0.75, 0.75, 0)), 0, 1e-12);
  EXPECT_EQ((*curve)->times().back(), 2);
  const std::vector<Vec3> felt = forces(scene, {0.5, 0.35, 0});
  EXPECT_GT(norm(felt[99]), 0.5);
  for (std::size_t k = 100; k < felt.size(); ++k) ASSERT_EQ(felt[k], felt[99]) << k;
}

}  // namespace catena::haptics::time_steps_test
