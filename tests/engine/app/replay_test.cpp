// SPDX-License-Identifier: MIT
/// The commands `catena replay` and `catena trace`, against closed forms and the paper's figures.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/base/numbers.h"
#include "engine/base/vec.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace replay_test {

using namespace catena;
using test::ProgramResult;
using test::Table;

ProgramResult catena_program(const std::vector<std::string>& arguments) { return test::run_catena(arguments); }

Vec3 vector_at(const Table& table, std::size_t row, const std::string& name) {
  return {table.number(row, name + "_x"), table.number(row, name + "_y"), table.number(row, name + "_z")};
}

// Writes one lap of a circle at a constant speed, at 1 kHz; the probe is at `outward` times the radius.
void write_lap(const std::string& path, double radius, double speed, double outward = 1) {
  std::string text = "t,x,y,z\n";
  const double lap_s = 2 * M_PI * radius / speed;
  const int ticks = static_cast<int>(std::ceil(lap_s / 1e-3));
  for (int k = 0; k <= ticks; ++k) {
    const double angle = speed * (1e-3 * k) / radius;
    text +=
        to_text(1e-3 * k) + "," + to_text(outward * radius * std::cos(angle)) + "," + to_text(outward * radius * std::sin(angle)) + ",0\n";
  }
  test::write_file(path, text);
}

std::string circle_scene(const std::string& link_keys) {
  return R"({"fields": {"v": {"analytic": "circle"}},
             "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.05, 0, 0])" +
         link_keys + "}]}";
}

double drift_of_last_tick(const std::string& link_keys) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", circle_scene(link_keys));
  write_lap(folder / "lap.csv", 0.05, 0.2);
  const ProgramResult run = catena_program({"replay", folder / "s.json", "--probe", folder / "lap.csv", "-o", folder / "t.csv"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Table table = Table::read(folder / "t.csv");
  double worst = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Vec3 p = vector_at(table, row, "curve");
    worst = std::max(worst, std::hypot(std::hypot(p.x, p.y) - 0.05, p.z));
  }
  return worst;
}

TEST(Replay, LinearStreamlineDriftsAsInThePaper) { EXPECT_NEAR(drift_of_last_tick(R"(, "method": "linear")"), 0.63e-3, 0.02e-3); }

TEST(Replay, SelectedAndOnlineStreamlinesStayOnTheCircle) {
  EXPECT_LE(drift_of_last_tick(""), 5e-10);
  EXPECT_LE(drift_of_last_tick(R"(, "follow": "online")"), 5e-10);
  EXPECT_LE(drift_of_last_tick(R"(, "method": "dp54")"), 5e-10);
}

TEST(Replay, TheProxyOnASphereIsTheClosestPoint) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"s": {"analytic": "sphere"}},
    "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.5}]})");
  std::string path = "t,x,y,z\n";
  for (int k = 0; k < 1000; ++k) {
    const double t = 1e-3 * k, r = 0.3 + 0.4 * std::sin(7 * t);
    path += to_text(t) + "," + to_text(r * std::cos(3 * t) + 0.3) + "," + to_text(r * std::sin(3 * t)) + "," +
            to_text(0.2 + 0.3 * std::sin(11 * t)) + "\n";
  }
  test::write_file(folder / "p.csv", path);
  const ProgramResult run = catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table table = Table::read(folder / "t.csv");
  ASSERT_EQ(table.rows(), 1000u);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Vec3 probe = vector_at(table, row, "probe"), p = vector_at(table, row, "surface");
    EXPECT_NEAR(norm(p), 0.5, 1e-11) << row;
    const Vec3 closest = direction(probe) * 0.5;
    EXPECT_LE(norm(p - closest), 1e-6) << row;
    EXPECT_EQ(table.text(row, "surface_status"), "OK");
    EXPECT_EQ(table.text(row, "surface_active"), "1");
  }
}

