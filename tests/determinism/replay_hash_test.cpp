// SPDX-License-Identifier: MIT
/// The state_hash of each replay equals the committed constant in every preset, with and without the thread.
/// The scenes use only + - * / sqrt (sampled grids, circle, sphere); a commit that changes behaviour must update the constants.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "engine/base/numbers.h"
#include "haptics/build/build_program.h"
#include "haptics/device/recorded_path.h"
#include "haptics/servo/replay.h"
#include "haptics/servo/servo.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace replay_hash_test {

using namespace catena;
using namespace catena::haptics;

struct Recorded {
  const char* name;
  std::uint64_t hash;
  const char* scene;
  bool presses = false;
};

// A path without libm functions: a polygon with rational corners, a rest, a jump.
/// `presses`: true: the button is pressed and released repeatedly; false: pressed once.
std::vector<ProbeSample> probe_path(bool presses) {
  const Vec3 corners[] = {{0.6, 0.1, 0.0}, {0.1, 0.7, 0.2}, {-0.6, 0.2, -0.1}, {-0.2, -0.5, 0.3}, {0.5, -0.4, -0.2}, {0.45, 0.05, 0.1}};
  std::vector<ProbeSample> path;
  for (int k = 0; k < 3000; ++k) {
    const int segment = k / 500;
    const double f = segment == 3 ? 0.5 : (k % 500) / 500.0;
    const Vec3 a = corners[segment], b = corners[(segment + 1) % 6];
    path.push_back({k / 1000.0, a + (b - a) * f, (presses ? k / 150 % 2 == 1 : k > 1500) ? 1u : 0u});
  }
  return path;
}

const Recorded kRecorded[] = {
    {"circle", 0x9b0462b529f38796, R"({"fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0]}], "coupling": {"stiffness": 300, "damping": 1.5, "max_force": 6}})"},
    {"circle_online", 0x67d1ceac0b0241de, R"({"fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0], "follow": "online"}]})"},
    {"sphere", 0x4a5465667050ae74, R"({"fields": {"s": {"analytic": "sphere"}},
  "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.5, "free": "above", "release": 0.3}]})"},
    {"chain", 0x0765d772fb8a76fa, R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1]},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.45, "active_when": {"button": 1}},
            {"name": "floor", "type": "plane", "point": [0, 0, 0.05], "normal": [0, 0, 1], "free": "above"},
            {"name": "pin", "type": "point", "position": [0.1, 0.2, 0.3], "stiffness": 20}], "coupling": {"ramp_s": 0.02}})"},
    {"shapes", 0x421d00521f36a7bf, R"({"fields": {},
  "chain": [{"name": "path", "type": "polyline", "points": [[0.7, 0, 0], [0, 0.7, 0.1], [-0.7, 0, 0], [0, -0.6, 0]], "closed": true},
            {"name": "rail", "type": "segment", "from": [-0.5, -0.4, 0], "to": [0.6, 0.5, 0.2], "snap": 0.2, "release": 0.35},
            {"name": "axis", "type": "line", "point": [0, 0, 0.1], "direction": [1, 1, 0], "stiffness": 90, "release": 0.5},
            {"name": "ball", "type": "sphere", "center": [0.1, 0, 0], "radius": 0.4, "free": "above"},
            {"name": "case", "type": "box", "center": [0, 0, 0], "size": [0.9, 0.8, 0.7], "free": "below", "release": 0.3}]})"},
    {"friction", 0xef3f6de4e6c46cdd, R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "drag", "type": "drag", "threshold": 0.02},
            {"name": "along", "type": "friction", "field": "v", "threshold": 0.05},
            {"name": "rough", "type": "texture", "threshold": 0.01, "amplitude": 0.8, "wavelength": 0.07},
            {"name": "oil", "type": "viscosity", "time": 0.004}], "coupling": {"stiffness": 250, "damping": 0.5}})"},
    {"anisotropic", 0xd20422e0f3ddfe54, R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "s", "level": 0.5, "field": "v", "threshold": 0.03,
             "tau_min": 0.002, "tau_max": 0.04, "free": "above", "release": 0.4}]})"},
    {"driven", 0x09d34e4fa123460e, R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "pull", "type": "gradient_force", "field": "s", "displacement": 0.05, "direction": "up_gradient"},
            {"name": "core", "type": "vortex_core", "field": "v", "radius": 0.2, "search_radius": 0.6,
             "stiffness": {"field": "s", "map": [[0.2, 100], [0.8, 400]]}},
            {"name": "drag", "type": "drag", "threshold": {"field": "v", "normalise": true, "map": [[0, 0.001], [1, 0.03]]}}]})"},
    {"modes", 0x502ca93c491c41f4, R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1], "snap": 0.1, "release": 0.25,
             "release_cue": {"type": "vibration", "amplitude": 0.3, "frequency": 130}},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.45, "release": 0.3, "release_cue": {"type": "detent"}},
            {"name": "floor", "type": "plane", "point": [0, 0, 0.05], "normal": [0, 0, 1], "active_when": {"force_above": 20, "force_below": 5}}],
  "modes": [{"name": "swapped", "links": ["surface", "curve"], "active_when": {"button": 1, "toggle": true}}],
  "coupling": {"ramp_s": 0.05, "max_force": 100}})"},
    {"mesh", 0x38bd92e22a245e8a, R"({"fields": {}, "meshes": [{"name": "wedge", "file": "wedge.obj", "scale": 2.6}],
  "chain": [{"name": "touch", "type": "mesh", "mesh": "wedge", "free": "above", "release": 0.3}]})"},
    {"pipe", 0xecb1973a8733ff12, R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.55, "release": 0.25},
            {"name": "floor", "type": "plane", "point": [0, 0, 0.05], "normal": [0, 1, 4]}], "coupling": {"method": "pipe"}})"},
    {"balance", 0x0192ae194d20fbed, R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1], "stiffness": 50},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.55}], "coupling": {"method": "balance"}})"},
    // two corners of the path are on the plane, two near the sphere; the path's buttons grab
    {"widgets", 0x43483bd5a65f0332, R"({"fields": {},
  "chain": [{"name": "floor", "type": "plane", "point": [0, 0, -0.3], "normal": [0, 1, 4]}],
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0.1, 0], "orientation": [0.8, 0, 0.6, 0], "radius": 0.45,
               "snap": 0.1, "release": 0.2, "grab_distance": 0.04, "step": 0.05},
              {"name": "box", "type": "box", "min": [-0.3, -0.6, -0.3], "max": [0.6, 0.2, 0.3], "grab_distance": 0.15},
              {"name": "rake", "type": "rake", "from": [-0.6, 0.2, -0.1], "to": [0.45, 0.05, 0.1]},
              {"name": "level", "type": "cutting_plane", "center": [0, 0, 0.1], "normal": [0, 0, 1], "radius": 0.05, "snap": 0.05,
               "release": 0.1, "grab_distance": 0.02, "step": 0.03}],
  "coupling": {"ramp_s": 0.05, "max_force": 100}})",
     true},
    {"grids", 0xbba92f721691bc6e, R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0.02, 0.03]},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.55, "free": "below", "release": 0.2}]})"},
    {"grid_online", 0x2d0fb7de732746be, R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.4},
            {"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0.02, 0.03], "method": "rk4"}]})"},
};

