// SPDX-License-Identifier: MIT
/// `catena replay --log`, `export` and `info` of a recording: every kind of link, switches, maps and program changes.
#include <fmt/format.h>

#include "engine/app/haptics/log_replay.h"
#include "haptics/build/build_program.h"
#include "haptics/servo/log/rewrite.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/fuzz/log_bytes.h"
#include "tests/support/recording_fixture.h"

namespace catena::log_test {

using namespace catena::haptics;
using test::ProgramChange;

struct TestedScene {
  const char* name;
  const char* scene;
};
void PrintTo(const TestedScene& scene, std::ostream* out) { *out << scene.name; }

const TestedScene kScenes[] = {
    {"Modes", R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1], "snap": 0.1, "release": 0.25,
             "release_cue": {"type": "vibration", "amplitude": 0.3, "frequency": 130}},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.45, "release": 0.3, "release_cue": {"type": "detent"}},
            {"name": "floor", "type": "plane", "point": [0, 0, 0.05], "normal": [0, 0, 1], "active_when": {"force_above": 20, "force_below": 5}}],
  "modes": [{"name": "swapped", "links": ["surface", "curve"], "active_when": {"button": 1, "toggle": true}}],
  "coupling": {"ramp_s": 0.05, "max_force": 100}})"},
    {"Grids", R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "follow": "online", "seed": [0.5, 0.02, 0.03]},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.55, "free": "below", "release": 0.2,
             "stiffness": {"field": "s", "map": [[0.2, 100], [0.8, 400]]}, "active_when": {"button": 2}}], "coupling": {"damping": 1.5}})"},
    {"Friction", R"({"fields": {"v": {"file": "circle.vdb"}, "s": {"file": "sphere.vdb"}},
  "chain": [{"name": "drag", "type": "drag", "threshold": {"field": "v", "normalise": true, "map": [[0, 0.001], [1, 0.03]]}},
            {"name": "along", "type": "friction", "field": "v", "threshold": 0.05},
            {"name": "rough", "type": "texture", "threshold": 0.01, "amplitude": 0.8, "wavelength": 0.07},
            {"name": "oil", "type": "viscosity", "time": 0.004},
            {"name": "pull", "type": "gradient_force", "field": "s", "displacement": 0.05, "direction": "up_gradient"},
            {"name": "core", "type": "vortex_core", "field": "v", "radius": 0.2, "search_radius": 0.6}], "coupling": {"stiffness": 250}})"},
    {"Shapes", R"({"fields": {},
  "chain": [{"name": "path", "type": "polyline", "points": [[0.7, 0, 0], [0, 0.7, 0.1], [-0.7, 0, 0], [0, -0.6, 0]], "closed": true},
            {"name": "rail", "type": "segment", "from": [-0.5, -0.4, 0], "to": [0.6, 0.5, 0.2], "snap": 0.2, "release": 0.35},
            {"name": "axis", "type": "line", "point": [0, 0, 0.1], "direction": [1, 1, 0], "stiffness": 90, "release": 0.5},
            {"name": "ball", "type": "sphere", "center": [0.1, 0, 0], "radius": 0.4, "free": "above"},
            {"name": "case", "type": "box", "center": [0, 0, 0], "size": [0.9, 0.8, 0.7], "free": "below", "release": 0.3}]})"},
    {"Mesh", R"({"fields": {}, "meshes": [{"name": "wedge", "file": "wedge.obj", "scale": 2.6}],
  "chain": [{"name": "touch", "type": "mesh", "mesh": "wedge", "free": "above", "release": 0.3}]})"},
    {"Beltrami", R"({"fields": {"v": {"analytic": "abc"}},
  "chain": [{"name": "core", "type": "vortex_core", "field": "v", "criterion": "vorticity"}]})"},
    {"Balance", R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1], "stiffness": 50},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.55}], "coupling": {"method": "balance"}})"},
};
// The scene of a part in the middle of each recording.
constexpr const char* kOtherScene = R"({"fields": {"s": {"analytic": "sphere"}},
  "chain": [{"name": "surface", "type": "isosurface", "field": "s", "level": 0.4}, {"name": "pin", "type": "point", "position": [0, 0, 0.2]}]})";

