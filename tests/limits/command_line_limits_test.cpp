// SPDX-License-Identifier: MIT
// Rows of the command line: numbers at the limits of doubles in scenes, tables and options, and a dense grid of 512^3.
#include <algorithm>
#include <sstream>

#include "tests/limits/limits_table.h"
#include "tests/limits/render_fixture.h"
#include "tests/support/run_program.h"

namespace catena::extremes {
namespace command_line_limits_test {

/// Exit code and error message of the program, without the folder's name; mentions an output "out.csv" or "out.png".
std::string ran(const test::TemporaryFolder& folder, const test::ProgramResult& run) {
  const bool wrote = test::exists(folder / "out.csv") || test::exists(folder / "out.png");
  if (run.exit_code == 0) return wrote ? "done" : "done, without an output";
  std::string message = without_folder(run.err, folder);
  if (message.ends_with('\n')) message.pop_back();
  return fmt::format("exit code {}: {}{}", run.exit_code, message, wrote ? ", and an output" : "");
}

struct Files {
  std::string scene = R"({"fields": {"v": {"analytic": "hill"}, "s": {"analytic": "sphere"}},
    "chain": [{"name": "a", "type": "isosurface", "field": "s", "level": 1}]})";
  std::string probe = "t,x,y,z\n0,0.5,0,0\n0.001,0.5,0.1,0\n";
  std::string seeds = "x,y,z\n0.5,0,0\n";
};

/// Runs the program; "S", "P" and "Z" stand for the scene, the probe's path and the seeds, "O" for out.csv and "G" for out.png.
std::string run(const Files& files, std::vector<std::string> arguments) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", files.scene);
  test::write_file(folder / "p.csv", files.probe);
  test::write_file(folder / "z.csv", files.seeds);
  for (std::string& argument : arguments)
    for (const auto& [word, name] : {std::pair{"S", "s.json"}, {"P", "p.csv"}, {"Z", "z.csv"}, {"O", "out.csv"}, {"G", "out.png"}})
      if (argument == word) argument = folder / name;
  return ran(folder, test::run_catena(arguments));
}

std::string replay(const std::string& scene, const std::string& rows = {}) {
  Files files;
  if (!scene.empty()) files.scene = scene;
  if (!rows.empty()) files.probe = "t,x,y,z\n" + rows;
  return run(files, {"replay", "S", "--probe", "P", "-o", "O"});
}
/// `option`: an option that is 1e-300.
std::string trace(const std::string& seed, const std::string& option = {}) {
  Files files;
  files.seeds = "x,y,z\n" + seed + "\n";
  std::vector<std::string> arguments{"trace", "S", "--field", "v", "--seeds", "Z", "-o", "O"};
  if (!option.empty()) arguments.insert(arguments.end(), {option, "1e-300"});
  return run(files, arguments);
}
std::string feel(const std::string& rate) {
  return run({}, {"feel", "S", "--device", "simulated", "--forces", "on", "--realtime", "off", "--rate", rate, "--seconds", "0.1"});
}
std::string sphere_of(const std::string& radius) {
  return R"({"chain": [{"name": "a", "type": "sphere", "center": [0, 0, 0],
 "radius": )" +
         radius + "}]}";
}

std::string times_at_the_ends_of_doubles() {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", Files().scene);
  test::write_file(folder / "p.csv", "t,x,y,z\n0,0,0,0\n1e-320,0.5,0,0\n1e-310,0.6,0,0\n1,0.5,0,0\n1e300,0.5,0,0\n1.7e308,0.4,0,0\n");
  const auto result = test::run_catena({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "out.csv"});
  std::size_t longest = 0;
  std::istringstream text(result.out + result.err);
  for (std::string line; std::getline(text, line);) longest = std::max(longest, line.size());
  return Findings().add(ran(folder, result)).at_most("bytes in the longest line of output", static_cast<double>(longest), 200);
}

std::string nine_translucent_surfaces() {
  std::string surfaces;
  for (int i = 0; i < 9; ++i) surfaces += std::string(i > 0 ? ", " : "") + R"({"field": "s", "level": 1, "opacity": 0.5})";
  Files files;
  files.scene = R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}}, "isosurfaces": [)" + surfaces + "]}";
  return run(files, {"render", "S", "-o", "G", "--size", "16x12"});
}

