// Curves from files: their colours in the picture, what `info` says, what is wrong with a scene that names them.
#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "tests/render/support/frames.h"
#include "tests/support/curve_files.h"
#include "tests/support/program.h"

namespace catena::app {
namespace curves_test {

using test::Polylines;

class CurvePictures : public test::PictureTest {
 protected:
  /// Three crossing lines along the axes, seen from where all three can be told apart.
  std::string scene_of(const std::string& keys, const std::string& more = "") {
    test::TrkFile file;
    file.voxel = Vec3(1.0);
    file.order = "RAS";
    file.scalars = {"fa"};
    for (int axis = 0; axis < 3; ++axis) {
      file.lines.emplace_back();
      for (int i = 0; i <= 20; ++i) {
        Vec3 p(0.5);  // the middle of the first voxel is the world's origin
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
  Result<render::FramePacket> packet_of(const std::string& text) {
    auto scene = scene::parse_scene(text, folder_ / "scene.json");
    if (!scene) return scene.error();
    return render::make_frame(*scene, 256, 192);
  }
  /// The colour of the picture where a world place is, without the light: its brightest component is 1.
  Color hue_at(const render::FramePacket& packet, const render::Picture& picture, const Vec3& place) {
    const auto camera = render::make_camera(packet.view, packet.width, packet.height, Bounds());
    const auto at = render::project(camera, place);
    const std::size_t pixel = 4 * (static_cast<std::size_t>(at->y) * packet.width + static_cast<std::size_t>(at->x));
    const auto part = [&](std::size_t i) { return static_cast<float>(picture.rgba[pixel + i]) / 255.0f; };
    const float most = std::max({part(0), part(1), part(2), 1e-3f});
    return {part(0) / most, part(1) / most, part(2) / most};
  }
  test::TemporaryFolder folder_;
};

const Vec3 kOn[] = {{0.7, 0.4, 0}, {0, 0.7, 0.4}, {0.4, 0, 0.7}};

TEST_F(CurvePictures, ColoursOfTheDirections) {
  const auto packet = packet_of(scene_of(""));
  ASSERT_TRUE(packet) << packet.error().message;
  const auto picture = draw(*packet, {}, "directions");
  for (int axis = 0; axis < 3; ++axis) {
    const Color seen = hue_at(*packet, picture, kOn[axis]);
    const float expected[] = {axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
    EXPECT_NEAR(seen.r, expected[0], 0.02) << axis;
    EXPECT_NEAR(seen.g, expected[1], 0.02) << axis;
    EXPECT_NEAR(seen.b, expected[2], 0.02) << axis;
  }
  // a line that runs askew
  test::write_file(folder_ / "askew.tck", test::tck_bytes({{{-1, -1, 0}, {1, 1, 0}}}, "Float32LE"));
  const auto askew = packet_of(R"({"curves": [{"name": "a", "file": "askew.tck"}]})");
  ASSERT_TRUE(askew);
  EXPECT_NEAR(askew->tubes[0].colors[0].r, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(askew->tubes[0].colors[0].g, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(askew->tubes[0].colors[0].b, 0);
}

TEST_F(CurvePictures, OneColourValuesAndLengths) {
  const auto one = packet_of(scene_of(R"(, "color": [0, 1, 1])"));
  ASSERT_TRUE(one);
  EXPECT_NEAR(hue_at(*one, draw(*one), kOn[0]).r, 0, 0.02);

  // scalars of the file: 100 n + i on line n
  const std::string table = R"("color": [[0, 1, 0, 0], [99, 1, 0, 0], [100, 0, 1, 0], [199, 0, 1, 0], [200, 0, 0, 1]])";
  const auto values = packet_of(scene_of(R"(, "color_by": {"value": "fa", )" + table + "}", R"(, "scalar_bars": [{"curves": 0}])"));
  ASSERT_TRUE(values) << values.error().message;
  const auto picture = draw(*values, {}, "values");
  EXPECT_NEAR(hue_at(*values, picture, kOn[1]).g, 1, 0.02);
  EXPECT_NEAR(hue_at(*values, picture, kOn[1]).r, 0, 0.02);
  ASSERT_EQ(values->overlay.scalar_bars.size(), 1u);
  EXPECT_EQ(values->overlay.scalar_bars[0].title, "fa");
  EXPECT_EQ(values->overlay.scalar_bars[0].colors.back()[0], 200);

  const auto lengths = packet_of(scene_of(R"(, "color_by": {"quantity": "arc_length", "color": [[0, 0, 0, 0], [2, 1, 0, 0]]})"));
  ASSERT_TRUE(lengths);
  EXPECT_NEAR(lengths->tubes[0].colors[5].r, 0.25, 1e-5);

  const auto field = packet_of(scene_of(R"(, "color_by": {"field": "x", "color": [[-1, 0, 0, 0], [1, 1, 0, 0]]})",
                                        R"(, "fields": {"x": {"analytic": "linear"}})"));
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_NEAR(field->tubes[0].colors[13].r, 0.5 + 0.5 * (0.3 + 0.4), 1e-5) << "x + y + z";
}

TEST_F(CurvePictures, ClipPlanesAndTheFitOfTheRadius) {
  const auto clipped = packet_of(scene_of("", R"(, "clip": [{"plane": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}])"));
  ASSERT_TRUE(clipped);
  const auto picture = draw(*clipped);
  EXPECT_NEAR(hue_at(*clipped, picture, {0.7, 0.4, 0}).r, 0, 0.02) << "cut away";
  const Color left = hue_at(*clipped, picture, {0, 0.7, 0.4});
  EXPECT_NEAR(left.g, 1, 0.02);
  test::write_file(folder_ / "one.tck", test::tck_bytes({{{0, 0, 0}, {3, 4, 0}}}, "Float32LE"));
  const auto fitted = packet_of(R"({"curves": [{"name": "a", "file": "one.tck"}]})");
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->tubes[0].radius, 0.003 * 5, 1e-9);
}

TEST_F(CurvePictures, VeryManyAreDrawnInPartAndSaySo) {
  // 2.2 million points: 11 lines of 200 000
  std::vector<Vec3> line;
  for (int i = 0; i < 200000; ++i) line.push_back({1e-5 * i, 0, 0});
  Polylines lines(11, line);
  test::write_file(folder_ / "many.tck", test::tck_bytes(lines, "Float32LE"));
  const auto packet = packet_of(R"({"curves": [{"name": "many", "file": "many.tck"}]})");
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->tubes.size(), 10u);
  EXPECT_EQ(packet->left_out,
            "curves \"many\": 10 of 11 lines are drawn, evenly chosen, so that they have about 2000000 points; all are felt");
}

TEST(CurveScenes, BareFilesAndInfo) {
  test::TemporaryFolder folder;
  test::write_file(folder / "a.tck", test::tck_bytes({{{0, 0, 0}, {3, 4, 0}}, {{0, 0, 0}, {0, 0, 1}}}, "Float32LE"));
  auto scene = scene::scene_for_file(folder / "a.tck");
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->notes.size(), 1u);
  EXPECT_NE(scene->notes[0].find("2 curves in the colours of their directions, red for x, green for y, blue for z"), std::string::npos);
  const auto packet = render::make_frame(*scene, 64, 48);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->tubes.size(), 2u);
  EXPECT_GT(packet->view.position.y, packet->view.target.y) << "a patient is seen from the front";
  const auto info = test::run_catena({"info", folder / "a.tck"});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_NE(info.out.find("lengths      3 mm in the mean, the longest 5 mm"), std::string::npos) << info.out;
}

TEST(CurveScenes, MessagesNameThePlace) {
  test::TemporaryFolder folder;
  test::write_file(folder / "a.tck", test::tck_bytes({{{0, 0, 0}, {3, 4, 0}}}, "Float32LE"));
  const auto message = [&](const std::string& text) {
    auto scene = scene::parse_scene(text, folder / "s.json");
    if (!scene) return scene.error().message;
    const auto packet = render::make_frame(*scene, 64, 48);
    return packet ? std::string() : packet.error().message;
  };
  const auto expect = [&](const std::string& text, const std::string& words) {
    EXPECT_NE(message(text).find(words), std::string::npos) << message(text);
    EXPECT_NE(message(text).find("s.json:1"), std::string::npos) << message(text);
  };
  expect(R"({"curves": [{"name": "a", "file": "b.tck"}]})", "does not exist; a .tck or .trk file was expected");
  expect(R"({"curves": [{"name": "a", "file": "a.tck"}, {"name": "a", "file": "a.tck"}]})", "a name of their own was expected");
  expect(R"({"curves": [{"name": "a", "file": "a.tck", "color_by": {"value": "fa"}}]})",
         "the file has no values called \"fa\"; known: none");
  expect(R"({"curves": [{"name": "a", "file": "a.tck", "color_by": {}}]})", "exactly one of them was expected");
  expect(R"({"curves": [{"name": "a", "file": "a.tck"}], "scalar_bars": [{"curves": 0}]})", "show no values");
  test::write_file(folder / "a.tck", "mrtrix tracks\n");
  expect(R"({"curves": [{"name": "a", "file": "a.tck"}]})", "a line END was expected");
}

}  // namespace curves_test
}  // namespace catena::app
