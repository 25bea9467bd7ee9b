// SPDX-License-Identifier: MIT
/// Bad input on the command line: exit code 2, one line on stderr, and no output file.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace bad_input_test {

using namespace catena;

struct Bad {
  const char* name;
  std::string scene;                 ///< the scene file's text
  std::vector<std::string> expects;  ///< expected parts of the message
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

constexpr const char* kProbe = "t,x,y,z\n0,0.1,0,0\n0.001,0.2,0,0\n";

void expect_one_line_and_no_file(const test::ProgramResult& run, const std::string& output, const std::vector<std::string>& expects) {
  // A full disk is an error of the machine: exit code 1.
  EXPECT_EQ(run.exit_code, run.err.find("No space left on device") != std::string::npos ? 1 : 2) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_TRUE(run.err.starts_with("catena: ")) << run.err;
  for (const std::string& part : expects) EXPECT_NE(run.err.find(part), std::string::npos) << "\"" << part << "\" in: " << run.err;
  if (!output.empty()) {
    EXPECT_FALSE(test::exists(output)) << output;
  }
}

class BadScene : public testing::TestWithParam<Bad> {};

TEST_P(BadScene, IsRefusedByReplayAndRender) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", GetParam().scene);
  test::write_file(folder / "p.csv", kProbe);
  test::write_file(folder / "broken.vdb", "this is no VDB");
  for (const bool picture : {false, true}) {
    const std::string output = folder / (picture ? "o.png" : "o.csv");
    const auto run = picture ? test::run_catena({"render", folder / "s.json", "-o", output, "--size", "16x16"})
                             : test::run_catena({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", output});
    std::vector<std::string> expects = GetParam().expects;
    expects.push_back("s.json:");
    expect_one_line_and_no_file(run, output, expects);
  }
}

std::string chain(const std::string& links) {
  return "{\"fields\": {\"v\": {\"analytic\": \"circle\"}, \"s\": {\"analytic\": \"sphere\"}},\n \"chain\": [\n" + links + "\n]}";
}
std::string surface(const std::string& keys) {
  return chain("{\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"s\", \"level\": 0.5" + keys + "}");
}
std::string curve(const std::string& keys) { return chain("{\"name\": \"a\", \"type\": \"streamline\", \"field\": \"v\"" + keys + "}"); }
std::string coupling(const std::string& keys) { return "{\"fields\": {},\n\"coupling\": {" + keys + "}}"; }
std::string nine_links() {
  std::string links;
  for (int i = 0; i < 9; ++i)
    links += std::string(i == 0 ? "" : ",\n") + "{\"name\": \"p" + std::to_string(i) + "\", \"type\": \"point\", \"position\": [0,0,0]}";
  return chain(links);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, BadScene,
    testing::Values(
        Bad{"NotJson", "{\"fields\": ", {}}, Bad{"UnknownKey", "{\"fields\": {},\n \"chian\": []}", {":2:", "chian", "chain"}},
        Bad{"DuplicateKey", "{\"fields\": {},\n \"fields\": {}}", {":2:", "fields"}},
        Bad{"DuplicateName",
            chain("{\"name\": \"a\", \"type\": \"point\", \"position\": [0,0,0]},\n{\"name\": \"a\", \"type\": \"point\", \"position\": "
                  "[1,0,0]}"),
            {":4:", "\"a\""}},
        Bad{"RefusedName", chain("{\"name\": \"probe\", \"type\": \"point\", \"position\": [0,0,0]}"), {":3:", "probe"}},
        Bad{"BadName", chain("{\"name\": \"A b\", \"type\": \"point\", \"position\": [0,0,0]}"), {":3:"}},
        Bad{"UnknownType", chain("{\"name\": \"a\", \"type\": \"blob\"}"), {":3:", "blob", "isosurface"}},
        Bad{"UnknownLinkKey", surface(", \"lvel\": 1"), {":3:", "lvel"}}, Bad{"NineLinks", nine_links(), {"8"}},
        Bad{"MissingFile",
            "{\"fields\": {\"d\": {\"file\": \"none.vdb\"}},\n \"volumes\": [{\"field\": \"d\"}], \"chain\": [{\"name\": \"a\", \"type\": "
            "\"isosurface\", \"field\": \"d\", \"level\": 1}]}",
            {"none.vdb"}},
        Bad{"BrokenFile",
            "{\"fields\": {\"d\": {\"file\": \"broken.vdb\"}},\n \"volumes\": [{\"field\": \"d\"}], \"chain\": [{\"name\": \"a\", "
            "\"type\": \"isosurface\", \"field\": \"d\", \"level\": 1}]}",
            {"broken.vdb"}},
        Bad{"UnknownAnalytic", "{\"fields\": {\n\"d\": {\"analytic\": \"spere\"}}}", {":2:", "spere", "sphere"}},
        Bad{"ZeroScale", "{\"fields\": {\n\"d\": {\"analytic\": \"sphere\", \"scale\": 0}}}", {":2:", "scale"}},
        Bad{"ZeroDirection", "{\"fields\": {\n\"d\": {\"analytic\": \"uniform\", \"direction\": [0, 0, 0]}}}", {":2:", "direction"}},
        Bad{"UnknownField", chain("{\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"q\", \"level\": 1}"), {":3:", "\"q\""}},
        Bad{"WrongKindOfField", chain("{\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"v\", \"level\": 1}"), {":3:", "scalar"}},
        Bad{"LevelNotAttained", chain("{\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"s\", \"level\": -1}"), {":3:", "level"}},
        Bad{"LevelOnlyApproached",
            "{\"fields\": {\"g\": {\"analytic\": \"gaussian\"}}, \"chain\": [\n{\"name\": \"a\", \"type\": \"isosurface\", \"field\": "
            "\"g\", \"level\": 0}]}",
            {":2:", "level"}},
        Bad{"NoLevel", chain("{\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"s\"}"), {":3:", "level"}},
        Bad{"NegativeRelease", surface(", \"release\": -0.1"), {":3:", "release"}},
        Bad{"NanRelease", surface(", \"release\": NaN"), {":3:"}}, Bad{"HugeNumber", surface(", \"release\": 1e999"), {":3:"}},
        Bad{"BadFreeWord", surface(", \"free\": \"left\""), {":3:", "free"}},
        Bad{"TwoComponentSeed", curve(", \"seed\": [1, 2]"), {":3:", "seed"}}, Bad{"NanSeed", curve(", \"seed\": [1, NaN, 2]"), {":3:"}},
        Bad{"SeedAtAZero", curve(", \"seed\": [0, 0, 0]"), {":3:", "seed"}},
        Bad{"ZeroTolerance", curve(", \"seed\": [1, 0, 0], \"follow\": \"online\", \"tolerance\": 0"), {":3:", "tolerance"}},
        Bad{"UnknownMethod", curve(", \"seed\": [1, 0, 0], \"method\": \"rk5\""), {":3:", "rk5"}},
        Bad{"NegativeStiffness", coupling("\n\"stiffness\": -1"), {":3:", "stiffness"}},
        Bad{"NanDamping", coupling("\n\"damping\": NaN"), {":3:"}},
        Bad{"NegativeDamping", coupling("\n\"damping\": -1"), {":3:", "damping"}},
        Bad{"NegativeMaxForce", coupling("\n\"max_force\": -1"), {":3:", "max_force"}},
        Bad{"NegativeLinkStiffness", surface(", \"stiffness\": -5"), {":3:", "stiffness"}},
        Bad{"HugeSeparation", "{\"stereo\": {\"mode\": \"anaglyph\",\n\"separation\": 1e308}}", {":2:", "1e+308"}},
        Bad{"ZeroWorkspace", "{\"workspace\": {\n\"metres_per_unit\": 0}}", {":2:", "metres_per_unit"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

struct BadTable {
  const char* name;
  std::string text;
  std::vector<std::string> expects;
};
void PrintTo(const BadTable& bad, std::ostream* out) { *out << bad.name; }

class BadProbe : public testing::TestWithParam<BadTable> {};

TEST_P(BadProbe, IsRefused) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", "{}");
  test::write_file(folder / "p.csv", GetParam().text);
  const auto run = test::run_catena({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "o.csv"});
  std::vector<std::string> expects = GetParam().expects;
  expects.push_back("p.csv");
  expect_one_line_and_no_file(run, folder / "o.csv", expects);
}

INSTANTIATE_TEST_SUITE_P(
    Paths, BadProbe,
    testing::Values(BadTable{"Empty", "", {}}, BadTable{"HeaderOnly", "t,x,y,z\n", {}},
                    BadTable{"BrokenRow", "t,x,y,z\n0,1,2,3\n1,2,zebra,3\n", {":3:", "zebra"}},
                    BadTable{"ShortRow", "t,x,y,z\n0,1,2\n", {":2:"}}, BadTable{"LongRow", "t,x,y,z\n0,1,2,3,4\n", {":2:"}},
                    BadTable{"MissingColumn", "t,x,y\n0,1,2\n", {"z"}}, BadTable{"ExtraColumn", "t,x,y,z,w\n0,1,2,3,4\n", {"w"}},
                    BadTable{"NotRising", "t,x,y,z\n0,0,0,0\n1,0,0,0\n1,0,0,0\n", {":4:", "ris"}},
                    BadTable{"NotFinite", "t,x,y,z\n0,0,nan,0\n", {":2:"}}, BadTable{"Infinite", "t,x,y,z\n0,0,inf,0\n", {":2:"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

class BadArguments : public testing::Test {
 protected:
  BadArguments() {
    test::write_file(folder_ / "s.json", "{\"fields\": {\"s\": {\"analytic\": \"sphere\"}, \"v\": {\"analytic\": \"circle\"}}}");
    test::write_file(folder_ / "p.csv", kProbe);
    test::write_file(folder_ / "seeds.csv", "x,y,z\n1,0,0\n");
  }
  void refused(const std::vector<std::string>& arguments, const std::string& output, const std::vector<std::string>& expects) {
    SCOPED_TRACE(arguments.empty() ? std::string("nothing") : arguments.front());
    expect_one_line_and_no_file(test::run_catena(arguments), output, expects);
  }
  test::TemporaryFolder folder_;
};

TEST_F(BadArguments, GenerateRefusesBadOptions) {
  const std::string o = folder_ / "o.vdb";
  refused({"generate", "spere", "-o", o, "--resolution", "8"}, o, {"spere", "sphere"});
  refused({"generate", "sphere", "-o", o, "--resolution", "1"}, o, {"resolution"});
  refused({"generate", "sphere", "-o", o, "--resolution", "-3"}, o, {"resolution"});
  refused({"generate", "sphere", "-o", o, "--resolution", "eight"}, o, {"resolution"});
  refused({"generate", "sphere", "-o", o}, o, {"resolution"});
  refused({"generate", "sphere", "-o", o, "--resolution", "8", "--box", "1", "1"}, o, {"box"});
  refused({"generate", "sphere", "-o", o, "--resolution", "8", "--box", "2", "-2"}, o, {"box"});
  refused({"generate", "sphere", "-o", o, "--resolution", "8", "--box", "nan", "2"}, o, {"box"});
  refused({"generate", "uniform", "-o", o, "--resolution", "8", "--direction", "0", "0", "0"}, o, {"direction"});
  refused({"generate", "sphere", "-o", folder_ / "none/o.vdb", "--resolution", "8"}, folder_ / "none/o.vdb", {"none"});
  refused({"generate", "sphere", "-o", "/dev/full", "--resolution", "8"}, {}, {"/dev/full"});
  refused({"generate", "left-ventricle", "-o", o, "--resolution", "2"}, o, {"fibre", "2 nodes"});
  refused({"generate", "circle", "-o", o, "--resolution", "4", "--scale", "1e39"}, o, {"circle"});
  refused({"generate", "circle", "-o", o, "--resolution", "4", "--box", "-1e39", "1e39"}, o, {"32-bit"});
  refused({"generate", "circle", "-o", o, "--resolution", "4", "--box", "-1e308", "1e308"}, o, {"circle"});
  refused({"generate", "circle", "-o", o, "--resolution", "4", "--direction", "1", "0", "0"}, o, {"direction"});
}

TEST_F(BadArguments, UnwritableOutputsAreRefused) {
  const std::string s = folder_ / "s.json", p = folder_ / "p.csv";
  refused({"replay", s, "--probe", p, "-o", folder_ / "none/o.csv"}, folder_ / "none/o.csv", {"none"});
  refused({"replay", s, "--probe", p, "-o", "/dev/full"}, {}, {"/dev/full", "space"});
  refused({"replay", s, "--probe", p, "-o", folder_ / "o.csv", "--stats", "/dev/full"}, folder_ / "o.csv", {"/dev/full"});
  refused({"replay", s, "--probe", p, "-o", p}, {}, {"input"});
  refused({"replay", s, "--probe", p, "-o", folder_ / "o.csv", "--stats", folder_ / "./o.csv"}, folder_ / "o.csv", {"one file"});
  refused({"replay", s, "--probe", p, "-o", s}, {}, {"input"});
  refused({"replay", s, "--probe", p, "-o", folder_.path()}, {}, {"folder"});
  refused({"render", s, "-o", "/dev/full", "--size", "8x8"}, {}, {"/dev/full"});
  refused({"render", s, "-o", folder_ / "none/o.png", "--size", "8x8"}, folder_ / "none/o.png", {"none"});
  refused({"trace", s, "--field", "v", "--seeds", folder_ / "seeds.csv", "-o", folder_ / "seeds.csv"}, {}, {"input"});
  refused({"trace", s, "--field", "v", "--seeds", folder_ / "seeds.csv", "-o", "/dev/full"}, {}, {"/dev/full"});
  EXPECT_EQ(test::read_file(p), kProbe) << "an input was harmed";
}

TEST_F(BadArguments, TraceRenderAndInfoRefuseBadArguments) {
  const std::string s = folder_ / "s.json", seeds = folder_ / "seeds.csv", o = folder_ / "o.csv";
  refused({"trace", s, "--field", "q", "--seeds", seeds, "-o", o}, o, {"\"q\"", "s, v"});
  refused({"trace", s, "--field", "s", "--seeds", seeds, "-o", o}, o, {"vector"});
  test::write_file(folder_ / "bad.csv", "x,y,z\n1,0\n");
  refused({"trace", s, "--field", "v", "--seeds", folder_ / "bad.csv", "-o", o}, o, {"bad.csv:2"});
  refused({"trace", s, "--field", "v", "--seeds", folder_ / "none.csv", "-o", o}, o, {"none.csv"});
  refused({"trace", s, "--field", "v", "--seeds", seeds, "-o", folder_ / "o.xyz"}, folder_ / "o.xyz", {".csv or .vtp"});
  test::write_file(folder_ / "zero.csv", "x,y,z\n1,0,0\n0,0,1\n");
  refused({"trace", s, "--field", "v", "--seeds", folder_ / "zero.csv", "-o", o}, o, {"zero.csv:3:"});
  refused({"trace", s, "--field", "v", "--seeds", seeds, "-o", o, "--length", "nan"}, o, {"length"});
  refused({"trace", s, "--field", "v", "--seeds", seeds, "-o", o, "--length", "-1"}, o, {"length"});
  refused({"render", s, "-o", folder_ / "o.png", "--size", "0x5"}, folder_ / "o.png", {"size"});
  refused({"render", s, "-o", folder_ / "o.png", "--size", "axb"}, folder_ / "o.png", {"size"});
  refused({"render", s, "-o", folder_ / "o.png", "--quality", "best"}, folder_ / "o.png", {"quality"});
  refused({"render", folder_ / "none.json", "-o", folder_ / "o.png"}, folder_ / "o.png", {"none.json"});
  refused({"render", folder_ / "none.vdb", "-o", folder_ / "o.png"}, folder_ / "o.png", {"none.vdb"});
  refused({"info", folder_ / "none.vdb"}, {}, {"none.vdb"});
  refused({"info", folder_.path()}, {}, {});
  refused({"fly"}, {}, {});
  refused({}, {}, {});
}

// An empty number must not abort the program or be read as 0.
TEST_F(BadArguments, AnEmptyNumberIsRefusedByEveryOption) {
  const std::string s = folder_ / "s.json", seeds = folder_ / "seeds.csv", o = folder_ / "o.csv", png = folder_ / "o.png";
  const std::string empty = "the value is empty; a number was expected";
  for (const char* option : {"--bits", "--antialias", "--tile", "--frames", "--fps", "--orbit", "--zoom", "--animation-phase",
                             "--gpu-memory", "--eye-separation", "--memory"})
    refused({"render", s, "-o", png, "--size", "16x16", option, ""}, png, {option, empty});
  for (const char* option : {"--length", "--tolerance", "--step", "--min-speed", "--repeat"})
    refused({"trace", s, "--field", "v", "--seeds", seeds, "-o", o, option, ""}, o, {option, empty});
  refused({"view", s, "--frames", ""}, {}, {"--frames", empty});
  refused({"view", s, "--frames", "-1"}, {}, {"--frames", "a finite number from 0 to 2147483647 was expected"});
  refused({"trace", s, "--field", "v", "--seeds", seeds, "-o", o, "--length", "0"}, o,
          {"--length", "a finite number above 0 was expected"});
  refused({"feel", s, "--seconds", ""}, {}, {"--seconds", empty});
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

}  // namespace bad_input_test