TEST(Replay, SelectedProxyLiesOnTheTracedCurve) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"v": {"analytic": "abc"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.3, -0.2, 0.7]}]})");
  test::write_file(folder / "seeds.csv", "x,y,z\n0.3,-0.2,0.7\n");
  std::string path = "t,x,y,z\n";
  for (int k = 0; k < 800; ++k) {
    const double t = 1e-3 * k;
    path += to_text(t) + "," + to_text(0.3 + 0.5 * std::sin(5 * t)) + "," + to_text(-0.2 + 0.3 * t) + "," + to_text(0.7 - 0.4 * t) + "\n";
  }
  test::write_file(folder / "p.csv", path);
  ASSERT_EQ(catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"}).exit_code, 0);
  const ProgramResult traced =
      catena_program({"trace", folder / "s.json", "--field", "v", "--seeds", folder / "seeds.csv", "-o", folder / "l.csv"});
  ASSERT_EQ(traced.exit_code, 0) << traced.err;
  const Table ticks = Table::read(folder / "t.csv"), line = Table::read(folder / "l.csv");
  const auto knot = [&](std::size_t i, const char* a, const char* b, const char* c) {
    return Vec3(line.number(i, a), line.number(i, b), line.number(i, c));
  };
  for (std::size_t row = 0; row < ticks.rows(); row += 7) {
    const Vec3 p = vector_at(ticks, row, "curve");
    // The distance to the Hermite curve through knots and tangents, searched in the intervals near the proxy.
    double best = 1e9;
    for (std::size_t i = 0; i + 1 < line.rows(); ++i) {
      const Vec3 a = knot(i, "x", "y", "z"), b = knot(i + 1, "x", "y", "z");
      const double h = line.number(i + 1, "s") - line.number(i, "s");
      if (norm(p - a) > 2 * h) continue;
      const Vec3 ta = knot(i, "tx", "ty", "tz") * h, tb = knot(i + 1, "tx", "ty", "tz") * h;
      const auto at = [&](double f) {
        const double f2 = f * f, f3 = f2 * f;
        return a * (2 * f3 - 3 * f2 + 1) + ta * (f3 - 2 * f2 + f) + b * (3 * f2 - 2 * f3) + tb * (f3 - f2);
      };
      double lo = 0, hi = 1;
      for (int k = 0; k < 100; ++k) {
        const double m1 = lo + (hi - lo) / 3, m2 = hi - (hi - lo) / 3;
        (norm(p - at(m1)) < norm(p - at(m2)) ? hi : lo) = norm(p - at(m1)) < norm(p - at(m2)) ? m2 : m1;
      }
      best = std::min(best, norm(p - at(0.5 * (lo + hi))));
    }
    // The rest is rounding of the ternary search.
    EXPECT_LE(best, 4 * 1e-12) << row;
  }
}

TEST(Replay, TheTableHasTheDocumentedColumns) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {}, "chain": [{"name": "a", "type": "point", "position": [0, 0, 0]},
     {"name": "b_2", "type": "plane", "point": [0, 0, 1], "normal": [0, 0, 2]}]})");
  test::write_file(folder / "p.csv", "\xef\xbb\xbft,x,y,z,buttons\r\n0,1,2,3,1\r\n");
  const ProgramResult run =
      catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv", "--stats", folder / "s.out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = test::read_file(folder / "t.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "t,probe_x,probe_y,probe_z,a_x,a_y,a_z,a_active,a_status,a_evaluations,a_reason,b_2_x,b_2_y,b_2_z,b_2_active,b_2_status,b_2_"
            "evaluations,b_2_reason,"
            "force_x,force_y,force_z,a_curve,b_2_curve");
  const std::string stats = test::read_file(folder / "s.out");
  for (const char* key : {"\"ticks\": 1", "\"tick_ns\"", "\"p50\"", "\"p99\"", "\"p999\"", "\"max\"", "\"evaluations\"", "\"state_hash\""})
    EXPECT_NE(stats.find(key), std::string::npos) << key;
}

TEST(Replay, AnEmptySceneIsValidAndOnlyDamps) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {}, "chain": [], "coupling": {"damping": 2, "max_force": 100}})");
  test::write_file(folder / "p.csv", "t,x,y,z\n0,0,0,0\n0.5,1,0,0\n");
  ASSERT_EQ(catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"}).exit_code, 0);
  const Table table = Table::read(folder / "t.csv");
  EXPECT_EQ(table.number(0, "force_x"), 0);
  EXPECT_EQ(table.number(1, "force_x"), -4);
}

