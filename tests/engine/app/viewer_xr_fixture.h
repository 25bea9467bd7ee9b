// SPDX-License-Identifier: MIT
/// `catena view --xr` on the scripted runtime (tests/xr_runtime) and a virtual display.
#pragma once
#include <filesystem>
#include <sstream>
#include <string>

#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"
#include "tests/support/child_test.h"

namespace catena::app::viewer_xr_fixture {

inline constexpr const char* kScene = R"({
  "fields": {"s": {"analytic": "sphere"}},
  "chain": [{"name": "ball", "type": "isosurface", "field": "s", "level": 1}],
  "isosurfaces": [{"field": "s", "level": 1, "color": [1, 0.5, 0.2]}],
  "camera": {"position": [0, -6, 3], "target": [0, 0, 0]} })";

class ViewerXr : public test::WindowTest {
 protected:
  void SetUp() override {
    if (!test::exists(test::binary_dir() + "/libcatena_xr_runtime.so")) GTEST_SKIP() << "the scripted runtime was not built";
    test::write_file(folder_ / "scene.json", kScene);
  }
  int run_view(const std::string& options, const std::string& words, const std::string& runtime) {
    std::filesystem::remove(std::filesystem::path(folder_ / "record"));  // of an earlier run
    return run_on_display("export HOME=" + folder_.path() + " XR_RUNTIME_JSON=" + runtime + " CATENA_XR_SCRIPT='" + words +
                          " record=" + (folder_ / "record") + "'\nexec " + test::program_path() + " view " + (folder_ / "scene.json") +
                          " --xr --size 320x240 " + options + "\n");
  }
  int run_view(const std::string& options, const std::string& words) {
    return run_view(options, words, test::binary_dir() + "/xr_runtime.json");
  }
  /// Runs the window; it must succeed without an illegal call of the runtime.
  void expect_legal_view(const std::string& options, const std::string& words) {
    EXPECT_EQ(run_view(options, words), 0) << words << log();
    EXPECT_EQ(runtime_count("illegal"), 0) << words << test::read_file(folder_ / "record");
  }
  /// Neither an illegal
  void expect_clean_runtime() const {
    EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
    EXPECT_EQ(runtime_count("objects"), 0);
  }
  /// A counter in the runtime's record; -1 if there is none.
  double runtime_count(const std::string& word) const {
    std::istringstream in(test::read_file(folder_ / "record"));
    std::string name;
    for (double value = 0; in >> name >> value;)
      if (name == word) return value;
    return -1;
  }
  /// The number of errors of the headset in the log, without notes about a low frame rate.
  int headset_error_count() const {
    std::istringstream in(log());
    int count = 0;
    for (std::string line; std::getline(in, line);) count += line.starts_with("catena: the headset could not");
    return count;
  }
};

}  // namespace catena::app::viewer_xr_fixture
