// SPDX-License-Identifier: MIT
#include "render/extract/auto_camera.h"

#include "render/passes/overlay/canvas.h"
#include "tests/render/support/scene_packet.h"
#include "tests/support/nifti_file.h"
#include "tests/support/support.h"

namespace catena::render::auto_camera_test {

const std::string kBall = R"("fields": {"s": {"analytic": "sphere", "resolution": 64, "box": [-8, 8]}})";

FramePacket packet_of(const std::string& text, std::uint32_t width = 400, std::uint32_t height = 300, const std::string& path = "s.json") {
  return test::packet_from(text, path, width, height);
}

/// Extent and centre of the projected ball of radius r about `centre`, as fractions of the image's width and height.
struct Extent {
  double width = 0, height = 0, x = 0, y = 0;
};

Extent extent_of(const FramePacket& packet, double r, const Vec3& centre = Vec3(0.0)) {
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  Bounds seen;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j <= 32; ++j) {
      const double a = i * 0.0981747704, b = j * 0.0981747704;
      const auto at = project(camera, centre + r * Vec3(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)));
      EXPECT_TRUE(at);
      if (at) seen.extend({at->x / packet.width, at->y / packet.height, 0});
    }
  const Vec3 size = seen.hi - seen.lo, middle = seen.center();
  return {size.x, size.y, middle.x, middle.y};
}

TEST(AutoCamera, ASurfaceFillsTheHeightForAnySizeOfItsBox) {
  for (const double level : {1.0, 3.0, 7.0}) {
    const FramePacket packet = packet_of("{" + kBall + R"(, "isosurfaces": [{"field": "s", "level": )" + std::to_string(level) + "}]}");
    const Extent extent = extent_of(packet, level);
    EXPECT_NEAR(extent.height, 0.88, level < 2 ? 0.05 : 0.02) << level;  // a ball with a radius of four voxels is rough
    EXPECT_NEAR(extent.x, 0.5, 0.01);
    EXPECT_NEAR(extent.y, 0.5, 0.01);
  }
  // a narrow image is filled horizontally
  const FramePacket narrow = packet_of("{" + kBall + R"(, "isosurfaces": [{"field": "s", "level": 3}]})", 200, 600);
  EXPECT_NEAR(extent_of(narrow, 3).width, 0.94, 0.02);
}

TEST(AutoCamera, FitsTheOpaquePartsOfAVolume) {
  // opaque within radius 2, nearly invisible outside
  const std::string volume = R"(, "volumes": [{"field": "s", "extinction": [[0, 5], [2, 5], [2.01, 0.0005]]}]})";
  EXPECT_NEAR(extent_of(packet_of("{" + kBall + volume), 2).height, 0.88, 0.1);
}

TEST(AutoCamera, IgnoresClippedParts) {
  const FramePacket packet = packet_of("{" + kBall + R"(, "isosurfaces": [{"field": "s", "level": 4}],
    "clip": [{"plane": {"point": [0, 0, 3.5], "normal": [0, 0, 1]}}]})");
  EXPECT_GT(packet.view.target.z, 3.4);
  EXPECT_LT(norm(packet.view.position - packet.view.target), 15);
}

TEST(AutoCamera, LeavesSpaceForAScalarBar) {
  const std::string slice = R"(, "slices": [{"field": "s", "axis": "y", "at": 0}])";
  const auto distance = [](const FramePacket& packet) { return norm(packet.view.position - packet.view.target); };
  const FramePacket plain = packet_of("{" + kBall + slice + "}", 300, 300);
  const FramePacket bar = packet_of("{" + kBall + slice + R"(, "scalar_bars": [{"slice": 0}]})", 300, 300);
  EXPECT_GT(distance(bar), 1.05 * distance(plain));
  EXPECT_NEAR(norm(bar.view.target - plain.view.target), 0, 0.5);
}

TEST(AutoCamera, LeavesSpaceForALegendWithLongNames) {
  const test::TemporaryFolder folder;
  std::string bytes, values, names;
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) bytes += static_cast<char>(std::hypot(x - 11.5, y - 11.5, z - 11.5) > 10 ? 0 : 1 + x % 20);
  for (int n = 1; n <= 20; ++n) {
    values += (n > 1 ? ", " : "") + std::to_string(n);
    names += std::string(n > 1 ? ", " : "") + "\"Cerebellum_Posterior_" + std::to_string(n) + "_L\"";
  }
  test::write_file(folder / "m.raw", bytes);
  for (const auto& [width, height] : {std::pair{1024u, 768u}, {600u, 600u}, {1600u, 900u}}) {
    const FramePacket packet = packet_of(R"({"fields": {"m": {"file": "m.raw", "shape": [24, 24, 24], "type": "uint8",
        "labels": {"values": [)" + values + R"(], "names": [)" +
                                             names + R"(]}}, "all": {"label": "*", "of": "m"}},
      "isosurfaces": [{"field": "all", "level": 0.5, "color_by": {"field": "m"}}], "scalar_bars": [{"field": "m", "title": "m"}]})",
                                         width, height, folder / "s.json");
    Typesetter typesetter;
    const Canvas canvas(packet, typesetter);
    const auto places = layout_scalar_bars(canvas, packet.overlay);
    ASSERT_EQ(places.size(), 1u);
    const Extent extent = extent_of(packet, 10.5, Vec3(11.5));
    EXPECT_LT((extent.x + 0.5 * extent.width) * width, places[0].ramp.x) << width;
    EXPECT_GT((extent.x - 0.5 * extent.width) * width, 0.03 * width);
    EXPECT_GT(extent.width * width, 0.35 * height) << "and is seen";
  }
}