TEST(Replay, ReleaseAndReArmOfAOneSidedSurface) {
  // The surface is free above (|x| > 0.5); the probe moves along x from outside towards the center, and back.
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"s": {"analytic": "sphere"}},
    "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.5, "free": "above", "release": 0.05}],
    "coupling": {"stiffness": 100, "max_force": 1000}})");
  std::string path = "t,x,y,z\n";
  std::vector<double> depth;
  for (int k = 0; k < 400; ++k) {
    const double x = k < 200 ? 0.6 - 0.001 * k : 0.4 + 0.001 * (k - 200);
    depth.push_back(0.5 - x);
    path += to_text(1e-3 * k) + "," + to_text(x) + ",0,0\n";
  }
  test::write_file(folder / "p.csv", path);
  ASSERT_EQ(catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"}).exit_code, 0);
  const Table table = Table::read(folder / "t.csv");
  bool released = false;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string status = table.text(row, "surface_status");
    const double d = depth[row];
    if (std::fabs(d) < 1e-12) continue;  // on the level, within rounding
    if (d < 0) released = false;
    if (!released && d >= 0.05 - 1e-12 && d <= 0.05 + 1e-12) {
      // Within rounding of the limit, either status is correct.
      released = status == "RELEASED";
      continue;
    }
    if (d > 0.05) released = true;
    if (released) {
      EXPECT_EQ(status, "RELEASED") << row;
      EXPECT_EQ(table.text(row, "surface_active"), "0");
      EXPECT_EQ(table.text(row, "surface_x"), table.text(row, "probe_x"));
      EXPECT_EQ(table.number(row, "force_x"), 0);
    } else if (d > 1e-12) {
      EXPECT_EQ(status, "OK") << row;
      EXPECT_NEAR(table.number(row, "surface_x"), 0.5, 1e-11);
      EXPECT_NEAR(table.number(row, "force_x"), 100 * d, 1e-7);
    } else if (d < -1e-12) {
      EXPECT_EQ(status, "FREE") << row;
      EXPECT_EQ(table.text(row, "surface_active"), "1");
      EXPECT_EQ(table.text(row, "surface_x"), table.text(row, "probe_x"));
    }
  }
}

TEST(Trace, CircleIsOneLap) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", circle_scene(""));
  test::write_file(folder / "seeds.csv", "x,y,z\n0.05,0,0\n1,0,0.5\n");
  const ProgramResult run =
      catena_program({"trace", folder / "s.json", "--field", "v", "--seeds", folder / "seeds.csv", "-o", folder / "l.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table line = Table::read(folder / "l.csv");
  double last_s[2] = {0, 0};
  for (std::size_t i = 0; i < line.rows(); ++i) {
    const int which = static_cast<int>(line.number(i, "line"));
    const double radius = which == 0 ? 0.05 : 1;
    const Vec3 p(line.number(i, "x"), line.number(i, "y"), line.number(i, "z")),
        t(line.number(i, "tx"), line.number(i, "ty"), line.number(i, "tz"));
    EXPECT_NEAR(std::hypot(p.x, p.y), radius, 4e-9);
    EXPECT_NEAR(norm(t), 1, 1e-14);
    EXPECT_NEAR(dot(p, t), 0, 4e-9);
    last_s[which] = line.number(i, "s");
  }
  EXPECT_NEAR(last_s[0], 2 * M_PI * 0.05, 4e-9);
  EXPECT_NEAR(last_s[1], 2 * M_PI, 4e-9);
}

TEST(Replay, DetailsHaveTheStateOfEveryLink) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"coupling": {"stiffness": 200, "max_force": 1000}, "workspace": {"metres_per_unit": 0.5},
    "chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "release": 0.05},
              {"name": "pin", "type": "point", "position": [0, 0, 0], "stiffness": 10}],
    "modes": [{"name": "pinned", "links": ["pin"], "active_when": {"button": 2}}]})");
  std::string path = "t,x,y,z,buttons\n";
  for (int k = 0; k < 70; ++k) path += to_text(1e-3 * k) + ",0.2,0," + to_text(0.005 - 1e-3 * k) + (k >= 65 ? ",2\n" : ",0\n");
  test::write_file(folder / "p.csv", path);
  const ProgramResult run =
      catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv", "--details", folder / "links.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table ticks = Table::read(folder / "t.csv"), table = Table::read(folder / "links.csv");
  ASSERT_EQ(table.rows(), 70u);
  for (std::size_t row = 6; row < 54; ++row) {
    const double depth = 1e-3 * static_cast<double>(row) - 0.005;
    EXPECT_NEAR(table.number(row, "floor_gap"), depth, 1e-12);
    EXPECT_NEAR(table.number(row, "floor_release_ratio"), depth / 0.05, 1e-10);
    EXPECT_NEAR(table.number(row, "floor_energy"), 0.5 * 200 * std::pow(0.5 * depth, 2), 1e-12);
    EXPECT_NEAR(table.number(row, "floor_force_z"), 200 * 0.5 * depth, 1e-9);
    EXPECT_EQ(table.number(row, "floor_released"), 0);
    EXPECT_EQ(table.number(row, "floor_stiffness"), 200);
    EXPECT_EQ(table.number(row, "pin_stiffness"), 10);
    EXPECT_NEAR(table.number(row, "floor_force_z") + table.number(row, "pin_force_z"), ticks.number(row, "force_z"), 1e-12);
    EXPECT_EQ(table.text(row, "mode"), "");
  }
  EXPECT_EQ(table.number(56, "floor_released"), 1);
  EXPECT_EQ(table.number(56, "floor_release_ratio"), 1);
  EXPECT_EQ(table.text(66, "mode"), "pinned");
  EXPECT_EQ(ticks.number(66, "floor_active"), 0);
  EXPECT_EQ(ticks.number(66, "pin_active"), 1);
}

