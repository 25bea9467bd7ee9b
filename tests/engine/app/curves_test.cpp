// SPDX-License-Identifier: MIT
// Curves from files: colors in the image, the output of `info`, and errors of scenes that name them.
#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/curve_files.h"
#include "tests/support/results.h"

namespace catena::app::curves_test {

using test::Polylines;
using test::value_of;

class CurveImages : public test::ImageTest {
 protected:
  /// Three crossing lines along the axes, seen from a position where all three can be distinguished.
  std::string scene_of(const std::string& keys, const std::string& more = "") {
    test::TrkFile file;
    file.voxel = Vec3(1.0);
    file.order = "RAS";
    file.scalars = {"fa"};
    for (int axis = 0; axis < 3; ++axis) {
      file.lines.emplace_back();
      for (int i = 0; i <= 20; ++i) {
        Vec3 p(0.5);  // the center of the first voxel is the world's origin
        p[(axis + 1) % 3] += 0.4;
        p[axis] += -1 + 0.1 * i;
        file.lines.back().push_back(p);
      }
    }
    test::write_file(folder_ / "axes.trk", file.bytes());
    return R"({"curves": [{"name": "axes", "file": "axes.trk", "radius": 0.05)" + keys + R"(}],
               "camera": {"position": [4, 3, 2.5], "target": [0, 0, 0], "fovy_deg": 35})" +
           more + "}";
  }
  render::FramePacket packet_of(const std::string& text) {
    auto scene = value_of(scene::parse_scene(text, folder_ / "scene.json"));
    return value_of(render::make_frame(scene, 256, 192));
  }
  /// The scene of one file of curves, without further keys.
  render::FramePacket packet_of_tck(const Polylines& lines) {
    test::write_file(folder_ / "a.tck", test::tck_bytes(lines, "Float32LE"));
    return packet_of(R"({"curves": [{"name": "a", "file": "a.tck"}]})");
  }
  /// The color of the image at a world position, without lighting: the brightest component is 1.
  Color hue_at(const render::FramePacket& packet, const render::Image8& picture, const Vec3& place) {
    const auto camera = render::make_camera(packet.view, packet.width, packet.height, Bounds());
    const auto at = render::project(camera, place);
    const std::uint8_t* pixel = picture.pixel(static_cast<std::uint32_t>(at->x), static_cast<std::uint32_t>(at->y));
    const float max_part = std::max({float(pixel[0]), float(pixel[1]), float(pixel[2]), 0.255f});
    return {float(pixel[0]) / max_part, float(pixel[1]) / max_part, float(pixel[2]) / max_part};
  }
  test::TemporaryFolder folder_;
};

const Vec3 kOn[] = {{0.7, 0.4, 0}, {0, 0.7, 0.4}, {0.4, 0, 0.7}};

