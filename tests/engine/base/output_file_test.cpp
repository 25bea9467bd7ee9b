// SPDX-License-Identifier: MIT
#include "engine/base/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <filesystem>

#include "engine/base/folder_lock.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::output_file_test {

namespace fs = std::filesystem;

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// The process id of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

Outcome write_to(const std::string& path, const std::string& text) {
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(text);
  return file.commit();
}

TEST(OutputFile, IsWrittenAtomically) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  {
    auto file = test::value_of(OutputFile::open(path));
    file.write("half");
    EXPECT_FALSE(test::exists(path));
  }
  EXPECT_EQ(files_in(folder.path()), 0u);
  ASSERT_TRUE(write_to(path, "whole"));
  EXPECT_EQ(test::read_file(path), "whole");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(OutputFile, FollowsNoLinkAtATemporaryName) {
  // Links under names that earlier temporary files had must not be followed.
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt", victim = folder / "victim";
  test::write_file(victim, "precious");
  fs::create_symlink(victim, path + ".part" + std::to_string(::getpid()));
  ASSERT_TRUE(write_to(path, "new"));
  EXPECT_EQ(test::read_file(victim), "precious");
  EXPECT_EQ(test::read_file(path), "new");
}

TEST(OutputFile, TwoWritersOfAPathHaveSeparateTemporaries) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  auto first = OutputFile::open(path), second = OutputFile::open(path);
  ASSERT_TRUE(first && second);
  first->write("first");
  second->write("the second");
  ASSERT_TRUE(first->commit());
  EXPECT_EQ(test::read_file(path), "first");
  ASSERT_TRUE(second->commit());
  EXPECT_EQ(test::read_file(path), "the second");
}

TEST(OutputFile, OnlyTemporariesOfEndedProcessesAreRemoved) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt", dead = std::to_string(ended_process());
  // A number alone is no temporary name of this program: `split` makes such names.
  const std::string number = path + ".part" + dead, ours = path + ".part" + dead + "-0123456789ab", longer = ours + "c",
                    capitals = path + ".part" + dead + "-0123456789AB", folder_of_numbers = number + "0";
  const std::string locked = path + ".part" + dead + "-ba9876543210",  // another machine writes it
      others = (folder / "b.txt") + ".part" + dead, words = path + ".partition", alive = path + ".part" + std::to_string(::getppid());
  for (const std::string& name : {number, ours, longer, capitals, locked, others, words, alive}) test::write_file(name, "x");
  fs::create_directory(folder_of_numbers);
  test::write_file(folder_of_numbers + "/inside", "x");
  const int lock = ::open(locked.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  ASSERT_TRUE(write_to(path, "new"));
  EXPECT_FALSE(test::exists(ours));
  for (const std::string& name : {number, longer, capitals, folder_of_numbers + "/inside", locked, others, words, alive})
    EXPECT_TRUE(test::exists(name)) << name;
  ::close(lock);
}

TEST(OutputFile, TemporaryFoldersAreRemovedUnlessLockedOrRecent) {
  const test::TemporaryFolder folder;
  const auto make = [&](pid_t pid, int number, std::time_t age_s) {
    const std::string path = (folder / "tables.part") + std::to_string(pid) + "-00000000000" + std::to_string(number);
    fs::create_directory(path);
    test::write_file(path + "/plot0.svg", "<svg");
    const timespec then{std::time(nullptr) - age_s, 0}, both[2] = {then, then};
    EXPECT_EQ(::utimensat(AT_FDCWD, path.c_str(), both, 0), 0);
    return path;
  };
  const std::string dead = make(ended_process(), 1, 0), mine = make(::getpid(), 2, 3600), alive = make(::getppid(), 3, 3600),
                    held = make(::getppid(), 4, 3600), young = make(::getppid(), 5, 0);
  const auto lock = test::value_of(FolderLock::acquire(held));
  remove_stale_temporaries(folder / "tables");
  for (const std::string& path : {dead, mine, alive}) EXPECT_FALSE(test::exists(path)) << path;
  for (const std::string& path : {held, young}) EXPECT_TRUE(test::exists(path + "/plot0.svg")) << path;
}

