// SPDX-License-Identifier: MIT
// A study session without a window: instructions, the procedure, and the files of a subject.
#include "engine/app/study/procedure.h"

#include <filesystem>

#include "engine/app/study/subject_folder.h"
#include "engine/app/study/tick_observer.h"
#include "tests/engine/app/program_runs.h"
#include "tests/support/results.h"

namespace catena::app::study_procedure_test {

using Stage = Procedure::Stage;

constexpr const char* kInstructions =
    "# introduction\n\nWelcome\none\ntwo\n\n- a point\n- another\n---\nThe hand\n"
    "# before trace\nTrace\n# end\nThanks\n";

Instructions instructions() {
  auto parsed = parse_instructions(kInstructions, "i.txt", {"trace", "flow"});
  EXPECT_TRUE(parsed) << parsed.error().message;
  return parsed ? *parsed : Instructions{};
}

study::Study small_study() {
  study::Study study;
  study.tasks.resize(2);
  study.tasks[0].name = "trace";
  study.tasks[1].name = "flow";
  study.conditions.resize(2);
  study.questions = {{"hard", "Was it hard?", {"no", "a little", "very"}}, {"how", "How?", {}}};
  return study;
}

/// Two blocks, each of one training trial and two experimental trials.
std::vector<study::Trial> six_trials() {
  std::vector<study::Trial> trials;
  for (int i = 0; i < 6; ++i) trials.push_back({.index = i, .block = i / 3, .task = i / 3, .training = i % 3 == 0});
  return trials;
}

const KeyPress kSpace{KeyPress::Kind::space}, kEnter{KeyPress::Kind::enter}, kBackspace{KeyPress::Kind::backspace};

KeyPress letter(char32_t c) { return {KeyPress::Kind::character, c}; }

/// Presses space until the next trial is ready or no page is left, and returns the headings of the pages.
std::vector<std::string> pages_passed(Procedure& procedure) {
  std::vector<std::string> headings;
  while (procedure.stage() == Stage::page) {
    headings.push_back(procedure.page().heading);
    procedure.handle_key(kSpace, false);
  }
  return headings;
}

TEST(StudyInstructions, PagesHaveAHeadingAndParagraphs) {
  const Instructions all = instructions();
  ASSERT_EQ(all.introduction.size(), 2u);
  EXPECT_EQ(all.introduction[0], (InstructionPage{"Welcome", {"one two", "- a point", "- another"}}));
  EXPECT_EQ(all.introduction[1], (InstructionPage{"The hand", {}}));
  EXPECT_EQ(all.pages_before_task("trace").size(), 1u);
  EXPECT_TRUE(all.pages_before_task("flow").empty());
  EXPECT_EQ(all.end.size(), 1u);
}

TEST(StudyInstructions, ErrorsNameTheLine) {
  for (const auto& [text, message] :
       {std::pair{"hello\n", "i.txt:1: text before the first section"},
        {"# introduction\nA\n# before tracee\nB\n", "i.txt:3: there is no section \"before tracee\" (did you mean \"before trace\"?)"},
        {"# end\n---\nA\n", "i.txt:2: a page without text"},
        {"# end\nA\n---\n", "i.txt:3: a page without text"},
        {"# end\nA\n# end\nB\n", "i.txt:3: the section \"end\" is repeated"}}) {
    const auto parsed = parse_instructions(text, "i.txt", {"trace"});
    ASSERT_FALSE(parsed) << text;
    EXPECT_TRUE(parsed.error().message.starts_with(message)) << parsed.error().message;
  }
}

TEST(StudyProcedure, GoesFromTheFirstPageToTheLast) {
  const study::Study study = small_study();
  Procedure procedure(study, instructions(), six_trials());
  using Words = std::vector<std::string>;
  EXPECT_EQ(pages_passed(procedure), (Words{"Welcome", "The hand", "Trace", "Training"}));
  for (std::size_t i = 0; i < 6; ++i) {
    if (i == 1 || i == 4) {
      EXPECT_EQ(pages_passed(procedure), Words{"Main trials"}) << i;
    }
    // The second task has no instruction page.
    if (i == 3) {
      EXPECT_EQ(pages_passed(procedure), (Words{"Pause", "Training"}));
    }
    ASSERT_EQ(procedure.stage(), Stage::ready) << i;
    EXPECT_EQ(procedure.trial(), i);
    procedure.handle_key(kSpace, false);
    EXPECT_EQ(procedure.stage(), Stage::ready) << "the cursor is not at the start";
    procedure.handle_key(i % 2 == 0 ? kSpace : kEnter, true);
    ASSERT_EQ(procedure.stage(), Stage::running);
    procedure.handle_key(kSpace, true);
    procedure.handle_key(letter('p'), true);
    EXPECT_EQ(procedure.stage(), Stage::running) << "no key counts";
    procedure.complete_trial();
  }
  ASSERT_EQ(procedure.stage(), Stage::question);
  procedure.handle_key(kEnter, false);
  EXPECT_EQ(procedure.question().name, "hard") << "nothing was chosen";
  for (const char key : {'4', '0', 'x', '2', '3'}) procedure.handle_key(letter(key), false);
  EXPECT_EQ(procedure.typed_answer(), "very");
  procedure.handle_key(kEnter, false);
  const auto hard = test::value_of(procedure.take_answer());
  EXPECT_EQ(hard.question + "=" + hard.answer, "hard=very");
  EXPECT_FALSE(procedure.take_answer()) << "once";
  for (const char32_t c : {U'a', U' ', U'\u00e9', U'b'}) procedure.handle_key(letter(c), false);
  procedure.handle_key(kSpace, false);
  procedure.handle_key(kBackspace, false);
  procedure.handle_key(kBackspace, false);
  EXPECT_EQ(procedure.typed_answer(), "a ") << "a whole letter goes, and space is text";
  procedure.handle_key(kEnter, false);
  EXPECT_EQ(procedure.take_answer()->answer, "a ");
  EXPECT_EQ(pages_passed(procedure), Words{"Thanks"});
  EXPECT_EQ(procedure.stage(), Stage::finished);
  EXPECT_EQ(procedure.progress_text(), "6 of 6 trials and 2 of 2 questions are done");
}

TEST(StudyProcedure, APauseOrAnAbortedTrialReturnsToTheSameTrial) {
  const study::Study study = small_study();
  Procedure procedure(study, {}, six_trials());
  pages_passed(procedure);
  procedure.handle_key(letter('P'), true);
  EXPECT_EQ(procedure.page().heading, "Pause");
  EXPECT_EQ(procedure.next_trial(), 0u);
  procedure.handle_key(kSpace, true);
  ASSERT_EQ(procedure.stage(), Stage::ready);
  procedure.handle_key(kSpace, true);
  procedure.abort_trial("Why");
  ASSERT_EQ(procedure.stage(), Stage::page);
  EXPECT_EQ(procedure.page().paragraphs.front(), "Why");
  procedure.complete_trial();
  procedure.handle_key(kSpace, true);
  EXPECT_EQ(procedure.stage(), Stage::ready);
  EXPECT_EQ(procedure.trial(), 0u) << "it was not done";
}

TEST(StudyProcedure, ContinuesAfterAnyNumberOfTrialsAndAnswers) {
  const study::Study study = small_study();
  for (std::size_t finished = 0; finished <= 6; ++finished)
    for (std::size_t answered = 0; answered <= (finished == 6 ? 2u : 0u); ++answered) {
      Procedure procedure(study, instructions(), six_trials(), finished, answered);
      std::vector<std::size_t> trials;
      std::vector<std::string> headings, questions;
      for (int guard = 0; procedure.stage() != Stage::finished && guard < 100; ++guard) {
        const auto passed = pages_passed(procedure);
        headings.insert(headings.end(), passed.begin(), passed.end());
        if (procedure.stage() == Stage::ready) {
          trials.push_back(procedure.trial());
          procedure.handle_key(kSpace, true);
          procedure.complete_trial();
        } else if (procedure.stage() == Stage::question) {
          questions.push_back(procedure.question().name);
          procedure.handle_key(letter('1'), false);
          procedure.handle_key(kEnter, false);
        }
      }
      ASSERT_EQ(trials.size(), 6 - finished);
      for (std::size_t k = 0; k < trials.size(); ++k) EXPECT_EQ(trials[k], finished + k);
      EXPECT_EQ(questions.size(), 2 - answered);
      EXPECT_EQ(headings.front(), finished + answered > 0 ? "Welcome back" : "Welcome");
      // A continued session shows the instructions of the current task.
      EXPECT_EQ(std::ranges::count(headings, "Trace"), finished < 3 ? 1 : 0) << finished;
      EXPECT_EQ(std::ranges::count(headings, "Thanks"), 1);
    }
}

// ---- the folder ----

constexpr const char* kStudy = R"({
  "name": "small", "seed": 3, "trials": 2, "training": 0,
  "tasks": [{"name": "trace", "kind": "tracing", "dimensions": 2, "field": "flow", "stimulus": {"path_mm": 20, "context_streamlines": 0},
    "scene": {"fields": {"flow": {"analytic": "vortices", "dimensions": 2, "seed": 5}},
              "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0]}, "workspace": {"metres_per_unit": 0.05}}}],
  "conditions": [{"name": "free", "chain": []}, {"name": "held", "chain": [{"name": "hold", "type": "drag", "threshold": 0.01}]}],
  "questionnaire": [{"name": "hard", "question": "Was it hard, or \"hard\"?"}, {"name": "how", "question": "How?"}]
})";

class StudyFolder : public testing::Test {
 protected:
  StudyFolder() {
    test::write_file(folder_ / "study.json", kStudy);
    auto read = study::read_study(folder_ / "study.json");
    EXPECT_TRUE(read) << read.error().message;
    if (read) study_ = std::move(*read);
  }
  Result<SubjectFolder> open(int subject = 7) { return SubjectFolder::open(folder_ / "data", study_, subject); }
  std::string read(const std::string& name) const { return test::read_file(folder_ / ("data/" + name)); }

  test::TemporaryFolder folder_;
  study::Study study_;
};

TEST_F(StudyFolder, OnlyOneSessionAtATimeWritesToAFolder) {
  {
    auto first = test::value_of(open());
    const auto second = open(8);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().message, folder_ / "data: another session writes to it; its end was expected, or another folder");
  }
  EXPECT_TRUE(open(8)) << "the lock has gone with its holder";
}

TEST_F(StudyFolder, ARowNeedsItsRecordingAndTheNextSessionContinues) {
  {
    auto folder = test::value_of(open());
    ASSERT_EQ(folder.trials().size(), 4u);
    const std::string unfinished = folder.unfinished_recording(folder.trials()[0]);
    test::write_file(unfinished, "ticks");
    study::TrialResult measured;
    measured.time_s = 1.25;
    ASSERT_TRUE(folder.save_trial(folder.trials()[0], measured, unfinished));
    EXPECT_FALSE(test::exists(unfinished));
    EXPECT_EQ(read("recordings/007-000.catlog"), "ticks");
    // Without a recording, no row is written.
    EXPECT_FALSE(folder.save_trial(folder.trials()[1], measured, unfinished));
  }
  auto again = test::value_of(open());
  EXPECT_EQ(again.finished_trials(), 1u);
  const std::string rows = read("subjects/007.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 2) << rows;
}

TEST_F(StudyFolder, AnswersSurviveATruncationAtAnyByte) {
  {
    auto folder = open();
    ASSERT_TRUE(folder && folder->save_answer("hard", "a \"bit\", yes\n") && folder->save_answer("how", "so"));
  }
  const std::string whole = read("questionnaire/007.csv"), one = "question,answer\nhard,\"a \"\"bit\"\", yes \"\n";
  EXPECT_EQ(whole, one + "how,so\n");
  for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) {
    test::write_file(folder_ / "data/questionnaire/007.csv", whole.substr(0, bytes));
    auto folder = open();
    ASSERT_TRUE(folder) << bytes << " " << folder.error().message;
    ASSERT_EQ(folder->answered_questions(), bytes == whole.size() ? 2u : bytes >= one.size() ? 1u : 0u) << bytes;
    if (folder->answered_questions() == 0) {
      ASSERT_TRUE(folder->save_answer("hard", "a \"bit\", yes\n"));
    }
    if (folder->answered_questions() <= 1) {
      ASSERT_TRUE(folder->save_answer("how", "so"));
    }
    ASSERT_EQ(read("questionnaire/007.csv"), whole) << bytes;
  }
}

TEST_F(StudyFolder, RowsAndAnswersOfAnotherSessionAreRefused) {
  ASSERT_TRUE(open());
  test::write_file(folder_ / "data/questionnaire/007.csv", "question,answer\nother,1\n");
  const auto answers = open();
  ASSERT_FALSE(answers);
  EXPECT_TRUE(test::has(answers.error().message, "007.csv:2: the row is not an answer to question 1"));
  std::filesystem::remove(folder_ / "data/questionnaire/007.csv");
  study::Trial second = study::make_session(study_, 7)[1];
  second.index = 1;
  test::write_file(folder_ / "data/subjects/007.csv", study::table_header() + study::format_row(study::make_row(study_, second, {})));
  const auto rows = open();
  ASSERT_FALSE(rows);
  EXPECT_TRUE(test::has(rows.error().message, "007.csv:2: the row is not trial 0"));
}

TEST(StudyTickObserver, ForwardsEveryTickAndReportsLostTicks) {
  struct Counting final : haptics::TickSink {
    void put(const haptics::ProbeSample&, const HapticState&) noexcept override { ++count; }
    int count = 0;
  } next;
  TickObserver tap(100);
  tap.begin(&next);
  HapticState state;
  for (std::uint64_t k = 1; k <= 50; ++k) {
    state.tick = k;
    state.program_epoch = 9;
    state.t_s = 0.001 * static_cast<double>(k);
    state.probe = Vec3(static_cast<double>(k), 0, 0);
    state.condition = k == 50 ? TickCondition::no_device : TickCondition::normal;
    tap.put({}, state);
  }
  for (int k = 1; k <= 50; ++k) {
    const auto tick = tap.pop();
    ASSERT_TRUE(tick) << k;
    EXPECT_EQ(tick->epoch, 9u);
    EXPECT_EQ(tick->probe.x, k);
    EXPECT_EQ(tick->is_valid, k != 50);
  }
  EXPECT_FALSE(tap.pop());
  EXPECT_EQ(next.count, 50);
  EXPECT_FALSE(tap.has_lost_ticks());
  for (int k = 0; k < 1000; ++k) tap.put({}, state);
  EXPECT_TRUE(tap.has_lost_ticks());
  EXPECT_EQ(next.count, 1050) << "the recording loses nothing by it";
  tap.begin(nullptr);
  EXPECT_FALSE(tap.has_lost_ticks() || tap.pop());
}

}  // namespace catena::app::study_procedure_test
