// SPDX-License-Identifier: MIT
// Rows of trials: they read back exactly, and a row that a kill has truncated is dropped, but no other row.
#include <filesystem>

#include "engine/study/protocol_deviations.h"
#include "engine/study/trial_table.h"
#include "tests/engine/study/study_fixture.h"

namespace trial_table_test {

using namespace catena;
using study::ParticipantKind;

class TrialTable : public testing::Test {
 protected:
  auto open_people() const { return study::DataFolder::open(folder_ / "d", study_rig::small(), ParticipantKind::people); }
  test::TemporaryFolder folder_;
};

study::TrialRow row(int subject, int index) {
  study::TrialRow r;
  r.subject = subject;
  r.index = index;
  r.task = "trace";
  r.kind = "tracing";
  r.condition = "free";
  r.seed = 1 << 29;
  r.reached_target = index % 2 == 0;
  r.time_s = 1.0 / 3;
  r.error_mm = 0.1 + index;
  r.end_mm = Vec3(1e-300, -2.5, 1e17);
  return r;
}

TEST_F(TrialTable, RowsReadBackExactly) {
  const std::string text = study::table_header() + study::format_row(row(1, 0)) + study::format_row(row(1, 1));
  const auto rows = study::parse_rows(text, "t.csv");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(*rows, (std::vector<study::TrialRow>{row(1, 0), row(1, 1)}));
}

TEST_F(TrialTable, ErrorsNameTheLine) {
  const std::string header = study::table_header(), good = study::format_row(row(1, 0));
  const auto said = [](const std::string& text) {
    const auto rows = study::parse_rows(text, "t.csv");
    return rows ? std::string() : rows.error().message;
  };
  EXPECT_TRUE(said("subject\n" + good).starts_with("t.csv:1:"));
  EXPECT_TRUE(said(header + good + "1,2,3\n").starts_with("t.csv:3: the row has 3 cells"));
  std::string bad = good;
  bad.replace(bad.find("target"), 6, "tarmac");
  EXPECT_NE(said(header + bad).find("\"tarmac\" is not valid for the column ended"), std::string::npos);
  EXPECT_TRUE(said("").starts_with("t.csv:1:"));
}

TEST_F(TrialTable, ATruncationLosesAtMostTheLastRow) {
  const auto data = open_people();
  ASSERT_TRUE(data);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(data->append(row(4, i)));
  const std::string path = study::subject_file(folder_ / "d", 4), whole = test::read_file(path);
  EXPECT_TRUE(path.ends_with("d/subjects/004.csv"));
  std::size_t lines = 0;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    test::write_file(path, whole.substr(0, cut));
    const std::size_t ends = static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut), '\n'));
    const auto rows = data->rows(4);
    ASSERT_TRUE(rows) << cut << ": " << rows.error().message;
    ASSERT_EQ(rows->size(), ends == 0 ? 0 : ends - 1) << cut;
    lines = std::max(lines, rows->size());
    // The next appended row begins a new line.
    if (cut % 97 != 0) continue;
    ASSERT_TRUE(data->append(row(4, 9)));
    const auto after = data->rows(4);
    ASSERT_TRUE(after) << cut;
    EXPECT_EQ(after->back(), row(4, 9));
    EXPECT_EQ(after->size(), rows->size() + 1) << cut;
  }
  EXPECT_EQ(lines, 3u);
}

TEST(ProtocolDeviations, AreRowsThatAreNotInTheDesign) {
  const study::Study study = study_rig::small();
  std::vector<study::TrialRow> rows;
  for (const int subject : {1, 2, 3})
    for (const study::Trial& trial : study::make_session(study, subject)) rows.push_back(study::make_row(study, trial, {}));
  EXPECT_EQ(study::find_protocol_deviations(study, rows), std::vector<std::string>{});
  std::vector<study::TrialRow> trained = rows;
  std::erase_if(trained, [](const study::TrialRow& r) { return r.training; });
  EXPECT_EQ(study::find_protocol_deviations(study, trained), std::vector<std::string>{}) << "a model does not train";
  rows.pop_back();
  rows[0].seed += 1;
  rows[1].condition = "other";
  const std::vector<std::string> lines = study::find_protocol_deviations(study, rows);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("subject 1, trial 0: seed is ")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("subject 1, trial 1: condition is other, but ")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("subject 3: ")) << lines[2];
  for (study::TrialRow& r : rows) r.block = 9;
  EXPECT_TRUE(study::find_protocol_deviations(study, rows)[3].ends_with(" more trials deviate")) << "a few, the rest counted";
}