/// Program changes like those of a session with a device: a fitted workspace, limits, and four programs (the scene, an equal one,
/// another one, the scene).
std::vector<ProgramChange> session(const std::string& scene_path, const std::string& text) {
  DeviceLimits limits;
  limits.max_force_n = 6;
  limits.max_stiffness_n_per_m = 450;
  std::vector<ProgramChange> changes;
  auto scene = scene::parse_scene(text, scene_path), between = scene::parse_scene(kOtherScene, scene_path);
  EXPECT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(between) << between.error().message;
  for (scene::Scene* s : {&*scene, &*between}) {
    if (!s->coupling.ramp_s) s->coupling.ramp_s = 0.02;
    s->workspace.meters_per_unit = 0.07;
    s->workspace.origin = {0.01, 0.02, 0.03};
  }
  const std::pair<std::uint64_t, bool> plan[] = {{1, false}, {400, false}, {700, true}, {900, false}};
  for (const auto& [tick, other] : plan) {
    auto program = build_program(other ? *between : *scene, limits);
    EXPECT_TRUE(program) << program.error().message;
    changes.push_back({tick, *program, other ? std::optional<std::string>(kOtherScene) : std::nullopt});
  }
  return changes;
}

class RecordingTest : public test::ProgramInFolder {
 protected:
  /// Writes the scene s.json and the files that scenes name to a subfolder of the folder, for example "a/".
  void make_scene(const TestedScene& scene, const std::string& subfolder = "") {
    for (const std::string name : {"circle", "sphere"})
      succeed("generate " + name + " -o {" + subfolder + name + ".vdb} --resolution 17 --box -1 1");
    write(subfolder + "wedge.obj", "v -0.4 -0.4 -0.3\nv 0.4 -0.4 -0.3\nv 0 0.5 -0.3\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write(subfolder + "s.json", scene.scene);
  }
  /// Records a session with the scene to l.catlog; returns its state_hash as it is printed.
  std::string record_session(const std::string& scene_name = "s.json") {
    const std::string scene_path = folder_ / scene_name;
    auto header = app::make_log_header(scene_path, {}, "simulated", 1000);
    EXPECT_TRUE(header) << header.error().message;
    auto writer = log::LogWriter::open(log_, *header, {scene_path});
    EXPECT_TRUE(writer) << writer.error().message;
    const std::uint64_t hash = test::record_ticks(**writer, session(scene_path, header->scene_text), test::adversarial_path(1200));
    const Outcome done = (*writer)->finish();
    EXPECT_TRUE(done) << done.error().message;
    return fmt::format("{:016x}", hash);
  }
  test::Table table(const std::string& name) const { return test::Table::read(folder_ / name); }
  std::string log_ = folder_ / "l.catlog";
};

/// The text of a tick table without its "_curve" columns, which a recording does not contain.
std::string without_curves(const test::Table& table) {
  std::string text;
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const std::string& column : table.header())
      if (!column.ends_with("_curve")) text += table.text(row, column) + (column == "t" ? "\n" : ",");
  return text;
}

using Upgrade = RecordingTest;
TEST_F(Upgrade, AnUpgradedRecordingOfVersion02ReplaysToTheSameHash) {
  make_scene(kScenes[0]);
  const std::string hash = record_session(), old = folder_ / "old.catlog";
  const auto old_names = [](std::string_view scene_text) -> Result<std::string> {
    std::string text(scene_text);
    for (const auto& [now, then] :
         {std::pair{"active_when", "on"}, {"release_cue", "indicate"}, {"{\"type\": \"detent", "{\"cue\": \"detent"}})
      for (std::size_t at; (at = text.find(now)) != std::string::npos;) text.replace(at, std::string_view(now).size(), then);
    return text;
  };
  ASSERT_TRUE(haptics::log::rewrite_scene_texts(log_, old, old_names));
  expect_refused("replay --log {old.catlog}", {"\"indicate\" is now \"release_cue\""});

  const std::string bytes = read("old.catlog");
  succeed("upgrade {old.catlog}");
  EXPECT_EQ(read("old.catlog.bak"), bytes);
  succeed("replay --log {old.catlog} --stats {s.txt}");
  test::expect_parts(read("s.txt"), {hash});
  EXPECT_EQ(succeed("upgrade {old.catlog}").out, old + ": has no old names\n");

  write("a.json", R"({"fog": {"most": 0.5}})");
  write("a.json.bak", "mine");
  EXPECT_EQ(run("upgrade {a.json}").exit_code, 2);  // no file is overwritten
  EXPECT_EQ(read("a.json") + read("a.json.bak"), R"({"fog": {"most": 0.5}}mine)");
  write("old.catlog", bytes.substr(0, 100) + "x" + bytes.substr(101));
  EXPECT_EQ(run("upgrade --no-backup {old.catlog}").exit_code, 2);
}

class RecordedScene : public RecordingTest, public testing::WithParamInterface<TestedScene> {};

