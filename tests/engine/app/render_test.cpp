// SPDX-License-Identifier: MIT
/// `catena render`: images with known results, statistics, and a scene that is both rendered and felt.
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "engine/base/json.h"
#include "engine/base/vec.h"
#include "render/image/image.h"
#include "tests/engine/app/program_runs.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/results.h"

namespace render_test {

using namespace catena;
using render::Image8;

using test::has;
using test::run_ok;
using test::run_refused;

Image8 picture_of(const std::string& scene, const std::vector<std::string>& more, const std::string& keep) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", scene);
  run_ok({"render", folder / "s.json", "-o", folder / "o.png", "--validation", "--stats", folder / "o.json"}, more);
  EXPECT_TRUE(has(test::read_file(folder / "o.json"), "\"validation_messages\": 0"));
  auto picture = render::read_png(folder / "o.png");
  EXPECT_TRUE(picture) << picture.error().message;
  if (!keep.empty()) {
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-" + keep + ".png", *picture, true));
  }
  return *picture;
}

// The number of pixels whose red, green and blue (or only red) sum to more than a limit.
int count_brighter(const Image8& picture, int channels, int limit) {
  int count = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    int sum = 0;
    for (int c = 0; c < channels; ++c) sum += picture.rgba[i + static_cast<std::size_t>(c)];
    count += sum > limit;
  }
  return count;
}

TEST(Import, EveryFormatCanBeWrittenToAPipe) {
  const test::TemporaryFolder folder;
  run_ok({"generate", "torus", "-o", folder / "g.vdb", "--resolution", "8"});
  for (const char* ending : {".vdb", ".vti", ".nrrd", ".nii", ".nii.gz"}) {
    const std::string pipe = folder / (std::string("p") + ending), plain = folder / (std::string("f") + ending);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    run_refused({"import", folder / "g.vdb", "-o", pipe}, "nothing reads from this pipe");
    EXPECT_TRUE(std::filesystem::is_fifo(pipe)) << ending;
    const auto read =
        test::run_program("/bin/sh", {"-c", "cat " + pipe + " > " + folder.path() + "/got & sleep 0.2; " + test::program_path() +
                                                " import " + folder.path() + "/g.vdb -o " + pipe + " && wait"});
    EXPECT_EQ(read.exit_code, 0) << ending << read.err;
    run_ok({"import", folder / "g.vdb", "-o", plain});
    EXPECT_EQ(test::read_file(folder / "got").size(), test::read_file(plain).size()) << ending;
  }
}

