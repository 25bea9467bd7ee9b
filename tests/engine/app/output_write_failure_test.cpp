// SPDX-License-Identifier: MIT
// Write errors on standard output and standard error: lost output is an error, and nothing else changes.
#include <sys/wait.h>

#include <cstdlib>

#include "tests/engine/app/program_in_folder.h"

namespace catena::output_write_failure_test {

class LostOutput : public test::ProgramInFolder {
 protected:
  LostOutput() { succeed("generate sphere -o {g.vdb} --resolution 8"); }
  /// Runs "catena WORDS" with a shell's `redirection`, and returns the exit code.
  int redirected(const std::string& words, const std::string& redirection) {
    const std::string command = "cd " + folder_.path() + " && " + test::program_path() + " " + words + " 2> err " + redirection;
    const int status = std::system(("bash -c '" + command + "'").c_str());
    err_ = read("err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::string err_;
};

TEST_F(LostOutput, IsAnError) {
  for (const char* words : {"info g.vdb", "devices --json", "--help", "info --colormaps", "--version"}) {
    EXPECT_EQ(redirected(words, "> /dev/full"), 1) << words;
    EXPECT_TRUE(err_.starts_with("catena: standard output cannot be written")) << words << ": " << err_;
    test::expect_one_line(err_);
  }
  EXPECT_EQ(redirected("info g.vdb", ">&-"), 1);
  EXPECT_TRUE(err_.starts_with("catena: standard output cannot be written")) << err_;
  EXPECT_EQ(redirected("info g.vdb", "> out"), 0) << err_;
  EXPECT_EQ(err_, "");
  EXPECT_EQ(redirected("info none.vdb", "> /dev/full"), 2);
  test::expect_one_line(err_);
}

TEST_F(LostOutput, AClosedPipeEndsTheProgramWithoutAMessage) {
  for (const bool ignored : {false, true}) {
    const std::string late =
        std::string(ignored ? "trap \"\" PIPE; " : "") + "sleep 0.3; exec " + test::program_path() + " info g.vdb 2> err";
    const int status = std::system(("cd " + folder_.path() + " && bash -c '(" + late + ") | true; exit ${PIPESTATUS[0]}'").c_str());
    // If SIGPIPE is ignored, the write itself fails.
    EXPECT_EQ(WEXITSTATUS(status), ignored ? 1 : 128 + 13);
    EXPECT_EQ(read("err"), "");
  }
}

// An error that cannot be printed must keep its exit code.
TEST_F(LostOutput, AnErrorThatCannotBePrintedKeepsItsExitCode) {
  for (const char* redirection : {"2> /dev/full", "2>&-"}) {
    EXPECT_EQ(redirected("info none.vdb", redirection), 2) << redirection;
    EXPECT_EQ(redirected("info --nonsense", redirection), 2) << redirection;
    EXPECT_EQ(redirected("info g.vdb > out", redirection), 0) << redirection;
  }
  // A closed standard error must not become the descriptor of an opened file.
  EXPECT_EQ(redirected("import g.vdb -o h.vdb --grid absent", "2>&-"), 2);
  EXPECT_EQ(redirected("generate sphere -o i.vdb --resolution 8", ">&- 2>&- <&-"), 1) << "its line on standard output is lost";
  EXPECT_EQ(redirected("info i.vdb", "> out"), 0) << err_;
}

}  // namespace catena::output_write_failure_test