TEST_P(RecordedScene, ReplaysBitExactlyAndExportsTheSameTable) {
  make_scene(GetParam());
  const std::string hash = record_session();
  const auto run = succeed("replay --log {l.catlog} -o {t.csv} --details {d.csv} --stats {s.txt}");
  test::expect_parts(run.out, {"1200 ticks, all bit-identical; ends cleanly with tick 1200"});
  test::expect_parts(read("s.txt"), {hash});

  succeed("export {l.catlog} -o {e.csv} --details {ed.csv}");
  const test::Table exported_ticks = table("e.csv"), details = table("d.csv"), all = table("ed.csv");
  EXPECT_EQ(exported_ticks.header(), table("t.csv").header());
  EXPECT_EQ(without_curves(exported_ticks), without_curves(table("t.csv")));
  for (const std::string& column : exported_ticks.header()) {
    if (column.ends_with("_curve")) {
      EXPECT_EQ(exported_ticks.text(0, column), "") << column;
    }
  }
  ASSERT_EQ(details.rows(), 1200u);
  ASSERT_EQ(all.rows(), 1200u);
  for (const std::string& column : details.header())
    for (std::size_t row = 0; row < 1200; row += 41) EXPECT_EQ(all.text(row, column), details.text(row, column)) << column << " " << row;
  for (const char* column : {"probe_time", "orientation_w", "coupling_x", "torque_z", "observer_energy", "compute_us", "device_us"})
    EXPECT_TRUE(all.has(column)) << column;
  EXPECT_EQ(all.text(50, "condition"), "NO_DEVICE");
  EXPECT_EQ(all.text(50, "force_state"), "STOPPED");
  EXPECT_EQ(all.text(5, "probe_time"), "0.005");
  EXPECT_EQ(all.text(1199, "tick"), "1200");
  EXPECT_EQ(all.text(100, "period_us"), "1000.5");
  // The link of the other program has cells for its ticks only.
  EXPECT_EQ(all.text(600, "pin_gap"), "");
  EXPECT_NE(all.text(800, "pin_gap"), "");
}

