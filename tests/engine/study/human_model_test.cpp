// SPDX-License-Identifier: MIT
// The model of a human subject, and its simulated trials.
#include <numbers>

#include "engine/study/human_model.h"
#include "engine/study/simulated_trial.h"
#include "tests/engine/study/study_fixture.h"

namespace human_model_test {

using namespace catena;

bool same(const study::TrialResult& a, const study::TrialResult& b) {
  return a.reached_target == b.reached_target && a.time_s == b.time_s && a.error_mm == b.error_mm && a.traveled_mm == b.traveled_mm &&
         a.peak_force_n == b.peak_force_n && a.end_mm == b.end_mm;
}

TEST(HumanModel, ATrialDoesNotDependOnEarlierTrials) {
  const study::Study study = study_rig::small();
  const std::vector<study::Trial> session = study::make_session(study, 3);
  study::TrialSimulator all(study);
  std::vector<study::TrialResult> in_order;
  for (const study::Trial& trial : session) in_order.push_back(all.run(trial).value());
  for (std::size_t i = 0; i < session.size(); i += 3) {
    const auto alone = study::TrialSimulator(study).run(session[i]);
    EXPECT_TRUE(same(*alone, in_order[i])) << i;
  }
}

TEST(HumanModel, FollowsThePathWithoutNoise) {
  study::Study study = study_rig::small();
  study::HumanModelParameters& m = study.human_model;
  m.speed_spread_subject = m.speed_spread_trial = m.motor_noise = m.lateral_noise_mm = m.tremor_mm = 0;
  m.depth_noise_mm = m.depth_bias_mm = 0;
  study::TrialSimulator simulator(study);
  for (const study::Trial& trial : study::make_session(study, 1)) {
    const study::TrialResult measured = simulator.run(trial).value();
    EXPECT_TRUE(measured.reached_target);
    EXPECT_LT(measured.error_mm, 6);
    // 92 mm at 55 mm/s, slower towards the end.
    EXPECT_GT(measured.time_s, 92 / 55.0 - 0.1);
    EXPECT_LT(measured.time_s, 4);
    // Cut corners make the traveled path shorter.
    EXPECT_GT(measured.traveled_mm, 75);
    EXPECT_LT(measured.traveled_mm, 115);
  }
}

TEST(HumanModel, EachParameterHasItsEffect) {
  study::Study study = study_rig::small();
  study.tasks[0].rules.path_mm = 60;
  const auto error_with = [&](auto&& change) {
    study::Study with = study;
    study::HumanModelParameters& m = with.human_model;
    m.speed_spread_subject = m.speed_spread_trial = m.motor_noise = m.lateral_noise_mm = m.tremor_mm = 0;
    change(m);
    study::TrialSimulator simulator(with);
    double sum = 0;
    for (const study::Trial& trial : study::make_session(with, 1))
      if (trial.condition == 0) sum += simulator.run(trial).value().error_mm;
    return sum;
  };
  const double none = error_with([](study::HumanModelParameters&) {});
  EXPECT_GT(error_with([](study::HumanModelParameters& m) { m.lateral_noise_mm = 4; }), none);
  EXPECT_GT(error_with([](study::HumanModelParameters& m) { m.motor_noise = 1; }), none);
  EXPECT_NE(error_with([](study::HumanModelParameters& m) { m.tremor_mm = 1; }), none);
  EXPECT_GT(error_with([](study::HumanModelParameters& m) { m.speed_mm_per_s = 150; }), none) << "faster is less accurate";
  EXPECT_EQ(error_with([](study::HumanModelParameters& m) { m.depth_noise_mm = m.depth_bias_mm = 50; }), none) << "of 3D tasks only";
}

TEST(HumanModel, SubjectsHaveTheStatedSpread) {
  const study::Study& study = study_rig::paper_study();
  double bias2 = 0, logarithm2 = 0, logarithm = 0;
  constexpr int n = 2000;
  for (int subject = 1; subject <= n; ++subject) {
    const study::HumanModelTraits model = study::draw_subject_traits(study, subject);
    bias2 += model.depth_bias * model.depth_bias / n;
    logarithm += std::log(model.speed) / n;
    logarithm2 += std::log(model.speed) * std::log(model.speed) / n;
  }
  // Tolerances of four standard errors.
  EXPECT_NEAR(std::sqrt(bias2), 5, 5 * 4 / std::sqrt(2.0 * n));
  EXPECT_NEAR(std::sqrt(logarithm2), 0.36, 0.36 * 4 / std::sqrt(2.0 * n));
  EXPECT_NEAR(logarithm, 0, 0.36 * 4 / std::sqrt(1.0 * n));
}

TEST(HumanModel, GuidanceHasAForceAndErrorsAreThoseOfTheDevice) {
  const study::Study study = study_rig::small();
  study::TrialSimulator simulator(study);
  for (const study::Trial& trial : study::make_session(study, 2)) {
    const study::TrialResult measured = simulator.run(trial).value();
    EXPECT_EQ(measured.peak_force_n > 0, trial.condition == 1);
    EXPECT_TRUE(trial.condition == 0 || measured.peak_force_n > 0.1) << measured.peak_force_n;
    EXPECT_GT(measured.error_mm, 0.05) << "a proxy on the line would have none";
  }
}

TEST(SimulatedDevice, FollowsTargetsSetAtEachTick) {
  haptics::SimulatedDeviceParameters p;
  p.mass_kg = 0.02;
  haptics::SimulatedDevice led({{.position_m = Vec3(0.01, 0, 0)}}, p);
  // The same targets as a recorded path.
  std::vector<haptics::SimulatedDevice::Waypoint> path{{.position_m = Vec3(0.01, 0, 0)}};
  const auto target = [](int k) { return Vec3(0.01 + 1e-4 * k, 2e-5 * (k % 7), 0); };
  for (int k = 1; k <= 300; ++k) path.push_back({1e-3 * k, target(k), 0});
  haptics::SimulatedDevice along(path, p);
  for (int k = 0; k < 300; ++k) {
    const Vec3 a = led.read().position_m, b = along.read().position_m;
    ASSERT_LT(norm(a - b), 1e-12) << k;
    led.set_target(target(k + 1));
  }
  EXPECT_GT(led.position_m().x, 0.03);
}

}  // namespace human_model_test