TEST_F(CurveImages, LinesAreColouredByDirection) {
  const auto packet = packet_of(scene_of(""));
  const auto picture = draw(packet, {}, "directions");
  for (int axis = 0; axis < 3; ++axis) {
    const Color seen = hue_at(packet, picture, kOn[axis]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((std::array{seen.r, seen.g, seen.b})[std::size_t(c)], c == axis ? 1 : 0, 0.02) << axis;
  }
  // A diagonal line.
  const auto askew = packet_of_tck({{{-1, -1, 0}, {1, 1, 0}}});
  EXPECT_NEAR(askew.tubes[0].colors[0].r, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(askew.tubes[0].colors[0].g, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(askew.tubes[0].colors[0].b, 0);
}

TEST_F(CurveImages, LinesHaveOneColourOrAreColouredByValueOrLength) {
  const auto one = packet_of(scene_of(R"(, "color": [0, 1, 1])"));
  EXPECT_NEAR(hue_at(one, draw(one), kOn[0]).r, 0, 0.02);

  // The file's scalars are 100 n + i on line n.
  const std::string table = R"("color": [[0, 1, 0, 0], [99, 1, 0, 0], [100, 0, 1, 0], [199, 0, 1, 0], [200, 0, 0, 1]])";
  const auto values = packet_of(scene_of(R"(, "color_by": {"value": "fa", )" + table + "}", R"(, "scalar_bars": [{"curves": 0}])"));
  const auto picture = draw(values, {}, "values");
  EXPECT_NEAR(hue_at(values, picture, kOn[1]).g, 1, 0.02);
  EXPECT_NEAR(hue_at(values, picture, kOn[1]).r, 0, 0.02);
  ASSERT_EQ(values.overlay.scalar_bars.size(), 1u);
  EXPECT_EQ(values.overlay.scalar_bars[0].title, "fa");
  EXPECT_EQ(values.overlay.scalar_bars[0].colors.back()[0], 200);

  const auto lengths = packet_of(scene_of(R"(, "color_by": {"quantity": "arc_length", "color": [[0, 0, 0, 0], [2, 1, 0, 0]]})"));
  EXPECT_NEAR(lengths.tubes[0].colors[5].r, 0.25, 1e-5);

  const auto field = packet_of(
      scene_of(R"(, "color_by": {"field": "x", "color": [[-1, 0, 0, 0], [1, 1, 0, 0]]})", R"(, "fields": {"x": {"analytic": "linear"}})"));
  EXPECT_NEAR(field.tubes[0].colors[13].r, 0.5 + 0.5 * (0.3 + 0.4), 1e-5) << "x + y + z";
}

TEST_F(CurveImages, ClipPlanesCutAndTheDefaultRadiusFitsTheExtent) {
  const auto clipped = packet_of(scene_of("", R"(, "clip": [{"plane": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}])"));
  const auto picture = draw(clipped);
  EXPECT_NEAR(hue_at(clipped, picture, {0.7, 0.4, 0}).r, 0, 0.02) << "cut away";
  const Color left = hue_at(clipped, picture, {0, 0.7, 0.4});
  EXPECT_NEAR(left.g, 1, 0.02);
  const auto fitted = packet_of_tck({{{0, 0, 0}, {3, 4, 0}}});
  EXPECT_NEAR(fitted.tubes[0].radius, 0.003 * 5, 1e-9);
}

TEST_F(CurveImages, TooManyLinesAreDrawnInPartWithANote) {
  // 2.2 million points: 11 lines of 200 000.
  std::vector<Vec3> line;
  for (int i = 0; i < 200000; ++i) line.push_back({1e-5 * i, 0, 0});
  const auto packet = packet_of_tck(Polylines(11, line));
  EXPECT_EQ(packet.tubes.size(), 10u);
  EXPECT_EQ(packet.omitted, "curves \"a\": 10 of 11 lines are drawn, evenly chosen, so that they have about 2000000 points; all are felt");
}

TEST_F(CurveImages, PointsAreDrawnAsLitSpheresAtTheirPositions) {
  test::write_file(folder_ / "p.csv", "x,y,z,v,size\n0,0,0,0,0.5\n1.5,0,0,1,0.25\n0,5,0,2,nan\n");
  for (const bool flat : {false, true}) {
    const std::string camera = flat ? R"("projection": "orthographic", "height": 3)" : R"("fovy_deg": 30)";
    const auto packet = packet_of(R"({"points": [{"name": "p", "file": "p.csv", "radius_by": "size",
                                       "color_by": {"value": "v", "color": [[0, 1, 0, 0], [1, 0, 1, 0], [2, 0, 0, 1]]}}],
                                      "scalar_bars": [{"points": 0}],
                                      "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "up": [0, 1, 0], )" +
                                  camera + "}}");
    ASSERT_EQ(packet.spheres.size(), 1u);
    EXPECT_EQ(packet.spheres[0].spheres->offsets.size(), 2u) << "one has no radius";
    EXPECT_EQ(packet.overlay.scalar_bars.size(), 1u);
    const auto picture = draw(packet, {}, flat ? "flat" : "perspective");
    EXPECT_NEAR(hue_at(packet, picture, {0, 0, 0}).r, 1, 0.02);
    EXPECT_NEAR(hue_at(packet, picture, {1.5, 0, 0}).g, 1, 0.02);
    // Compares each pixel with the nearest depth by the formula of the sphere, or with no hit.
    const auto camera_now = render::make_camera(packet.view, packet.width, packet.height, Bounds());
    const auto depth = renderer_->read_depth();
    ASSERT_TRUE(depth);
    int on = 0, wrong = 0;
    for (std::uint32_t y = 0; y < packet.height; ++y)
      for (std::uint32_t x = 0; x < packet.width; ++x) {
        const Vec3 a = render::unproject(camera_now, x + 0.5, y + 0.5, 1), b = render::unproject(camera_now, x + 0.5, y + 0.5, 9);
        const Vec3 ray = direction(b - a);
        double expected = std::numeric_limits<double>::infinity();
        for (const auto& [centre, radius] : {std::pair{Vec3(0.0), 0.5}, {Vec3(1.5, 0, 0), 0.25}}) {
          const Vec3 off = a - centre;
          const double root = radius * radius - dot(off, off) + dot(off, ray) * dot(off, ray);
          if (root > 0) expected = std::min(expected, 6 - (a + ray * (-dot(off, ray) - std::sqrt(root))).z);
        }
        const double seen = depth->depth[y * packet.width + x];
        on += std::isfinite(expected);
        wrong += std::isfinite(seen) != std::isfinite(expected) || (std::isfinite(seen) && std::fabs(seen - expected) > 0.01);
      }
    EXPECT_GT(on, 1000);
    EXPECT_LE(wrong, on / 100) << "of " << on;
  }
}

TEST_F(CurveImages, AClippedSphereShowsItsInside) {
  test::write_file(folder_ / "p.csv", "x,y,z\n0,0,0\n");
  const auto packet = packet_of(R"({"points": [{"name": "p", "file": "p.csv", "radius": 1, "color": [0, 1, 0]}],
                                    "clip": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, -1]}}],
                                    "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 30}})");
  const auto picture = draw(packet);
  EXPECT_NEAR(hue_at(packet, picture, {0, 0, 0}).g, 1, 0.02);
  const auto depth = renderer_->read_depth();
  ASSERT_TRUE(depth);
  EXPECT_NEAR(depth->depth[96 * 256 + 128], 7, 0.01) << "the far half";
}

