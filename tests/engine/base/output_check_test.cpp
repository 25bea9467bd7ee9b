// SPDX-License-Identifier: MIT
#include "engine/base/output_file.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/support.h"

namespace catena {
namespace output_check_test {

namespace fs = std::filesystem;

class OutputCheck : public testing::Test {
 protected:
  void SetUp() override {
    test::write_file(at("in.csv"), "x");
    fs::create_directory(at("sub"));
    fs::create_directory_symlink("sub", at("other"));
    fs::create_symlink("in.csv", at("soft.csv"));
    fs::create_hard_link(at("in.csv"), at("hard.csv"));
    fs::create_symlink("new.csv", at("dangling.csv"));
    fs::create_symlink("dangling.csv", at("twice.csv"));
    fs::create_symlink("loop.csv", at("loop.csv"));
  }
  std::string at(const std::string& name) const { return folder_ / name; }
  bool same(const std::string& a, const std::string& b) const {
    EXPECT_EQ(is_same_file(at(a), at(b)), is_same_file(at(b), at(a)));
    return is_same_file(at(a), at(b));
  }
  test::TemporaryFolder folder_;
};

TEST_F(OutputCheck, DifferentNamesOfAFileAreRecognized) {
  for (const char* name : {"in.csv", "./in.csv", "sub/../in.csv", "soft.csv", "hard.csv", "other/../in.csv", "sub/.././soft.csv"})
    EXPECT_TRUE(same(name, "in.csv")) << name;
  for (const char* name : {"IN.csv", "In.csv", "in.csv.part1", "new.csv", "sub"}) EXPECT_FALSE(same(name, "in.csv")) << name;
}

TEST_F(OutputCheck, DifferentNamesOfANonexistentFileAreRecognized) {
  for (const char* name : {"new.csv", "./new.csv", "sub/../new.csv", "dangling.csv", "twice.csv"})
    EXPECT_TRUE(same(name, "new.csv")) << name;
  EXPECT_TRUE(same("sub/new.csv", "other/new.csv"));
  EXPECT_TRUE(same("loop.csv", "loop.csv"));
  EXPECT_FALSE(same("New.csv", "new.csv"));
  EXPECT_FALSE(same("sub/new.csv", "new.csv"));
  EXPECT_FALSE(same("nowhere/a", "nowhere/b"));
  EXPECT_TRUE(same("nowhere/./a", "nowhere/a"));
}

TEST_F(OutputCheck, DevicesAndPipesNeverConflict) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  EXPECT_FALSE(same("pipe", "pipe"));
  EXPECT_FALSE(is_same_file("/dev/null", "/dev/null"));
  EXPECT_TRUE(check_outputs({{"-o", "/dev/null"}, {"--stats", "/dev/null"}}, {"/dev/null"}));
}

TEST_F(OutputCheck, ConflictsAreOneErrorLine) {
  const auto why = [&](const std::vector<PlannedOutput>& outputs) {
    const Outcome done = check_outputs(outputs, {at("in.csv")});
    return done ? std::string("fine") : done.error().message;
  };
  EXPECT_EQ(why({{"-o", at("a")}, {"--stats", ""}, {"--record", at("b")}}), "fine");
  EXPECT_EQ(why({{"-o", at("soft.csv")}}), at("soft.csv") + ": is also an input: expected another name for the output");
  EXPECT_EQ(why({{"-o", at("sub/../a")}, {"--stats", at("a")}}), at("a") + ": -o and --stats name one file: expected two");
  EXPECT_EQ(why({{"-o", at("a")}, {"-o", at("a")}}), at("a") + ": -o and -o name one file: expected one a frame");
  EXPECT_EQ(why({{"-o", at("sub")}}), at("sub") + ": is a folder: expected a file name to write to");
  EXPECT_EQ(why({{"-o", at("none/a")}}), at("none/a") + ": the folder " + at("none") + " does not exist");
}

}  // namespace output_check_test
}  // namespace catena
