// SPDX-License-Identifier: MIT
/// `catena render`: images with known results, statistics, and a scene that is both rendered and felt.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "engine/base/json.h"
#include "engine/base/vec.h"
#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace render_test {

using namespace catena;
using render::Image8;

test::ProgramResult program(const std::vector<std::string>& arguments) { return test::run_catena(arguments); }

Image8 picture_of(const std::string& scene, const std::vector<std::string>& more, const std::string& keep) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene);
  std::vector<std::string> arguments{"render", folder / "s.json", "-o", folder / "o.png", "--validation", "--stats", folder / "o.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = program(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "o.json").find("\"validation_messages\": 0"), std::string::npos) << run.err;
  auto picture = render::read_png(folder / "o.png");
  EXPECT_TRUE(picture) << picture.error().message;
  if (!keep.empty()) {
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-" + keep + ".png", *picture, true));
  }
  return *picture;
}

// The length of a ray's segment in the cube lo..hi.
double chord(const Vec3& origin, const Vec3& unit, double lo, double hi) {
  double near = 0, far = 1e30;
  for (int a = 0; a < 3; ++a) {
    const double t0 = (lo - origin[a]) / unit[a], t1 = (hi - origin[a]) / unit[a];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return std::max(0.0, far - near);
}

TEST(Import, EveryFormatCanBeWrittenToAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(program({"generate", "torus", "-o", folder / "g.vdb", "--resolution", "8"}).exit_code, 0);
  for (const char* ending : {".vdb", ".vti", ".nrrd", ".nii", ".nii.gz"}) {
    const std::string pipe = folder / (std::string("p") + ending), plain = folder / (std::string("f") + ending);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto unread = program({"import", folder / "g.vdb", "-o", pipe});
    EXPECT_EQ(unread.exit_code, 2) << ending;
    EXPECT_NE(unread.err.find("nothing reads from this pipe"), std::string::npos) << unread.err;
    EXPECT_TRUE(std::filesystem::is_fifo(pipe)) << ending;
    const auto read =
        test::run_program("/bin/sh", {"-c", "cat " + pipe + " > " + folder.path() + "/got & sleep 0.2; " + test::program_path() +
                                                " import " + folder.path() + "/g.vdb -o " + pipe + " && wait"});
    EXPECT_EQ(read.exit_code, 0) << ending << read.err;
    ASSERT_EQ(program({"import", folder / "g.vdb", "-o", plain}).exit_code, 0);
    EXPECT_EQ(test::read_file(folder / "got").size(), test::read_file(plain).size()) << ending;
  }
}

TEST(Render, EveryCommandTakesTheFilesOfASeriesAsSteps) {
  const test::TemporaryFolder folder;
  std::vector<std::string> files;
  for (const char* step : {"10", "2", "1"}) {
    files.push_back(folder / ("w_" + std::string(step) + ".vdb"));
    const auto made = program({"generate", "abc", "-o", files.back(), "--resolution", "8", "--scale", step});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  const auto with_files = [&](const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> words{command};
    words.insert(words.end(), files.begin(), files.end());
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  };
  const auto info = with_files("info", {"--json"});
  EXPECT_NE(info.out.find("\"steps\":3"), std::string::npos) << info.out << info.err;
  EXPECT_NE(with_files("info", {}).out.find("3: " + folder.path() + "/w_1.vdb .. " + folder.path() + "/w_10.vdb"), std::string::npos);
  EXPECT_EQ(with_files("render", {"-o", folder / "o%d.png", "--size", "16x16", "--quality", "draft", "--steps", "0:2"}).exit_code, 0);
  EXPECT_TRUE(test::exists(folder / "o2.png"));
  for (const std::vector<std::string>& lost :
       {std::vector<std::string>{"-o", folder / "one.png"}, {"-o", folder / "f%d.png", "--frames", "2"}}) {
    std::vector<std::string> words{"--size", "16x16", "--steps", "0:2"};
    words.insert(words.end(), lost.begin(), lost.end());
    EXPECT_EQ(with_files("render", words).exit_code, 2) << lost[1];
  }
  // The values of a step.
  const auto speed_in = [](const std::string& path) {
    const std::string text = program({"info", path, "--json"}).out;
    const std::size_t at = text.find("\"range\":[");
    return at == std::string::npos ? 0.0 : std::stod(text.substr(text.find(',', at) + 1));
  };
  const auto text_of_range = [](const std::string& path) {
    const std::string text = program({"info", path, "--json"}).out;
    const std::size_t at = text.find("\"range\":[");
    return at == std::string::npos ? "none" : text.substr(at, text.find(']', at) - at);
  };
  EXPECT_EQ(with_files("import", {"-o", folder / "i%02d.vti"}).exit_code, 0);
  EXPECT_NE(with_files("info", {"--step", "2", "--json"}).out.find(text_of_range(folder / "w_10.vdb")), std::string::npos);
  EXPECT_EQ(with_files("info", {"--step", "3"}).exit_code, 2);
  EXPECT_NEAR(speed_in(folder / "i02.vti") / speed_in(folder / "i00.vti"), 10, 1e-5);
  EXPECT_EQ(with_files("import", {"-o", folder / "one.vti", "--step", "1"}).exit_code, 0);
  EXPECT_NEAR(speed_in(folder / "one.vti") / speed_in(folder / "i00.vti"), 2, 1e-5);
  EXPECT_EQ(with_files("import", {"-o", folder / "none.vti"}).exit_code, 2);
  EXPECT_EQ(with_files("import", {"-o", folder / "none.vti", "--step", "3"}).exit_code, 2);
  // An output must not be the file of another step, by any name.
  const std::string later = test::read_file(folder / "w_10.vdb");
  std::filesystem::create_symlink("w_10.vdb", folder / "link.vdb");
  for (const std::string& other :
       {"/../" + std::filesystem::path(folder.path()).filename().string() + "/w_10.vdb", std::string("/link.vdb")}) {
    EXPECT_EQ(with_files("import", {"-o", folder.path() + other, "--step", "0"}).exit_code, 2) << other;
    EXPECT_EQ(test::read_file(folder / "w_10.vdb"), later) << other;
  }
  // No step is written if the output of another step is an input.
  std::filesystem::create_symlink("w_10.vdb", folder / "s_002.vdb");
  EXPECT_EQ(with_files("import", {"-o", folder / "s_%03d.vdb"}).exit_code, 2);
  EXPECT_FALSE(test::exists(folder / "s_000.vdb"));
  EXPECT_EQ(test::read_file(folder / "w_10.vdb"), later);
  EXPECT_EQ(with_files("export", {"--field", "abc", "-o", folder / "e.vti", "--step", "2"}).exit_code, 0);
  EXPECT_NEAR(speed_in(folder / "e.vti") / speed_in(folder / "i00.vti"), 10, 1e-5);
  test::write_file(folder / "seeds.csv", "x,y,z\n0.1,0.2,0.3\n");
  const std::vector<std::string> trace{"--field", "abc", "--seeds", folder / "seeds.csv", "-o", folder / "l.csv"};
  EXPECT_EQ(with_files("trace", trace).exit_code, 0);
  EXPECT_FALSE(test::exists(folder / "none.vti"));
  // Files that are not a series, and files without data.
  files.push_back(folder / "i00.vti");
  const auto mixed = with_files("info", {});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_NE(mixed.err.find("are not a series"), std::string::npos) << mixed.err;
  EXPECT_EQ(program({"render", folder / "a.json", folder / "b.json", "-o", folder / "o.png"}).exit_code, 2);
}

TEST(Render, StepsBeyondTheLastAreRefused) {
  const test::TemporaryFolder folder;
  for (const char* name : {"f_0.001", "f_0.01", "f_0.0015"}) {
    const auto made = program({"generate", "sphere", "-o", folder / (std::string(name) + ".vdb"), "--resolution", "6"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  test::write_file(folder / "s.json", R"({"fields": {"d": {"file": "f_*.vdb"}}, "isosurfaces": [{"field": "d", "level": 1}]})");
  const auto drawn = [&](const std::vector<std::string>& steps) {
    std::vector<std::string> words{"render", folder / "s.json", "-o", folder / "o%03d.png", "--size", "16x16", "--quality", "draft"};
    words.insert(words.end(), steps.begin(), steps.end());
    return program(words);
  };
  EXPECT_EQ(drawn({"--steps", "0:2"}).exit_code, 0);
  EXPECT_EQ(drawn({"--step", "2", "--frames", "1"}).exit_code, 0);
  for (const std::vector<std::string>& steps : {std::vector<std::string>{"--steps", "0:3"}, {"--steps", "0:99"}, {"--step", "3"}}) {
    const auto run = drawn(steps);
    EXPECT_EQ(run.exit_code, 2) << steps[1];
    EXPECT_NE(run.err.find("the last step of"), std::string::npos) << run.err;
  }
}

TEST(Render, AHomogeneousBoxIsExactAtEveryStepSize) {
  constexpr double sigma = 0.7;
  constexpr std::uint32_t w = 120, h = 90;
  const Vec3 position(3.1, -6.2, 4.3), target(0.1, 0.2, -0.1), up(0, 0, 1);
  const Vec3 forward = direction(target - position), right = direction(cross(forward, up)), over = cross(right, forward);
  const double half = std::tan(0.5 * 40 * M_PI / 180);
  for (const char* step : {"step=0.25", "step=0.5", "step=1"}) {
    const Image8 picture = picture_of(R"({"fields": {"d": {"analytic": "constant", "resolution": 17, "box": [-1, 1]}},
      "volumes": [{"field": "d", "color": [[1, 1, 1, 1]], "extinction": [[1, 0.7]]}],
      "camera": {"position": [3.1, -6.2, 4.3], "target": [0.1, 0.2, -0.1], "up": [0, 0, 1], "fovy_deg": 40}, "background": "transparent"})",
                                      {"--size", "120x90", "--quality", step}, std::string("box-") + step);
    double worst = 0;
    for (std::uint32_t y = 0; y < h; ++y)
      for (std::uint32_t x = 0; x < w; ++x) {
        const double u = (2 * (x + 0.5) / w - 1) * half * w / h, v = (1 - 2 * (y + 0.5) / h) * half;
        const double alpha = 1 - std::exp(-sigma * chord(position, direction(forward + right * u + over * v), -1, 1));
        worst = std::max(worst, std::fabs(picture.pixel(x, y)[3] / 255.0 - alpha));
      }
    EXPECT_LE(worst, 1 / 255.0) << step;
  }
}

TEST(Render, ARequestedErrorIsMeasuredAndReported) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"d": {"analytic": "marschner-lobb", "resolution": 48}},
    "volumes": [{"field": "d", "color": [[0, 0.1, 0.2, 0.9], [1, 1, 0.6, 0]], "opacity": [[0.3, 0], [1, 0.1]]}]})");
  for (const char* quality : {"error=1", "time=10000"}) {
    const auto run = program({"render", folder / "s.json", "-o", folder / "o.png", "--size", "128x96", "--validation", "--stats",
                              folder / "o.json", "--quality", quality});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    auto stats = json::parse(test::read_file(folder / "o.json"), "o.json");
    ASSERT_TRUE(stats);
    const json::Node* chosen = stats->find("quality");
    ASSERT_NE(chosen, nullptr);
    EXPECT_TRUE(chosen->find("mode")->string.starts_with(quality)) << chosen->find("mode")->string;
    EXPECT_LE(chosen->find("estimated_rmse")->number, 1);
    EXPECT_EQ(stats->find("validation_messages")->number, 0);
  }
  // The first image of a sequence equals the single image.
  const auto one = program({"render", folder / "s.json", "-o", folder / "one.png", "--size", "128x96", "--quality", "error=1"});
  const auto many = program({"render", folder / "s.json", "-o", folder / "of_%d.png", "--size", "128x96", "--quality", "error=1", "--orbit",
                             "1", "--frames", "2"});
  ASSERT_EQ(one.exit_code + many.exit_code, 0) << one.err << many.err;
  EXPECT_EQ(test::read_file(folder / "of_0.png"), test::read_file(folder / "one.png"));
  EXPECT_EQ(many.out.find(one.out.substr(0, one.out.find('\n'))), 0u) << many.out;
  EXPECT_NE(many.out.find("\nquality error=1 of the sequence: "), std::string::npos) << many.out;
  for (const char* quality : {"error=-1", "time=soon", "error="})
    EXPECT_EQ(program({"render", folder / "s.json", "-o", folder / "p.png", "--quality", quality}).exit_code, 2) << quality;
}