TEST(Render, EveryCommandTakesTheFilesOfASeriesAsSteps) {
  const test::TemporaryFolder folder;
  test::Words files;
  for (const std::string step : {"10", "2", "1"}) {
    files.push_back(folder / ("w_" + step + ".vdb"));
    run_ok({"generate", "abc", "-o", files.back(), "--resolution", "8", "--scale", step});
  }
  const auto words = [&](const std::string& command, const test::Words& more) {
    return test::joined(test::joined({command}, files), more);
  };
  const auto shown = [&](const test::Words& more) { return run_ok(words("info", more)).out; };
  EXPECT_TRUE(has(shown({"--json"}), "\"steps\":3"));
  EXPECT_TRUE(has(shown({}), "3: " + folder.path() + "/w_1.vdb .. " + folder.path() + "/w_10.vdb"));
  const test::Words small{"--size", "16x16", "--steps", "0:2"};
  run_ok(words("render", small), {"-o", folder / "o%d.png", "--quality", "draft"});
  EXPECT_TRUE(test::exists(folder / "o2.png"));
  for (const test::Words& lost : {test::Words{"-o", folder / "one.png"}, {"-o", folder / "f%d.png", "--frames", "2"}})
    run_refused(test::joined(words("render", small), lost));
  // The values of a step.
  const auto range_of = [](const std::string& path) {
    const std::string text = run_ok({"info", path, "--json"}).out;
    const std::size_t at = text.find("\"range\":[");
    return at == std::string::npos ? "none" : text.substr(at, text.find(']', at) - at);
  };
  const auto speed_in = [&](const std::string& path) {
    const std::string range = range_of(path);
    return range == "none" ? 0.0 : std::stod(range.substr(range.find(',') + 1));
  };
  run_ok(words("import", {"-o", folder / "i%02d.vti"}));
  EXPECT_TRUE(has(shown({"--step", "2", "--json"}), range_of(folder / "w_10.vdb")));
  run_refused(words("info", {"--step", "3"}));
  EXPECT_NEAR(speed_in(folder / "i02.vti") / speed_in(folder / "i00.vti"), 10, 1e-5);
  run_ok(words("import", {"-o", folder / "one.vti", "--step", "1"}));
  EXPECT_NEAR(speed_in(folder / "one.vti") / speed_in(folder / "i00.vti"), 2, 1e-5);
  run_refused(words("import", {"-o", folder / "none.vti"}));
  run_refused(words("import", {"-o", folder / "none.vti", "--step", "3"}));
  // An output must not be the file of another step, by any name.
  const std::string later = test::read_file(folder / "w_10.vdb");
  std::filesystem::create_symlink("w_10.vdb", folder / "link.vdb");
  for (const std::string& other :
       {"/../" + std::filesystem::path(folder.path()).filename().string() + "/w_10.vdb", std::string("/link.vdb")}) {
    run_refused(words("import", {"-o", folder.path() + other, "--step", "0"}));
    EXPECT_EQ(test::read_file(folder / "w_10.vdb"), later) << other;
  }
  // No step is written if the output of another step is an input.
  std::filesystem::create_symlink("w_10.vdb", folder / "s_002.vdb");
  run_refused(words("import", {"-o", folder / "s_%03d.vdb"}));
  EXPECT_FALSE(test::exists(folder / "s_000.vdb"));
  EXPECT_EQ(test::read_file(folder / "w_10.vdb"), later);
  run_ok(words("export", {"--field", "abc", "-o", folder / "e.vti", "--step", "2"}));
  EXPECT_NEAR(speed_in(folder / "e.vti") / speed_in(folder / "i00.vti"), 10, 1e-5);
  test::write_file(folder / "seeds.csv", "x,y,z\n0.1,0.2,0.3\n");
  run_ok(words("trace", {"--field", "abc", "--seeds", folder / "seeds.csv", "-o", folder / "l.csv"}));
  EXPECT_FALSE(test::exists(folder / "none.vti"));
  // Files that are not a series, and files without data.
  files.push_back(folder / "i00.vti");
  run_refused(words("info", {}), "are not a series");
  run_refused({"render", folder / "a.json", folder / "b.json", "-o", folder / "o.png"});
}

TEST(Render, StepsBeyondTheLastAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string name : {"f_0.001", "f_0.01", "f_0.0015"})
    run_ok({"generate", "sphere", "-o", folder / (name + ".vdb"), "--resolution", "6"});
  test::write_file(folder / "s.json", R"({"fields": {"d": {"file": "f_*.vdb"}}, "isosurfaces": [{"field": "d", "level": 1}]})");
  const test::Words words{"render", folder / "s.json", "-o", folder / "o%03d.png", "--size", "16x16", "--quality", "draft"};
  run_ok(words, {"--steps", "0:2"});
  run_ok(words, {"--step", "2", "--frames", "1"});
  for (const test::Words& steps : {test::Words{"--steps", "0:3"}, {"--steps", "0:99"}, {"--step", "3"}})
    run_refused(test::joined(words, steps), "the last step of");
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
    run_ok({"render", folder / "s.json", "-o", folder / "o.png", "--size", "128x96", "--validation", "--stats", folder / "o.json",
            "--quality", quality});
    auto stats = test::value_of(json::parse(test::read_file(folder / "o.json"), "o.json"));
    const json::Node* chosen = stats.find("quality");
    ASSERT_NE(chosen, nullptr);
    EXPECT_TRUE(chosen->find("mode")->string.starts_with(quality)) << chosen->find("mode")->string;
    EXPECT_LE(chosen->find("estimated_rmse")->number, 1);
    EXPECT_EQ(stats.find("validation_messages")->number, 0);
  }
  // The first image of a sequence equals the single image.
  const test::Words words{"render", folder / "s.json", "--size", "128x96", "--quality", "error=1", "-o"};
  const auto one = run_ok(words, {folder / "one.png"}), many = run_ok(words, {folder / "of_%d.png", "--orbit", "1", "--frames", "2"});
  EXPECT_EQ(test::read_file(folder / "of_0.png"), test::read_file(folder / "one.png"));
  EXPECT_EQ(many.out.find(one.out.substr(0, one.out.find('\n'))), 0u) << many.out;
  EXPECT_TRUE(has(many.out, "\nquality error=1 of the sequence: "));
  for (const char* quality : {"error=-1", "time=soon", "error="})
    run_refused({"render", folder / "s.json", "-o", folder / "p.png", "--quality", quality});
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
  const std::uint8_t *glyph = with_cursor.pixel(px, py), *line = bare.pixel(px, py);
  EXPECT_GT(std::abs(glyph[0] - line[0]) + std::abs(glyph[1] - line[1]) + std::abs(glyph[2] - line[2]), 60) << "the glyph covers the line";
  // Pixels away from the glyph are unchanged.
  const std::uint32_t above = 96 + static_cast<std::uint32_t>(scale);
  EXPECT_EQ(0, std::memcmp(bare.pixel(128, above), with_cursor.pixel(128, above), 4));
}

