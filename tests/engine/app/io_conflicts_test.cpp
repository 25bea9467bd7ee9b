// SPDX-License-Identifier: MIT
// Conflicts of inputs and outputs: every command with each output on each input, and with each input replaced by a pipe or a device. Each
// run fails with one line and exit code 2, writes nothing, and does not block.
#include <sys/stat.h>
#include <unistd.h>

#include <map>

#include "tests/engine/app/program_in_folder.h"

namespace catena::app::io_conflicts_test {

namespace fs = std::filesystem;

constexpr const char* kScene = R"({
  "fields": {"d": {"file": "grid.vdb"}, "v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
  "volumes": [{"field": "d", "transfer": "map.json"}],
  "meshes": [{"name": "m", "file": "shape.stl"}],
  "workspace": {"metres_per_unit": 0.05} })";
constexpr const char* kTriangle = R"(solid s
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid s
)";

/// One way to run a command. In its line, "{OUT}" is the tested output, and "{X.png}" another output.
struct Try {
  const char* name;
  std::string line;
  std::vector<std::string> hostile{};  ///< those of the inputs that may be replaced by a pipe or a device
  std::string ending{};                ///< required extension of the output; the output is then a link with this extension
};

void PrintTo(const Try& run, std::ostream* out) { *out << run.name; }

class OutputConflicts : public test::ProgramInFolder {
 protected:
  void SetUp() override {
    if (originals_.empty()) make_originals();
    for (const auto& [name, bytes] : originals_) write(name, bytes);
  }
  /// Makes once the files that all runs read.
  static void make_originals() {
    const test::TemporaryFolder made;
    ASSERT_EQ(test::run_catena({"generate", "sphere", "-o", made / "grid.vdb", "--resolution", "8"}).exit_code, 0);
    ASSERT_EQ(test::run_catena({"generate", "circle", "-o", made / "flow.vdb", "--resolution", "8"}).exit_code, 0);
    test::write_file(made / "scene.json", kScene);
    test::write_file(made / "map.json", R"({"color": [[0, 0, 0, 0], [1, 1, 1, 1]], "opacity": [[0, 0], [1, 0.5]]})");
    test::write_file(made / "shape.stl", kTriangle);
    test::write_file(made / "probe.csv", "t,x,y,z\n0,0.1,0,0\n0.001,0.2,0,0\n0.002,0.2,0,0\n");
    test::write_file(made / "seeds.csv", "x,y,z\n1,0,0\n");
    test::write_file(made / "pattern.json", R"({"line": {"from": [0.5, 0, 0], "to": [1, 0, 0], "count": 2}})");
    test::write_file(made / "camera.csv", "t,px,py,pz,tx,ty,tz\n0,0,-6,3,0,0,0\n1,0,-7,3,0,0,0\n");
    test::write_file(made / "image.bin", "no firmware");
    const auto feel_run =
        test::run_catena({"feel", made / "scene.json", "--device", "null", "--seconds", "0.05", "--record", made / "old.catlog"});
    ASSERT_EQ(feel_run.exit_code, 0) << feel_run.err;
    for (const auto& entry : fs::directory_iterator(made.path()))
      originals_[entry.path().filename().string()] = test::read_file(entry.path().string());
  }
  std::vector<std::string> words(std::string line, const std::string& output) const {
    if (const auto at = line.find("{OUT}"); at != std::string::npos) line.replace(at, 5, output);
    return test::words_of(folder_, line);
  }
  /// The inputs that no output may overwrite: the files of the line, and those that the scene names.
  static std::vector<std::string> inputs_of(const std::string& line) {
    const auto names = [&](const std::string& name) { return line.find("{" + name + "}") != std::string::npos; };
    std::vector<std::string> inputs;
    for (const auto& [name, bytes] : originals_) {
      const bool of_scene = name == "grid.vdb" || name == "map.json" || name == "shape.stl";
      if (names("OUT") && (names(name) || (of_scene && names("scene.json")))) inputs.push_back(name);
    }
    return inputs;
  }
  void expect_refused_unharmed(const test::ProgramResult& run, const std::string& what) const {
    SCOPED_TRACE(what);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    test::expect_one_line(run.err);
    for (const auto& [name, bytes] : originals_) EXPECT_EQ(read(name) == bytes, true) << name;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(originals_.contains(name) || name.starts_with("link") || name.starts_with("hard") || name == "pipe" || name == "sub")
          << "left " << name;
    }
  }
  static inline std::map<std::string, std::string> originals_;
};
class IoConflicts : public OutputConflicts, public testing::WithParamInterface<Try> {};

