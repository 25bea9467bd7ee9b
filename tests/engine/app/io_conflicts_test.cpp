// SPDX-License-Identifier: MIT
// Conflicts of inputs and outputs: every command with each output on each input, and with each input replaced by a pipe or a device. Each
// run fails with one line and exit code 2, writes nothing, and does not block.
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::app {
namespace io_conflicts_test {

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

/// One way to run a command. A word of the command line may name a file of the folder: "{grid.vdb}"; "{OUT}" is the tested output,
/// "{X.png}" another output.
struct Try {
  const char* name;
  std::vector<std::string> words;
  std::vector<std::string> inputs;     ///< files that no output may overwrite
  std::vector<std::string> hostile{};  ///< those of the inputs that may be replaced by a pipe or a device
  std::string ending{};                ///< required extension of the output; the output is then a link with this extension
};

void PrintTo(const Try& run, std::ostream* out) { *out << run.name; }

class OutputConflicts : public testing::Test {
 protected:
  void SetUp() override {
    if (originals_.empty()) make_originals();
    for (const auto& [name, bytes] : originals_) test::write_file(folder_ / name, bytes);
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
  std::vector<std::string> words(const Try& run, const std::string& output) const {
    std::vector<std::string> all;
    for (std::string word : run.words) {
      const auto open = word.find('{'), close = word.find('}');
      if (open != std::string::npos && close != std::string::npos) {
        const std::string inside = word.substr(open + 1, close - open - 1);
        word = word.substr(0, open) + (inside == "OUT" ? output : folder_ / inside) + word.substr(close + 1);
      }
      all.push_back(word);
    }
    return all;
  }
  static void expect_refused(const test::ProgramResult& run, const std::string& what) {
    EXPECT_EQ(run.exit_code, 2) << what << "\n" << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << what << "\n" << run.err;
    EXPECT_TRUE(run.err.starts_with("catena: ")) << what << "\n" << run.err;
  }
  void expect_all_unharmed(const std::string& what) const {
    for (const auto& [name, bytes] : originals_) EXPECT_EQ(test::read_file(folder_ / name) == bytes, true) << what << ": " << name;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(originals_.contains(name) || name.starts_with("link") || name.starts_with("hard") || name == "pipe" || name == "sub")
          << what << " left " << name;
    }
  }
  static inline std::map<std::string, std::string> originals_;
  test::TemporaryFolder folder_;
};
class IoConflicts : public OutputConflicts, public testing::WithParamInterface<Try> {};

TEST_P(IoConflicts, AnOutputOnAnInputIsRefused) {
  const Try& run = GetParam();
  fs::create_directory(folder_ / "sub");
  for (const std::string& input : run.inputs) {
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
      const auto done = test::run_catena(words(run, output));
      expect_refused(done, input + " as " + output);
      EXPECT_NE(done.err.find("is also an input"), std::string::npos) << done.err;
      expect_all_unharmed(input + " as " + output);
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
      const auto done = test::run_program("/usr/bin/env", [&] {
        std::vector<std::string> all{"timeout", "20", test::program_path()};
        for (const std::string& word : words(run, folder_ / "out")) all.push_back(word);
        return all;
      }());
      expect_refused(done, input + " is " + hostile);
      fs::remove(folder_ / input);
      test::write_file(folder_ / input, originals_.at(input));
      expect_all_unharmed(input + " is " + hostile);
    }
}

const std::vector<std::string> kScenesFiles = {"scene.json", "grid.vdb", "map.json", "shape.stl"};

std::vector<std::string> with(std::vector<std::string> more) {
  more.insert(more.end(), kScenesFiles.begin(), kScenesFiles.end());
  return more;
}

INSTANTIATE_TEST_SUITE_P(
    Commands, IoConflicts,
    testing::Values(
        Try{"RenderOutput",
            {"render", "{scene.json}", "-o", "{OUT}", "--size", "16x16"},
            kScenesFiles,
            {"scene.json", "map.json", "shape.stl"},
            ".png"},
        Try{"RenderDepth", {"render", "{scene.json}", "-o", "{x.png}", "--size", "16x16", "--depth", "{OUT}"}, kScenesFiles, {}, ".exr"},
        Try{"RenderIds", {"render", "{scene.json}", "-o", "{x.png}", "--size", "16x16", "--ids", "{OUT}"}, kScenesFiles, {}, ".png"},
        Try{"RenderCamera",
            {"render", "{scene.json}", "-o", "{x.png}", "--size", "16x16", "--camera", "{camera.csv}", "--frames", "2", "--stats", "{OUT}"},
            with({"camera.csv"}),
            {"camera.csv"}},
        Try{"RenderProbe",
            {"render", "{scene.json}", "-o", "{x.png}", "--size", "16x16", "--probe", "{probe.csv}", "--stats", "{OUT}"},
            with({"probe.csv"}),
            {"probe.csv"}},
        Try{"RenderBare", {"render", "{grid.vdb}", "-o", "{x.png}", "--size", "16x16", "--stats", "{OUT}"}, {"grid.vdb"}},
        Try{"RenderField",
            {"render", "{scene.json}", "--field", "d={flow.vdb}", "-o", "{x.png}", "--size", "16x16", "--stats", "{OUT}"},
            with({"flow.vdb"})},
        Try{"ReplayOutput",
            {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{OUT}"},
            with({"probe.csv"}),
            {"scene.json", "probe.csv", "map.json", "shape.stl"}},
        Try{"ReplayDetails",
            {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.csv}", "--details", "{OUT}"},
            with({"probe.csv"})},
        Try{"ReplayWidgets",
            {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.csv}", "--widgets", "{OUT}"},
            with({"probe.csv"})},
        Try{"ReplayStats", {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.csv}", "--stats", "{OUT}"}, with({"probe.csv"})},
        Try{"ReplayLog", {"replay", "{scene.json}", "--log", "{old.catlog}", "-o", "{OUT}"}, with({"old.catlog"}), {"old.catlog"}},
        Try{"ReplayLogStats", {"replay", "{scene.json}", "--log", "{old.catlog}", "--stats", "{OUT}"}, with({"old.catlog"})},
        Try{"FeelStats",
            {"feel", "{scene.json}", "--device", "recorded:{probe.csv}", "--seconds", "0.05", "--stats", "{OUT}"},
            with({"probe.csv"}),
            {"scene.json", "probe.csv"}},
        Try{"FeelRecord",
            {"feel", "{scene.json}", "--device", "recorded:{probe.csv}", "--seconds", "0.05", "--record", "{OUT}"},
            with({"probe.csv"})},
        Try{"FeelSimulated",
            {"feel", "{scene.json}", "--device", "simulated:{probe.csv}", "--seconds", "0.05", "--record", "{OUT}"},
            with({"probe.csv"}),
            {"probe.csv"}},
        Try{"FeelFirmware",
            {"feel", "{scene.json}", "--device", "null", "--firmware", "{image.bin}", "--seconds", "0.05", "--stats", "{OUT}"},
            with({"image.bin"})},
        Try{"ViewScreenshot", {"view", "{scene.json}", "--frames", "1", "--screenshot", "{OUT}"}, kScenesFiles, {"scene.json"}},
        Try{"ViewWindowScreenshot", {"view", "{scene.json}", "--frames", "1", "--screenshot-ui", "{OUT}"}, kScenesFiles},
        Try{"ViewServoStats",
            {"view", "{scene.json}", "--frames", "1", "--device", "recorded:{probe.csv}", "--servo-stats", "{OUT}"},
            with({"probe.csv"})},
        Try{"ViewFrameStats", {"view", "{scene.json}", "--frames", "1", "--frame-stats", "{OUT}"}, kScenesFiles},
        Try{"ViewRecord",
            {"view", "{scene.json}", "--frames", "1", "--device", "recorded:{probe.csv}", "--record", "{OUT}"},
            with({"probe.csv"})},
        Try{"TraceStats",
            {"trace", "{scene.json}", "--field", "v", "--seeds", "{seeds.csv}", "-o", "{x.csv}", "--stats", "{OUT}"},
            with({"seeds.csv"}),
            {"scene.json", "seeds.csv"}},
        Try{"TracePattern",
            {"trace", "{flow.vdb}", "--field", "circle", "--seeds", "{pattern.json}", "-o", "{x.csv}", "--stats", "{OUT}"},
            {"flow.vdb", "pattern.json"},
            {"pattern.json"}},
        Try{"TraceOutput",
            {"trace", "{scene.json}", "--field", "v", "--seeds", "{seeds.csv}", "-o", "{OUT}"},
            with({"seeds.csv"}),
            {},
            ".csv"},
        Try{"Import", {"import", "{grid.vdb}", "-o", "{OUT}"}, {"grid.vdb"}, {}, ".vdb"},
        Try{"ExportOutput", {"export", "{old.catlog}", "-o", "{OUT}"}, {"old.catlog"}, {"old.catlog"}},
        Try{"ExportDetails", {"export", "{old.catlog}", "-o", "{x.csv}", "--details", "{OUT}"}, {"old.catlog"}},
        Try{"InfoScene", {"info", "{scene.json}"}, {}, {"scene.json", "map.json", "shape.stl"}},
        Try{"InfoLog", {"info", "{old.catlog}"}, {}, {"old.catlog"}}, Try{"InfoMesh", {"info", "{shape.stl}"}, {}, {"shape.stl"}}),
    [](const auto& one) { return one.param.name; });

/// Two outputs of one run must not be one file.
TEST_F(OutputConflicts, TwoOutputsInOneFileAreRefused) {
  const std::vector<std::vector<std::string>> runs = {
      {"render", "{scene.json}", "-o", "{x.png}", "--size", "16x16", "--stats", "{OUT}"},
      {"render", "{scene.json}", "-o", "{OUT}", "--size", "16x16", "--ids", "{x.png}"},
      {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.png}", "--details", "{OUT}"},
      {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.png}", "--widgets", "{OUT}"},
      {"replay", "{scene.json}", "--probe", "{probe.csv}", "-o", "{x.png}", "--stats", "{OUT}"},
      {"replay", "{scene.json}", "--log", "{old.catlog}", "-o", "{x.png}", "--stats", "{OUT}"},
      {"feel", "{scene.json}", "--device", "null", "--seconds", "0.05", "--stats", "{x.png}", "--record", "{OUT}"},
      {"view", "{scene.json}", "--frames", "1", "--screenshot", "{x.png}", "--screenshot-ui", "{OUT}"},
      {"view", "{scene.json}", "--frames", "1", "--servo-stats", "{x.png}", "--record", "{OUT}"},
      {"view", "{scene.json}", "--frames", "1", "--frame-stats", "{x.png}", "--record", "{OUT}"},
      {"trace", "{scene.json}", "--field", "v", "--seeds", "{seeds.csv}", "-o", "{x.csv}", "--stats", "{OUT}"},
      {"export", "{old.catlog}", "-o", "{x.png}", "--details", "{OUT}"}};
  fs::create_directory(folder_ / "sub");
  for (const auto& run : runs) {
    const bool csv = std::ranges::find(run, "{x.csv}") != run.end();
    const auto done = test::run_catena(words({"", run, {}}, folder_.path() + "/sub/../x." + (csv ? "csv" : "png")));
    expect_refused(done, run.front());
    EXPECT_NE(done.err.find("name one file: expected two"), std::string::npos) << run.front() << ": " << done.err;
    expect_all_unharmed(run.front());
  }
}

}  // namespace io_conflicts_test
}  // namespace catena::app
