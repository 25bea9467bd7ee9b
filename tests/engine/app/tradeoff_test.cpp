// SPDX-License-Identifier: MIT
/// `catena tradeoff --figure N`: the figures of the paper, and the command's outputs and errors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace tradeoff_test {

using namespace catena;
using test::Table;
namespace fs = std::filesystem;

test::ProgramResult tradeoff(const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"tradeoff"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_catena(all);
}

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

/// Expects a plot as PNG if gnuplot is installed.
void expect_plot(const std::string& path) {
  if (!has_gnuplot()) return;
  const std::string bytes = test::read_file(path);
  EXPECT_TRUE(bytes.starts_with("\x89PNG")) << path;
  EXPECT_GT(bytes.size(), 10000u) << path;
}

int files_in(const std::string& folder) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) count += entry.exists() ? 1 : 0;
  return count;
}

TEST(Tradeoff, Figure2MeasuresTheDriftOfEveryMethod) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "new/folder";
  const auto run = tradeoff({"--figure", "2", "-o", out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table drift = Table::read(out + "/figure2-drift.csv");
  std::map<std::string, std::map<double, double>> lap;
  for (std::size_t row = 0; row < drift.rows(); ++row) {
    lap[drift.text(row, "method")][drift.number(row, "speed_m_per_s")] = drift.number(row, "drift_mm_first_lap");
    EXPECT_LE(drift.number(row, "evaluations_max"), 257);
  }
  ASSERT_EQ(lap.size(), 8u);
  for (const char* first_order : {"linear", "euler"}) {
    EXPECT_NEAR(lap[first_order][0.05], 0.157, 0.001);
    EXPECT_NEAR(lap[first_order][0.2], 0.632, 0.002);
    EXPECT_NEAR(lap[first_order][1.0], 3.25, 0.02);
  }
  EXPECT_LE(lap["rk3"][0.2], 2e-6);
  EXPECT_LE(lap["rkf34"][0.2], 5e-7);
  EXPECT_LE(lap["rk3"][1.0], 2e-4);
  for (const char* precise : {"rk4", "rkf34", "dp54"}) EXPECT_LE(lap[precise][1.0], 1e-8);
  for (const double speed : {0.05, 0.2, 1.0}) EXPECT_LE(lap["selected"][speed], 5e-8);
  EXPECT_GT(lap["rk2"][1.0], 50 * lap["rk2"][0.2]);  // third order in the step for a lap

  // The proxy on the traced curve does not drift in five laps; the linear proxy spirals outwards.
  for (std::size_t row = 0; row < drift.rows(); ++row) {
    if (drift.text(row, "method") != "selected") continue;
    EXPECT_NEAR(drift.number(row, "drift_mm_after_5_laps"), drift.number(row, "drift_mm_first_lap"), 1e-12);
  }
  const Table path = Table::read(out + "/figure2-path.csv");
  const std::size_t last = path.rows() - 1;
  EXPECT_NEAR(std::hypot(path.number(last, "linear_x_mm"), path.number(last, "linear_y_mm")), 83, 2);
  EXPECT_NEAR(std::hypot(path.number(last, "selected_x_mm"), path.number(last, "selected_y_mm")), 50, 1e-7);

  const Table tremor = Table::read(out + "/figure2-tremor.csv");
  EXPECT_EQ(tremor.number(tremor.rows() - 1, "t_s"), 60);
  EXPECT_NEAR(tremor.number(tremor.rows() - 1, "linear_drift_mm"), 1.2, 0.02);
  EXPECT_NEAR(tremor.number(tremor.rows() - 1, "euler_drift_mm"), 1.2, 0.02);
  EXPECT_LE(tremor.number(tremor.rows() - 1, "rkf34_drift_mm"), 1e-11);
  EXPECT_LE(tremor.number(tremor.rows() - 1, "selected_drift_mm"), 5e-8);
  for (const char* name : {"/figure2-drift.png", "/figure2-path.png", "/figure2-tremor.png"}) expect_plot(out + name);
}

TEST(Tradeoff, Figure3MeasuresTheDepthOfRelease) {
  const test::TemporaryFolder folder;
  const auto run = tradeoff({"--figure", "3", "-o", folder / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table table = Table::read(folder / "out/figure3-release.csv");
  ASSERT_EQ(table.rows(), 2u * 18 * 5);
  double max_off_curve = 0, min_off_curve = 1;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string method = table.text(row, "method"), scene = table.text(row, "scene");
    const double angle = table.number(row, "angle_deg"), depth = table.number(row, "release_depth");
    const double off_curve = table.number(row, "off_curve_while_held"), at_depth = table.number(row, "off_curve_at_release_depth");
    const std::string where = scene + " " + method + " " + std::to_string(angle);
    const bool flat = scene == "flat";
    EXPECT_LE(table.number(row, "evaluations_max"), 2 * 257) << where;
    if (method == "chain") {
      EXPECT_NEAR(depth, 0.05, 2e-4 + 1e-9) << where;  // the probe's motion in a tick
      EXPECT_LE(off_curve, flat ? 2e-16 : 4e-11) << where;
      EXPECT_LE(table.number(row, "off_surface_while_held"), flat ? 2e-16 : 4e-12) << where;
    } else if (method == "pipe") {
      EXPECT_NEAR(depth, 0.05 * std::sin(angle * M_PI / 180), 3e-4) << where;
      EXPECT_LE(off_curve, 4e-11) << where;
      EXPECT_LE(table.number(row, "off_surface_while_held"), 4e-11) << where;
    } else if (method == "balance" && flat) {
      max_off_curve = std::max(max_off_curve, at_depth);
      if (angle <= 75) min_off_curve = std::min(min_off_curve, at_depth);
      EXPECT_NEAR(depth, 0.1, 2e-3) << where;  // the springs take half of the depth
    } else if (method == "closest") {
      EXPECT_EQ(table.number(row, "released"), 0) << where;  // the curve is always the closest constraint
      EXPECT_EQ(table.number(row, "force_while_held_n"), 0) << where;
    } else if (method == "linear") {
      EXPECT_NEAR(depth, 0.05 * std::sin(angle * M_PI / 180), 3e-4) << where;
      if (!flat && angle >= 10 && angle < 90) {
        EXPECT_GT(table.number(row, "off_curve_at_end"), 1e-4) << where;
      }
    }
  }
  EXPECT_NEAR(max_off_curve, 0.025, 0.003);
  EXPECT_NEAR(min_off_curve, 0.006, 0.001);

  const Table series = Table::read(folder / "out/figure3-series.csv");
  EXPECT_GT(series.rows(), 1000u);
  EXPECT_EQ(series.number(0, "chain_active"), 1);
  EXPECT_EQ(series.number(series.rows() - 1, "chain_active"), 0);
  for (const char* name : {"release-flat", "release-curved", "off-curve", "force", "path"})
    expect_plot(folder / "out/figure3-" + std::string(name) + ".png");
}

TEST(Tradeoff, FigureStiffnessMeasuresTheMaximumStiffness) {
  const test::TemporaryFolder folder;
  const auto run = tradeoff({"--figure", "stiffness", "-o", folder / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table damping = Table::read(folder / "out/stiffness-damping.csv");
  ASSERT_EQ(damping.rows(), 4u * 9);
  for (std::size_t row = 0; row < damping.rows(); ++row) {
    const double b = damping.number(row, "device_damping_ns_per_m"), rate = damping.number(row, "rate_hz");
    const double late = damping.number(row, "delay_ms"), passive = damping.number(row, "passive_n_per_m");
    EXPECT_NEAR(passive, 2 * b / (1 / rate + 2e-3 * late), 1e-9 * passive);
    // Stable for passive stiffnesses, and not much beyond the passive limit for a mass without damping.
    const double stable = damping.number(row, "stable_n_per_m") / passive;
    EXPECT_GT(stable, 0.99) << row;
    EXPECT_LT(stable, 1.1) << row;
    if (b <= 2) {
      EXPECT_GT(damping.number(row, "controlled_n_per_m"), 2.9 * passive) << row;
    }
  }
  const Table virtuals = Table::read(folder / "out/stiffness-virtual.csv");
  const std::map<double, std::pair<double, double>> expected{
      {0, {994, 332}}, {5, {10585, 3535}}, {20, {36061, 11660}}, {50, {73324, 21522}}};
  int seen = 0;
  for (std::size_t row = 0; row < virtuals.rows(); ++row) {
    const auto it = expected.find(virtuals.number(row, "virtual_damping_ns_per_m"));
    if (it == expected.end()) continue;
    ++seen;
    EXPECT_NEAR(virtuals.number(row, "stable_n_per_m") / it->second.first, 1, 0.015);
    EXPECT_NEAR(virtuals.number(row, "stable_delayed_n_per_m") / it->second.second, 1, 0.015);
  }
  EXPECT_EQ(seen, 4);
  EXPECT_EQ(virtuals.number(virtuals.rows() - 1, "stable_delayed_n_per_m"), 0) << "200 N s/m with a delay: nothing";
  EXPECT_EQ(Table::read(folder / "out/stiffness-delay.csv").rows(), 9u);
  for (const char* name : {"damping", "delay", "virtual"}) expect_plot(folder / "out/stiffness-" + std::string(name) + ".png");
}

TEST(Tradeoff, WrongArgumentsAreOneLine) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "file", "x");
  const std::string out = folder / "out";
  const std::vector<std::pair<std::vector<std::string>, const char*>> cases{{{"-o", out}, "--figure 2"},
                                                                            {{"--figure", "4", "-o", out}, "--figure"},
                                                                            {{"--figure", "two", "-o", out}, "--figure"},
                                                                            {{"--figure", "2"}, "--output"},
                                                                            {{"--figure", "3", "-o", folder / "file"}, "is a file"},
                                                                            {{"--figure", "3", "-o", folder / "file/below"}, "file/below"},
                                                                            {{"--figure", "3", "-o", ""}, "empty"}};
  for (const auto& [arguments, part] : cases) {
    const auto run = tradeoff(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out << run.err;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
    EXPECT_FALSE(test::exists(out));
  }
  EXPECT_EQ(test::read_file(folder / "file"), "x");
}

/// Runs the command with PATH set to one folder.
test::ProgramResult tradeoff_among(const std::string& programs, const std::vector<std::string>& arguments) {
  const char* path = std::getenv("PATH");
  const std::string before = path ? path : "";
  ::setenv("PATH", programs.c_str(), 1);
  const auto run = tradeoff(arguments);
  ::setenv("PATH", before.c_str(), 1);
  return run;
}

TEST(Tradeoff, WithoutGnuplotTheTablesAreComplete) {
  const test::TemporaryFolder folder;
  const auto run = tradeoff_among(folder.path(), {"--figure", "3", "-o", folder / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("gnuplot is not installed"), std::string::npos) << run.out;
  EXPECT_EQ(files_in(folder / "out"), 3);
  EXPECT_TRUE(test::exists(folder / "out/figure3.gp"));
}

TEST(Tradeoff, LeavesNoPartialOutput) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "out/figure3.gp");  // blocks a file
  const auto run = tradeoff({"--figure", "3", "-o", folder / "out"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("figure3.gp"), std::string::npos) << run.err;
  EXPECT_EQ(files_in(folder / "out"), 1);
}

TEST(Tradeoff, RemainsOfAKilledRunAreRemovedByTheNext) {
  const test::TemporaryFolder folder, programs;
  test::write_file(programs / "gnuplot", "#!/bin/sh\nkill -9 $PPID\n");
  fs::permissions(programs / "gnuplot", fs::perms::owner_all);
  const std::string out = folder / "out";
  EXPECT_EQ(tradeoff_among(programs.path(), {"--figure", "3", "-o", out}).exit_code, 128 + 9);
  ASSERT_EQ(files_in(out), 1);
  EXPECT_TRUE(fs::directory_iterator(out)->path().filename().string().starts_with("tables.part"));
  ASSERT_EQ(tradeoff_among(folder.path(), {"--figure", "3", "-o", out}).exit_code, 0);
  EXPECT_EQ(files_in(out), 3) << "two tables and the script";
}

TEST(Tradeoff, RepeatedRunsAreEqual) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(tradeoff({"--figure", "3", "-o", folder / "a"}).exit_code, 0);
  ASSERT_EQ(tradeoff({"--figure", "3", "-o", folder / "b"}).exit_code, 0);
  for (const char* name : {"/figure3-release.csv", "/figure3-series.csv"})
    EXPECT_EQ(test::read_file((folder / "a") + name), test::read_file((folder / "b") + name));
}

}  // namespace tradeoff_test
