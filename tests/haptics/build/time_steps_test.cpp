// SPDX-License-Identifier: MIT
/// Time steps in the haptic chain: a series of files, of which the next one replaces the current one.
#include "engine/scene/time_steps.h"

#include "engine/io/field_cache.h"
#include "engine/io/volume/load_field.h"
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

}  // namespace catena::haptics::time_steps_test
