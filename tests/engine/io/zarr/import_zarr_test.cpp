// SPDX-License-Identifier: MIT
/// `catena import` and `catena generate` to .zarr: killed programs, what is refused, full disks.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/support/results.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

extern char** environ;

namespace catena::import_zarr_test {

using test::has;
using Words = std::vector<std::string>;

/// Starts the program, and kills it when the log of the store has `records`; returns whether it was killed.
bool run_and_kill(const Words& words, const std::string& log, std::uintmax_t records) {
  constexpr std::uintmax_t kRecordBytes = 48;
  std::vector<char*> arguments{const_cast<char*>(test::program_path().c_str())};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  EXPECT_EQ(posix_spawn(&child, test::program_path().c_str(), nullptr, nullptr, arguments.data(), environ), 0);
  int status = 0;
  std::error_code code;
  const auto has_written = [&] {
    return std::filesystem::exists(log, code) && std::filesystem::file_size(log, code) >= records * kRecordBytes;
  };
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (has_written()) kill(child, SIGKILL);
    std::this_thread::yield();
  }
  return WIFSIGNALED(status);
}

class ImportZarr : public testing::Test {
 protected:
  void SetUp() override {
    std::string numbers(std::size_t{2} * 300 * 200 * 150, '\0');
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<char>(i * i >> 7);
    test::write_file(folder_ / "in.raw", numbers);
  }
  Words import_to(const std::string& name) const {
    return {"import", folder_ / "in.raw", "--shape", "300", "200", "150", "--type", "uint16", "-o", folder_ / name};
  }
  /// Runs the command with kills until it succeeds; compares the store with that of an uninterrupted run.
  void expect_same_after_kills(const Words& words, const std::string& name) {
    Words whole = words;
    for (std::string& word : whole)
      if (word == folder_ / name) word = folder_ / "whole.zarr";
    test::expect_run(whole);
    int kills = 0;
    for (std::uintmax_t records = 0; !test::exists(folder_ / name) && records < 1000; records += 7)
      kills += run_and_kill(words, folder_ / (name + ".part/log"), records);
    EXPECT_GE(kills, 3);
    EXPECT_EQ(test::run_program("/usr/bin/diff", {"-r", folder_ / name, folder_ / "whole.zarr"}).exit_code, 0);
    EXPECT_FALSE(test::exists(folder_ / (name + ".part/store")));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportZarr, AKilledImportIsCompletedToTheSameBytes) { expect_same_after_kills(import_to("a.zarr"), "a.zarr"); }

TEST_F(ImportZarr, AKilledGenerateIsCompletedToTheSameBytes) {
  expect_same_after_kills({"generate", "marschner-lobb", "--resolution", "200", "-o", folder_ / "g.zarr"}, "g.zarr");
}

TEST_F(ImportZarr, GenerateHasTheSameValuesAsVdb) {
  test::expect_run({"generate", "tanh", "--resolution", "90", "--box", "0", "89", "-o", folder_ / "a.zarr"});
  test::expect_run({"generate", "tanh", "--resolution", "90", "--box", "0", "89", "-o", folder_ / "a.vdb"});
  test::expect_run({"import", folder_ / "a.vdb", "-o", folder_ / "b.zarr"});
  EXPECT_EQ(test::run_program("/usr/bin/diff", {"-r", folder_ / "a.zarr", folder_ / "b.zarr"}).exit_code, 0);
}

TEST_F(ImportZarr, RefusalsAreOneSentence) {
  const auto refused = [&](const Words& words, const std::string& part) {
    const auto result = test::run_catena(words);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(has(result.err, part));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  };
  test::expect_run({"generate", "hill", "--resolution", "9", "-o", folder_ / "v.vdb"});
  refused({"import", folder_ / "v.vdb", "-o", folder_ / "v.zarr"}, "contains vectors");
  refused({"generate", "hill", "--resolution", "9", "-o", folder_ / "v.zarr"}, "these are vectors");
  refused({"generate", "left-ventricle", "--resolution", "9", "-o", folder_ / "v.zarr"}, "3 fields");
  refused({"import", folder_ / "in.raw", "--shape", "300", "200", "151", "--type", "uint16", "-o", folder_ / "v.zarr"}, "18120000");
  EXPECT_FALSE(test::exists(folder_ / "v.zarr.part"));
  test::expect_run(import_to("a.zarr"));
  refused(import_to("a.zarr"), "a store is never overwritten");
  refused({"import", folder_ / "a.zarr", "-o", folder_ / "a.zarr/b.zarr"}, "lies in the folder that is imported");
  refused(import_to("nowhere/a.zarr"), "does not exist");
  std::filesystem::create_directory(folder_ / "c.zarr.part");
  test::write_file(folder_ / "c.zarr.part/mine.txt", "mine");
  refused(import_to("c.zarr"), "an unfinished store of another input");
  EXPECT_TRUE(test::exists(folder_ / "c.zarr.part/mine.txt"));
}

TEST_F(ImportZarr, AFailedWriteIsASystemFailureAndContinues) {
  const rlimit small{50'000, RLIM_INFINITY};
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::vector<std::string> command{"generate", "sphere", "--resolution", "129", "-o", folder_ / "a.zarr"};
  const auto failed = test::run_catena(command);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_TRUE(has(failed.err, "cannot write: File too large"));
  EXPECT_TRUE(has(failed.err, "the same command continues"));
  EXPECT_FALSE(test::exists(folder_ / "a.zarr"));
  test::expect_run(command);
}

}  // namespace catena::import_zarr_test
