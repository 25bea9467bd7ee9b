// SPDX-License-Identifier: MIT
#include "engine/base/helper_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::helper_process_test {

using test::TemporaryFolder;

/// Writes a script as a program, and returns its path.
std::string script(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder / "helper";
  test::write_file(path, "#!/bin/sh\n" + text);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

TEST(HelperProcess, InheritsOnlyTheGivenDescriptors) {
  TemporaryFolder folder;
  ::setenv("CATENA_SECRET", "told", 1);
  const FileDescriptor other(::open("/dev/null", O_RDONLY));  // inherited by any child that does not close it
  const FileDescriptor a(::open((folder / "a").c_str(), O_RDWR | O_CREAT, 0600)), b(::open((folder / "b").c_str(), O_RDWR | O_CREAT, 0600));
  const int given[] = {a.get(), b.get()};
  auto helper = test::value_of(HelperProcess::start(script(folder, "ls /proc/self/fd >&3; env >&4; echo gone; exit 5\n"), given));
  const ProcessExit end = helper.wait(30);
  EXPECT_EQ(end.cause, ProcessExit::Cause::exited);
  EXPECT_EQ(end.code, 5);
  // The descriptors of the script (0 to 4), the one that ls opens, and the shell's descriptor of its script.
  EXPECT_LE(test::read_file(folder / "a").size(), std::string("0\n1\n2\n3\n4\n10\n5\n").size());
  EXPECT_EQ(test::read_file(folder / "b").find("told"), std::string::npos);
}

TEST(HelperProcess, ReportsItsExit) {
  TemporaryFolder folder;
  auto killed = HelperProcess::start(script(folder, "kill -SEGV $$\n"), {});
  ASSERT_TRUE(killed);
  const ProcessExit end = killed->wait(30);
  EXPECT_EQ(end.cause, ProcessExit::Cause::killed);
  EXPECT_EQ(end.code, SIGSEGV);
  auto slow = test::value_of(HelperProcess::start(script(folder, "while :; do :; done\n"), {}));
  EXPECT_EQ(slow.wait(0.1).cause, ProcessExit::Cause::timed_out);
  EXPECT_TRUE(test::fails(HelperProcess::start(folder / "absent", {}), "cannot be started"));
}

// A lack of descriptors must not be reported as a missing helper.
TEST(HelperProcess, TooFewDescriptorsAreASystemFailure) {
  const FileDescriptor file(::open("/dev/null", O_RDONLY));
  const int given[] = {file.get()};
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = 32;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  const auto started = HelperProcess::start("/bin/true", given);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_FALSE(started);
  EXPECT_TRUE(started.error().system_failure);
  EXPECT_EQ(started.error().message,
            "/bin/true: this part of Catena cannot be started: at most 32 files may be open at a time (ulimit -n), expected at least 128");
}

}  // namespace catena::helper_process_test
