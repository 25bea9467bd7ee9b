// SPDX-License-Identifier: MIT
/// The statistics of a study against two independent packages: R 4.2.2 (t.test, cor.test, p.adjust, power.t.test with strict = TRUE, pt
/// with ncp and uniroot, binom.test), and scipy 1.10.1 with numpy 1.24.2 (permutation_test, and where stated). The expected numbers are as
/// the packages printed them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "engine/study/statistics/correlation.h"
#include "engine/study/statistics/distributions.h"
#include "engine/study/statistics/permutation.h"
#include "engine/study/statistics/power.h"
#include "engine/study/statistics/summary.h"

namespace statistics_test {

using namespace catena::statistics;
using Values = std::vector<double>;

const Values kA{4.1, 5.2, 3.9, 6, 5.5, 4.8, 5.1, 4.4}, kB{3, 4.1, 3.5, 4.2, 4.9, 3.3, 4, 3.9};
const Values kX{12.1, 9.4, 15.2, 11.8, 8.7, 13.3, 10.9, 14.6, 9.9, 12.4, 7.8, 16.1};
const Values kY{10.2, 9.9, 12.7, 12.1, 8.1, 11.0, 10.5, 12.2, 10.4, 11.9, 8.3, 12.8};
const Values kU{3.1, 2.2, 4.7, 3.9, 2.0, 4.1, 3.0, 4.9, 2.2, 3.3, 1.2, 5.5};
const Values kV{5.5, 7.1, 5.0, 5.9, 7.2, 6.6, 6.1, 4.2, 7.7, 5.3, 6.9, 5.1};
const double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

Values differences(const Values& a, const Values& b) {
  Values d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

TEST(Summary, MeanDeviationAndIntervalEqualThoseOfR) {
  const auto s = summarize(kA);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->mean, 4.875, 1e-14);
  EXPECT_NEAR(s->sd, 0.716638980639086, 1e-14);
  EXPECT_NEAR(s->half_width, 0.599125181069666, 1e-13);
}

TEST(PairedTest, EqualsR) {
  const auto t = paired_test(kA, kB);
  ASSERT_TRUE(t);
  EXPECT_NEAR(t->t, 5.830507581064425793, 1e-12);
  EXPECT_NEAR(t->p, 0.000643220069637476, 1e-15);
  EXPECT_NEAR(t->difference, 1.0125, 1e-14);
  EXPECT_NEAR(t->low, 0.601869875358157169, 1e-12);
  EXPECT_NEAR(t->high, 1.423130124641842631, 1e-12);
  EXPECT_NEAR(t->effect, 2.06139572416512, 1e-13);
  EXPECT_NEAR(t->effect_low, 0.779173192418667, 1e-8);
  EXPECT_NEAR(t->effect_high, 3.305244771680923, 1e-8);
  const auto second = paired_test(kX, kY);
  EXPECT_NEAR(second->t, 2.5155287625874014, 1e-12);
  EXPECT_NEAR(second->p, 0.0287028719014346, 1e-14);
  EXPECT_NEAR(second->low, 0.1260827559995779, 1e-12);
  EXPECT_NEAR(second->high, 1.8905839106670890, 1e-12);
  // Exchanged arguments: the mirror image.
  const auto turned = paired_test(kB, kA);
  EXPECT_NEAR(turned->effect_low, -t->effect_high, 1e-9);
  EXPECT_NEAR(turned->effect_high, -t->effect_low, 1e-9);
  EXPECT_EQ(turned->p, t->p);
}

TEST(PairedTest, TheIntervalOfAHugeEffectIsContinuous) {
  // Both sides of t = 200, where the method changes.
  const double below = solve_noncentrality(199.9, 19, 0.975), above = solve_noncentrality(200.1, 19, 0.975);
  EXPECT_NEAR(below / 199.9, above / 200.1, 1e-3 * above / 200.1);
}

TEST(Holm, EqualsR) {
  const Values corrected = holm_correction(Values{.01, .04, .03, .005, .6, .04}), expected{.05, .12, .12, .03, .6, .12};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(corrected[i], expected[i], 1e-15) << i;
  EXPECT_TRUE(holm_correction(Values{}).empty());
}

TEST(Pearson, EqualsR) {
  const auto c = pearson(kA, kB);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->r, 0.7340871442963960, 1e-14);
  EXPECT_NEAR(c->t, 2.6480008332449354, 1e-13);
  EXPECT_NEAR(c->p, 0.0381303558061136, 1e-14);
  EXPECT_NEAR(c->low, 0.0609357530901201, 1e-13);
  EXPECT_NEAR(c->high, 0.9482424614080353, 1e-13);
  // The strongest correlation of the paper: r = -0.704 of 20 subjects.
  EXPECT_NEAR(-0.704 * std::sqrt(18 / (1 - 0.704 * 0.704)), -4.206, 5e-4);
  EXPECT_NEAR(two_sided_p(-4.206, 18), 0.000531092930852332, 1e-15);
}

