// SPDX-License-Identifier: MIT
/// Bad input on the command line: exit code 2, one line on stderr, and no output file.
#include "tests/engine/app/program_in_folder.h"

namespace catena::bad_input_test {

/// A scene, and the expected parts of the message. Most refusals of keys are tested at the reader (engine/scene, haptics/build).
struct Bad {
  const char* name;
  std::string text;
  std::vector<std::string> expects;
};

constexpr const char* kProbe = "t,x,y,z\n0,0.1,0,0\n0.001,0.2,0,0\n";

std::string chain(const std::string& links) {
  return R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
 "chain": [
)" + links +
         "\n]}";
}
std::string surface(const std::string& keys) {
  return chain(R"({"name": "a", "type": "isosurface", "field": "s", "level": 0.5)" + keys + "}");
}
std::string surface_of(const std::string& keys) { return chain(R"({"name": "a", "type": "isosurface", "field": )" + keys + "}"); }
std::string curve(const std::string& keys) { return chain(R"({"name": "a", "type": "streamline", "field": "v")" + keys + "}"); }
std::string file(const std::string& name) {
  return R"({"fields": {"d": {"file": ")" + name + R"("}},
 "volumes": [{"field": "d"}], "chain": [{"name": "a", "type": "isosurface", "field": "d", "level": 1}]})";
}

const Bad kScenes[] = {{"NotJson", "{\"fields\": ", {}},
                       {"UnknownLinkKey", surface(R"(, "lvel": 1)"), {":3:", "lvel"}},
                       {"MissingFile", file("none.vdb"), {"none.vdb"}},
                       {"BrokenFile", file("broken.vdb"), {"broken.vdb"}},
                       {"WrongKindOfField", surface_of(R"("v", "level": 1)"), {":3:", "scalar"}},
                       {"LevelOnlyApproached",
                        "{\"fields\": {\"g\": {\"analytic\": \"gaussian\"}}, \"chain\": [\n"
                        R"({"name": "a", "type": "isosurface", "field": "g", "level": 0}]})",
                        {":2:", "level"}},
                       {"NoLevel", surface_of(R"("s")"), {":3:", "level"}},
                       {"BadFreeWord", surface(R"(, "free": "left")"), {":3:", "free"}},
                       {"TwoComponentSeed", curve(R"(, "seed": [1, 2])"), {":3:", "seed"}},
                       {"SeedAtAZero", curve(R"(, "seed": [0, 0, 0])"), {":3:", "seed"}},
                       {"ZeroTolerance", curve(R"(, "seed": [1, 0, 0], "follow": "online", "tolerance": 0)"), {":3:", "tolerance"}},
                       {"UnknownMethod", curve(R"(, "seed": [1, 0, 0], "method": "rk5")"), {":3:", "rk5"}}};

using BadScene = test::ProgramInFolder;

TEST_F(BadScene, IsRefusedByReplayAndRender) {
  write("p.csv", kProbe);
  write("broken.vdb", "this is no VDB");
  for (const Bad& bad : kScenes) {
    SCOPED_TRACE(bad.name);
    write("s.json", bad.text);
    const test::Words parts = test::joined(bad.expects, {"s.json:"});
    expect_refused("replay {s.json} --probe {p.csv} -o {o.csv}", parts);
    expect_refused("render {s.json} -o {o.png} --size 16x16", parts);
  }
}

class BadArguments : public test::ProgramInFolder {
 protected:
  BadArguments() {
    write("s.json", R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}}})");
    write("p.csv", kProbe);
    write("seeds.csv", "x,y,z\n1,0,0\n");
  }
  void refused(const std::string& command, const std::vector<std::pair<std::string, std::vector<std::string>>>& table) {
    for (const auto& [more, parts] : table) expect_refused(command + " " + more, parts);
  }
};

TEST_F(BadArguments, GenerateRefusesBadOptions) {
  refused("generate", {{"spere -o {o.vdb} --resolution 8", {"spere", "sphere"}},
                       {"sphere -o {none/o.vdb} --resolution 8", {"none"}},
                       {"sphere -o /dev/full --resolution 8", {"/dev/full"}},
                       {"uniform -o {o.vdb} --resolution 8 --direction 0 0 0", {"direction"}},
                       {"left-ventricle -o {o.vdb} --resolution 2", {"fibre", "2 nodes"}}});
  refused("generate sphere -o {o.vdb}", {{"--resolution 1", {"resolution"}},
                                         {"--resolution -3", {"resolution"}},
                                         {"--resolution eight", {"resolution"}},
                                         {"", {"resolution"}},
                                         {"--resolution 8 --box 1 1", {"box"}},
                                         {"--resolution 8 --box 2 -2", {"box"}},
                                         {"--resolution 8 --box nan 2", {"box"}}});
  refused("generate circle -o {o.vdb} --resolution 4", {{"--scale 1e39", {"circle"}},
                                                        {"--box -1e39 1e39", {"32-bit"}},
                                                        {"--box -1e308 1e308", {"circle"}},
                                                        {"--direction 1 0 0", {"direction"}}});
}