TEST(Render, TheProxysGlyphIsOnTheDrawnLine) {
  // A streamline seen from above; the probe is beside the line, the proxy on the line.
  const std::string scene = R"({"fields": {"v": {"analytic": "circle"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
    "streamlines": [{"field": "v", "seeds": [[1, 0, 0]], "radius": 0.02, "color": [1, 0, 0]}],
    "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 40}CURSOR})";
  const auto with = [&](const std::string& cursor) { return std::string(scene).replace(scene.find("CURSOR"), 6, cursor); };
  const Image8 bare = picture_of(with(""), {"--size", "256x192"}, "line");
  const Image8 with_cursor = picture_of(with(R"(, "cursor": {"probe": [0.2, 1.3, 0]})"), {"--size", "256x192"}, "held");
  // The proxy is the closest point of the circle.
  const Vec3 proxy = direction(Vec3(0.2, 1.3, 0));
  const double scale = 96 / (6 * std::tan(20 * M_PI / 180));
  const auto px = static_cast<std::uint32_t>(128 + scale * proxy.x), py = static_cast<std::uint32_t>(96 - scale * proxy.y);
  EXPECT_GT(bare.pixel(px, py)[0], 100) << "the line is drawn there";
  EXPECT_LT(bare.pixel(px, py)[1], 60);
  const std::uint8_t* glyph = with_cursor.pixel(px, py);
  EXPECT_GT(
      std::abs(glyph[0] - bare.pixel(px, py)[0]) + std::abs(glyph[1] - bare.pixel(px, py)[1]) + std::abs(glyph[2] - bare.pixel(px, py)[2]),
      60)
      << "the glyph covers the line";
  // Pixels away from the glyph are unchanged.
  EXPECT_EQ(0, std::memcmp(bare.pixel(128, 96 + static_cast<std::uint32_t>(scale)),
                           with_cursor.pixel(128, 96 + static_cast<std::uint32_t>(scale)), 4));
}