TEST(Pearson, ComparesTwoCorrelationsOfTheSameSubjects) {
  // Computed with numpy, by the covariance of correlations of I. Olkin and M. Siotani.
  const auto first = compare_correlations(kX, kY, kU, kV);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->first, 0.902045340815415, 1e-14);
  EXPECT_NEAR(first->second, -0.800299887086593, 1e-14);
  EXPECT_NEAR(first->z, 4.64816906031994, 1e-10);
  const auto second = compare_correlations(kX, kU, kY, kV);
  EXPECT_NEAR(second->z, 5.7445811387766, 1e-10);
  EXPECT_NEAR(second->p, 9.21488015937996e-09, 1e-18);
  EXPECT_FALSE(compare_correlations(kX, kY, kX, kY));
}

TEST(Regression, EqualsR) {
  const auto line = regression(kA, kB);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->slope, 0.607093184979138, 1e-14);
  EXPECT_NEAR(line->intercept, 0.902920723226699, 1e-13);
}

TEST(SignFlips, EqualScipy) {
  const auto a = sign_flip_test(differences(kA, kB)), x = sign_flip_test(differences(kX, kY));
  ASSERT_TRUE(a && x);
  EXPECT_EQ(a->p, 0.0078125);
  EXPECT_EQ(x->p, 156.0 / 4096);
  EXPECT_TRUE(x->exact);
}

TEST(SignFlips, ExactCountsEqualAFullEnumeration) {
  std::mt19937 random(3);
  for (const int n : {2, 3, 7, 13}) {
    Values d(static_cast<std::size_t>(n));
    for (double& x : d) x = static_cast<double>(random() % 21) - 9;  // with many ties
    const double seen = std::fabs(std::accumulate(d.begin(), d.end(), 0.0));
    int far = 0;
    for (int choice = 0; choice < 1 << n; ++choice) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += (choice >> i & 1) != 0 ? d[static_cast<std::size_t>(i)] : -d[static_cast<std::size_t>(i)];
      far += std::fabs(sum) >= seen ? 1 : 0;
    }
    EXPECT_EQ(sign_flip_test(d)->p, far / std::ldexp(1.0, n)) << n;
  }
}

