// SPDX-License-Identifier: MIT
#include "engine/base/output_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <filesystem>

#include "engine/base/folder_lock.h"
#include "tests/support/support.h"

namespace catena {
namespace output_file_test {

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
    auto file = OutputFile::open(path);
    ASSERT_TRUE(file);
    file->write("half");
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
  const std::string locked = path + ".part" + dead + "-ba9876543210", others = (folder / "b.txt") + ".part" + dead,
                    words = path + ".partition", alive = path + ".part" + std::to_string(::getppid());
  for (const std::string& name : {number, ours, longer, capitals, locked, others, words, alive}) test::write_file(name, "x");
  fs::create_directory(folder_of_numbers);
  test::write_file(folder_of_numbers + "/inside", "x");
  const int lock = ::open(locked.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  ASSERT_TRUE(write_to(path, "new"));
  EXPECT_FALSE(test::exists(ours));
  for (const std::string& name : {number, longer, capitals, folder_of_numbers + "/inside"}) EXPECT_TRUE(test::exists(name)) << name;
  EXPECT_TRUE(test::exists(locked)) << "another machine writes it";
  EXPECT_TRUE(test::exists(others));
  EXPECT_TRUE(test::exists(words));
  EXPECT_TRUE(test::exists(alive));
  ::close(lock);
}

TEST(OutputFile, TemporaryFoldersAreRemovedUnlessLockedOrRecent) {
  const test::TemporaryFolder folder;
  const auto make = [&](pid_t pid, const char* digits, std::time_t age_s) {
    const std::string path = (folder / "tables.part") + std::to_string(pid) + "-" + digits;
    fs::create_directory(path);
    test::write_file(path + "/plot0.svg", "<svg");
    const timespec then{std::time(nullptr) - age_s, 0}, both[2] = {then, then};
    EXPECT_EQ(::utimensat(AT_FDCWD, path.c_str(), both, 0), 0);
    return path;
  };
  const std::string dead = make(ended_process(), "000000000001", 0), mine = make(::getpid(), "000000000002", 3600),
                    alive = make(::getppid(), "000000000003", 3600), held = make(::getppid(), "000000000004", 3600),
                    young = make(::getppid(), "000000000005", 0);
  const auto lock = FolderLock::acquire(held);
  ASSERT_TRUE(lock);
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
  auto file = OutputFile::open(path);
  ASSERT_TRUE(file);
  file->write("new");
  fs::create_directories(path + "/inside");
  const Outcome done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find(path + ": cannot write: "), std::string::npos) << done.error().message;
  EXPECT_TRUE(fs::is_directory(path + "/inside"));
}

TEST(OutputFile, AFolderThatDisappearsIsOneErrorLine) {
  const test::TemporaryFolder folder;
  const std::string inner = folder / "inner", path = inner + "/a.txt";
  fs::create_directory(inner);
  auto file = OutputFile::open(path);
  ASSERT_TRUE(file);
  file->write("new");
  fs::remove_all(inner);
  const Outcome done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, path + ": cannot write: No such file or directory");
  EXPECT_EQ(OutputFile::open(path).error().message, path + ": cannot write: No such file or directory");
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
  const std::string path = folder / "a.txt";
  test::write_file(path, "old");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  ASSERT_TRUE(write_to(path, "new"));
  struct stat about {};
  ASSERT_EQ(::stat(path.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777u, 0640u);
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

}  // namespace output_file_test
}  // namespace catena
