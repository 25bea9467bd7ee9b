// SPDX-License-Identifier: MIT
/// Windows on a virtual display, with their log and screenshots in a temporary folder.
#pragma once
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <utility>

#include "render/image/image.h"
#include "tests/support/drive_window.h"
#include "tests/support/support.h"

namespace catena::test {

class WindowTest : public testing::Test {
 protected:
  /// Runs a shell command; its output goes to the log. Returns the exit code; -1: killed by a signal.
  int run_logged(const std::string& command) const {
    const int status = std::system((command + " > " + (folder_ / "log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Runs a shell script on a virtual display of its own.
  int run_on_display(const std::string& script, const std::string& size = "640x480") const {
    write_file(folder_ / "script.sh", script);
    return run_logged("timeout 120 " + on_display(size) + "sh " + (folder_ / "script.sh"));
  }
  std::string log() const { return read_file(folder_ / "log"); }
  render::Image8 picture(const std::string& name) const {
    auto read = render::read_png(folder_ / name);
    EXPECT_TRUE(read) << name << "\n" << log();
    return read ? std::move(*read) : render::Image8();
  }
  TemporaryFolder folder_;
};

/// Skipped without the programs for real events.
class DrivenWindow : public WindowTest {
 protected:
  void SetUp() override {
    if (!can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  }
  /// drive_window; it must end with exit code 0, and no wait of the script may time out.
  void play(const std::string& options, const std::string& script, const std::string& environment = "") const {
    EXPECT_EQ(drive_window(folder_, options, script, environment), 0) << log();
    EXPECT_EQ(log().find("never"), std::string::npos) << log();
  }
};

}  // namespace catena::test