TEST(Render, StatsHaveTheDocumentedKeys) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"s": {"analytic": "gaussian", "resolution": 24}}, "volumes": [{"field": "s"}]})");
  const auto run =
      program({"render", folder / "s.json", "-o", folder / "o.png", "--size", "64x48", "--frames", "4", "--stats", folder / "o.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto stats = json::read(folder / "o.json");
  ASSERT_TRUE(stats) << stats.error().message;
  for (const char* key : {"device", "driver", "frames", "frame_ms", "first_frame_ms", "load_ms", "mirror_ms", "choose_ms", "encode_ms",
                          "cpu_bytes", "gpu_bytes", "validation_messages"})
    EXPECT_NE(stats->find(key), nullptr) << key;
  EXPECT_EQ(stats->find("frames")->number, 4);
  for (const char* key : {"median", "p99", "max"}) EXPECT_GT(stats->find("frame_ms")->find(key)->number, 0) << key;
  EXPECT_GT(stats->find("gpu_bytes")->number, 24 * 24 * 24 * 2);
  EXPECT_GT(stats->find("cpu_bytes")->number, 24 * 24 * 24 * 4);
  EXPECT_GE(stats->find("first_frame_ms")->number, stats->find("load_ms")->number);
}

TEST(Render, ADataFileIsDrawnWithoutAScene) {
  const test::TemporaryFolder folder;
  for (const char* name : {"torus", "helix"}) {
    const std::string file = folder / (std::string(name) + ".vdb"), out = folder / "o.png";
    ASSERT_EQ(program({"generate", name, "-o", file, "--resolution", "32"}).exit_code, 0);
    const auto run = program({"render", file, "-o", out, "--size", "128x96"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto picture = render::read_png(out);
    ASSERT_TRUE(picture);
    int lit = 0;
    for (std::uint32_t y = 0; y < 96; ++y)
      for (std::uint32_t x = 0; x < 128; ++x) lit += picture->pixel(x, y)[0] + picture->pixel(x, y)[1] + picture->pixel(x, y)[2] > 60;
    EXPECT_GT(lit, 128 * 96 / 50) << name;
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-bare-" + name + ".png", *picture, false));
  }
}

/// A text STL of a tetrahedron is described, drawn and felt.
TEST(Render, AMeshFileIsDrawnDescribedAndFelt) {
  const test::TemporaryFolder folder;
  const char* corners[4] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string text = "solid t\n";
  for (const auto& f : faces) {
    text += "facet normal 0 0 0 outer loop";
    for (const int v : f) text += std::string(" vertex ") + corners[v];
    text += " endloop endfacet\n";
  }
  test::write_file(folder / "t.stl", text + "endsolid\n");
  const auto info = program({"info", folder / "t.stl"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  for (const char* part : {"triangles    4", "vertices     4", "world box    0 0 0 .. 1 1 1", "open edges   0"})
    EXPECT_NE(info.out.find(part), std::string::npos) << info.out;
  const auto run = program({"render", folder / "t.stl", "-o", folder / "o.png", "--size", "128x96"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("1 mesh"), std::string::npos) << run.out;
  const auto picture = render::read_png(folder / "o.png");
  ASSERT_TRUE(picture);
  int lit = 0;
  for (std::uint32_t y = 0; y < 96; ++y)
    for (std::uint32_t x = 0; x < 128; ++x) lit += picture->pixel(x, y)[0] > 30;
  EXPECT_GT(lit, 128 * 96 / 20);
  EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-bare-mesh.png", *picture, false));

  // One scene draws the mesh and has a link to it: the probe is pushed 0.1 into the slanted face.
  test::write_file(folder / "s.json", R"({"meshes": [{"name": "t", "file": "t.stl", "color": [0.9, 0.5, 0.3]}],
    "chain": [{"name": "touch", "type": "mesh", "mesh": "t", "free": "above"}], "coupling": {"stiffness": 100, "damping": 0}})");
  test::write_file(folder / "p.csv", "t,x,y,z\n0,1,1,1\n0.001,0.3,0.3,0.3\n");
  const auto replayed = program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "o.csv"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const std::string csv = test::read_file(folder / "o.csv");
  EXPECT_NE(csv.find("1,OK,0,NONE,3.3333333333"), std::string::npos) << csv;
  EXPECT_EQ(program({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.stl"}).exit_code, 2) << "an input is kept";
}

TEST(Render, AnOrbitNumbersItsImages) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json",
                   R"({"fields": {"s": {"analytic": "plane", "resolution": 16}}, "isosurfaces": [{"field": "s", "level": 0.3}]})");
  const auto run =
      program({"render", folder / "s.json", "-o", folder / "turn_%02d.png", "--size", "64x48", "--frames", "3", "--orbit", "90"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"turn_00.png", "turn_01.png", "turn_02.png"}) EXPECT_TRUE(test::exists(folder / name)) << name;
  EXPECT_NE(test::read_file(folder / "turn_00.png"), test::read_file(folder / "turn_02.png"));
}

TEST(Render, TheProbeFollowsItsPathOverTheFrames) {
  const test::TemporaryFolder folder;
  const std::string scene = test::source_dir() + "/assets/scenes/hand.json", probe = test::source_dir() + "/assets/probes/hand.csv";
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "--size", "96x80", "--quality", "draft"});
    return test::run_catena(more);
  };
  // Three frames: the beginning, the middle and the end of the path; a still image has the probe at the end.
  ASSERT_EQ(render({"--probe", probe, "--play", "--frames", "3", "-o", folder / "p_%d.png"}).exit_code, 0);
  ASSERT_EQ(render({"--probe", probe, "-o", folder / "still.png"}).exit_code, 0);
  EXPECT_EQ(test::read_file(folder / "p_2.png"), test::read_file(folder / "still.png"));
  EXPECT_NE(test::read_file(folder / "p_0.png"), test::read_file(folder / "p_1.png"));
  EXPECT_NE(test::read_file(folder / "p_1.png"), test::read_file(folder / "p_2.png"));
  // The default number of frames: a path of 6 s at 0.5 frames a second, with both ends.
  ASSERT_EQ(render({"--probe", probe, "--play", "--fps", "0.5", "-o", folder / "q_%d.png"}).exit_code, 0);
  EXPECT_TRUE(test::exists(folder / "q_3.png"));
  EXPECT_FALSE(test::exists(folder / "q_4.png"));
  const auto bad = render({"--play", "-o", folder / "bad.png"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("--probe PATH.csv was expected"), std::string::npos) << bad.err;
}

TEST(Render, AFieldCanBeReplacedFromTheCommandLine) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(program({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "16"}).exit_code, 0);
  ASSERT_EQ(program({"generate", "plane", "-o", folder / "b.vdb", "--resolution", "16"}).exit_code, 0);
  test::write_file(folder / "s.json",
                   R"({"fields": {"d": {"file": "a.vdb", "grid": "sphere"}}, "isosurfaces": [{"field": "d", "level": 0.5}]})");
  ASSERT_EQ(program({"render", folder / "s.json", "-o", folder / "a.png", "--size", "64x48"}).exit_code, 0);
  const auto run =
      program({"render", folder / "s.json", "-o", folder / "b.png", "--size", "64x48", "--field", "d=" + (folder / "b.vdb") + ":plane"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(test::read_file(folder / "a.png"), test::read_file(folder / "b.png"));
  // The option takes one value, so it may precede the scene.
  const auto first =
      program({"render", "--field", "d=" + (folder / "b.vdb") + ":plane", folder / "s.json", "-o", folder / "c.png", "--size", "64x48"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(test::read_file(folder / "c.png"), test::read_file(folder / "b.png"));
}

TEST(Render, TheCombustorIsDrawnAndFeltFromOneScene) {
  if (test::shared_data("combustor_cfd.vdb").empty()) GTEST_SKIP() << "the shared data is not there";
  const std::string assets = test::source_dir() + "/assets/";
  const test::TemporaryFolder folder;
  const auto replayed =
      program({"replay", assets + "scenes/data/combustor.json", "--probe", assets + "probes/combustor.csv", "-o", folder / "t.csv"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const test::Table ticks = test::Table::read(folder / "t.csv");
  int both = 0;
  for (std::size_t row = 0; row < ticks.rows(); ++row)
    both += ticks.text(row, "curve_status") == "OK" && ticks.text(row, "surface_status") == "OK";
  EXPECT_GT(both, 100) << "the hand is on the streamline and pressed into the isosurface";
  const auto seen = program({"render", assets + "scenes/data/combustor.json", "--probe", assets + "probes/combustor.csv", "-o",
                             test::binary_dir() + "/app-combustor.png", "--size", "256x192", "--validation"});
  EXPECT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_EQ(seen.err.find("validation"), std::string::npos) << seen.err;
}

}  // namespace render_test
