// SPDX-License-Identifier: MIT
/// `catena study analyse` finds simulated effects at the stated power, and absent effects at the rate alpha, with the same code that
/// analyses a data folder.
#include <gtest/gtest.h>

#include "engine/study/statistics/distributions.h"
#include "engine/study/statistics/power.h"
#include "tests/engine/app/trial_table_fixtures.h"

namespace study_recovery_test {

using namespace study_tables;

/// The number of tables: 400, or the value of CATENA_STUDY_TABLES.
int table_count() {
  const char* text = std::getenv("CATENA_STUDY_TABLES");
  return text != nullptr ? std::atoi(text) : 400;
}

TEST(StudyRecovery, ASimulatedDifferenceIsFoundAtTheStatedPower) {
  const double power = statistics::paired_power(0.5, 20, 0.05);
  EXPECT_NEAR(power, 0.5645, 1e-4);
  std::mt19937_64 random(11);
  const int tables = table_count();
  int found = 0, by_flips = 0, supported = 0, elsewhere = 0;
  for (int i = 0; i < tables; ++i) {
    const Analysis a = run_analysis(make_trial_table(random, {.effect = 0.5}));
    EXPECT_EQ(a.total_rejections().total(), 0);
    const PairedComparison& p = find_difference(a, Quantity::error, 0);
    found += p.test->p < 0.05 ? 1 : 0;
    by_flips += p.sign_flip_test->p < 0.05 ? 1 : 0;
    supported += find_finding(a, "held is more accurate").verdict == Verdict::supported ? 1 : 0;
    elsewhere += find_difference(a, Quantity::error, 1).test->p < 0.05 ? 1 : 0;
  }
  const auto share = statistics::proportion_interval(found, tables, 0.99),
             false_share = statistics::proportion_interval(elsewhere, tables, 0.99);
  std::printf("planted d_z 0.5: found in %d of %d tables (power %.4f), by sign flips in %d, after correction in %d; nothing planted: %d\n",
              found, tables, power, by_flips, supported, elsewhere);
  EXPECT_TRUE(share.contains(power)) << found;
  EXPECT_TRUE(false_share.contains(0.05)) << elsewhere;
  // The correction for eight tests costs power: the corrected findings are fewer.
  EXPECT_LT(supported, found);
  EXPECT_GT(supported, 0.15 * tables);
  EXPECT_TRUE(statistics::proportion_interval(by_flips, tables, 0.999).contains(power)) << by_flips;
}

TEST(StudyRecovery, WithoutEffectsTheErrorRateIsAlpha) {
  std::mt19937_64 random(12);
  const int tables = table_count();
  int tests = 0, found = 0, by_flips = 0, families = 0, correlations = 0, trades = 0;
  for (int i = 0; i < tables; ++i) {
    const Analysis a = run_analysis(make_trial_table(random, {}));
    bool any = false;
    for (const PairedComparison& p : a.condition_comparisons) {
      ++tests;
      found += p.test->p < 0.05 ? 1 : 0;
      by_flips += p.sign_flip_test->p < 0.05 ? 1 : 0;
      any = any || p.corrected_p < 0.05;
    }
    families += any ? 1 : 0;
    for (const ConditionCorrelation& c : a.correlations) correlations += c.result->p < 0.05 ? 1 : 0;
    for (const PairedComparison& p : a.tradeoff_comparisons) trades += p.test->p < 0.05 ? 1 : 0;
  }
  std::printf(
      "nothing planted: %d of %d tests below 0.05, %d by sign flips; %d of %d families after correction; %d of %d correlations; %d of %d "
      "trades\n",
      found, tests, by_flips, families, tables, correlations, 4 * tables, trades, 2 * tables);
  EXPECT_TRUE(statistics::proportion_interval(found, tests, 0.99).contains(0.05)) << found;
  EXPECT_TRUE(statistics::proportion_interval(by_flips, tests, 0.99).contains(0.05)) << by_flips;
  EXPECT_LE(statistics::proportion_interval(families, tables, 0.99).low, 0.05) << families;
  EXPECT_TRUE(statistics::proportion_interval(correlations, 4 * tables, 0.99).contains(0.05)) << correlations;
  EXPECT_TRUE(statistics::proportion_interval(trades, 2 * tables, 0.99).contains(0.05)) << trades;
}

}  // namespace study_recovery_test