TEST_F(BadArguments, UnwritableOutputsAreRefused) {
  refused("replay {s.json} --probe {p.csv}", {{"-o {none/o.csv}", {"none"}},
                                              {"-o /dev/full", {"/dev/full", "space"}},
                                              {"-o {o.csv} --stats /dev/full", {"/dev/full"}},
                                              {"-o {}", {"folder"}}});
  refused("render {s.json} --size 8x8", {{"-o /dev/full", {"/dev/full"}}, {"-o {none/o.png}", {"none"}}});
  expect_refused("trace {s.json} --field v --seeds {seeds.csv} -o /dev/full", {"/dev/full"});
}

TEST_F(BadArguments, TraceRenderAndInfoRefuseBadArguments) {
  write("row.csv", "t,x,y,z\n0,1,2,3\n1,2,zebra,3\n");
  expect_refused("replay {s.json} --probe {row.csv} -o {o.csv}", {"row.csv:3:", "zebra"});
  write("bad.csv", "x,y,z\n1,0\n");
  write("zero.csv", "x,y,z\n1,0,0\n0,0,1\n");
  refused("trace {s.json}", {{"--field q --seeds {seeds.csv} -o {o.csv}", {"\"q\"", "s, v"}},
                             {"--field s --seeds {seeds.csv} -o {o.csv}", {"vector"}},
                             {"--field v --seeds {bad.csv} -o {o.csv}", {"bad.csv:2"}},
                             {"--field v --seeds {none.csv} -o {o.csv}", {"none.csv"}},
                             {"--field v --seeds {seeds.csv} -o {o.xyz}", {".csv or .vtp"}},
                             {"--field v --seeds {zero.csv} -o {o.csv}", {"zero.csv:3:"}},
                             {"--field v --seeds {seeds.csv} -o {o.csv} --length nan", {"length"}},
                             {"--field v --seeds {seeds.csv} -o {o.csv} --length -1", {"length"}}});
  refused("render -o {o.png}", {{"{s.json} --size 0x5", {"size"}},
                                {"{s.json} --size axb", {"size"}},
                                {"{s.json} --quality best", {"quality"}},
                                {"{none.json}", {"none.json"}},
                                {"{none.vdb}", {"none.vdb"}}});
  refused("info", {{"{none.vdb}", {"none.vdb"}}, {"{}", {}}});
  refused("", {{"fly", {}}, {"", {}}});
}

// An empty number must not abort the program or be read as 0.
TEST_F(BadArguments, AnEmptyNumberIsRefusedByEveryOption) {
  const auto refuse_empty = [&](const std::string& command, const std::vector<std::string>& options) {
    for (const std::string& option : options) expect_refused(command, {option, "the value is empty; a number was expected"}, {option, ""});
  };
  refuse_empty("render {s.json} -o {o.png} --size 16x16", {"--bits", "--antialias", "--tile", "--frames", "--fps", "--orbit", "--zoom",
                                                           "--animation-phase", "--gpu-memory", "--eye-separation", "--memory"});
  refuse_empty("trace {s.json} --field v --seeds {seeds.csv} -o {o.csv}", {"--length", "--tolerance", "--step", "--min-speed", "--repeat"});
  refuse_empty("view {s.json}", {"--frames"});
  refuse_empty("feel {s.json}", {"--seconds"});
  expect_refused("view {s.json} --frames -1", {"--frames", "a finite number from 0 to 2147483647 was expected"});
  expect_refused("trace {s.json} --field v --seeds {seeds.csv} -o {o.csv} --length 0",
                 {"--length", "a finite number above 0 was expected"});
}

TEST(UnknownWords, UnknownCommandsAndOptionsSuggestTheNearestName) {
  const auto says = [](const std::vector<std::string>& words) {
    const test::ProgramResult run = test::run_catena(words);
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_EQ(says({"rendr", "a.json"}).find("catena: there is no command \"rendr\" (did you mean \"render\"?); one of render, replay,"), 0u);
  EXPECT_EQ(says({"bogus"}).find("catena: there is no command \"bogus\"; one of"), 0u);
  EXPECT_EQ(says({"render", "a.json", "--frmes=3"}), "catena: there is no option \"--frmes\" (did you mean \"--frames\"?)\n");
  EXPECT_NE(says({"render"}).find("is required"), std::string::npos);
}

}  // namespace catena::bad_input_test
