// SPDX-License-Identifier: MIT
/// Untrusted files: escape sequences in terminal output, and memory use.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "tests/engine/app/program_runs.h"

namespace untrusted_file_test {

using namespace catena;
using test::has;
using test::run_ok;
using test::run_refused;

const std::string kRaw = "{\"file\": \"a.raw\", \"shape\": [192, 192, 192], \"type\": \"float32\"}";

/// Writes 28 MB of numbers without repeated blocks.
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

/// The maximum resident memory of the program or one of its helpers, in bytes.
std::uint64_t peak_of(const std::vector<std::string>& arguments, const std::string& output, int exit_code = 0) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> argv{const_cast<char*>(test::program_path().c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    if (!std::freopen(output.c_str(), "w", stdout) || ::dup2(1, 2) < 0) ::_exit(9);
    ::execv(argv[0], argv.data());
    ::_exit(9);
  }
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == exit_code) << status << ": " << test::read_file(output);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

TEST(UntrustedFile, EscapeSequencesInGridNamesAreNotPrinted) {
  const test::TemporaryFolder folder;
  const std::string name = "den\033[31msity\033]0;title\007\xc2\x9b";
  run_ok({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "8"});
  const auto imported = run_ok({"import", folder / "a.vdb", "-o", folder / "b.vdb", "--name", name});
  ASSERT_NE(test::read_file(folder / "b.vdb").find(name), std::string::npos);
  const auto info = run_ok({"info", folder / "b.vdb"});
  const auto absent = run_refused({"import", folder / "b.vdb", "-o", folder / "c.vdb", "--grid", "absent"});
  for (const std::string& text : {imported.out, info.out, absent.err}) {
    EXPECT_TRUE(has(text, "[31msity"));
    for (const char* bad : {"\033", "\007", "\xc2\x9b"}) EXPECT_EQ(text.find(bad), std::string::npos) << text;
  }
}

TEST(UntrustedFile, EscapeSequencesInFileNamesAreNotPrinted) {
  const test::TemporaryFolder folder;
  const std::string evil = folder / "a\033[31mPWN\033[0m";
  test::write_file(folder / "s.json", R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
    "isosurfaces": [{"field": "s", "level": 1}], "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}]})");
  const std::vector<std::vector<std::string>> runs = {
      {"feel", folder / "s.json", "--device", "simulated", "--seconds", "0.05", "--record", evil + ".catlog"},
      {"replay", "--log", evil + ".catlog"},
      {"export", evil + ".catlog", "-o", folder / "e.csv"},
      {"info", evil + ".catlog"},
      {"generate", "sphere", "-o", evil + ".vdb", "--resolution", "8"},
      {"info", evil + ".vdb"},
      {"render", folder / "s.json", "--size", "16x16", "-o", evil + ".png"},
      {"tradeoff", "--figure", "3", "-o", evil + ".d"}};
  for (const std::vector<std::string>& arguments : runs) {
    const auto run = run_ok(arguments);
    EXPECT_EQ((run.out + run.err).find('\033'), std::string::npos) << arguments[0] << ": " << run.out << run.err;
  }
}

// A magnitude beyond the range of floats must be an error, not a failed assertion.
TEST(UntrustedFile, AMagnitudeBeyondFloatsIsOneErrorLine) {
  const test::TemporaryFolder folder;
  run_ok({"generate", "circle", "-o", folder / "c.vdb", "--resolution", "4", "--scale", "1.6e38", "--box", "2", "2.1"});
  test::write_file(folder / "s.json", R"({"fields": {"f": {"file": "c.vdb", "grid": "circle"}},
    "slices": [{"field": "f", "axis": "x", "at": 2.05}]})");
  run_refused({"render", folder / "s.json", "-o", folder / "o.png", "--size", "24x24"},
              "s.json:2: the magnitude of \"f\" has no finite value");
}

