// SPDX-License-Identifier: MIT
// Random input to the window for a few seconds (tests/monkey/monkey.py). For longer runs by hand: CATENA_MONKEY_SECONDS=1800
// CATENA_MONKEY_SEED=3 build/release/test_engine_app --gtest_filter='ViewerRandomInput.*'
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/drive_window.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::app::viewer_random_input_test {

constexpr const char* kDensity = R"({ "fields": {"d": {"analytic": "gaussian", "resolution": 24}, "v": {"analytic": "circle"}},
  // a comment
  "chain": [{"name": "skin", "type": "isosurface", "field": "d", "level": 0.4}],
  "isosurfaces": [{"field": "d", "level": 0.4}],
  "volumes": [{"field": "d"}] })";
constexpr const char* kFlow = R"({"fields": {"v": {"analytic": "circle", "resolution": 9}, "s": {"analytic": "sphere"}},
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0]]}],
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]}],
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}]})";

std::string word_of(const char* variable, const char* otherwise) {
  const char* word = std::getenv(variable);
  return word == nullptr ? otherwise : word;
}

TEST(ViewerRandomInput, DoesNotCrashTheWindow) {
  const bool has_xlib = std::system("/usr/bin/python3 -c 'import Xlib' > /dev/null 2>&1") == 0;
  if (!test::can_drive_windows() || !has_xlib) GTEST_SKIP() << "no Xvfb or no python3-xlib here";
  const test::TemporaryFolder folder;
  test::write_file(folder / "slow.json", kDensity);
  test::write_file(folder / "Capital.json", kFlow);
  test::write_file(folder / "a.csv", "t,x,y,z\n");
  ASSERT_EQ(test::run_catena({"generate", "sphere", "-o", folder / "grid.vdb", "--resolution", "12"}).exit_code, 0);
  const std::string command = "cd " + folder.path() + " && HOME=" + folder.path() + " XDG_STATE_HOME=" + (folder / "state") + " " +
                              test::on_display("1000x700") + "/usr/bin/python3 " + test::source_dir() + "/tests/monkey/monkey.py --seed " +
                              word_of("CATENA_MONKEY_SEED", "1") + " --seconds " + word_of("CATENA_MONKEY_SECONDS", "8") + " --folder " +
                              folder.path() + " " + test::program_path() + " slow.json Capital.json grid.vdb '' > " + (folder / "out") +
                              " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << test::read_file(folder / "out") << test::read_file(folder / "monkey.log");
}

}  // namespace catena::app::viewer_random_input_test
