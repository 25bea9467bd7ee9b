// SPDX-License-Identifier: MIT
/// The commands `catena replay` and `catena trace`, against closed forms and the paper's figures.

#include <cmath>

#include "engine/base/numbers.h"
#include "tests/engine/app/program_runs.h"

namespace replay_test {

using namespace catena;
using test::has;
using test::ProgramResult;
using test::run_ok;
using test::Table;

Vec3 vector_at(const Table& table, std::size_t row, const std::string& name) {
  return {table.number(row, name + "_x"), table.number(row, name + "_y"), table.number(row, name + "_z")};
}

/// A row of a path.
std::string row(int k, double x, double y, double z) {
  return to_text(1e-3 * k) + "," + to_text(x) + "," + to_text(y) + "," + to_text(z) + "\n";
}

class Replay : public testing::Test {
 protected:
  /// Replays a path, a header and rows, in a scene, with more options.
  ProgramResult run(const std::string& scene, const std::string& path, const test::Words& more = {}) const {
    test::write_file(folder_ / "s.json", scene);
    test::write_file(folder_ / "p.csv", path);
    return run_ok({"replay", folder_ / "s.json", "--probe", folder_ / "p.csv", "-o", folder_ / "t.csv"}, more);
  }
  Table replay(const std::string& scene, const std::string& path, const test::Words& more = {}) const {
    run(scene, path, more);
    return Table::read(folder_ / "t.csv");
  }
  /// Traces the field v of the last scene from the rows of seeds.
  Table trace(const std::string& seeds) const {
    test::write_file(folder_ / "seeds.csv", "x,y,z\n" + seeds);
    run_ok({"trace", folder_ / "s.json", "--field", "v", "--seeds", folder_ / "seeds.csv", "-o", folder_ / "l.csv"});
    return Table::read(folder_ / "l.csv");
  }
  test::TemporaryFolder folder_;
};

// One lap of a circle of radius 0.05 at a speed of 0.2, at 1 kHz.
std::string lap() {
  constexpr double kRadius = 0.05, kSpeed = 0.2;
  std::string text = "t,x,y,z\n";
  const int ticks = static_cast<int>(std::ceil(2 * M_PI * kRadius / kSpeed / 1e-3));
  for (int k = 0; k <= ticks; ++k) {
    const double angle = kSpeed * (1e-3 * k) / kRadius;
    text += row(k, kRadius * std::cos(angle), kRadius * std::sin(angle), 0);
  }
  return text;
}

std::string circle_scene(const std::string& link_keys) {
  return R"({"fields": {"v": {"analytic": "circle"}},
             "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.05, 0, 0])" +
         link_keys + "}]}";
}

/// The largest distance of the proxy from the circle.
double max_drift(const Table& table) {
  double worst = 0;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const Vec3 p = vector_at(table, k, "curve");
    worst = std::max(worst, std::hypot(std::hypot(p.x, p.y) - 0.05, p.z));
  }
  return worst;
}

TEST_F(Replay, LinearStreamlineDriftsAsInThePaper) {
  EXPECT_NEAR(max_drift(replay(circle_scene(R"(, "method": "linear")"), lap())), 0.63e-3, 0.02e-3);
}

TEST_F(Replay, SelectedAndOnlineStreamlinesStayOnTheCircle) {
  for (const char* keys : {"", R"(, "follow": "online")", R"(, "method": "dp54")"})
    EXPECT_LE(max_drift(replay(circle_scene(keys), lap())), 5e-10) << keys;
}

TEST_F(Replay, SelectedProxyLiesOnTheTracedCurve) {
  std::string path = "t,x,y,z\n";
  for (int k = 0; k < 800; ++k) {
    const double t = 1e-3 * k;
    path += row(k, 0.3 + 0.5 * std::sin(5 * t), -0.2 + 0.3 * t, 0.7 - 0.4 * t);
  }
  const Table ticks = replay(R"({"fields": {"v": {"analytic": "abc"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.3, -0.2, 0.7]}]})",
                             path);
  const Table line = trace("0.3,-0.2,0.7\n");
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

TEST_F(Replay, TheTableHasTheDocumentedColumns) {
  run(R"({"fields": {}, "chain": [{"name": "a", "type": "point", "position": [0, 0, 0]},
     {"name": "b_2", "type": "plane", "point": [0, 0, 1], "normal": [0, 0, 2]}]})",
      "\xef\xbb\xbft,x,y,z,buttons\r\n0,1,2,3,1\r\n", {"--stats", folder_ / "s.out"});
  const std::string text = test::read_file(folder_ / "t.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "t,probe_x,probe_y,probe_z,a_x,a_y,a_z,a_active,a_status,a_evaluations,a_reason,b_2_x,b_2_y,b_2_z,b_2_active,b_2_status,b_2_"
            "evaluations,b_2_reason,"
            "force_x,force_y,force_z,a_curve,b_2_curve");
  const std::string stats = test::read_file(folder_ / "s.out");
  for (const char* key : {"\"ticks\": 1", "\"tick_ns\"", "\"p50\"", "\"p99\"", "\"p999\"", "\"max\"", "\"evaluations\"", "\"state_hash\""})
    EXPECT_TRUE(has(stats, key));
}

TEST_F(Replay, AnEmptySceneIsValidAndOnlyDamps) {
  const Table table =
      replay(R"({"fields": {}, "chain": [], "coupling": {"damping": 2, "max_force": 100}})", "t,x,y,z\n0,0,0,0\n0.5,1,0,0\n");
  EXPECT_EQ(table.number(0, "force_x"), 0);
  EXPECT_EQ(table.number(1, "force_x"), -4);
}