/// The error message for numbers that a 32-bit float cannot represent.
std::string notes_of_data() {
  const test::TemporaryFolder folder;
  std::vector<double> values;
  for (int i = 0; i < 512; ++i) values.push_back(i % 2 ? 1e300 : 0.1 * i);
  test::write_file(folder / "d.raw", to_bytes(values));
  test::write_file(folder / "p.csv", Files().probe);
  test::write_file(folder / "s.json", R"({"fields": {"d": {"file": "d.raw", "type": "float64", "shape": [8, 8, 8]}},
    "chain": [{"name": "a", "type": "isosurface", "field": "d", "level": 5}]})");
  const auto result = test::run_catena({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "out.csv"});
  return result.err.substr(0, result.err.find('\n')).replace(0, result.err.find("d.raw"), "");
}

std::string voxels_beyond_pictures() {
  const test::TemporaryFolder folder;
  std::string values;
  for (int i = 0; i < 512; ++i) values.push_back(static_cast<char>(i % 7));
  test::write_file(folder / "d.raw", values);
  test::write_file(folder / "s.json",
                   R"({"fields": {"d": {"file": "d.raw", "type": "uint8", "shape": [8, 8, 8], "spacing": [1e30, 1e30, 1e30]}},
    "volumes": [{"field": "d"}]})");
  return ran(folder, test::run_catena({"render", folder / "s.json", "-o", folder / "out.png", "--size", "64x48"}));
}

// ---- 512^3 without constant blocks ----

const test::TemporaryFolder& dense() {
  static const test::TemporaryFolder folder;
  if (test::exists(folder / "s.json")) return folder;
  std::string bytes(std::size_t(512) * 512 * 512, '\0');
  std::uint32_t number = 1;
  for (char& byte : bytes) byte = static_cast<char>((number = number * 1664525 + 1013904223) >> 24);
  test::write_file(folder / "d.raw", bytes);
  test::write_file(folder / "p.csv", "t,x,y,z\n0,200,200,200\n0.001,200.1,200,200\n0.002,200.2,200,200\n");
  test::write_file(folder / "s.json", R"({"fields": {"d": {"file": "d.raw", "shape": [512, 512, 512], "type": "uint8"}},
    "isosurfaces": [{"field": "d", "level": 127.5}], "camera": {"position": [900, -1200, 800], "target": [256, 256, 256]},
    "chain": [{"name": "skin", "type": "isosurface", "field": "d", "level": 127.5}]})");
  return folder;
}

