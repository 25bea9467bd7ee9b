// Rows of trials: they read back to the bit, and a line that a kill has torn is dropped, not the rest.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/study/trial_table.h"
#include "tests/engine/study/study_rig.h"

namespace trial_table_test {

using namespace catena;

study::Row row(int subject, int index) {
  study::Row r;
  r.subject = subject;
  r.index = index;
  r.task = "trace";
  r.kind = "tracing";
  r.condition = "free";
  r.seed = 1 << 29;
  r.by_target = index % 2 == 0;
  r.time_s = 1.0 / 3;
  r.error_mm = 0.1 + index;
  r.end_mm = Vec3(1e-300, -2.5, 1e17);
  return r;
}

TEST(TrialTable, RowsReadBackToTheBit) {
  const std::string text = study::table_header() + study::row_text(row(1, 0)) + study::row_text(row(1, 1));
  const auto rows = study::parse_rows(text, "t.csv");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(*rows, (std::vector<study::Row>{row(1, 0), row(1, 1)}));
}

TEST(TrialTable, FaultsAreToldWithTheirLine) {
  const std::string header = study::table_header(), good = study::row_text(row(1, 0));
  const auto said = [](const std::string& text) {
    const auto rows = study::parse_rows(text, "t.csv");
    return rows ? std::string() : rows.error().message;
  };
  EXPECT_TRUE(said("subject\n" + good).starts_with("t.csv:1:"));
  EXPECT_TRUE(said(header + good + "1,2,3\n").starts_with("t.csv:3: 3 cells"));
  std::string bad = good;
  bad.replace(bad.find("target"), 6, "tarmac");
  EXPECT_NE(said(header + bad).find("\"tarmac\" is no ended"), std::string::npos);
  EXPECT_TRUE(said("").starts_with("t.csv:1:"));
}

TEST(TrialTable, EveryTornEndCostsTheLastLineAtMost) {
  const test::TemporaryFolder folder;
  const study::Study study = study_rig::small();
  const auto data = study::DataFolder::open(folder / "d", study);
  ASSERT_TRUE(data);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(data->append(row(4, i)));
  const std::string path = study::subject_file(folder / "d", 4), whole = test::read_file(path);
  EXPECT_TRUE(path.ends_with("d/subjects/004.csv"));
  std::size_t lines = 0;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    test::write_file(path, whole.substr(0, cut));
    const std::size_t ends = static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut), '\n'));
    const auto rows = data->rows(4);
    ASSERT_TRUE(rows) << cut << ": " << rows.error().message;
    ASSERT_EQ(rows->size(), ends == 0 ? 0 : ends - 1) << cut;
    lines = std::max(lines, rows->size());
    // what is appended next begins a line
    if (cut % 97 != 0) continue;
    ASSERT_TRUE(data->append(row(4, 9)));
    const auto after = data->rows(4);
    ASSERT_TRUE(after) << cut;
    EXPECT_EQ(after->back(), row(4, 9));
    EXPECT_EQ(after->size(), rows->size() + 1) << cut;
  }
  EXPECT_EQ(lines, 3u);
}

TEST(TrialTable, AFolderHoldsOneStudy) {
  const test::TemporaryFolder folder;
  const study::Study study = study_rig::small();
  {
    const auto first = study::DataFolder::open(folder / "d", study);
    ASSERT_TRUE(first);
    const auto second = study::DataFolder::open(folder / "d", study);
    ASSERT_FALSE(second) << "two at a time";
    EXPECT_NE(second.error().message.find("another session writes to it"), std::string::npos);
  }
  EXPECT_EQ(test::read_file(folder / "d/study.json"), study.text) << "verbatim";
  const study::Study other = study::parse_study(study_rig::small_text("small", "other"), "other.json").value();
  const auto refused = study::DataFolder::open(folder / "d", other);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("another study"), std::string::npos);
  EXPECT_EQ(test::read_file(folder / "d/study.json"), study.text);
}

TEST(TrialTable, IsReadFromAllSubjectsAndFromTheTableAlone) {
  const test::TemporaryFolder folder;
  const auto data = study::DataFolder::open(folder / "d", study_rig::small());
  ASSERT_TRUE(data);
  for (const int subject : {2, 1, 1000, 11}) ASSERT_TRUE(data->append(row(subject, 0)));
  const auto loose = study::read_table(folder / "d");
  ASSERT_TRUE(loose);
  EXPECT_EQ(loose->rows.size(), 4u);
  EXPECT_EQ(loose->rows.back().subject, 1000) << "by number, not by name";
  ASSERT_TRUE(data->write_table());
  EXPECT_FALSE(study::read_table(folder / "d")->differs);
  // a session that came later counts before its rows are in the table, and one that is torn does not hinder
  ASSERT_TRUE(data->append(row(11, 1)));
  const std::string torn = test::read_file(study::subject_file(folder / "d", 1)) + "1,1,tra";
  test::write_file(study::subject_file(folder / "d", 1), torn);
  const auto newer = study::read_table(folder / "d");
  ASSERT_TRUE(newer);
  EXPECT_TRUE(newer->differs);
  EXPECT_EQ(newer->rows.size(), 5u);
  EXPECT_EQ(test::read_file(study::subject_file(folder / "d", 1)), torn) << "who reads writes nothing";
  std::filesystem::remove_all(folder / "d/subjects");
  const auto table = study::read_table(folder / "d");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows, loose->rows);
  EXPECT_FALSE(study::read_table(folder / "nothing"));
}

}  // namespace trial_table_test
