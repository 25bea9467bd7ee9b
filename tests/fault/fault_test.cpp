// SPDX-License-Identifier: MIT
/// Every command on a tiny file with one injected fault (tests/fault/fault_injection.cpp): no signal ends it; exit code 0, 1 or 2; for
/// codes other than 0 one line that begins "catena: ", no output and no partial files. A sample by default; all faults:
///   CATENA_FAULT_FIRST=10000 CATENA_FAULT_EVERY=100 build/release/test_fault
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/support/nifti_file.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::fault_test {

long setting(const char* variable, long otherwise) {
  const char* wanted = std::getenv(variable);
  return wanted != nullptr ? std::strtol(wanted, nullptr, 10) : otherwise;
}

struct Command {
  const char* name;
  std::vector<std::string> words;
  std::vector<std::string> outputs;
  bool draws = false;  ///< true: uses a graphics driver, which has its own threads and memory
};

class FaultInjection : public testing::Test {
 protected:
  void SetUp() override {
    test::expect_run({"generate", "sphere", "-o", path("s.vdb"), "--resolution", "8"});
    test::expect_run({"generate", "circle", "-o", path("v.vdb"), "--resolution", "8"});
    test::write_file(path("r.raw"), std::string(4 * 6 * 6 * 6, '\x3f'));
    test::NiftiFile nifti({4, 4, 4}, 16, 32);
    nifti.put(112, 1.f);
    for (int k = 0; k < 64; ++k) nifti.append(static_cast<float>(k));
    test::write_file(path("n.nii"), nifti.bytes());
    test::write_file(path("wedge.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    test::write_file(path("s.json"), R"({"fields": {"s": {"file": "s.vdb"}, "v": {"file": "v.vdb"},
      "r": {"file": "r.raw", "shape": [6, 6, 6], "type": "float32"}},
      "meshes": [{"name": "wedge", "file": "wedge.obj"}],
      "chain": [{"name": "a", "type": "streamline", "field": "v", "seed": [0.5, 0, 0.1]},
                {"name": "b", "type": "isosurface", "field": "s", "level": 0.5},
                {"name": "c", "type": "mesh", "mesh": "wedge"}],
      "isosurfaces": [{"field": "s", "level": 0.8}]})");
    test::write_file(path("p.csv"), "t,x,y,z\n0,0.1,0,0\n0.001,0.2,0,0\n0.002,0.3,0.1,0\n");
    test::write_file(path("seeds.csv"), "x,y,z\n0.5,0,0\n");
    test::expect_run({"feel", path("s.json"), "--seconds", "0.05", "--record", path("l.catlog"), "--realtime", "off"});
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) inputs_.insert(entry.path().filename());
  }
  std::string path(const std::string& name) const { return folder_ / name; }

  std::vector<Command> commands() const {
    return {
        {"info vdb", {"info", path("s.vdb")}, {}},
        {"info nii", {"info", path("n.nii")}, {}},
        {"info log", {"info", path("l.catlog")}, {}},
        {"info scene", {"info", path("s.json")}, {}},
        {"import nii", {"import", path("n.nii"), "-o", path("o.vdb")}, {"o.vdb"}},
        {"import to nii.gz", {"import", path("n.nii"), "-o", path("o.nii.gz")}, {"o.nii.gz"}},
        {"import to vti", {"import", path("n.nii"), "-o", path("o.vti")}, {"o.vti"}},
        {"export field", {"export", path("v.vdb"), "--field", "circle", "-o", path("o.nrrd")}, {"o.nrrd"}},
        {"export", {"export", path("l.catlog"), "-o", path("o.csv"), "--details", path("d.csv")}, {"o.csv", "d.csv"}},
        {"trace", {"trace", path("v.vdb"), "--field", "circle", "--seeds", path("seeds.csv"), "-o", path("o.csv")}, {"o.csv"}},
        {"replay",
         {"replay", path("s.json"), "--probe", path("p.csv"), "-o", path("o.csv"), "--stats", path("o.json")},
         {"o.csv", "o.json"}},
        {"replay log", {"replay", "--log", path("l.catlog"), "-o", path("o.csv")}, {"o.csv"}},
        {"feel", {"feel", path("s.json"), "--seconds", "0.02", "--realtime", "off", "--stats", path("o.json")}, {"o.json"}},
        {"render", {"render", path("s.json"), "-o", path("o.png"), "--size", "16x16"}, {"o.png"}, true},
    };
  }

  struct Ended {
    int code = 0;  ///< 128 + signal
    long count = 0;
    std::string err;
  };
  Ended run(const Command& command, const std::string& fault) {
    // set by env for the program only
    std::vector<std::string> words{"LD_PRELOAD=" + test::binary_dir() + "/libcatena_faults.so", "CATENA_FAULT=" + fault,
                                   "CATENA_FAULT_COUNT=" + (reports_ / "count"), test::program_path()};
    words.insert(words.end(), command.words.begin(), command.words.end());
    std::filesystem::remove(reports_ / "count");
    const auto ended = test::run_program("/usr/bin/env", words);
    const bool was_counted = test::exists(reports_ / "count");
    return {ended.exit_code, was_counted ? std::strtol(test::read_file(reports_ / "count").c_str(), nullptr, 10) : -1,
            own_lines(ended.err)};
  }
  /// The program's lines, without the NIfTI library's "** nifti_strdup: failed to alloc", which it prints at any verbosity.
  static std::string own_lines(const std::string& text) {
    std::istringstream in(text);
    std::string own;
    for (std::string line; std::getline(in, line);)
      if (!line.starts_with("** ")) own += line + "\n";
    return own;
  }

  /// Checks the requirements above, and removes the output.
  void judge(const Command& command, const std::string& fault, const Ended& ended) {
    ++(ended.code == 0 ? survived_ : refused_);
    std::string found;
    const std::set<std::string> outputs(command.outputs.begin(), command.outputs.end());
    const bool all = std::ranges::all_of(outputs, [&](const std::string& output) { return test::exists(path(output)); });
    if (ended.code < 0 || ended.code > 2) found += " ended with " + std::to_string(ended.code) + ";";
    if (ended.code != 0 && (std::count(ended.err.begin(), ended.err.end(), '\n') != 1 || !ended.err.starts_with("catena: ")))
      found += " does not say one sentence;";
    if (ended.code == 0 && !all) found += " says that all is well, and has not written everything;";
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      if (inputs_.contains(name)) continue;
      if (ended.code != 0 || !outputs.contains(name)) found += " leaves " + name + ";";
      std::filesystem::remove(entry.path());
    }
    if (found.empty()) return;
    ++broken_;
    ADD_FAILURE() << command.name << " with " << fault << ":" << found << " " << ended.err.substr(0, 300);
  }

  /// Runs every command with faults of `kind`: number `first`, then every `every`-th.
  void fail_each(const std::string& kind, long first, long every) {
    for (const Command& command : commands()) {
      const char* only = std::getenv("CATENA_FAULT_COMMAND");
      if (only != nullptr && command.name != std::string(only)) continue;
      // a Vulkan driver may end the process if it has no memory (Mesa: xmlconfig.c)
      if (only == nullptr && kind == "alloc" && command.draws) continue;
      const Ended whole = run(command, kind + ":0");
      ASSERT_EQ(whole.code, 0) << command.name << ": " << whole.err;
      judge(command, kind + ":0", whole);
      const long before = survived_ + refused_;
      for (long n = 1; n <= whole.count && broken_ < 20; n += n < first ? 1 : every) {
        const std::string fault = kind + ":" + std::to_string(n);
        judge(command, fault, run(command, fault));
      }
      std::printf("%-11s %-6s could fail %7ld times, did %6ld times\n", command.name, kind.c_str(), whole.count,
                  survived_ + refused_ - before);
      std::fflush(stdout);
    }
    std::printf("%s: %ld survived, %ld refused in one sentence, %ld broken\n", kind.c_str(), survived_, refused_, broken_);
  }

  test::TemporaryFolder folder_, reports_;
  std::set<std::string> inputs_;
  long survived_ = 0, refused_ = 0, broken_ = 0;
};

TEST_F(FaultInjection, Allocations) { fail_each("alloc", setting("CATENA_FAULT_FIRST", 2), setting("CATENA_FAULT_EVERY", 1777)); }
TEST_F(FaultInjection, FullDisk) { fail_each("space", setting("CATENA_FAULT_FIRST", 5), setting("CATENA_FAULT_EVERY", 250)); }
TEST_F(FaultInjection, Threads) { fail_each("thread", setting("CATENA_FAULT_FIRST", 10), 1); }

TEST_F(FaultInjection, InterruptedSystemCalls) {
  long interrupted = 0;
  for (const Command& command : commands()) {
    const Ended ended = run(command, "signal:400");
    EXPECT_EQ(ended.code, 0) << command.name << ": " << ended.err;
    judge(command, "signal:400", ended);
    interrupted += ended.count;
  }
  EXPECT_GT(interrupted, 0);
  std::printf("%ld signals\n", interrupted);
}

}  // namespace catena::fault_test
