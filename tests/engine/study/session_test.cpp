// SPDX-License-Identifier: MIT
// The design over 24 subjects: the Latin square, interleaved conditions, and seeds that follow from the subject's number.
#include <map>
#include <set>

#include "engine/study/session.h"
#include "tests/engine/study/study_fixture.h"

namespace session_test {

using namespace catena;

std::vector<int> order_of(const std::vector<study::Trial>& session) {
  std::vector<int> order;
  for (const study::Trial& trial : session)
    if (order.empty() || order.back() != trial.task) order.push_back(trial.task);
  return order;
}

TEST(Session, TasksAreALatinSquareBalancedForOrder) {
  for (const int count : {1, 2, 3, 4, 5, 6}) {
    const int rows = count % 2 == 0 ? count : 2 * count;
    std::map<std::pair<int, int>, int> at_place, follows;
    for (int row = 0; row < rows; ++row) {
      const std::vector<int> order = study::latin_square_row(count, row);
      ASSERT_EQ(order.size(), static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        ++at_place[{i, order[static_cast<std::size_t>(i)]}];
        if (i > 0) ++follows[{order[static_cast<std::size_t>(i) - 1], order[static_cast<std::size_t>(i)]}];
      }
    }
    ASSERT_EQ(at_place.size(), static_cast<std::size_t>(count * count));
    for (const auto& [where, times] : at_place) EXPECT_EQ(times, rows / count) << count;
    ASSERT_EQ(follows.size(), static_cast<std::size_t>(count * (count - 1)));
    for (const auto& [pair, times] : follows) EXPECT_EQ(times, rows / count) << count;
  }
}

TEST(Session, TwentyFourSubjectsDoEachTaskInEachPositionEquallyOften) {
  std::map<std::pair<std::size_t, int>, int> at_place;
  for (int subject = 1; subject <= 24; ++subject) {
    const std::vector<int> order = order_of(study::make_session(study_rig::paper_study(), subject));
    ASSERT_EQ(order.size(), 4u) << "a task is one block";
    for (std::size_t i = 0; i < order.size(); ++i) ++at_place[{i, order[i]}];
  }
  EXPECT_EQ(at_place.size(), 16u);
  for (const auto& [where, times] : at_place) EXPECT_EQ(times, 6);
}

TEST(Session, ConditionsAreInterleavedWithEqualStimuli) {
  const study::Study& study = study_rig::paper_study();
  std::set<int> seeds;
  int changes = 0, neighbours = 0, first_of_pair[2] = {0, 0};
  for (int subject = 1; subject <= 24; ++subject) {
    const std::vector<study::Trial> session = study::make_session(study, subject);
    ASSERT_EQ(session.size(), 4u * 2u * 12u);
    std::map<int, int> counted;
    std::map<std::tuple<int, int>, std::vector<study::Trial>> pairs;
    for (std::size_t i = 0; i < session.size(); ++i) {
      const study::Trial& trial = session[i];
      EXPECT_EQ(trial.index, static_cast<int>(i));
      EXPECT_EQ(trial.subject, subject);
      EXPECT_EQ(trial.training, trial.stimulus >= study.trials);
      pairs[{trial.task, trial.stimulus}].push_back(trial);
      if (!trial.training) ++counted[trial.condition];
      if (i == 0 || session[i - 1].task != trial.task || session[i - 1].training != trial.training) continue;
      if (!trial.training) {
        EXPECT_NE(session[i - 1].stimulus, trial.stimulus) << "a stimulus twice in a row tells the conditions apart";
        ++neighbours;
        changes += session[i - 1].condition != trial.condition;
      }
      EXPECT_LE(session[i - 1].training, true);
    }
    EXPECT_EQ(counted[0], 40);
    EXPECT_EQ(counted[1], 40);
    for (const auto& [what, both] : pairs) {
      ASSERT_EQ(both.size(), 2u);
      EXPECT_NE(both[0].condition, both[1].condition);
      EXPECT_EQ(both[0].seed, both[1].seed);
      EXPECT_GE(both[0].seed, 0);
      seeds.insert(both[0].seed);
      if (!both[0].training) ++first_of_pair[both[0].condition];
    }
  }
  EXPECT_EQ(seeds.size(), 24u * 4u * 12u) << "stimuli of subjects and tasks are different ones";
  // By chance, 10/19 of neighboring trials differ in condition, and each condition is first in half of the pairs: within five standard
  // deviations.
  const double expected = neighbours * 10.0 / 19, spread = std::sqrt(neighbours * 0.25);
  EXPECT_NEAR(changes, expected, 5 * spread);
  EXPECT_NEAR(first_of_pair[0], 480, 5 * std::sqrt(960 * 0.25));
}

TEST(Session, DependsOnTheSubjectAndTheStudysSeedOnly) {
  const study::Study& study = study_rig::paper_study();
  EXPECT_EQ(study::make_session(study, 7), study::make_session(study, 7));
  EXPECT_NE(study::make_session(study, 7), study::make_session(study, 11));
  study::Study other = study;
  other.seed += 1;
  EXPECT_NE(study::make_session(study, 7)[0].seed, study::make_session(other, 7)[0].seed);
  // A fixed value: every machine draws the same seed.
  EXPECT_EQ(study::make_session(study, 1)[0].seed, 936779463);
}

}  // namespace session_test