std::string full_under_the_hand() {
  const auto& folder = dense();
#ifdef CATENA_SANITIZED  // the sanitizer's own memory exceeds it
  const std::string limit = "exec \"$0\" \"$@\"";
#else  // 1.25 times the grid's 32-bit floats
  const std::string limit = "ulimit -v 700000; exec \"$0\" \"$@\"";
#endif
  const auto result = test::run_program(
      "/bin/sh", {"-c", limit, test::program_path(), "replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "out.csv"});
  const std::string text = ran(folder, result);
  if (test::exists(folder / "out.csv")) std::remove((folder / "out.csv").c_str());
  return text;
}
std::string full_under_the_eye(const std::string& megabytes) {
  const auto& folder = dense();
  test::use_lavapipe();
  return ran(folder, test::run_catena({"render", folder / "s.json", "-o", folder / "out.png", "--size", "64x48", "--memory", megabytes}));
}

}  // namespace command_line_limits_test

Group command_rows() {
  using namespace command_line_limits_test;
  const std::string exit = "exit code 2: catena: ";
  return {
      "Command line",
      {
          {"TwentyKilohertz", "Haptic rate of 20 kHz",
           exit + "--rate: \"20000\" is out of range; a finite number from 100 to 10000 was expected (see catena feel --help)",
           [] { return feel("20000"); }},
          {"SlowAndFastServos", "Haptic rates of 100 Hz and 10 kHz", "100 Hz: done, without an output; 10000 Hz: done, without an output",
           [] { return Findings().add("100 Hz: " + feel("100")).add("10000 Hz: " + feel("10000")); }},
          {"TooSmall", "The number 9e-31 in a scene",
           exit + "s.json:2: 9e-31 is too small; 0 or a number of magnitude 1e-30 to 1e30 was expected",
           [] { return replay(sphere_of("9e-31")); }},
          {"TooLarge", "1.1e30", exit + "s.json:2: 1.1e+30 is too large; 0 or a number of magnitude 1e-30 to 1e30 was expected",
           [] { return replay(sphere_of("1.1e30")); }},
          {"BeyondDoubles", "1e309", exit + "s.json:2: '1e309' is not a number; a finite number was expected",
           [] { return replay(sphere_of("1e309")); }},
          {"SmallestAndLargest", "Sphere links with radii 1e-30 and 1e30, for a workspace of size 1", "done; done",
           [] { return Findings().add(replay(sphere_of("1e-30"))).add(replay(sphere_of("1e30"))); }},
          {"NanInAPath", "Probe path with NaN", exit + "p.csv:3: \"nan\" in column \"x\"; a finite number was expected",
           [] { return replay({}, "0,0.5,0,0\n0.001,nan,0,0\n"); }},
          {"InfinityInAPath", "Probe path with -inf", exit + "p.csv:3: \"-inf\" in column \"y\"; a finite number was expected",
           [] { return replay({}, "0,0.5,0,0\n0.001,0,-inf,0\n"); }},
          {"PathBeyondDoubles", "Probe path with 1e309", exit + "p.csv:2: \"1e309\" in column \"z\"; a finite number was expected",
           [] { return replay({}, "0,0.5,0,1e309\n"); }},
          {"PathAtTheEndsOfDoubles", "Probe path with 1.7e308 and 5e-324", "done",
           [] { return replay({}, "0,1.7e308,0,0\n0.001,-1e308,1e-320,0\n0.002,5e-324,0,0\n0.003,0.5,0,0\n"); }},
          {"TimesAtTheEndsOfDoubles", "Probe path with times from 1e-320 to 1.7e308 s",
           "done; bytes in the longest line of output at most 200", times_at_the_ends_of_doubles},
          {"FarSeed", "`trace` from a seed 1e300 units away", "done", [] { return trace("1e300,0,0"); }},
          {"DenormalSeed", "`trace` from a seed 1e-320 beside the axis of a vortex ring", "done", [] { return trace("1e-320,1e-310,0"); }},
          {"NanSeed", "`trace` from a seed with NaN", exit + "z.csv:2: \"nan\" in column \"x\"; a finite number was expected",
           [] { return trace("nan,0,0"); }},
          {"NoLength", "`trace` with `--length 1e-300`", exit + "z.csv:2: seed (0.5, 0, 0): the line has no length in either direction",
           [] { return trace("0.5,0,0", "--length"); }},
          {"NineTranslucentSurfaces", "Nine translucent isosurfaces",
           exit + "s.json: the scene has 9 translucent isosurfaces, expected at most 8", nine_translucent_surfaces},
          {"NotesOfData", "Note about 64-bit data with 0.1 and 1e300, in `replay`",
           "d.raw: values of type float64 were rounded to 32-bit floats", notes_of_data},
          {"VoxelsBeyondPictures", "Image of voxels of 1e30",
           exit + "s.json:1: field \"d\": extends to 7e+30 from the origin, too far to be rendered; at most 1e+30 was expected",
           voxels_beyond_pictures},
          {"NoTolerance", "`trace` with `--tolerance 1e-300`", "done", [] { return trace("0.5,0,0", "--tolerance"); }},
          {"FullUnderTheHand", "`replay` on 512^3 voxels of noise, with 700000 KB of address space", "done", full_under_the_hand},
          {"FullInBricks", "`render` of these voxels with `--memory 300`", "done", [] { return full_under_the_eye("300"); }},
          {"FullUnderTheEye", "The same with `--memory 700`", "done", [] { return full_under_the_eye("700"); }},
      }};
}

}  // namespace catena::extremes