std::string fmt_hash(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::shared_ptr<const HapticProgram> program_of(const Recorded& recorded, const test::TemporaryFolder& folder) {
  for (const char* name : {"circle", "sphere"}) {
    test::expect_run({"generate", name, "-o", folder / (std::string(name) + ".vdb"), "--resolution", "33", "--box", "-1", "1"});
  }
  test::write_file(folder / "wedge.obj",
                   "v -0.4 -0.4 -0.3\nv 0.4 -0.4 -0.3\nv 0 0.5 -0.3\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  auto scene = scene::parse_scene(recorded.scene, folder / "scene.json");
  EXPECT_TRUE(scene) << scene.error().message;
  auto program = build_program(*scene);
  EXPECT_TRUE(program) << program.error().message;
  return *program;
}

void PrintTo(const Recorded& recorded, std::ostream* out) { *out << recorded.name; }

class ReplayHash : public testing::TestWithParam<Recorded> {};

// Checks that the widgets' replay grabs and moves them.
TEST(WidgetReplay, GrabsAndMovesWidgets) {
  const test::TemporaryFolder folder;
  const auto widgets = std::ranges::find_if(kRecorded, &Recorded::presses);
  const auto program = program_of(*widgets, folder);
  std::set<WidgetMode> plane, others;
  replay(*program, probe_path(true), [&](const HapticState& state) {
    plane.insert(state.widgets[0].mode);
    plane.insert(state.widgets[3].mode);
    others.insert(state.widgets[1].mode);
    others.insert(state.widgets[2].mode);
    return true;
  });
  using Mode = WidgetMode;
  EXPECT_EQ(plane, (std::set{Mode::idle, Mode::explore, Mode::translate, Mode::rotate, Mode::turn}));
  EXPECT_EQ(others, (std::set{Mode::idle, Mode::hover, Mode::drag}));
}

TEST_P(ReplayHash, MatchesTheCommittedHashWithAndWithoutTheThread) {
  const test::TemporaryFolder folder;
  const auto program = program_of(GetParam(), folder);
  const std::vector<ProbeSample> path = probe_path(GetParam().presses);
  const ReplayStats stats = replay(*program, path, [](const HapticState&) { return true; });
  EXPECT_EQ(stats.state_hash, GetParam().hash) << fmt_hash(stats.state_hash);

  std::vector<RecordedPath::Sample> samples;
  for (const ProbeSample& p : path) samples.push_back({p.t_s, p.position, p.buttons});
  RecordedPath device(samples);
  Servo servo(device, program, {.rate_hz = 1000, .paced = false, .max_ticks = path.size()});
  EXPECT_TRUE(servo.start());
  while (servo.running()) std::this_thread::yield();
  servo.stop();
  EXPECT_EQ(servo.state_hash(), stats.state_hash);
}

TEST_P(ReplayHash, MatchesTheProgramsHash) {
  const test::TemporaryFolder folder;
  const auto program = program_of(GetParam(), folder);
  test::write_file(folder / "scene.json", GetParam().scene);
  std::string csv = "t,x,y,z,buttons\n";
  for (const ProbeSample& p : probe_path(GetParam().presses))
    csv += fmt::format("{},{},{},{},{}\n", to_text(p.t_s), to_text(p.position.x), to_text(p.position.y), to_text(p.position.z), p.buttons);
  test::write_file(folder / "p.csv", csv);
  test::expect_run({"replay", folder / "scene.json", "--probe", folder / "p.csv", "-o", folder / "t.csv", "--stats", folder / "s.json"});
  EXPECT_NE(test::read_file(folder / "s.json").find(fmt_hash(GetParam().hash)), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReplayHash, testing::ValuesIn(kRecorded),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace replay_hash_test
