// SPDX-License-Identifier: MIT
/// `catena tradeoff --figure N`: the figures of the paper, and the command's outputs and errors.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/program_in_folder.h"

namespace tradeoff_test {

using namespace catena;
using test::Table;
namespace fs = std::filesystem;

class Tradeoff : public test::ProgramInFolder {
 protected:
  int files_in(const std::string& name) const { return int(std::distance(fs::directory_iterator(folder_ / name), {})); }
};

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

/// Expects a plot as PNG if gnuplot is installed.
void expect_plot(const std::string& path) {
  if (!has_gnuplot()) return;
  const std::string bytes = test::read_file(path);
  EXPECT_TRUE(bytes.starts_with("\x89PNG")) << path;
  EXPECT_GT(bytes.size(), 10000u) << path;
}

TEST_F(Tradeoff, Figure2MeasuresTheDriftOfEveryMethod) {
  const std::string out = folder_ / "new/folder";
  succeed("tradeoff --figure 2 -o {new/folder}");
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
  const auto final_number = [&](const char* column) { return tremor.number(tremor.rows() - 1, column); };
  EXPECT_EQ(final_number("t_s"), 60);
  EXPECT_NEAR(final_number("linear_drift_mm"), 1.2, 0.02);
  EXPECT_NEAR(final_number("euler_drift_mm"), 1.2, 0.02);
  EXPECT_LE(final_number("rkf34_drift_mm"), 1e-11);
  EXPECT_LE(final_number("selected_drift_mm"), 5e-8);
  for (const char* name : {"/figure2-drift.png", "/figure2-path.png", "/figure2-tremor.png"}) expect_plot(out + name);
}

TEST_F(Tradeoff, Figure3MeasuresTheDepthOfRelease) {
  succeed("tradeoff --figure 3 -o {out}");
  const Table table = Table::read(folder_ / "out/figure3-release.csv");
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

  const Table series = Table::read(folder_ / "out/figure3-series.csv");
  EXPECT_GT(series.rows(), 1000u);
  EXPECT_EQ(series.number(0, "chain_active"), 1);
  EXPECT_EQ(series.number(series.rows() - 1, "chain_active"), 0);
  for (const char* name : {"release-flat", "release-curved", "off-curve", "force", "path"})
    expect_plot(folder_ / "out/figure3-" + std::string(name) + ".png");
}

TEST_F(Tradeoff, FigureStiffnessMeasuresTheMaximumStiffness) {
  succeed("tradeoff --figure stiffness -o {out}");
  const Table damping = Table::read(folder_ / "out/stiffness-damping.csv");
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
  const Table virtuals = Table::read(folder_ / "out/stiffness-virtual.csv");
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
  EXPECT_EQ(Table::read(folder_ / "out/stiffness-delay.csv").rows(), 9u);
  for (const char* name : {"damping", "delay", "virtual"}) expect_plot(folder_ / "out/stiffness-" + std::string(name) + ".png");
}

TEST_F(Tradeoff, WrongArgumentsAreOneLine) {
  write("file", "x");
  for (const auto& [arguments, part] : {std::pair{"-o {out}", "--figure 2"},
                                        {"--figure 4 -o {out}", "--figure"},
                                        {"--figure two -o {out}", "--figure"},
                                        {"--figure 2", "--output"},
                                        {"--figure 3 -o {file}", "is a file"},
                                        {"--figure 3 -o {file/below}", "file/below"}})
    expect_refused(std::string("tradeoff ") + arguments, {part});
  expect_refused("tradeoff --figure 3", {"empty"}, {"-o", ""});
  EXPECT_EQ(read("file"), "x");
}

TEST_F(Tradeoff, WithoutGnuplotTheTablesAreComplete) {
  const test::EnvironmentVariable none("PATH", folder_.path());
  test::expect_parts(succeed("tradeoff --figure 3 -o {out}").out, {"gnuplot is not installed"});
  EXPECT_EQ(files_in("out"), 3);
  EXPECT_TRUE(exists("out/figure3.gp"));
}

TEST_F(Tradeoff, LeavesNoPartialOutput) {
  fs::create_directories(folder_ / "out/figure3.gp");  // blocks a file
  expect_refused("tradeoff --figure 3 -o {out}", {"figure3.gp"});
  EXPECT_EQ(files_in("out"), 1);
}

TEST_F(Tradeoff, RemainsOfAKilledRunAreRemovedByTheNext) {
  const test::TemporaryFolder programs;
  test::write_file(programs / "gnuplot", "#!/bin/sh\nkill -9 $PPID\n");
  fs::permissions(programs / "gnuplot", fs::perms::owner_all);
  {
    const test::EnvironmentVariable killer("PATH", programs.path());
    EXPECT_EQ(run("tradeoff --figure 3 -o {out}").exit_code, 128 + 9);
  }
  ASSERT_EQ(files_in("out"), 1);
  EXPECT_TRUE(fs::directory_iterator(folder_ / "out")->path().filename().string().starts_with("tables.part"));
  const test::EnvironmentVariable none("PATH", folder_.path());
  succeed("tradeoff --figure 3 -o {out}");
  EXPECT_EQ(files_in("out"), 3) << "two tables and the script";
}

TEST_F(Tradeoff, RepeatedRunsAreEqual) {
  for (const std::string out : {"a", "b"}) succeed("tradeoff --figure 3 -o {" + out + "}");
  for (const std::string name : {"/figure3-release.csv", "/figure3-series.csv"}) EXPECT_EQ(read("a" + name), read("b" + name));
}

}  // namespace tradeoff_test