TEST_F(Replay, DetailsHaveTheStateOfEveryLink) {
  std::string path = "t,x,y,z,buttons\n";
  for (int k = 0; k < 70; ++k) path += to_text(1e-3 * k) + ",0.2,0," + to_text(0.005 - 1e-3 * k) + (k >= 65 ? ",2\n" : ",0\n");
  const Table ticks = replay(R"({"coupling": {"stiffness": 200, "max_force": 1000}, "workspace": {"metres_per_unit": 0.5},
    "chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "release": 0.05},
              {"name": "pin", "type": "point", "position": [0, 0, 0], "stiffness": 10}],
    "modes": [{"name": "pinned", "links": ["pin"], "active_when": {"button": 2}}]})",
                             path, {"--details", folder_ / "links.csv"});
  const Table table = Table::read(folder_ / "links.csv");
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
  EXPECT_EQ(ticks.text(3, "floor_status"), "FREE");
  EXPECT_EQ(ticks.text(30, "floor_status"), "OK");
  EXPECT_EQ(ticks.text(56, "floor_status"), "RELEASED");
  EXPECT_EQ(ticks.text(56, "floor_active"), "0");
  for (const std::size_t row : {3u, 56u}) EXPECT_EQ(ticks.text(row, "floor_z"), ticks.text(row, "probe_z")) << row;
  EXPECT_NEAR(ticks.number(30, "floor_z"), 0, 1e-12);
  EXPECT_EQ(table.text(66, "mode"), "pinned");
  EXPECT_EQ(ticks.number(66, "floor_active"), 0);
  EXPECT_EQ(ticks.number(66, "pin_active"), 1);
}

// The force of a scene with a "device" is limited as the device limits it.
TEST_F(Replay, ADeviceOfTheSceneLimitsTheForce) {
  std::string path = "t,x,y,z\n";
  for (int k = 0; k < 400; ++k) path += row(k, 0, 0, 0);
  const auto replay_with = [&](const std::string& device) {
    return replay(R"({"coupling": {"stiffness": 800, "max_force": 1000},
      "chain": [{"name": "pin", "type": "point", "position": [0, 0, 0.01]}])" +
                      (device.empty() ? "" : ", \"device\": " + device) + "}",
                  path, {"--details", folder_ / "links.csv"});
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
  const Table links = Table::read(folder_ / "links.csv");
  EXPECT_NEAR(links.number(399, "pin_accounted"), 0.5 * 800 * 1e-4, 1e-12);
  EXPECT_NEAR(links.number(100, "pin_accounted"), 0.25 * 800 * 1e-4, 1e-12);

  test::write_file(folder_ / "s.json", R"({"chain": [], "device": {"type": "simulated", "slew": -1}})");
  test::run_refused({"replay", folder_ / "s.json", "--probe", folder_ / "p.csv", "-o", folder_ / "t.csv"}, "slew");
}

// Every scene in the documents runs unchanged.
TEST_F(Replay, TheExamplesOfTheDocumentsRun) {
  std::string text;
  for (const char* page : {"README.md", "docs/reference/scene.md", "docs/user/feeling.md", "docs/user/devices.md"})
    text += test::read_file(test::source_dir() + "/" + page);
  int examples = 0;
  for (std::size_t at = text.find("```json\n"); at != std::string::npos; at = text.find("```json\n", at + 1), ++examples) {
    const std::size_t begin = at + 8;
    run(text.substr(begin, text.find("```", begin) - begin),
        "t,x,y,z,buttons\n0,0.5,0.01,0,0\n0.001,0.49,0.05,-0.01,1\n0.002,0.45,0.1,-0.02,0\n");
  }
  EXPECT_EQ(examples, 8);
}

TEST_F(Replay, OrientationsGiveRotationalProxiesAndTorque) {
  const std::string scene = R"({"chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
    "align": {"stiffness": 0.25}}, {"name": "rail", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0]}]})";
  const double c = std::cos(0.2), s = std::sin(0.2);  // 0.4 rad about x
  const Table turned = replay(scene, "t,x,y,z,qw,qx,qy,qz\n0,0,0,0.1,1,0,0,0\n0.001,0,0,0.1," + to_text(c) + "," + to_text(s) + ",0,0\n");
  const Table plain = replay(scene, "t,x,y,z\n0,0,0,0.1\n0.001,0,0,0.1\n");
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

TEST_F(Replay, SummarizesTheContactOfEachLinkInASentence) {
  // From outside straight to a depth of 0.3 units in half a second: 15 mm of the hand.
  std::string path = "t,x,y,z\n";
  for (int k = 0; k <= 500; ++k) path += row(k, 1.2 - 1e-3 * k, 0, 0);
  const ProgramResult result = run(R"({"fields": {"ball": {"analytic": "sphere"}}, "workspace": {"metres_per_unit": 0.05},
    "coupling": {"stiffness": 300, "max_force": 2.5},
    "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.25},
              {"name": "rail", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0]},
              {"name": "far", "type": "sphere", "center": [9, 0, 0], "radius": 1, "free": "above"}]})",
                                   path);
  // The surface releases at 0.25 units, 12.5 mm: 3.8 N, which the coupling limits to 2.5 N.
  for (const char* part : {"  skin: pressed 12.5 mm deep, own force at most 2.5 N; held 0.25 of 0.50 s, released once. Gap 0.2",
                           "  rail: pulled up to 0 mm away, own force at most 0 N; held 0.50 of 0.50 s. Gap 0 units; ticks OK 501\n",
                           "  far: not touched. Gap 0 units; ticks FREE 501\n"})
    EXPECT_TRUE(has(result.out, part));
}

}  // namespace replay_test
