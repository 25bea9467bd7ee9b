// SPDX-License-Identifier: MIT
// `catena study run` in a window on a virtual display, with real key events and a scripted mouse that follows each path.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "engine/app/study/live_trial.h"
#include "engine/study/trial_table.h"
#include "render/frame/camera.h"
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"
#include "tests/support/results.h"

namespace catena::app::study_window_test {

using test::has;

constexpr std::uint32_t kWidth = 640, kHeight = 480;

constexpr const char* kStudy = R"({
  "name": "small", "seed": 3, "trials": 1, "training": 0, "instructions": "pages.txt",
  "tasks": [{"name": "trace", "kind": "tracing", "dimensions": 2, "field": "flow", "stimulus": {"path_mm": 60, "context_streamlines": 2},
    "scene": {"fields": {"flow": {"analytic": "vortices", "dimensions": 2, "seed": "$seed"}},
              "streamlines": [{"field": "flow", "seeds": ["$middle"], "length": "$half_length", "radius": 0.02}],
              "cursor": {"shape": "crosshair", "size": 0.05}, "background": [0.9, 0.9, 0.9],
              "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0], "projection": "orthographic", "height": 4.2},
              "workspace": {"metres_per_unit": 0.05}}}],
  "conditions": [{"name": "condition_a", "chain": [{"name": "hold", "type": "drag", "threshold": 0.01}]},
                 {"name": "condition_b", "chain": [{"name": "line", "type": "streamline", "field": "flow", "seed": "$start"}]}],
  "questionnaire": [{"name": "hard", "question": "Was it hard?", "answers": ["1 no", "2", "3 very"]}, {"name": "how", "question": "How?"}]
})";

// The script of a trial: moves the mouse to the start, presses the key, and follows the path and a little beyond. The wheel sets the
// depth.
std::string way_of(const study::Study& study, const study::Trial& trial, std::size_t trials, double step_s) {
  LiveTrial live(study);
  auto host = live.open(trial, {});
  EXPECT_TRUE(host) << (host ? "" : host.error().message);
  if (!host) return {};
  auto loaded = load_scene(std::move(*host), kWidth, kHeight);
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
  auto stimulus = study::StimulusGenerator(study).generate(trial.task, trial.seed);
  EXPECT_TRUE(stimulus);
  if (!loaded || !stimulus) return {};
  const render::Camera camera = render::make_camera(loaded->packet.view, kWidth, kHeight, Bounds());
  std::vector<Vec3> path;
  for (std::size_t i = 0; i < stimulus->path.size(); i += 16) path.push_back(stimulus->path[i]);
  const Vec3 last = path.back() - path[path.size() - 2];
  for (int i = 0; i < 4; ++i) path.push_back(path.back() + last);
  const auto at = [&](const Vec3& p) { return *render::project(camera, p); };
  const auto move = [&](const Vec3& p) { return fmt::format(" mousemove {:.0f} {:.0f}", at(p).x, at(p).y); };
  const std::string name = fmt::format("trial {} of {}", trial.index + 1, trials);
  // Two moves: a pointer that enters the window counts as moved only with the second one.
  std::string script =
      fmt::format("titled '{}'\nxdotool mousemove 5 5{}\ntitled '{}, at the start'\npicture ready-{}\nkeys space\ntitled '{}, running'\n",
                  name, move(path.front()), name, trial.index, name);
  double depth = at(path.front()).z;
  script += "xdotool";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double notch = 0.01 * camera.height * render::pixel_size(camera, depth);
    const int clicks = static_cast<int>(std::lround((at(path[i]).z - depth) / notch));
    depth += clicks * notch;
    if (clicks != 0) script += fmt::format(" click --repeat {} --delay 1 {}", std::abs(clicks), clicks > 0 ? 4 : 5);
    script += move(path[i]) + fmt::format(" sleep {}", step_s);
    if (i == path.size() / 2) script += fmt::format("\npicture running-{}\nxdotool", trial.index);
  }
  return script + "\n";
}

class StudyWindowTest : public test::DrivenWindow {
 protected:
  void write_study(const std::string& text, const std::string& pages) {
    test::write_file(folder_ / "study.json", text);
    test::write_file(folder_ / "pages.txt", pages);
    auto read = test::value_of(study::read_study(folder_ / "study.json"));
    study_ = std::move(read);
  }
  /// Runs the script; `$CATENA_PICTURE NAME`, where set, is called to capture the display for review.
  int drive(const std::string& script) {
    const std::string start = fmt::format(
        "picture() {{ [ -z \"$CATENA_PICTURE\" ] || $CATENA_PICTURE $1; }}\n"
        "study() {{ \"$CATENA\" study run study.json --subject 7 --device mouse -o data --size {}x{} & V=$!; titled '^catena study  '; "
        "}}\n",
        kWidth, kHeight);
    return test::drive_windows(folder_, start + script);
  }
  std::vector<study::TrialRow> rows() const {
    const std::string file = folder_ / "data/subjects/007.csv";
    auto rows = study::parse_rows(test::read_file(file), file);
    EXPECT_TRUE(rows) << rows.error().message;
    return rows ? *rows : std::vector<study::TrialRow>();
  }

  study::Study study_;
};

