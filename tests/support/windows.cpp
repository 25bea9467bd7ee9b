#include "tests/support/windows.h"

#include <sys/wait.h>

#include <cstdlib>

namespace catena::test {

namespace {

constexpr const char* kFunctions = R"(
until_() { for i in $(seq 600); do "$@" > /dev/null 2>&1 && return; kill -0 $V 2> /dev/null || break; sleep 0.05; done; "$@" > /dev/null 2>&1; }
titled() { until_ xdotool search --name "$1" && echo "titled $1" || echo "never titled $1"; }
written() { until_ test -s "$1" || echo "never written $1"; }
gone() { until_ test ! -e "$1" || echo "never gone $1"; }
says() { until_ grep -q -- "$1" log || echo "never says $1"; }
keys() { for k in "$@"; do xdotool key $k; sleep 0.25; done; }
view() { "$CATENA" view "$@" & V=$!; until_ xdotool search --pid $V --name '^catena  ' || echo "never a window";
  W=$(xdotool search --pid $V --name '^catena  ' | head -1); xdotool mousemove 600 300; sleep 0.3; }
)";

}  // namespace

bool can_drive_windows() {
  static const bool can = std::system("command -v Xvfb > /dev/null 2>&1 && command -v xdotool > /dev/null 2>&1") == 0;
  return can;
}

int drive_windows(const TemporaryFolder& folder, const std::string& script) {
  write_file(folder / "script.sh", "cd " + folder.path() + "\nexport HOME=" + folder.path() + " XDG_STATE_HOME=" + (folder / "state") +
                                       " CATENA=" + program_path() + "\n" + kFunctions + script);
  // the server chooses its own number: two tests at once never take the same
  write_file(folder / "display.sh", "cd " + folder.path() +
                                        "\nXvfb -displayfd 3 -screen 0 1000x700x24 -nolisten tcp 3> display 2> /dev/null &\nX=$!\n" +
                                        "for i in $(seq 200); do test -s display && break; sleep 0.05; done\n" +
                                        "export DISPLAY=:$(cat display)\nsh script.sh\nR=$?\nkill $X\nwait $X 2> /dev/null\nexit $R\n");
  const int status = std::system(("timeout -k 5 120 sh " + (folder / "display.sh") + " > " + (folder / "log") + " 2>&1").c_str());
  return WIFEXITED(status) && WEXITSTATUS(status) < 124 ? WEXITSTATUS(status) : -1;
}

int drive_window(const TemporaryFolder& folder, const std::string& options, const std::string& script, const std::string& environment) {
  const std::string exported = environment.empty() ? "" : "export " + environment + "\n";
  return drive_windows(folder, exported + "view " + options + "\n" + script + "\nwait $V\nexit $?\n");
}

}  // namespace catena::test