TEST(Render, StatsHaveTheDocumentedKeys) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", R"({"fields": {"s": {"analytic": "gaussian", "resolution": 24}}, "volumes": [{"field": "s"}]})");
  run_ok({"render", folder / "s.json", "-o", folder / "o.png", "--size", "64x48", "--frames", "4", "--stats", folder / "o.json"});
  const auto stats = test::value_of(json::read(folder / "o.json"));
  for (const char* key : {"device", "driver", "frames", "frame_ms", "first_frame_ms", "load_ms", "mirror_ms", "choose_ms", "encode_ms",
                          "cpu_bytes", "gpu_bytes", "validation_messages"})
    EXPECT_NE(stats.find(key), nullptr) << key;
  EXPECT_EQ(stats.find("frames")->number, 4);
  for (const char* key : {"median", "p99", "max"}) EXPECT_GT(stats.find("frame_ms")->find(key)->number, 0) << key;
  EXPECT_GT(stats.find("gpu_bytes")->number, 24 * 24 * 24 * 2);
  EXPECT_GT(stats.find("cpu_bytes")->number, 24 * 24 * 24 * 4);
  EXPECT_GE(stats.find("first_frame_ms")->number, stats.find("load_ms")->number);
}

TEST(Render, ADataFileIsDrawnWithoutAScene) {
  const test::TemporaryFolder folder;
  for (const char* name : {"torus", "helix"}) {
    const std::string file = folder / (std::string(name) + ".vdb"), out = folder / "o.png";
    run_ok({"generate", name, "-o", file, "--resolution", "32"});
    run_ok({"render", file, "-o", out, "--size", "128x96"});
    const auto picture = test::value_of(render::read_png(out));
    EXPECT_GT(count_brighter(picture, 3, 60), 128 * 96 / 50) << name;
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-bare-" + name + ".png", picture, false));
  }
}

/// A text STL of a tetrahedron is described, drawn and felt.
TEST(Render, AMeshFileIsDrawnDescribedAndFelt) {
  const test::TemporaryFolder folder;
  const mesh::TriangleSoup tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  test::write_file(folder / "t.stl", test::text_stl(tetrahedron));
  const auto info = run_ok({"info", folder / "t.stl"});
  for (const char* part : {"triangles    4", "vertices     4", "world box    0 0 0 .. 1 1 1", "open edges   0"})
    EXPECT_TRUE(has(info.out, part));
  const auto run = run_ok({"render", folder / "t.stl", "-o", folder / "o.png", "--size", "128x96"});
  EXPECT_TRUE(has(run.out, "1 mesh"));
  const auto picture = test::value_of(render::read_png(folder / "o.png"));
  EXPECT_GT(count_brighter(picture, 1, 30), 128 * 96 / 20);
  EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-bare-mesh.png", picture, false));

  // One scene draws the mesh and has a link to it: the probe is pushed 0.1 into the slanted face.
  test::write_file(folder / "s.json", R"({"meshes": [{"name": "t", "file": "t.stl", "color": [0.9, 0.5, 0.3]}],
    "chain": [{"name": "touch", "type": "mesh", "mesh": "t", "free": "above"}], "coupling": {"stiffness": 100, "damping": 0}})");
  test::write_file(folder / "p.csv", "t,x,y,z\n0,1,1,1\n0.001,0.3,0.3,0.3\n");
  run_ok({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "o.csv"});
  EXPECT_TRUE(has(test::read_file(folder / "o.csv"), "1,OK,0,NONE,3.3333333333"));
  run_refused({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "t.stl"}, "");  // an input is kept
}