TEST(AutoCamera, IgnoresOutlyingPoints) {
  const test::TemporaryFolder folder;
  std::string table = "x,y,z\n";
  for (int k = 0; k < 1000; ++k) table += std::to_string(k % 10) + "," + std::to_string(k / 10 % 10) + "," + std::to_string(k / 100) + "\n";
  test::write_file(folder / "plain.csv", table);
  test::write_file(folder / "stray.csv", table + "5000,-3000,100\n");
  const auto shown = [&](const std::string& name) {
    return packet_of(R"({"points": [{"name": "p", "file": ")" + name + R"("}]})", 400, 300, folder / "s.json");
  };
  const FramePacket plain = shown("plain.csv"), stray = shown("stray.csv");
  EXPECT_EQ(stray.spheres[0].spheres->offsets.size(), 1001u) << "it is drawn";
  EXPECT_EQ(stray.spheres[0].spheres->radii[0], plain.spheres[0].spheres->radii[0]);
  EXPECT_NEAR(norm(stray.view.position - plain.view.position), 0, 1e-9);
  EXPECT_NEAR(norm(stray.view.target - plain.view.target), 0, 1e-9);
}

TEST(AutoCamera, FitsABoundingBox) {
  const FramePacket packet = packet_of("{" + kBall + R"(, "isosurfaces": [{"field": "s", "level": 1}], "bounding_box": true})");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  for (int i = 0; i < 8; ++i) {
    const auto at = project(camera, Vec3((i & 1) != 0 ? 8 : -8, (i & 2) != 0 ? 8 : -8, (i & 4) != 0 ? 8 : -8));
    ASSERT_TRUE(at);
    EXPECT_GT(at->y, 0.05 * packet.height);
    EXPECT_LT(at->y, 0.95 * packet.height);
  }
}

TEST(AutoCamera, KeepsAStatedCamera) {
  const FramePacket packet = packet_of("{" + kBall + R"(, "isosurfaces": [{"field": "s", "level": 1}],
    "camera": {"position": [9, 8, 7], "target": [1, 2, 3]}})");
  EXPECT_EQ(packet.view.position, Vec3(9, 8, 7));
  EXPECT_EQ(packet.view.target, Vec3(1, 2, 3));
}

/// A ball of value 100 in 24^3 voxels, with the qform code `code`.
void write_nifti(const std::string& path, std::int16_t code) {
  constexpr int kSize = 24;
  catena::test::NiftiFile file({kSize, kSize, kSize}, 2, 8);
  file.put(252, code);
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) file.append(norm(Vec3(x - 11.5, y - 11.5, z - 11.5)) < 9 ? char(100) : char(0));
  catena::test::write_file(path, file.bytes());
}

TEST(AutoCamera, ViewsAPatientFromTheFront) {
  const catena::test::TemporaryFolder folder;
  for (const std::int16_t code : {std::int16_t{1}, std::int16_t{0}}) {
    const std::string name = code != 0 ? "p.nii" : "q.nii";
    write_nifti(folder / name, code);
    const FramePacket packet = packet_of(R"({"fields": {"s": {"file": ")" + name + R"("}}, "isosurfaces": [{"field": "s", "level": 50}]})",
                                         400, 300, folder / "s.json");
    const Vec3 to_camera = direction(packet.view.position - packet.view.target);
    if (code != 0)
      EXPECT_GT(to_camera.y, 0.8);
    else
      EXPECT_NEAR(norm(to_camera - default_view_direction()), 0, 1e-9);
    EXPECT_EQ(packet.view.up, Vec3(0, 0, 1));
  }
}

TEST(AutoCamera, ViewsFlatDataAlongTheirNormal) {
  const catena::test::TemporaryFolder folder;
  catena::test::write_file(folder / "t.obj", "v 0 0 0\nv 9 0 0.5\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 1 3 4\n");
  catena::test::write_file(folder / "u.obj", "v 0 0 0\nv 0.5 9 0\nv 0 9 9\nv 0 0 9\nf 1 2 3\nf 1 3 4\n");
  for (const auto& [name, axis] : {std::pair{"t.obj", 2}, {"u.obj", 0}}) {
    const FramePacket packet =
        packet_of(std::string(R"({"meshes": [{"name": "a", "file": ")") + name + R"("}]})", 400, 300, folder / "s.json");
    const Vec3 to_camera = direction(packet.view.position - packet.view.target);
    EXPECT_GT(to_camera[axis], 0.7) << name;
  }
}

TEST(VisiblePoints, LieOnTheSurface) {
  const auto ball = *field::make_analytic("sphere");
  const auto grid = field::sample_on_grid(*ball.scalar, 40, -4, 4);
  const std::vector<Vec3> places = find_visible_points(*grid, 2);
  ASSERT_GT(places.size(), 200u);
  for (const Vec3& p : places) ASSERT_NEAR(norm(p), 2, 0.03);
  EXPECT_TRUE(find_visible_points(*grid, 100).empty());
}

}  // namespace catena::render::auto_camera_test