// The force of a scene with a "device" is limited as the device limits it.
TEST(Replay, ADeviceOfTheSceneLimitsTheForce) {
  const test::TemporaryFolder folder;
  const auto replay_with = [&](const std::string& device) {
    test::write_file(folder / "s.json", R"({"coupling": {"stiffness": 800, "max_force": 1000},
      "chain": [{"name": "pin", "type": "point", "position": [0, 0, 0.01]}])" +
                                            (device.empty() ? "" : ", \"device\": " + device) + "}");
    std::string path = "t,x,y,z\n";
    for (int k = 0; k < 400; ++k) path += to_text(1e-3 * k) + ",0,0,0\n";
    test::write_file(folder / "p.csv", path);
    const ProgramResult run = catena_program(
        {"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv", "--details", folder / "links.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Table::read(folder / "t.csv");
  };
  const std::string plain = R"({"type": "simulated", "slew": 1e9, "ramp_in": 0)";
  EXPECT_NEAR(replay_with("").number(0, "force_z"), 8, 1e-12);
  EXPECT_NEAR(replay_with(plain + R"(, "stiffness_cap": 300})").number(9, "force_z"), 3, 1e-12);
  EXPECT_NEAR(replay_with(plain + R"(, "damping": 0.1, "friction": 9})").number(9, "force_z"), 200 * 0.01, 1e-12) << "2 b / T";
  EXPECT_NEAR(replay_with(plain + R"(, "encoder_step": 1e-3, "friction": 0.3})").number(9, "force_z"), 3, 1e-12) << "f_c / step";
  EXPECT_NEAR(replay_with(plain + R"(, "max_force": 1.5})").number(9, "force_z"), 1.5, 1e-12);
  const Table slewed = replay_with(R"({"type": "simulated", "slew": 40, "ramp_in": 0, "stiffness_cap": "none"})");
  const Table ramped = replay_with(R"({"type": "simulated", "slew": 1e9, "ramp_in": 0.2, "stiffness_cap": "none"})");
  for (std::size_t row = 0; row < 400; row += 7) {
    const double t = 1e-3 * static_cast<double>(row);
    EXPECT_NEAR(slewed.number(row, "force_z"), std::min(8.0, 40 * t), 1e-9) << row;
    EXPECT_NEAR(ramped.number(row, "force_z"), std::min(8.0, 8 * t / 0.2), 1e-9) << row;
  }
  // The accounted energy of the spring rises with the ramp.
  const Table links = Table::read(folder / "links.csv");
  EXPECT_NEAR(links.number(399, "pin_accounted"), 0.5 * 800 * 1e-4, 1e-12);
  EXPECT_NEAR(links.number(100, "pin_accounted"), 0.25 * 800 * 1e-4, 1e-12);

  test::write_file(folder / "s.json", R"({"chain": [], "device": {"type": "simulated", "slew": -1}})");
  const ProgramResult bad = catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("slew"), std::string::npos) << bad.err;
}