TEST_P(IoConflicts, AnOutputOnAnInputIsRefused) {
  const Try& run = GetParam();
  fs::create_directory(folder_ / "sub");
  for (const std::string& input : inputs_of(run.line)) {
    const std::string link = "link" + run.ending, hard = "hard" + run.ending;
    fs::remove(folder_ / link);
    fs::remove(folder_ / hard);
    fs::create_symlink(input, folder_ / link);
    fs::create_hard_link(folder_ / input, folder_ / hard);
    // Takes the spellings in turn: the name itself, a longer path, and links of both kinds.
    static std::size_t turn = 0;
    std::vector<std::string> spellings = {folder_ / link, folder_ / hard};
    if (run.ending.empty())
      spellings = {folder_ / input, std::vector{folder_.path() + "/sub/../" + input, folder_ / link, folder_ / hard}[turn++ % 3]};
    for (const std::string& output : spellings) {
      const auto done = test::run_catena(words(run.line, output));
      expect_refused_unharmed(done, input + " as " + output);
      test::expect_parts(done.err, {"is also an input"});
    }
  }
}

TEST_P(IoConflicts, APipeOrDeviceAsInputIsRefused) {
  const Try& run = GetParam();
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const std::string& input : run.hostile)
    for (const std::string& hostile : {folder_ / "pipe", std::string("/dev/zero")}) {
      // The pipe or device has the file's name: the link's target counts.
      fs::remove(folder_ / input);
      fs::create_symlink(hostile, folder_ / input);
      std::vector<std::string> all = words(run.line, folder_ / "out");
      all.insert(all.begin(), {"timeout", "20", test::program_path()});
      const auto done = test::run_program("/usr/bin/env", all);
      fs::remove(folder_ / input);
      write(input, originals_.at(input));
      expect_refused_unharmed(done, input + " is " + hostile);
    }
}