TEST_F(StudyWindowTest, AScriptedMouseCompletesAStudyInTwoSessions) {
  write_study(kStudy, "# introduction\nHello\n# before trace\nTrace\n");
  const std::vector<study::Trial> trials = study::make_session(study_, 7);
  ASSERT_EQ(trials.size(), 2u);
  ASSERT_EQ(drive("study\ntitled Hello\nkeys space\ntitled Trace\nkeys Return\n" + way_of(study_, trials[0], 2, 0.01) +
                  "titled 'trial 2 of 2'\nkeys p\ntitled Pause\nkeys ctrl+q\nwait $V\n"
                  "study\ntitled 'Welcome back'\nkeys space\ntitled Trace\nkeys space\n" +
                  way_of(study_, trials[1], 2, 0.01) +
                  "titled 'question 1 of 2'\nkeys Return 3 Return\ntitled 'question 2 of 2'\nxdotool type --delay 30 'so, so'\n"
                  "keys Return\ntitled 'The end'\nkeys space\nwait $V\n"),
            0)
      << log();
  EXPECT_EQ(log().find("never"), std::string::npos) << log();
  EXPECT_TRUE(has(log(), "subject 7: 1 of 2 trials and 0 of 2 questions are done; the same command continues the session"));
  EXPECT_TRUE(has(log(), "subject 7: 2 of 2 trials and 2 of 2 questions are done"));
  EXPECT_EQ(log().find("condition_"), std::string::npos) << "neither titles nor the terminal tell the condition";
  const std::vector<study::TrialRow> done = rows();
  ASSERT_EQ(done.size(), 2u);
  for (const study::TrialRow& row : done) {
    EXPECT_TRUE(row.reached_target);
    EXPECT_GT(row.time_s, 0);
    // The mouse moves in straight lines between two frames.
    EXPECT_LT(row.error_mm, 10) << row.index;
    EXPECT_NEAR(row.traveled_mm, 60, 20) << row.index;
    EXPECT_TRUE(test::exists(folder_ / fmt::format("data/recordings/007-{:03}.catlog", row.index)));
  }
  EXPECT_NE(done[0].condition, done[1].condition);
  EXPECT_EQ(test::read_file(folder_ / "data/questionnaire/007.csv"), "question,answer\nhard,3 very\nhow,\"so, so\"\n");
}

/// The paper's study with a trial in each condition, from the first page to the questionnaire. It takes minutes, so it is run by hand only:
///   build/release/test_engine_app --gtest_also_run_disabled_tests --gtest_filter='*AllFourTasks*'
/// With CATENA_XVFB="-fbdir DIR" and CATENA_PICTURE=PROGRAM, the program is called with a name for each page, trial and question.
TEST_F(StudyWindowTest, DISABLED_AScriptedMouseCompletesAllFourTasks) {
  const std::string studies = test::source_dir() + "/assets/studies/";
  std::string text = test::read_file(studies + "proxy-chain.json");
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace("\"trials\": 10", "\"trials\": 1");
  replace("\"training\": 2", "\"training\": 0");
  replace("proxy-chain.txt", "pages.txt");
  write_study(text, test::read_file(studies + "proxy-chain.txt"));
  const std::vector<study::Trial> trials = study::make_session(study_, 7);
  // Captures each page under a name, and continues.
  const std::string pages =
      "pages() { n=0; while ! xdotool search --name '^catena study  (trial|question)' > /dev/null 2>&1 && kill -0 $V 2> /dev/null; "
      "do "
      "sleep 0.5; picture page-$1-$n; n=$((n+1)); keys space; sleep 0.3; done; }\n";
  std::string script = pages + "study\npages 0\n";
  for (const study::Trial& trial : trials)
    script += way_of(study_, trial, trials.size(), 0.06) + fmt::format("sleep 0.5; pages {}\n", trial.index + 1);
  script +=
      "keys 4; picture question-1; keys Return 1; picture question-2; keys Return; sleep 0.3; xdotool type --delay 30 'I went slowly at "
      "first.'\n"
      "sleep 0.5; picture question-3; keys Return; xdotool type --delay 30 'No.'; keys Return; sleep 0.5; picture end; keys space\nwait "
      "$V\n";
  ASSERT_EQ(drive(script), 0) << log();
  EXPECT_EQ(log().find("never"), std::string::npos) << log();
  const std::vector<study::TrialRow> done = rows();
  ASSERT_EQ(done.size(), trials.size());
  for (const study::TrialRow& row : done) {
    EXPECT_TRUE(row.reached_target) << row.index;
    fmt::print("{:<14} {:<6} {:6.2f} s {:6.2f} mm off, {:6.1f} mm travelled\n", row.task, row.condition, row.time_s, row.error_mm,
               row.traveled_mm);
  }
}

TEST(StudyRunCommand, ErrorsAreReportedBeforeAnyWindowAndWriteNothing) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "study.json", kStudy);
  const auto refused = [&](const test::Words& options, const std::string& part) {
    test::run_refused(test::joined({"study", "run", folder / "study.json", "-o", folder / "data"}, options), part);
    EXPECT_FALSE(test::exists(folder / "data"));
  };
  refused({"--subject", "7", "--device", "mouse"}, "pages.txt: ");
  test::write_file(folder / "pages.txt", "# before nothing\n");
  refused({"--subject", "7", "--device", "mouse"}, "pages.txt:1: there is no section \"before nothing\"");
  test::write_file(folder / "pages.txt", "# introduction\nHello\n");
  refused({"--subject", "0", "--device", "mouse"}, "--subject");
  refused({"--subject", "7", "--device", "falcon:7"}, "catena: ");
  refused({"--subject", "7", "--device", "simulated"}, "can exert forces; --forces on");
  refused({"--subject", "7", "--device", "mouse", "--forces", "on"}, "cannot exert forces");
  refused({"--subject", "7"}, "--device");
}

}  // namespace catena::app::study_window_test
