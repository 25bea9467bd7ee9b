// SPDX-License-Identifier: MIT
/// Natural sort of the files of a series by the numbers in their names.
#include "engine/base/natural_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace catena::natural_sort_test {

TEST(NameOrder, NumbersWithDecimalsSignsAndExponentsCompareAsNumbers) {
  const std::vector<std::vector<std::string>> series{
      {"t0.0005.vti", "t0.001.vti", "t0.0015.vti", "t0.01.vti"},
      {"wake_2.vtu", "wake_10.vtu", "wake_0100.vtu"},
      {"wake-2.vtu", "wake-10.vtu"},
      {"t-5.vti", "t-0.5.vti", "t0.vti", "t2.vti", "t10.vti"},
      {"s_-10_a", "s_-2_a", "s_3_a"},
      {"p_-1.vti", "p_+0.5.vti", "p_+2.vti", "p_10.vti"},
      {"f_1e-05.vti", "f_2.5e-05.vti", "f_1e-04.vti", "f_0.001.vti", "f_1E+2.vti"},
      {"r1.1.vtu", "r1.2.vtu", "r1.9.vtu", "r1.10.vtu"},  // as decimals, 1.1 and 1.10 would be equal
      {"v1.2.3", "v1.2.10", "v1.10.1"},
      {"2024-01-05.nc", "2024-01-15.nc", "2024-11-02.nc", "2025-01-01.nc"},
      {"a2b9.5.vti", "a2b10.vti", "a10b1.vti"},
      {"n99999999999999999998.vti", "n99999999999999999999.vti", "n100000000000000000000.vti"},
      {"s.0001.vti", "s.0002.vti", "s.0010.vti"},
      {"run", "run1", "run2"},
      {"x1.0.vti", "x1.5.vti", "x2.vti"},
      {"p_1.5_s.vti", "p_1.25e1_s.vti", "p_20_s.vti"},
  };
  std::mt19937 random(3);
  for (const std::vector<std::string>& expected : series) {
    for (int shuffle = 0; shuffle < 10; ++shuffle) {
      std::vector<std::string> names = expected;
      std::shuffle(names.begin(), names.end(), random);
      natural_sort(names);
      EXPECT_EQ(names, expected);
    }
  }
}

}  // namespace catena::natural_sort_test