/// Expects that the folder is not opened, for the stated reason.
void refused(const std::string& folder, const study::Study& study, ParticipantKind kind, const std::string& reason) {
  const auto data = study::DataFolder::open(folder, study, kind);
  ASSERT_FALSE(data) << reason;
  EXPECT_NE(data.error().message.find(reason), std::string::npos) << data.error().message;
}

TEST_F(TrialTable, AFolderHasOneStudyAndOneWriter) {
  const study::Study study = study_rig::small();
  {
    const auto first = open_people();
    ASSERT_TRUE(first);
    refused(folder_ / "d", study, ParticipantKind::people, "another session writes to it");
  }
  EXPECT_EQ(test::read_file(folder_ / "d/study.json"), study.text) << "verbatim";
  refused(folder_ / "d", study_rig::small("small", "other"), ParticipantKind::people, "another study");
  EXPECT_EQ(test::read_file(folder_ / "d/study.json"), study.text);
}

TEST_F(TrialTable, PeopleAndModelsNeverShareAFolder) {
  const study::Study study = study_rig::small();
  {
    const auto people = study::DataFolder::open(folder_ / "p", study, ParticipantKind::people);
    ASSERT_TRUE(people && people->append(row(1, 0)));
    const auto model = study::DataFolder::open(folder_ / "m", study, ParticipantKind::model);
    ASSERT_TRUE(model && model->append(row(1, 0)));
  }
  EXPECT_FALSE(study::is_simulated(folder_ / "p"));
  EXPECT_TRUE(study::is_simulated(folder_ / "m"));
  refused(folder_ / "p", study, ParticipantKind::model, "contains trials of people");
  refused(folder_ / "m", study, ParticipantKind::people, "contains trials of a model");
  EXPECT_FALSE(study::is_simulated(folder_ / "p"));
}

TEST_F(TrialTable, StrayFilesHaveNotesAndWrongSubjectsAreRefused) {
  const auto data = open_people();
  ASSERT_TRUE(data && data->append(row(1, 0)) && data->append(row(2, 0)));
  const std::string subjects = folder_ / "d/subjects/";
  test::write_file(subjects + "001 (copy).csv", "");
  test::write_file(subjects + "0004.csv", "");
  test::write_file(subjects + "003.csv", "");
  auto table = study::read_trial_table(folder_ / "d");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows.size(), 2u);
  EXPECT_EQ(table->notes.size(), 3u);
  std::filesystem::rename(subjects + "002.csv", subjects + "003.csv");
  const auto other = study::read_trial_table(folder_ / "d");
  ASSERT_FALSE(other);
  EXPECT_TRUE(other.error().message.ends_with("003.csv:2: the trial belongs to subject 2; subject 3 was expected"));
  std::filesystem::remove(subjects + "003.csv");
  std::filesystem::create_symlink("nowhere.csv", subjects + "003.csv");
  EXPECT_FALSE(study::read_trial_table(folder_ / "d")) << "a link that leads nowhere";
}

TEST_F(TrialTable, IsReadFromSubjectsFilesOrFromTheTable) {
  const auto data = open_people();
  ASSERT_TRUE(data);
  for (const int subject : {2, 1, 1000, 11}) ASSERT_TRUE(data->append(row(subject, 0)));
  const auto loose = study::read_trial_table(folder_ / "d");
  ASSERT_TRUE(loose);
  EXPECT_EQ(loose->rows.size(), 4u);
  EXPECT_EQ(loose->rows.back().subject, 1000) << "by number, not by name";
  ASSERT_TRUE(data->write_table());
  EXPECT_TRUE(study::read_trial_table(folder_ / "d")->notes.empty());
  // Rows of a later session count before they are in the table, and a truncated row does not matter.
  ASSERT_TRUE(data->append(row(11, 1)));
  const std::string torn = test::read_file(study::subject_file(folder_ / "d", 1)) + "1,1,tra";
  test::write_file(study::subject_file(folder_ / "d", 1), torn);
  const auto newer = study::read_trial_table(folder_ / "d");
  ASSERT_TRUE(newer);
  EXPECT_EQ(newer->notes.size(), 2u) << "torn, and another table";
  EXPECT_EQ(newer->rows.size(), 5u);
  EXPECT_EQ(test::read_file(study::subject_file(folder_ / "d", 1)), torn) << "who reads writes nothing";
  std::filesystem::remove_all(folder_ / "d/subjects");
  const auto table = study::read_trial_table(folder_ / "d");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows, loose->rows);
  EXPECT_FALSE(study::read_trial_table(folder_ / "nothing"));
}

}  // namespace trial_table_test
