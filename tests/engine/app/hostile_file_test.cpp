/// Files of strangers, from the outside: what reaches the terminal, and how much memory they take.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "tests/support/program.h"
#include "tests/support/support.h"

namespace hostile_file_test {

using namespace catena;

const std::string kRaw = "{\"file\": \"a.raw\", \"shape\": [192, 192, 192], \"type\": \"float32\"}";

/// 28 MB of numbers, no two blocks alike.
void write_raw(const std::string& path) {
  std::string bytes;
  std::vector<float> layer(192 * 192);
  for (int z = 0; z < 192; ++z) {
    for (std::size_t n = 0; n < layer.size(); ++n)
      layer[n] = static_cast<float>((n * 7919 + static_cast<std::size_t>(z) * 104729) % 1000003);
    bytes.append(reinterpret_cast<const char*>(layer.data()), layer.size() * sizeof(float));
  }
  test::write_file(path, bytes);
}

/// The most memory that the program or one of its helpers had at a time, in bytes.
std::uint64_t peak_of(const std::vector<std::string>& arguments, const std::string& output) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> argv{const_cast<char*>(test::program_path().c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    if (!std::freopen(output.c_str(), "w", stdout)) ::_exit(9);
    ::execv(argv[0], argv.data());
    ::_exit(9);
  }
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  EXPECT_EQ(status, 0);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

TEST(HostileFile, EscapesInNamesReachNoTerminal) {
  const test::TemporaryFolder folder;
  const std::string name = "den\033[31msity\033]0;title\007\xc2\x9b";
  const auto generated = test::run_catena({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "8"});
  ASSERT_EQ(generated.exit_code, 0) << generated.err;
  const auto imported = test::run_catena({"import", folder / "a.vdb", "-o", folder / "b.vdb", "--name", name});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  ASSERT_NE(test::read_file(folder / "b.vdb").find(name), std::string::npos);
  const auto info = test::run_catena({"info", folder / "b.vdb"});
  const auto absent = test::run_catena({"import", folder / "b.vdb", "-o", folder / "c.vdb", "--grid", "absent"});
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_EQ(std::count(absent.err.begin(), absent.err.end(), '\n'), 1);
  for (const std::string& text : {imported.out, info.out, absent.err}) {
    EXPECT_NE(text.find("[31msity"), std::string::npos) << text;
    for (const char* bad : {"\033", "\007", "\xc2\x9b"}) EXPECT_EQ(text.find(bad), std::string::npos) << text;
  }
}

TEST(HostileFile, TheMemoryLimitIsKeptByEveryCommand) {
  const test::TemporaryFolder folder;
  write_raw(folder / "a.raw");
  const std::string drawn =
      ", \"volumes\": [{\"field\": \"a\", \"color\": [[0, 0, 0, 0], [1, 1, 1, 1]], \"opacity\": [[0, 0], [1, 0.5]]}]}";
  test::write_file(folder / "raw.json", "{\"fields\": {\"a\": " + kRaw + "}" + drawn);
  test::write_file(folder / "nodes.json", "{\"fields\": {\"a\": {\"analytic\": \"sphere\", \"resolution\": 1024}}" + drawn);
  for (const std::string& scene : {folder / "raw.json", folder / "nodes.json"}) {
    const auto run = test::run_catena({"render", scene, "-o", folder / "o.png", "--size", "16x16", "--memory", "5"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find("MB of memory, expected at most 5 MB (--memory MB allows more)"), std::string::npos) << run.err;
    EXPECT_FALSE(test::exists(folder / "o.png"));
  }
  EXPECT_EQ(test::run_catena({"info", folder / "raw.json", "--memory", "0"}).exit_code, 2);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// 4.1 times the file's size before files were read layer by layer.
TEST(HostileFile, ARawFileTakesItsSizeInMemory) {
  const test::TemporaryFolder folder;
  write_raw(folder / "a.raw");
  test::write_file(folder / "raw.json", "{\"fields\": {\"a\": " + kRaw + "}}");
  test::write_file(folder / "none.json", "{\"fields\": {}}");
  const std::uint64_t size = std::uint64_t{4} * 192 * 192 * 192, output = peak_of({"info", folder / "none.json"}, folder / "log");
  EXPECT_LT(peak_of({"info", folder / "raw.json"}, folder / "log"), size * 3 / 2 + output);
  // import: the program, and the one that writes
  constexpr std::uint64_t kOpenVdb = 40 << 20;  // what its code takes
  EXPECT_LT(peak_of({"import", folder / "a.raw", "-o", folder / "o.vdb", "--shape", "192", "192", "192"}, folder / "log"),
            size * 3 / 2 + kOpenVdb);
}
#endif

}  // namespace hostile_file_test
