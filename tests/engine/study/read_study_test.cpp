// SPDX-License-Identifier: MIT
// The study file: its values, and errors with their line.
#include "engine/scene/scene.h"
#include "engine/study/trial_scene.h"
#include "haptics/build/build_program.h"
#include "tests/engine/study/study_fixture.h"

namespace read_study_test {

using namespace catena;
using study_rig::small_study_text;

TEST(ReadStudy, ReadsThePapersDesign) {
  const study::Study& study = study_rig::paper_study();
  ASSERT_EQ(study.tasks.size(), 4u);
  ASSERT_EQ(study.conditions.size(), 2u);
  EXPECT_EQ(study.conditions[0].name, "iso");
  EXPECT_EQ(study.subjects * static_cast<int>(study.tasks.size() * study.conditions.size()) * study.trials, 1600);
  int rejected_at_s = 0;
  for (const study::Task& task : study.tasks) {
    EXPECT_EQ(task.limits.timeout_s, 30);
    EXPECT_EQ(task.limits.announced_limit_s, 10);
    EXPECT_EQ(task.limits.reject_error_mm, task.dimensions == 2 ? 30 : 100);
    EXPECT_EQ(task.rules.path_mm, 100);
    rejected_at_s += static_cast<int>(task.limits.reject_time_s);
    EXPECT_NEAR(task.mm_from_world(task.world_from_mm(37)), 37, 1e-12);
  }
  EXPECT_EQ(rejected_at_s, 10 + 15 + 12 + 17);
  EXPECT_EQ(study.tasks[0].target, study::Target::circle);
  EXPECT_EQ(study.tasks[2].target, study::Target::plane);
  EXPECT_EQ(study.tasks[0].view_direction, Vec3(0, 0, -1));
  // The measured spread of speed, split over subjects and trials.
  EXPECT_NEAR(std::hypot(study.human_model.speed_spread_subject, study.human_model.speed_spread_trial), 0.45, 1e-12);
}

TEST(ReadStudy, ErrorsAreOneLineWithTheirPosition) {
  const struct {
    const char *from, *to, *says;
  } mistakes[] = {
      {R"("trials": 3)", R"("trials": 0)", "small.json:2:"},
      {R"("training": 1)", R"("trainings": 1)", "did you mean \"training\""},
      {R"("name": "small")", R"("seed": 4)", "\"name\""},
      {R"("dimensions": 2, "field")", R"("dimensions": 4, "field")", "small.json:4:"},
      {R"("dimensions": 2, "field")", R"("field")", "key \"dimensions\" is missing"},
      {R"("kind": "tracing")", R"("kind": "racing")", "small.json:4:"},
      {R"("kind": "tracing")", R"("kind": "tracing", "target": "circle")", "path's end was expected"},
      {R"("kind": "tracing")", R"("kind": "advection", "target": "end")", "was expected"},
      {R"("field": "flow",)", R"("field": "flows",)", "small.json:4:"},
      {R"("$seed")", R"("$sead")", "small.json:6: \"$sead\" is not a known placeholder"},
      {R"("target": [0, 0, 0])", R"("target": [0, 0, 8])", "small.json:7:"},
      {R"("metres_per_unit": 0.05)", R"("metres_per_unit": -1)", "small.json:8:"},
      {R"("workspace": {"metres_per_unit": 0.05})", R"("jitter": true)", "no \"workspace\""},
      {R"("chain": []})", R"("chains": []})", "small.json:11:"},
      {R"("chain": []})", R"("chain": {"trance": []}})", "did you mean \"trace\""},
      {R"("name": "held")", R"("name": "free")", "small.json:12: there are two of the name \"free\""},
      {R"("dimensions": 2, "field")", R"("dimensions": 2, "stimulus": {"path_mm": 0}, "field")", "\"path_mm\""},
      {R"("training": 1,)", R"("training": 1, "operator": {"yield_n": "3"},)", "\"yield_n\""},
      {R"("training": 1,)", R"("training": 1, "questionnaire": [{"name": "q"}],)", "\"question\""},
  };
  for (const auto& [from, to, says] : mistakes) {
    const auto read = study::parse_study(small_study_text(from, to), "small.json");
    ASSERT_FALSE(read) << to;
    const std::string& error = read.error().message;
    EXPECT_NE(error.find(says), std::string::npos) << to << "\n" << error;
    EXPECT_TRUE(error.starts_with("small.json:")) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

/// An error in a template or a chain is found when a trial is made; it is reported with the line of the study file.
TEST(ReadStudy, ErrorsInScenesAndChainsNameTheLineOfTheStudyFile) {
  const auto error_of = [](const char* from, const char* to, int condition) -> std::string {
    const study::Study study = study_rig::small(from, to);
    study::Trial trial;
    trial.condition = condition;
    study::Stimulus stimulus;
    stimulus.path = {Vec3(0.0), Vec3(1.0)};
    auto scene = scene::parse_scene(study::make_trial_scene(study, trial, stimulus), study.path);
    if (!scene) return scene.error().message;
    const auto program = haptics::build_program(*scene);
    return program ? "" : program.error().message;
  };
  EXPECT_EQ(error_of(R"("training": 1)", R"("training": 1)", 1), "");
  EXPECT_TRUE(error_of(R"("analytic": "vortices")", R"("analytic": "vortexes")", 0).starts_with("small.json:6:"));
  EXPECT_TRUE(error_of(R"("up": [0, 1, 0])", R"("up": [0, 1])", 0).starts_with("small.json:7:"));
  EXPECT_TRUE(error_of(R"("type": "streamline")", R"("type": "streamlime")", 1).starts_with("small.json:13:"));
  EXPECT_TRUE(error_of(R"("seed": "$start")", R"("seed": "$radius")", 1).starts_with("small.json:13:"));
}

TEST(ReadStudy, KeysOfVorticesAreRefusedForOtherFormulas) {
  const auto error_of = [](const std::string& keys) {
    const auto scene = scene::parse_scene("{\"fields\": {\n\"f\": {\"analytic\": " + keys + "}}}", "s.json");
    return scene ? std::string() : scene.error().message;
  };
  EXPECT_EQ(error_of(R"("vortices", "seed": 5, "dimensions": 2, "center": [1, 2, 3])"), "");
  EXPECT_EQ(error_of(R"("circle", "center": [1, 2, 3])"), "");
  EXPECT_TRUE(error_of(R"("circle", "seed": 5)").starts_with("s.json:2: \"seed\" does not belong to \"circle\""));
  EXPECT_TRUE(error_of(R"("hill", "dimensions": 2)").starts_with("s.json:2: \"dimensions\""));
  EXPECT_TRUE(error_of(R"("vortices", "dimensions": 4)").starts_with("s.json:2:"));
  EXPECT_TRUE(error_of(R"("vortices", "seed": -1)").starts_with("s.json:2:"));
  EXPECT_TRUE(error_of(R"("circle", "center": [1, 2])").starts_with("s.json:2:"));
}

TEST(ReadStudy, AChainMayPrecedeTheTasksAndCommentsAreAllowed) {
  const study::Study study = study::parse_study(R"({ "name": "turned",
  "conditions": [{"name": "a", "chain": [  // links
      {"name": "hold", "type": "point", "position": "$end"}]}],
  "tasks": [{"name": "t", "kind": "tracing", "dimensions": 3, "field": "f", "scene": {
    "fields": {"f": {"analytic": "helix"}}, "camera": {"position": [0, -8, 0], "target": [0, 0, 0]},
    "workspace": {"metres_per_unit": 1}  // the end
  }}]})",
                                                "turned.json")
                                 .value();
  study::Stimulus stimulus;
  stimulus.end = Vec3(1, 2, 3);
  const std::string text = study::make_trial_scene(study, {}, stimulus);
  EXPECT_NE(text.find(R"("position": [1, 2, 3])"), std::string::npos) << text;
  auto scene = scene::parse_scene(text, study.path);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(haptics::build_program(*scene).value()->links.size(), 1u);
}

}  // namespace read_study_test