// Every scene in the documents runs unchanged.
TEST(Replay, TheExamplesOfTheDocumentsRun) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "p.csv", "t,x,y,z,buttons\n0,0.5,0.01,0,0\n0.001,0.49,0.05,-0.01,1\n0.002,0.45,0.1,-0.02,0\n");
  std::string text;
  for (const char* page : {"README.md", "docs/reference/scene.md", "docs/user/feeling.md", "docs/user/devices.md"})
    text += test::read_file(test::source_dir() + "/" + page);
  int examples = 0;
  for (std::size_t at = text.find("```json\n"); at != std::string::npos; at = text.find("```json\n", at + 1), ++examples) {
    const std::size_t begin = at + 8;
    test::write_file(folder / "s.json", text.substr(begin, text.find("```", begin) - begin));
    const ProgramResult run = catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(examples, 8);
}

TEST(Replay, OrientationsGiveRotationalProxiesAndTorque) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
    "align": {"stiffness": 0.25}}, {"name": "rail", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0]}]})");
  const double c = std::cos(0.2), s = std::sin(0.2);  // 0.4 rad about x
  test::write_file(folder / "turned.csv",
                   "t,x,y,z,qw,qx,qy,qz\n0,0,0,0.1,1,0,0,0\n0.001,0,0,0.1," + to_text(c) + "," + to_text(s) + ",0,0\n");
  test::write_file(folder / "plain.csv", "t,x,y,z\n0,0,0,0.1\n0.001,0,0,0.1\n");
  ProgramResult run = catena_program({"replay", folder / "s.json", "--probe", folder / "turned.csv", "-o", folder / "a.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run = catena_program({"replay", folder / "s.json", "--probe", folder / "plain.csv", "-o", folder / "b.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Table turned = Table::read(folder / "a.csv"), plain = Table::read(folder / "b.csv");
  EXPECT_EQ(turned.number(0, "torque_x"), 0);
  EXPECT_NEAR(turned.number(1, "torque_x"), -0.25 * 0.4, 1e-12);
  EXPECT_NEAR(turned.number(1, "floor_qw"), 1, 1e-12);
  EXPECT_NEAR(turned.number(1, "rail_qw"), 1, 1e-12);
  EXPECT_EQ(turned.number(1, "force_z"), plain.number(1, "force_z"));
  // A path without orientations gives no columns of orientation and torque.
  EXPECT_FALSE(plain.has("torque_x"));
  EXPECT_FALSE(plain.has("floor_qw"));
  EXPECT_EQ(plain.header().size(), 4u + 2 * 8 + 3);
}

TEST(Replay, SummarizesTheContactOfEachLinkInASentence) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"ball": {"analytic": "sphere"}}, "workspace": {"metres_per_unit": 0.05},
    "coupling": {"stiffness": 300, "max_force": 2.5},
    "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.25},
              {"name": "rail", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0]},
              {"name": "far", "type": "sphere", "center": [9, 0, 0], "radius": 1, "free": "above"}]})");
  // From outside straight to a depth of 0.3 units in half a second: 15 mm of the hand.
  std::string path = "t,x,y,z\n";
  for (int k = 0; k <= 500; ++k) path += to_text(1e-3 * k) + "," + to_text(1.2 - 1e-3 * k) + ",0,0\n";
  test::write_file(folder / "p.csv", path);
  const ProgramResult run = catena_program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // The surface releases at 0.25 units, 12.5 mm: 3.8 N, which the coupling limits to 2.5 N.
  EXPECT_NE(run.out.find("  skin: pressed 12.5 mm deep, own force at most 2.5 N; held 0.25 of 0.50 s, released once. Gap 0.2"),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("  rail: pulled up to 0 mm away, own force at most 0 N; held 0.50 of 0.50 s. Gap 0 units; ticks OK 501\n"),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("  far: not touched. Gap 0 units; ticks FREE 501\n"), std::string::npos) << run.out;
}

}  // namespace replay_test
