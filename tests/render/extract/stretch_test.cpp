// SPDX-License-Identifier: MIT
/// Stretch of the image: against the same data that are really stretched ("transform" and edited numbers), in pictures, picked positions
/// and the marks around the data.
#include "render/extract/stretch.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "engine/scene/default_scene.h"
#include "render/extract/extract.h"
#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/results.h"

namespace catena::render::stretch_test {

using test::value_of;

const Vec3 kStretch(2, 1, 0.5);

/// A scene of a surface and a slice, cut by a plane. `stretched`: by "stretch", else the data are.
scene::Scene open(const test::TemporaryFolder& folder, bool stretched) {
  const auto grid = test::make_grid(
      {17, 17, 17}, [](const Vec3& i) { return norm(i - Vec3(9, 8, 7)) + 0.3 * i.x; },
      field::Mapping::from_linear(Mat3(0.125), Vec3(-1.0)));
  const Vec3 s = stretched ? Vec3(1.0) : kStretch;
  const Vec3 point = s * Vec3(0.3, 0, 0), normal = Vec3(-1, 0.2, 0.3) / s;
  const Vec3 slice = Vec3(0.1, 0.2, 1) / s;
  const std::string text = fmt::format(
      R"({{"fields": {{"f": {{"file": "f.vdb"{}}}}},
          "isosurfaces": [{{"field": "f", "level": 5}}],
          "slices": [{{"field": "f", "point": [0, 0, 0], "normal": [{}, {}, {}]}}],
          "clip": [{{"plane": {{"point": [{}, {}, {}], "normal": [{}, {}, {}]}}}}]{}}})",
      stretched ? "" : R"(, "transform": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0.5, 0], [0, 0, 0, 1]])", slice.x, slice.y, slice.z, point.x,
      point.y, point.z, normal.x, normal.y, normal.z, stretched ? R"(, "stretch": [2, 1, 0.5])" : "");
  scene::FieldOverride data{"f", "", "", {}};
  data.in_memory_field.scalar =
      stretched ? grid
                : grid->with_mapping(field::Mapping::from_linear(Mat3(0.25, 0, 0, 0, 0.125, 0, 0, 0, 0.0625), kStretch * Vec3(-1.0)));
  return value_of(scene::parse_scene(text, folder / "s.json", {data}));
}

TEST(Stretch, ThePictureIsThatOfStretchedData) {
  const test::TemporaryFolder folder;
  scene::Scene with = open(folder, true), data = open(folder, false);
  auto renderer = test::make_renderer();
  const FramePacket first = value_of(make_frame(with, 160, 120)), second = value_of(make_frame(data, 160, 120));
  value_of(renderer->draw(first, {}));
  const Image8 a = value_of(renderer->read_back());
  value_of(renderer->draw(second, {}));
  const Image8 b = value_of(renderer->read_back());
  test::save_picture(a, "stretched", false);
  int different = 0, drawn = 0;
  for (std::uint32_t y = 0; y < 120; ++y)
    for (std::uint32_t x = 0; x < 160; ++x) {
      drawn += b.pixel(x, y)[0] > 40;
      different += std::abs(a.pixel(x, y)[0] - b.pixel(x, y)[0]) > 2;
    }
  EXPECT_GT(drawn, 1000);
  EXPECT_LE(different, 4);
  EXPECT_EQ(renderer->stats().validation_messages, 0u);
  // the same grid is kept from frame to frame, or it would be uploaded again
  EXPECT_EQ(value_of(make_frame(with, 160, 120)).isosurfaces[0].grid, first.isosurfaces[0].grid);

  // positions on the screen are those of the world
  const Camera camera = make_camera(first.view, 160, 120, Bounds()), display = make_display_camera(first.view, 160, 120, Bounds());
  const Vec3 p(0.3, -0.4, 0.7), at = *project(camera, p);
  EXPECT_LT(norm(at - *project(display, kStretch * p)), 1e-12);
  EXPECT_LT(norm(unproject(camera, at.x, at.y, at.z) - p), 1e-12);
  const Ray ray = pixel_ray(camera, at.x, at.y);
  EXPECT_LT(norm(cross(p - ray.origin, ray.direction)), 1e-12);
}

TEST(Stretch, MarksKeepTheNumbersOfTheWorld) {
  scene::Scene scene = value_of(scene::parse_scene(R"({"fields": {"f": {"analytic": "sphere", "box": [0, 10], "resolution": 9}},
      "isosurfaces": [{"field": "f", "level": 5}], "axes": true, "labels": [{"text": "here", "at": [10, 10, 10]}],
      "widgets": [{"name": "r", "type": "ruler", "from": [0, 0, 0], "to": [0, 0, 10]}], "stretch": [1, 1, 0.1]})",
                                                   "s.json"));
  const FramePacket packet = value_of(make_frame(scene, 100, 100));
  EXPECT_LT(norm(packet.overlay.labels[0].position - Vec3(10, 10, 1)), 1e-12);
  EXPECT_EQ(packet.overlay.labels.back().text, "10 units") << "a ruler measures the world";
  const auto is = [](const std::string& text) { return [=](const LabelItem& label) { return label.text == text; }; };
  const auto& marks = packet.overlay.axis_labels;
  EXPECT_EQ(std::ranges::count_if(marks, is("10")), 3) << "z ends at 10, too";
  EXPECT_EQ(std::ranges::count_if(marks, is("z (× 0.1)")), 1);
  EXPECT_NEAR(packet_bounds(packet).hi.z, 1, 1e-9);
}

TEST(Stretch, RefusesFactorsThatAreNotPositive) {
  for (const char* factors : {"[1, 1, 0]", "[1, -1, 1]", "[1, 1]", "2", "[1e-6, 1, 1e6]"}) {
    const auto scene = scene::parse_scene(std::string(R"({"fields": {}, "stretch": )") + factors + "}", "s.json");
    ASSERT_FALSE(scene) << factors;
    EXPECT_NE(scene.error().message.find("stretch"), std::string::npos);
  }
}

TEST(Stretch, OnlyAxesOfOtherUnitsAreStretchedInAFirstLook) {
  const auto chosen = [](const Vec3& edges, const field::Index3& size) {
    const Mat3 linear(edges.x, 0, 0, 0, edges.y, 0, 0, 0, edges.z);
    return scene::choose_stretch(*test::make_grid(
        size, [](const Vec3& i) { return i.x; }, field::Mapping::from_linear(linear, Vec3(0.0))));
  };
  EXPECT_EQ(chosen({1, 1, 1}, {40, 4, 4}), Vec3(1.0)) << "a rod";
  EXPECT_EQ(chosen({0.2, 0.2, 2}, {50, 50, 5}), Vec3(1.0)) << "a microscope's stack";
  const Vec3 ocean = chosen({1, 1, 100}, {37, 19, 51});  // degrees and meters
  EXPECT_EQ(Vec3(ocean.x, ocean.y, 1), Vec3(1.0));
  EXPECT_EQ(ocean.z, 0.002);
  EXPECT_EQ(chosen({1, 1, 0.001}, {37, 19, 101}).z, 50);
}

}  // namespace catena::render::stretch_test