TEST(SignFlips, AreSampledIfThereAreTooMany) {
  // Differences of equal size: p is that of the binomial distribution, here P(|X - 25| >= 8) of 50 throws = 0.0328 (R: binom.test(33,
  // 50)).
  Values d(50, 1.0);
  for (std::size_t i = 0; i < 17; ++i) d[i] = -1;
  const auto drawn = sign_flip_test(d);
  EXPECT_FALSE(drawn->exact);
  EXPECT_NEAR(drawn->p, 0.03283912, 4 * std::sqrt(0.0328 * 0.9672 / 10'000));
  EXPECT_EQ(drawn->p, sign_flip_test(d)->p);
  EXPECT_NE(drawn->p, sign_flip_test(d, 2)->p);
}

TEST(Power, EqualsR) {
  struct Case {
    double effect;
    int n;
    double power;
  };
  for (const Case& c :
       {Case{.5, 20, 0.564504418439084}, Case{.2, 50, 0.283592414667614}, Case{.8, 10, 0.616232763475035}, Case{.1, 200, 0.290657617661524},
        Case{3, 5, 0.997679577438141}, Case{10, 2, 0.732819589806306}, Case{-.5, 20, 0.564504418439084}, Case{0, 20, 0.05}})
    EXPECT_NEAR(paired_power(c.effect, c.n, 0.05), c.power, 1e-9) << c.effect << " " << c.n;
  EXPECT_EQ(*required_subjects(.5, .8, .05), 34);   // 33.37
  EXPECT_EQ(*required_subjects(.2, .8, .05), 199);  // 198.15
  EXPECT_EQ(*required_subjects(.8, .9, .05), 19);   // 18.45
  EXPECT_EQ(*required_subjects(.05, .8, .05), 3142);
  EXPECT_EQ(*required_subjects(1.5, .95, .05), 8);  // 7.97
  EXPECT_FALSE(required_subjects(0, .8, .05));
  EXPECT_FALSE(required_subjects(1e-4, .8, .05));
  EXPECT_GT(paired_power(100, 1000, .05), 1 - 1e-9);
}

TEST(Proportions, IntervalsEqualThoseOfR) {
  const Interval i = proportion_interval(70, 1600, 0.95), none = proportion_interval(0, 20, 0.95), all = proportion_interval(20, 20, 0.95);
  EXPECT_NEAR(i.low, 0.0342613292717083, 1e-12);
  EXPECT_NEAR(i.high, 0.0549547669367596, 1e-12);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.168433470983085, 1e-12);
  EXPECT_NEAR(all.low, 0.831566529016915, 1e-12);
  EXPECT_EQ(all.high, 1);
}

TEST(Degenerate, InputHasASpecificError) {
  const auto says = [](const auto& result, const std::string& words) {
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
  };
  says(summarize(Values{}), "at least 2 values are required, but there are 0");
  says(summarize(Values{1}), "there is 1");
  says(summarize(Values{1, kNan}), "not a finite number");
  says(summarize(Values{1e308, 1e308, -1e308}), "too large");
  EXPECT_EQ(summarize(Values{2, 2, 2})->sd, 0);
  says(paired_test(Values{1, 2}, Values{1, kInf}), "not a finite number");
  says(paired_test(Values{1}, Values{2}), "at least 2");
  says(paired_test(Values{1, 2, 3}, Values{1, 2, 3}), "all 3 differences are equal");
  says(paired_test(Values{1.3, 2.3, 3.3}, Values{1, 2, 3}), "all 3 differences are equal");
  says(pearson(Values{1, 2}, Values{2, 1}), "at least 3");
  says(pearson(Values{1, 2, 3}, Values{.1, .1, .1}), "all 3 values of one measure are equal");
  says(pearson(Values{1, kNan, 3}, Values{1, 2, 3}), "not a finite number");
  says(regression(Values{1, 1}, Values{1, 2}), "all values of x are equal");
  says(sign_flip_test(Values{1}), "at least 2");
  EXPECT_EQ(sign_flip_test(Values{0, 0, 0})->p, 1);
  EXPECT_EQ(sign_flip_test(Values{1, -1, 0})->p, 1);
  const auto line = pearson(Values{1, 2, 3, 4}, Values{2, 4, 6, 8});
  EXPECT_EQ(line->p, 0);
  EXPECT_EQ(line->low, 1);
  EXPECT_EQ(line->high, 1);
  EXPECT_TRUE(std::isinf(line->t));
}

}  // namespace statistics_test