TEST(UntrustedFile, RenderAndInfoRespectTheMemoryLimit) {
  const test::TemporaryFolder folder;
  write_raw(folder / "a.raw");
  const std::string drawn =
      ", \"volumes\": [{\"field\": \"a\", \"color\": [[0, 0, 0, 0], [1, 1, 1, 1]], \"opacity\": [[0, 0], [1, 0.5]]}]}";
  test::write_file(folder / "raw.json", "{\"fields\": {\"a\": " + kRaw + "}" + drawn);
  test::write_file(folder / "nodes.json", "{\"fields\": {\"a\": {\"analytic\": \"sphere\", \"resolution\": 1024}}" + drawn);
  run_refused({"render", folder / "nodes.json", "-o", folder / "o.png", "--size", "16x16", "--memory", "5"},
              "MB of memory, expected at most 5 MB (--memory MB allows more)");
  EXPECT_FALSE(test::exists(folder / "o.png"));
  run_ok({"render", folder / "raw.json", "-o", folder / "o.png", "--size", "16x16", "--memory", "5"});  // in bricks
  run_refused({"info", folder / "raw.json", "--memory", "0"});
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// A file is read layer by layer, so that memory use is about the size of the field.
TEST(UntrustedFile, ARawFileTakesItsSizeInMemoryOnce) {
  const test::TemporaryFolder folder;
  write_raw(folder / "a.raw");
  test::write_file(folder / "raw.json", "{\"fields\": {\"a\": " + kRaw + "}}");
  test::write_file(folder / "none.json", "{\"fields\": {}}");
  const std::uint64_t size = std::uint64_t{4} * 192 * 192 * 192, output = peak_of({"info", folder / "none.json"}, folder / "log");
  EXPECT_LT(peak_of({"info", folder / "raw.json"}, folder / "log"), size * 3 / 2 + output);
  // The import has the program and the helper that writes.
  constexpr std::uint64_t kOpenVdb = 40 << 20;  // the memory of the library itself
  EXPECT_LT(peak_of({"import", folder / "a.raw", "-o", folder / "o.vdb", "--shape", "192", "192", "192"}, folder / "log"),
            size * 3 / 2 + kOpenVdb);
}

/// Memory use is limited even where parsed data take many times the file's size.
TEST(UntrustedFile, ScenesMeshesAndTablesRespectTheMemoryLimit) {
  const test::TemporaryFolder folder;
  std::string json = "{\"x\": [", csv = "t,x,y,z\n", stl(84, ' ');
  for (int i = 0; i < 1000000; ++i) json += "[],";
  for (int i = 0; i < 300000; ++i) csv += std::to_string(i) + ",0,0,0\n";
  const std::uint32_t triangles = 300000;
  std::memcpy(stl.data() + 80, &triangles, sizeof triangles);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const auto a = static_cast<float>(i % 1000), b = static_cast<float>(i / 1000);
    const float numbers[12] = {0, 0, 1, a, b, 0, a + 0.5F, b, 0, a, b + 0.5F, 0};
    stl.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append(2, '\0');
  }
  test::write_file(folder / "big.json", json + "1]}");
  test::write_file(folder / "p.csv", csv);
  test::write_file(folder / "m.stl", stl);
  test::write_file(folder / "none.json", "{\"fields\": {}}");
  test::write_file(folder / "s.json", R"({"fields": {"v": {"analytic": "circle"}},
    "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}]})");
  const std::uint64_t nothing = peak_of({"info", folder / "none.json"}, folder / "log");
  constexpr std::uint64_t kMb = 1000000;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", folder / "big.json"},
                                                    {"info", folder / "m.stl"},
                                                    {"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "o.csv"}}) {
    EXPECT_LT(peak_of(test::joined(arguments, {"--memory", "20"}), folder / "log", 2), nothing + 30 * kMb) << arguments[1];
    const std::string output_text = test::read_file(folder / "log");
    EXPECT_TRUE(has(output_text, "MB of memory, expected at most 20 MB (--memory MB allows more)\n"));
    EXPECT_TRUE(test::is_one_line(output_text));
  }
  run_ok({"info", folder / "s.json", "--memory", "1"});
  // The estimated memory is sufficient.
  EXPECT_LT(peak_of({"info", folder / "m.stl", "--memory", "220"}, folder / "log"), nothing + 220 * kMb);
}
#endif

}  // namespace untrusted_file_test
