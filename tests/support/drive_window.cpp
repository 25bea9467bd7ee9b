// SPDX-License-Identifier: MIT
#include "tests/support/drive_window.h"

#include <sys/wait.h>

#include <cstdlib>

#include "tests/support/run_program.h"

namespace catena::test {

namespace {

constexpr const char* kFunctions = R"(
until_() { for i in $(seq 600); do "$@" > /dev/null 2>&1 && return; kill -0 $V 2> /dev/null || break; sleep 0.05; done; "$@" > /dev/null 2>&1; }
titled() { until_ xdotool search --name "$1" && echo "titled $1" || echo "never titled $1"; }
written() { until_ test -s "$1" || echo "never written $1"; }
gone() { until_ test ! -e "$1" || echo "never gone $1"; }
says() { until_ grep -q -- "$1" log || echo "never says $1"; }
keys() { for k in "$@"; do xdotool key $k; sleep 0.25; done; }
view() { "$CATENA" view "$@" & V=$!; until_ xdotool search --pid $V --name ' - Catena' || echo "never a window";
  W=$(xdotool search --pid $V --name ' - Catena' | head -1); xdotool mousemove 600 300; sleep 0.3; }
)";

}  // namespace

std::string on_display(const std::string& size) { return "sh " + source_dir() + "/tests/support/on_display.sh " + size + "x24 "; }

bool can_drive_windows() {
  static const bool can = std::system("command -v Xvfb > /dev/null 2>&1 && command -v xdotool > /dev/null 2>&1") == 0;
  return can;
}

int drive_windows(const TemporaryFolder& folder, const std::string& script) {
  write_file(folder / "script.sh", "cd " + folder.path() + "\nexport HOME=" + folder.path() + " XDG_STATE_HOME=" + (folder / "state") +
                                       " LC_ALL=C.UTF-8 CATENA=" + program_path() + "\n" + kFunctions + script);
  const int status = std::system(
      ("timeout -k 5 120 " + on_display("1000x700") + "sh " + (folder / "script.sh") + " > " + (folder / "log") + " 2>&1").c_str());
  return WIFEXITED(status) && WEXITSTATUS(status) < 124 ? WEXITSTATUS(status) : -1;
}

int drive_window(const TemporaryFolder& folder, const std::string& options, const std::string& script, const std::string& environment) {
  const std::string exported = environment.empty() ? "" : "export " + environment + "\n";
  return drive_windows(folder, exported + "view " + options + "\n" + script + "\nwait $V\nexit $?\n");
}

}  // namespace catena::test