TEST(Render, AnOrbitNumbersItsImages) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json",
                   R"({"fields": {"s": {"analytic": "plane", "resolution": 16}}, "isosurfaces": [{"field": "s", "level": 0.3}]})");
  run_ok({"render", folder / "s.json", "-o", folder / "turn_%02d.png", "--size", "64x48", "--frames", "3", "--orbit", "90"});
  for (const char* name : {"turn_00.png", "turn_01.png", "turn_02.png"}) EXPECT_TRUE(test::exists(folder / name)) << name;
  EXPECT_NE(test::read_file(folder / "turn_00.png"), test::read_file(folder / "turn_02.png"));
}

TEST(Render, TheProbeFollowsItsPathOverTheFrames) {
  const test::TemporaryFolder folder;
  const std::string scene = test::source_dir() + "/assets/scenes/hand.json", probe = test::source_dir() + "/assets/probes/hand.csv";
  const test::Words words{"render", scene, "--size", "96x80", "--quality", "draft"};
  // Three frames: the beginning, the middle and the end of the path; a still image has the probe at the end.
  run_ok(words, {"--probe", probe, "--play", "--frames", "3", "-o", folder / "p_%d.png"});
  run_ok(words, {"--probe", probe, "-o", folder / "still.png"});
  EXPECT_EQ(test::read_file(folder / "p_2.png"), test::read_file(folder / "still.png"));
  EXPECT_NE(test::read_file(folder / "p_0.png"), test::read_file(folder / "p_1.png"));
  EXPECT_NE(test::read_file(folder / "p_1.png"), test::read_file(folder / "p_2.png"));
  // The default number of frames: a path of 6 s at 0.5 frames a second, with both ends.
  run_ok(words, {"--probe", probe, "--play", "--fps", "0.5", "-o", folder / "q_%d.png"});
  EXPECT_TRUE(test::exists(folder / "q_3.png"));
  EXPECT_FALSE(test::exists(folder / "q_4.png"));
  run_refused(test::joined(words, {"--play", "-o", folder / "bad.png"}), "--probe PATH.csv was expected");
}

TEST(Render, AFieldCanBeReplacedFromTheCommandLine) {
  const test::TemporaryFolder folder;
  run_ok({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "16"});
  run_ok({"generate", "plane", "-o", folder / "b.vdb", "--resolution", "16"});
  test::write_file(folder / "s.json",
                   R"({"fields": {"d": {"file": "a.vdb", "grid": "sphere"}}, "isosurfaces": [{"field": "d", "level": 0.5}]})");
  const std::string scene = folder / "s.json", field = "d=" + (folder / "b.vdb") + ":plane";
  run_ok({"render", scene, "-o", folder / "a.png", "--size", "64x48"});
  run_ok({"render", scene, "-o", folder / "b.png", "--size", "64x48", "--field", field});
  EXPECT_NE(test::read_file(folder / "a.png"), test::read_file(folder / "b.png"));
  // The option takes one value, so it may precede the scene.
  run_ok({"render", "--field", field, scene, "-o", folder / "c.png", "--size", "64x48"});
  EXPECT_EQ(test::read_file(folder / "c.png"), test::read_file(folder / "b.png"));
}

TEST(Render, TheCombustorIsDrawnAndFeltFromOneScene) {
  if (test::shared_data("combustor_cfd.vdb").empty()) GTEST_SKIP() << "the shared data is not there";
  const std::string assets = test::source_dir() + "/assets/";
  const test::TemporaryFolder folder;
  run_ok({"replay", assets + "scenes/data/combustor.json", "--probe", assets + "probes/combustor.csv", "-o", folder / "t.csv"});
  const test::Table ticks = test::Table::read(folder / "t.csv");
  int both = 0;
  for (std::size_t row = 0; row < ticks.rows(); ++row)
    both += ticks.text(row, "curve_status") == "OK" && ticks.text(row, "surface_status") == "OK";
  EXPECT_GT(both, 100) << "the hand is on the streamline and pressed into the isosurface";
  const auto seen = run_ok({"render", assets + "scenes/data/combustor.json", "--probe", assets + "probes/combustor.csv", "-o",
                            test::binary_dir() + "/app-combustor.png", "--size", "256x192", "--validation"});
  EXPECT_EQ(seen.err.find("validation"), std::string::npos) << seen.err;
}

}  // namespace render_test
