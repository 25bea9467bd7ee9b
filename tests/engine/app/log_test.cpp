// SPDX-License-Identifier: MIT
/// `catena replay --log`, `export` and `info` of a recording: every kind of link, switches, maps and program changes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/app/haptics/log_replay.h"
#include "haptics/build/build_program.h"
#include "haptics/servo/log/rewrite.h"
#include "tests/fuzz/log_bytes.h"
#include "tests/support/recording_fixture.h"
#include "tests/support/run_program.h"

namespace log_test {

using namespace catena;
using namespace catena::haptics;
using test::ProgramChange;

test::ProgramResult catena_program(const std::vector<std::string>& arguments) { return test::run_catena(arguments); }

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

void make_data(const std::string& folder) {
  for (const char* name : {"circle", "sphere"}) {
    const auto run =
        catena_program({"generate", name, "-o", folder + "/" + std::string(name) + ".vdb", "--resolution", "17", "--box", "-1", "1"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  test::write_file(folder + "/wedge.obj",
                   "v -0.4 -0.4 -0.3\nv 0.4 -0.4 -0.3\nv 0 0.5 -0.3\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
}

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

std::uint64_t record_session(const std::string& log, const std::string& scene_path, int ticks = 1200) {
  auto header = app::make_log_header(scene_path, {}, "simulated", 1000);
  EXPECT_TRUE(header) << header.error().message;
  auto writer = log::LogWriter::open(log, *header, {scene_path});
  EXPECT_TRUE(writer) << writer.error().message;
  const std::uint64_t hash = test::record_ticks(**writer, session(scene_path, header->scene_text), test::adversarial_path(ticks));
  const Outcome done = (*writer)->finish();
  EXPECT_TRUE(done) << done.error().message;
  return hash;
}

/// The text of a tick table without its "_curve" columns, which a recording does not contain.
std::string without_curves(const std::string& path) {
  const test::Table table = test::Table::read(path);
  std::string text;
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const std::string& column : table.header())
      if (!column.ends_with("_curve")) text += table.text(row, column) + (column == "t" ? "\n" : ",");
  return text;
}

TEST(Upgrade, AnUpgradedRecordingOfVersion02ReplaysToTheSameHash) {
  const test::TemporaryFolder folder;
  make_data(folder.path());
  test::write_file(folder / "s.json", kScenes[0].scene);
  const std::uint64_t hash = record_session(folder / "new.catlog", folder / "s.json");
  const std::string old = folder / "old.catlog";
  const auto old_names = [](std::string_view scene_text) -> Result<std::string> {
    std::string text(scene_text);
    for (const auto& [now, then] :
         {std::pair{"active_when", "on"}, {"release_cue", "indicate"}, {"{\"type\": \"detent", "{\"cue\": \"detent"}})
      for (std::size_t at; (at = text.find(now)) != std::string::npos;) text.replace(at, std::string_view(now).size(), then);
    return text;
  };
  ASSERT_TRUE(haptics::log::rewrite_scene_texts(folder / "new.catlog", old, old_names));
  const auto refused = catena_program({"replay", "--log", old});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("\"indicate\" is now \"release_cue\""), std::string::npos) << refused.err;

  const std::string bytes = test::read_file(old);
  ASSERT_EQ(catena_program({"upgrade", old}).exit_code, 0);
  EXPECT_EQ(test::read_file(old + ".bak"), bytes);
  const auto run = catena_program({"replay", "--log", old, "--stats", folder / "s.txt"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "s.txt").find(fmt::format("{:016x}", hash)), std::string::npos);
  EXPECT_EQ(catena_program({"upgrade", old}).out, old + ": has no old names\n");

  test::write_file(folder / "a.json", R"({"fog": {"most": 0.5}})");
  test::write_file(folder / "a.json.bak", "mine");
  EXPECT_EQ(catena_program({"upgrade", folder / "a.json"}).exit_code, 2);  // no file is overwritten
  EXPECT_EQ(test::read_file(folder / "a.json") + test::read_file(folder / "a.json.bak"), R"({"fog": {"most": 0.5}}mine)");
  test::write_file(old, bytes.substr(0, 100) + "x" + bytes.substr(101));
  EXPECT_EQ(catena_program({"upgrade", "--no-backup", old}).exit_code, 2);
}

class RecordedScene : public testing::TestWithParam<TestedScene> {};

TEST_P(RecordedScene, ReplaysBitExactlyAndExportsTheSameTable) {
  const test::TemporaryFolder folder;
  make_data(folder.path());
  test::write_file(folder / "s.json", GetParam().scene);
  const std::uint64_t hash = record_session(folder / "l.catlog", folder / "s.json");
  const auto run = catena_program(
      {"replay", "--log", folder / "l.catlog", "-o", folder / "t.csv", "--details", folder / "d.csv", "--stats", folder / "s.txt"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("1200 ticks, all bit-identical; ends cleanly with tick 1200"), std::string::npos) << run.out;
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  EXPECT_NE(test::read_file(folder / "s.txt").find(text), std::string::npos);

  const auto exported = catena_program({"export", folder / "l.catlog", "-o", folder / "e.csv", "--details", folder / "ed.csv"});
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  const test::Table exported_ticks = test::Table::read(folder / "e.csv");
  EXPECT_EQ(exported_ticks.header(), test::Table::read(folder / "t.csv").header());
  EXPECT_EQ(without_curves(folder / "e.csv"), without_curves(folder / "t.csv"));
  for (const std::string& column : exported_ticks.header()) {
    if (column.ends_with("_curve")) {
      EXPECT_EQ(exported_ticks.text(0, column), "") << column;
    }
  }
  const test::Table details = test::Table::read(folder / "d.csv"), all = test::Table::read(folder / "ed.csv");
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

class Recording : public testing::Test {
 protected:
  Recording() {
    std::filesystem::create_directory(folder_ / "a");
    make_data(folder_ / "a");
    test::write_file(folder_ / "a/s.json", kScenes[1].scene);
    record_session(log_, folder_ / "a/s.json");
  }
  test::TemporaryFolder folder_;
  std::string log_ = folder_ / "l.catlog";
};

TEST_F(Recording, IsReplayedWithAMovedSceneIfThatIsGiven) {
  std::filesystem::rename(folder_ / "a", folder_ / "b");
  const auto lost = catena_program({"replay", "--log", log_, "-o", folder_ / "t.csv"});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.err.find("circle.vdb"), std::string::npos) << lost.err;
  EXPECT_FALSE(test::exists(folder_ / "t.csv"));
  // The scene is next to its files; a replay needs no output.
  const auto found = catena_program({"replay", folder_ / "b/s.json", "--log", log_});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_NE(found.out.find("all bit-identical"), std::string::npos);
  // Tables need neither the scene nor its files.
  std::filesystem::remove_all(folder_ / "b");
  EXPECT_EQ(catena_program({"export", log_, "-o", folder_ / "e.csv"}).exit_code, 0);
  EXPECT_EQ(test::Table::read(folder_ / "e.csv").rows(), 1200u);
}

TEST_F(Recording, WithoutAWorkspaceTheScaleIsReported) {
  const std::string sentence = "the scene states no workspace: 1 world unit is ";
  const auto own = catena_program({"replay", "--log", log_});
  EXPECT_NE(own.out.find(sentence + "0.07 m of the device, as recorded\n"), std::string::npos) << own.out;
  test::write_file(folder_ / "p.csv", "t,x,y,z\n0,0,0,0\n");
  const auto path = catena_program({"replay", folder_ / "a/s.json", "--probe", folder_ / "p.csv", "-o", folder_ / "t.csv"});
  EXPECT_NE(path.out.find(sentence + "1 m of the device\n"), std::string::npos) << path.out;
  std::string text = kScenes[1].scene;
  text.insert(1, R"("workspace": {"metres_per_unit": 0.07}, )");
  test::write_file(folder_ / "a/stated.json", text);
  const auto stated = catena_program({"replay", folder_ / "a/stated.json", "--probe", folder_ / "p.csv", "-o", folder_ / "t.csv"});
  EXPECT_EQ(stated.exit_code, 0) << stated.err;
  EXPECT_EQ(stated.out.find(sentence), std::string::npos) << stated.out;
}

TEST_F(Recording, AnotherSceneIsReportedWithTheFirstDifferentTick) {
  std::string text = kScenes[1].scene;
  text.replace(text.find("0.02, 0.03]"), 4, "0.03");
  test::write_file(folder_ / "a/other.json", text);
  const auto run = catena_program({"replay", folder_ / "a/other.json", "--log", log_, "-o", folder_ / "t.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("first differs at tick "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("recorded"), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(test::Table::read(folder_ / "t.csv").rows(), 1200u) << "what the replay gave, to compare";
  test::write_file(folder_ / "a/none.json", R"({"chain": []})");
  const auto none = catena_program({"replay", folder_ / "a/none.json", "--log", log_});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("links or widgets of the scene differ"), std::string::npos) << none.err;
}

TEST_F(Recording, ATruncatedLogIsReplayedAndDescribed) {
  const std::string bytes = test::read_file(log_);
  test::write_file(log_, bytes.substr(0, bytes.size() - 100));
  const auto run = catena_program({"replay", "--log", log_, "-o", folder_ / "t.csv"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("all bit-identical; truncated after tick "), std::string::npos) << run.out;
  const auto info = catena_program({"info", log_});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  for (const char* part :
       {"a/s.json", "simulated at 1000 Hz", "truncated after tick", "from tick 1: curve, surface", "from tick 700: surface, pin", "ticks "})
    EXPECT_NE(info.out.find(part), std::string::npos) << part << " in\n" << info.out;
}

TEST_F(Recording, AGapIsReportedAndTheReplayFails) {
  std::string bytes = test::read_file(log_);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  test::write_file(log_, bytes);
  const auto run = catena_program({"replay", "--log", log_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.out.find("all bit-identical"), std::string::npos) << run.out;
  EXPECT_NE(run.err.find("are lost: the log is damaged at this point; the rest cannot be replayed"), std::string::npos) << run.err;
  const auto table = catena_program({"export", log_, "-o", folder_ / "e.csv"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.err.find("are lost"), std::string::npos);
  EXPECT_NE(catena_program({"info", log_}).out.find("gap "), std::string::npos);
}

TEST_F(Recording, BadArgumentsAreOneLineAndNoFile) {
  test::write_file(folder_ / "no.catlog", "this is no recording");
  test::write_file(folder_ / "p.csv", "t,x,y,z\n0,0,0,0\n");
  const std::string o = folder_ / "o.csv";
  const std::pair<std::vector<std::string>, std::string> bad[] = {
      {{"replay", "--log", folder_ / "no.catlog", "-o", o}, "not a recording"},
      {{"replay", "--log", folder_ / "none.catlog", "-o", o}, "none.catlog"},
      {{"replay", "--log", log_, "--probe", folder_ / "p.csv", "-o", o}, "--probe and --log"},
      {{"replay", "--log", log_, "-o", log_}, "input"},
      {{"replay", "--log", log_, "-o", folder_ / "a/s.json"}, "input"},
      {{"replay", "--log", log_, "-o", o, "--details", o}, "one file"},
      {{"export", folder_ / "no.catlog", "-o", o}, "not a recording"},
      {{"export", log_, "-o", log_}, "input"},
      {{"export", log_, "-o", o, "--details", folder_ / "./o.csv"}, "one file"},
      {{"info", folder_ / "no.catlog"}, "not a recording"},
      {{"replay", "-o", o}, "SCENE is required"},
      {{"replay", folder_ / "a/s.json", "-o", o}, "--probe or --log"},
      {{"replay", folder_ / "a/s.json", "--probe", folder_ / "p.csv"}, "--output is required"}};
  for (const auto& [arguments, expected] : bad) {
    const auto run = catena_program(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(expected), std::string::npos) << expected << " in " << run.err;
    EXPECT_FALSE(test::exists(o));
  }
  EXPECT_EQ(test::read_file(folder_ / "a/s.json"), kScenes[1].scene);
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
  const auto run = catena_program({"replay", "--log", log_});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(catena_program({"info", log_}).out.find("s=a/sphere.vdb"), std::string::npos);
}

// A log that begins during a run contains the chain's raw state, which is validated even if the hashes are right.
TEST(ForgedRecording, IsOneErrorLineAndExitCodeTwo) {
  const test::TemporaryFolder folder;
  const std::string scene_path = folder / "s.json", log_path = folder / "l.catlog";
  test::write_file(scene_path, R"({"chain": [{"name": "path", "type": "polyline", "points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0]]}]})");
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
  auto writer = log::LogWriter::open(log_path, *header, {scene_path});
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
  const auto good = catena_program({"replay", "--log", log_path});
  EXPECT_EQ(good.exit_code, 0) << good.err;

  // Sets the polyline's current segment to an index far out of range.
  std::string bytes = test::read_file(log_path);
  for (std::size_t at = log::kPreambleBytes; at < bytes.size();) {
    log::BlockHeader head;
    std::memcpy(&head, bytes.data() + at, sizeof head);
    at += sizeof head;
    if (head.type == static_cast<std::uint32_t>(log::BlockType::state))
      std::memset(bytes.data() + at + 16 + offsetof(LinkState, memory) + 64, 0x7f, 300);
    at += head.length;
  }
  test::rewrite_hashes(bytes);
  test::write_file(log_path, bytes);
  const auto forged = catena_program({"replay", "--log", log_path, "-o", folder / "t.csv"});
  EXPECT_EQ(forged.exit_code, 2) << forged.out << forged.err;
  EXPECT_NE(forged.err.find("l.catlog: before tick 61: the state of link \"path\" is damaged, forged or from another scene"),
            std::string::npos)
      << forged.err;
  EXPECT_EQ(std::count(forged.err.begin(), forged.err.end(), '\n'), 1) << forged.err;
  EXPECT_FALSE(test::exists(folder / "t.csv"));
}

}  // namespace log_test