TEST(OutputFile, AKilledProcessKeepsTheOldFileAndItsTemporariesAreRemovedLater) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  test::write_file(path, "old");
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = OutputFile::open(path);
    if (file) file->write(std::string(100000, 'x'));
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(files_in(folder.path()), 2u);
  // The last folder that this process has cleaned is another one.
  const test::TemporaryFolder other;
  ASSERT_TRUE(write_to(other / "x", "x"));
  ASSERT_TRUE(write_to(path, "new"));
  EXPECT_EQ(test::read_file(path), "new");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(OutputFile, AFailedRenameKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a";
  auto file = test::value_of(OutputFile::open(path));
  file.write("new");
  fs::create_directories(path + "/inside");
  const Outcome done = file.commit();
  EXPECT_TRUE(test::fails(done, path + ": cannot write: "));
  EXPECT_TRUE(fs::is_directory(path + "/inside"));
}

TEST(OutputFile, AFolderThatDisappearsIsOneErrorLine) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "inner/a.txt";
  fs::create_directory(folder / "inner");
  auto file = test::value_of(OutputFile::open(path));
  file.write("new");
  fs::remove_all(folder / "inner");
  for (const std::string& message : {test::message_of(file.commit()), test::message_of(OutputFile::open(path))})
    EXPECT_EQ(message, path + ": cannot write: No such file or directory");
}

TEST(OutputFile, AFullDiskKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  test::write_file(path, "old");
  EXPECT_EQ(write_to("/dev/full", "x").error().message, "/dev/full: cannot write: No space left on device");
  // A file size limit ends a write as a full disk does.
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const Outcome done = write_to(path, std::string(100000, 'x'));
    ::_exit(!done && done.error().system_failure &&
                    done.error().message == path + ": cannot write: File too large (files may have at most 1000 bytes: ulimit -f)"
                ? 0
                : 1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(OutputFile, AReplacedFileKeepsItsPermissions) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.txt", "old");
  fs::permissions(folder / "a.txt", fs::perms{0640});
  ASSERT_TRUE(write_to(folder / "a.txt", "new"));
  EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms{0640});
}

TEST(OutputFile, ASymbolicLinkStaysALink) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "real.txt", "old");
  fs::create_symlink("real.txt", folder / "link.txt");
  ASSERT_TRUE(write_to(folder / "link.txt", "new"));
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(test::read_file(folder / "real.txt"), "new");
}

TEST(OutputFile, ANameOfMaximumLengthCanBeWritten) {
  const test::TemporaryFolder folder;
  const std::string path = folder / (std::string(251, 'n') + ".txt");
  ASSERT_TRUE(write_to(path, "new"));
  EXPECT_EQ(test::read_file(path), "new");
}

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
  const auto why = [&](const std::vector<PlannedOutput>& outputs) { return test::message_of(check_outputs(outputs, {at("in.csv")})); };
  EXPECT_EQ(why({{"-o", at("a")}, {"--stats", ""}, {"--record", at("b")}}), "");
  EXPECT_EQ(why({{"-o", at("soft.csv")}}), at("soft.csv") + ": is also an input: expected another name for the output");
  EXPECT_EQ(why({{"-o", at("sub/../a")}, {"--stats", at("a")}}), at("a") + ": -o and --stats name one file: expected two");
  EXPECT_EQ(why({{"-o", at("a")}, {"-o", at("a")}}), at("a") + ": -o and -o name one file: expected one a frame");
  EXPECT_EQ(why({{"-o", at("sub")}}), at("sub") + ": is a folder: expected a file name to write to");
  EXPECT_EQ(why({{"-o", at("none/a")}}), at("none/a") + ": the folder " + at("none") + " does not exist");
}

}  // namespace catena::output_file_test