const Try kCommands[] = {
    {"RenderOutput", "render {scene.json} -o {OUT} --size 16x16", {"scene.json", "map.json", "shape.stl"}, ".png"},
    {"RenderDepth", "render {scene.json} -o {x.png} --size 16x16 --depth {OUT}", {}, ".exr"},
    {"RenderIds", "render {scene.json} -o {x.png} --size 16x16 --ids {OUT}", {}, ".png"},
    {"RenderCamera", "render {scene.json} -o {x.png} --size 16x16 --camera {camera.csv} --frames 2 --stats {OUT}", {"camera.csv"}},
    {"RenderProbe", "render {scene.json} -o {x.png} --size 16x16 --probe {probe.csv} --stats {OUT}", {"probe.csv"}},
    {"RenderBare", "render {grid.vdb} -o {x.png} --size 16x16 --stats {OUT}"},
    {"RenderField", "render {scene.json} --field d={flow.vdb} -o {x.png} --size 16x16 --stats {OUT}"},
    {"ReplayOutput", "replay {scene.json} --probe {probe.csv} -o {OUT}", {"scene.json", "probe.csv", "map.json", "shape.stl"}},
    {"ReplayDetails", "replay {scene.json} --probe {probe.csv} -o {x.csv} --details {OUT}"},
    {"ReplayWidgets", "replay {scene.json} --probe {probe.csv} -o {x.csv} --widgets {OUT}"},
    {"ReplayStats", "replay {scene.json} --probe {probe.csv} -o {x.csv} --stats {OUT}"},
    {"ReplayLog", "replay {scene.json} --log {old.catlog} -o {OUT}", {"old.catlog"}},
    {"ReplayLogStats", "replay {scene.json} --log {old.catlog} --stats {OUT}"},
    {"FeelStats", "feel {scene.json} --device recorded:{probe.csv} --seconds 0.05 --stats {OUT}", {"scene.json", "probe.csv"}},
    {"FeelRecord", "feel {scene.json} --device recorded:{probe.csv} --seconds 0.05 --record {OUT}"},
    {"FeelSimulated", "feel {scene.json} --device simulated:{probe.csv} --seconds 0.05 --record {OUT}", {"probe.csv"}},
    {"FeelFirmware", "feel {scene.json} --device null --firmware {image.bin} --seconds 0.05 --stats {OUT}"},
    {"ViewScreenshot", "view {scene.json} --frames 1 --screenshot {OUT}", {"scene.json"}},
    {"ViewWindowScreenshot", "view {scene.json} --frames 1 --screenshot-ui {OUT}"},
    {"ViewServoStats", "view {scene.json} --frames 1 --device recorded:{probe.csv} --servo-stats {OUT}"},
    {"ViewFrameStats", "view {scene.json} --frames 1 --frame-stats {OUT}"},
    {"ViewRecord", "view {scene.json} --frames 1 --device recorded:{probe.csv} --record {OUT}"},
    {"TraceStats", "trace {scene.json} --field v --seeds {seeds.csv} -o {x.csv} --stats {OUT}", {"scene.json", "seeds.csv"}},
    {"TracePattern", "trace {flow.vdb} --field circle --seeds {pattern.json} -o {x.csv} --stats {OUT}", {"pattern.json"}},
    {"TraceOutput", "trace {scene.json} --field v --seeds {seeds.csv} -o {OUT}", {}, ".csv"},
    {"Import", "import {grid.vdb} -o {OUT}", {}, ".vdb"},
    {"ExportOutput", "export {old.catlog} -o {OUT}", {"old.catlog"}},
    {"ExportDetails", "export {old.catlog} -o {x.csv} --details {OUT}"},
    {"InfoScene", "info {scene.json}", {"scene.json", "map.json", "shape.stl"}},
    {"InfoLog", "info {old.catlog}", {"old.catlog"}},
    {"InfoMesh", "info {shape.stl}", {"shape.stl"}}};
INSTANTIATE_TEST_SUITE_P(Commands, IoConflicts, testing::ValuesIn(kCommands), [](const auto& one) { return one.param.name; });

/// Two outputs of one run must not be one file.
TEST_F(OutputConflicts, TwoOutputsInOneFileAreRefused) {
  fs::create_directory(folder_ / "sub");
  for (const std::string line :
       {"render {scene.json} -o {x.png} --size 16x16 --stats {OUT}", "render {scene.json} -o {OUT} --size 16x16 --ids {x.png}",
        "replay {scene.json} --probe {probe.csv} -o {x.png} --details {OUT}",
        "replay {scene.json} --probe {probe.csv} -o {x.png} --widgets {OUT}",
        "replay {scene.json} --probe {probe.csv} -o {x.png} --stats {OUT}",
        "replay {scene.json} --log {old.catlog} -o {x.png} --stats {OUT}",
        "feel {scene.json} --device null --seconds 0.05 --stats {x.png} --record {OUT}",
        "view {scene.json} --frames 1 --screenshot {x.png} --screenshot-ui {OUT}",
        "view {scene.json} --frames 1 --servo-stats {x.png} --record {OUT}",
        "view {scene.json} --frames 1 --frame-stats {x.png} --record {OUT}",
        "trace {scene.json} --field v --seeds {seeds.csv} -o {x.csv} --stats {OUT}", "export {old.catlog} -o {x.png} --details {OUT}"}) {
    const std::string ending = line.find("{x.csv}") != std::string::npos ? "csv" : "png";
    const auto done = test::run_catena(words(line, folder_.path() + "/sub/../x." + ending));
    expect_refused_unharmed(done, line);
    test::expect_parts(done.err, {"name one file: expected two"});
  }
}

}  // namespace catena::app::io_conflicts_test