using CurveScenes = test::ProgramInFolder;

TEST_F(CurveScenes, ATableOfPointsIsRecognizedByItsHeader) {
  write("table.csv", "id,x,y,z,mass\n1,0,0,0,7\n2,3,4,0,9\n");
  auto scene = value_of(scene::scene_for_file(folder_ / "table.csv"));
  ASSERT_EQ(scene.notes.size(), 1u);
  test::expect_parts(scene.notes[0], {"a table of points (columns x, y, z): 2 points, shown as spheres, coloured by \"mass\""});
  value_of(render::make_frame(scene, 64, 48));
  write("other.csv", "t,force\n1,0\n");
  expect_refused("render {other.csv} -o {a.png}", {"there is no column x"});
  test::expect_parts(run("info {table.csv}").out, {"spacing      median 5"});
}

TEST_F(CurveScenes, OutliersOfATableAreLeftOutOfTheViewAndTheColorRange) {
  std::string table = "x,y,z,mass\n";
  for (int k = 0; k < 200; ++k) table += fmt::format("{},{},{},{}\n", k % 6, k / 6 % 6, k / 36, k * k % 199);
  write("plain.csv", table);
  write("stray.csv", table + "9000,0,0,100000\n");
  auto plain = value_of(scene::scene_for_file(folder_ / "plain.csv")), stray = value_of(scene::scene_for_file(folder_ / "stray.csv"));
  EXPECT_FALSE(plain.annotations.scalar_bars.at(0).title);
  EXPECT_FALSE(stray.annotations.scalar_bars.at(0).title);
  test::expect_parts(stray.notes.at(0),
                     {"coloured by \"mass\"; 1 value of 100000 beyond the others, 0 .. 196", "1 distant points outside the initial view"});
  for (scene::Scene* one : {&plain, &stray}) {
    const auto camera = render::make_camera(value_of(render::make_frame(*one, 320, 240)).view, 320, 240, {});
    const auto low = render::project(camera, {0, 0, 0}).value(), high = render::project(camera, {5, 5, 5}).value();
    EXPECT_GT(std::fabs(low.y - high.y), 80) << "pixels";
  }
}

