// SPDX-License-Identifier: MIT
/// The gnuplot scripts of a report's plots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <string>
#include <vector>

#include "engine/app/tuning/report/gnuplot_script.h"
#include "engine/base/numbers.h"

namespace catena::gnuplot_script_test {

/// The numbers of a line like "set xtics (1, 2, 5)".
std::vector<double> listed(const std::string& text) {
  std::vector<double> all;
  const auto open = text.find('('), close = text.find(')');
  if (open == std::string::npos) return all;
  std::string rest = text.substr(open + 1, close - open - 1);
  for (std::size_t at = 0; at < rest.size();) {
    const auto comma = std::min(rest.find(", ", at), rest.size());
    all.push_back(parse_double(rest.substr(at, comma - at)).value_or(NAN));
    at = comma + 2;
  }
  return all;
}

TEST(ReportPlot, TheShortestAxisHasTickLabels) {
  for (const double lo : {3e-7, 0.9, 24.0, 610.0})
    for (const double times : {1.6, 2.0, 5.0, 30.0, 900.0}) {
      const std::string text = app::log_tics('x', lo, lo * times);
      const std::vector<double> tics = listed(text);
      EXPECT_GE(tics.size(), 3u) << text;
      for (const double tic : tics) EXPECT_TRUE(tic >= lo && tic <= lo * times * (1 + 1e-9)) << text;
    }
  EXPECT_EQ(app::log_tics('y', 1, 1e6), "set ytics autofreq\n");
  EXPECT_EQ(app::log_tics('x', 0.7, 14), "set xtics (1, 3, 10)\n");
}

}  // namespace catena::gnuplot_script_test