INSTANTIATE_TEST_SUITE_P(Scenes, RecordedScene, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

class Recording : public RecordingTest {
 protected:
  Recording() {
    std::filesystem::create_directory(folder_ / "a");
    make_scene(kScenes[1], "a/");
    record_session("a/s.json");
  }
};

TEST_F(Recording, IsReplayedWithAMovedSceneIfThatIsGiven) {
  std::filesystem::rename(folder_ / "a", folder_ / "b");
  expect_refused("replay --log {l.catlog} -o {t.csv}", {"circle.vdb"});
  // The scene is next to its files; a replay needs no output.
  test::expect_parts(succeed("replay {b/s.json} --log {l.catlog}").out, {"all bit-identical"});
  // Tables need neither the scene nor its files.
  std::filesystem::remove_all(folder_ / "b");
  succeed("export {l.catlog} -o {e.csv}");
  EXPECT_EQ(table("e.csv").rows(), 1200u);
}

TEST_F(Recording, WithoutAWorkspaceTheScaleIsReported) {
  const std::string sentence = "the scene states no workspace: 1 world unit is ";
  test::expect_parts(run("replay --log {l.catlog}").out, {sentence + "0.07 m of the device, as recorded\n"});
  write("p.csv", "t,x,y,z\n0,0,0,0\n");
  test::expect_parts(run("replay {a/s.json} --probe {p.csv} -o {t.csv}").out, {sentence + "1 m of the device\n"});
  std::string text = kScenes[1].scene;
  text.insert(1, R"("workspace": {"metres_per_unit": 0.07}, )");
  write("a/stated.json", text);
  const auto stated = succeed("replay {a/stated.json} --probe {p.csv} -o {t.csv}");
  EXPECT_EQ(stated.out.find(sentence), std::string::npos) << stated.out;
}

TEST_F(Recording, AnotherSceneIsReportedWithTheFirstDifferentTick) {
  std::string text = kScenes[1].scene;
  text.replace(text.find("0.02, 0.03]"), 4, "0.03");
  write("a/other.json", text);
  const auto other = run("replay {a/other.json} --log {l.catlog} -o {t.csv}");
  EXPECT_EQ(other.exit_code, 1);
  test::expect_parts(other.err, {"first differs at tick ", "recorded"});
  test::expect_one_line(other.err);
  EXPECT_EQ(table("t.csv").rows(), 1200u) << "what the replay gave, to compare";
  write("a/none.json", R"({"chain": []})");
  expect_refused("replay {a/none.json} --log {l.catlog}", {"links or widgets of the scene differ"});
}

TEST_F(Recording, ATruncatedLogIsReplayedAndDescribed) {
  const std::string bytes = read("l.catlog");
  write("l.catlog", bytes.substr(0, bytes.size() - 100));
  test::expect_parts(succeed("replay --log {l.catlog} -o {t.csv}").out, {"all bit-identical; truncated after tick "});
  test::expect_parts(succeed("info {l.catlog}").out, {"a/s.json", "simulated at 1000 Hz", "truncated after tick",
                                                      "from tick 1: curve, surface", "from tick 700: surface, pin", "ticks "});
}

TEST_F(Recording, AGapIsReportedAndTheReplayFails) {
  std::string bytes = read("l.catlog");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("l.catlog", bytes);
  const auto replay = run("replay --log {l.catlog}");
  EXPECT_EQ(replay.exit_code, 1);
  test::expect_parts(replay.out, {"all bit-identical"});
  test::expect_parts(replay.err, {"are lost: the log is damaged at this point; the rest cannot be replayed"});
  test::expect_parts(succeed("export {l.catlog} -o {e.csv}").err, {"are lost"});
  test::expect_parts(run("info {l.catlog}").out, {"gap "});
}

TEST_F(Recording, BadArgumentsAreOneLineAndNoFile) {
  write("no.catlog", "this is no recording");
  write("p.csv", "t,x,y,z\n0,0,0,0\n");
  const std::pair<const char*, const char*> bad[] = {{"replay --log {no.catlog} -o {o.csv}", "not a recording"},
                                                     {"replay --log {none.catlog} -o {o.csv}", "none.catlog"},
                                                     {"replay --log {l.catlog} --probe {p.csv} -o {o.csv}", "--probe and --log"},
                                                     {"export {no.catlog} -o {o.csv}", "not a recording"},
                                                     {"info {no.catlog}", "not a recording"},
                                                     {"replay -o {o.csv}", "SCENE is required"},
                                                     {"replay {a/s.json} -o {o.csv}", "--probe or --log"},
                                                     {"replay {a/s.json} --probe {p.csv}", "--output is required"}};
  for (const auto& [line, part] : bad) expect_refused(line, {part});
}

TEST_F(Recording, ReplacedFieldsAreRelativeToTheRecordedWorkingFolder) {
  // The option --field s=a/sphere.vdb, recorded in the working folder.
  std::string text = kScenes[1].scene;
  text.replace(text.find("sphere.vdb"), 10, "circle.vdb:x");
  auto header = app::make_log_header(folder_ / "a/s.json", {"s=a/sphere.vdb"}, "null", 1000);
  header->working_folder = folder_.path();
  header->scene_path = "a/s.json";
  auto scene = app::open_scene(folder_ / "a/s.json", {"s=" + (folder_ / "a/sphere.vdb")});
  ASSERT_TRUE(scene) << scene.error().message;
  auto program = build_program(*scene);
  ASSERT_TRUE(program);
  auto writer = log::LogWriter::open(log_, *header);
  test::record_ticks(**writer, {{1, *program, {}}}, test::adversarial_path(200));
  ASSERT_TRUE((*writer)->finish());
  succeed("replay --log {l.catlog}");
  test::expect_parts(run("info {l.catlog}").out, {"s=a/sphere.vdb"});
}

using ForgedRecording = RecordingTest;

// A log that begins during a run contains the chain's raw state, which is validated even if the hashes are right.
TEST_F(ForgedRecording, IsOneErrorLineAndExitCodeTwo) {
  const std::string scene_path = folder_ / "s.json";
  write("s.json", R"({"chain": [{"name": "path", "type": "polyline", "points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0]]}]})");
  auto header = app::make_log_header(scene_path, {}, "simulated", 1000);
  ASSERT_TRUE(header);
  auto scene = scene::parse_scene(header->scene_text, scene_path);
  ASSERT_TRUE(scene);
  const auto program = build_program(*scene, {});
  ASSERT_TRUE(program);
  const auto path = test::adversarial_path(80);
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  HapticState out;
  auto writer = log::LogWriter::open(log_, *header, {scene_path});
  ASSERT_TRUE(writer);
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (k == 60) {
      (*writer)->begin(*state);
      (*writer)->add_program(**program, {});
      *scratch = {};
    }
    tick(**program, path[k], *state, *scratch, out);
    if (k >= 60) (*writer)->put(path[k], out);
  }
  ASSERT_TRUE((*writer)->finish());
  writer->reset();
  succeed("replay --log {l.catlog}");

  // Sets the polyline's current segment to an index far out of range.
  std::string bytes = read("l.catlog");
  for (std::size_t at = log::kPreambleBytes; at < bytes.size();) {
    log::BlockHeader head;
    std::memcpy(&head, bytes.data() + at, sizeof head);
    at += sizeof head;
    if (head.type == static_cast<std::uint32_t>(log::BlockType::state))
      std::memset(bytes.data() + at + 16 + offsetof(LinkState, memory) + 64, 0x7f, 300);
    at += head.length;
  }
  test::rewrite_hashes(bytes);
  write("l.catlog", bytes);
  expect_refused("replay --log {l.catlog} -o {t.csv}",
                 {"l.catlog: before tick 61: the state of link \"path\" is damaged, forged or from another scene"});
}

}  // namespace catena::log_test