TEST_F(CurveScenes, ACurveFileIsDrawnAndDescribed) {
  write("a.tck", test::tck_bytes({{{0, 0, 0}, {3, 4, 0}}, {{0, 0, 0}, {0, 0, 1}}}, "Float32LE"));
  auto scene = value_of(scene::scene_for_file(folder_ / "a.tck"));
  ASSERT_EQ(scene.notes.size(), 1u);
  test::expect_parts(scene.notes[0], {"2 curves, coloured by direction: red for x, green for y, blue for z"});
  const auto packet = value_of(render::make_frame(scene, 64, 48));
  EXPECT_EQ(packet.tubes.size(), 2u);
  EXPECT_GT(packet.view.position.y, packet.view.target.y) << "a patient is seen from the front";
  test::expect_parts(succeed("info {a.tck}").out, {"lengths      mean 3 mm, maximum 5 mm"});
}

TEST_F(CurveScenes, ErrorsNameTheLine) {
  write("a.tck", test::tck_bytes({{{0, 0, 0}, {3, 4, 0}}}, "Float32LE"));
  const auto message = [&](const std::string& text) {
    auto scene = scene::parse_scene(text, folder_ / "s.json");
    if (!scene) return scene.error().message;
    const auto packet = render::make_frame(*scene, 64, 48);
    return packet ? std::string() : packet.error().message;
  };
  const auto expect = [&](const std::string& text, const std::string& words) { test::expect_parts(message(text), {words, "s.json:1"}); };
  const auto curves = [](const std::string& keys) { return R"({"curves": [{"name": "a", "file": "a.tck")" + keys + "}"; };
  const auto points = [](const std::string& keys) { return R"({"points": [{"name": "p", "file": "p.csv")" + keys + "}"; };
  expect(R"({"curves": [{"name": "a", "file": "b.tck"}]})", "does not exist; a .tck, .trk, ");
  expect(curves("") + R"(, {"name": "a", "file": "a.tck"}]})", "a unique name was expected");
  expect(curves(R"(, "color_by": {"value": "fa"})") + "]}", "the file has no values called \"fa\"; known: none");
  expect(curves(R"(, "color_by": {})") + "]}", "exactly one of them was expected");
  expect(curves("") + R"(], "scalar_bars": [{"curves": 0}]})", "shows no values");
  write("p.csv", "x,y,z,v\n1,2,3,4\n");
  expect(points(R"(, "radius_by": "w")") + "]}", "no column of numbers called \"w\"; known: v");
  expect(points(R"(, "color_by": {"value": "w"})") + "]}", "no column of numbers called \"w\"; known: v");
  expect(points(R"(, "radius": 1, "radius_by": "v")") + "]}", "both \"radius_by\" and \"radius\" are given");
  expect(points("") + R"(], "scalar_bars": [{"points": 0}]})", "shows no values");
  write("a.tck", "mrtrix tracks\n");
  expect(curves("") + "]}", "a line END was expected");
}

}  // namespace catena::app::curves_test
