// SPDX-License-Identifier: MIT
// Orthogonal views: frames of the planes, their common scale, and the page that is rendered from them.
#include "render/extract/plane_views.h"

#include <gtest/gtest.h>

#include "render/extract/extract.h"
#include "render/frame/camera.h"
#include "render/passes/renderer.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/nifti_file.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::render::plane_views_test {

using test::value_of;

/// A NIfTI grid of 20 x 16 x 12 voxels of 1 x 2 x 3 mm; voxel values are 100 where i > 9, with a bright voxel block at the patient's left,
/// front and top. `sform`: world from voxel, row by row.
std::string nifti(const std::array<float, 12>& sform) {
  test::NiftiFile file({20, 16, 12}, 16, 32);
  file.put(123, std::uint8_t{2});  // millimeters
  file.put(254, std::int16_t{1});
  for (std::size_t k = 0; k < 12; ++k) file.put(280 + 4 * k, sform[k]);
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 20; ++i) file.append(i < 5 && j > 11 && k > 8 ? 200.f : 50.f);
  return file.bytes();
}

class PlaneViews : public testing::Test {
 protected:
  scene::Scene open(const std::array<float, 12>& sform) {
    test::write_file(folder_ / "t1.nii", nifti(sform));
    test::write_file(folder_ / "s.json", R"({"fields": {"t1": {"file": "t1.nii"}}, "isosurfaces": [{"field": "t1", "level": 120}]})");
    return value_of(scene::read_scene(folder_ / "s.json"));
  }
  test::TemporaryFolder folder_;
};

// The first voxels are at the patient's left: x decreases with i.
constexpr std::array<float, 12> kLeftFirst{-1, 0, 0, 10, 0, 2, 0, -16, 0, 0, 3, -18};

TEST_F(PlaneViews, PatientPlanesAreRadiologicalAndShareOneScale) {
  scene::Scene scene = open(kLeftFirst);
  FramePacket packet = value_of(make_frame(scene, 200, 150));
  const OrthoPlanes planes = value_of(find_ortho_planes(scene));
  value_of(add_plane_views(scene, planes, {.focus = Vec3(5, 8, 9)}, packet));
  ASSERT_EQ(packet.planes.size(), 3u);
  EXPECT_EQ(packet.planes[0]->overlay.texts.front().text, "50 .. 200") << "window of values";
  const char* names[] = {"axial", "coronal", "sagittal"};
  const char* texts[] = {"axial 9 mm", "coronal 8 mm", "sagittal 5 mm"};
  const Vec3 backs[] = {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}};
  for (std::size_t k = 0; k < 3; ++k) {
    const FramePacket& plane = *packet.planes[k];
    EXPECT_EQ(planes.frames[k].name, names[k]);
    EXPECT_LT(norm(planes.frames[k].back - backs[k]), 1e-12) << names[k];
    EXPECT_EQ(plane.view.height, packet.planes[0]->view.height);
    EXPECT_EQ(plane.overlay.texts.back().text, std::string(texts[k]));
    ASSERT_EQ(plane.slices.size(), 1u);
    EXPECT_NEAR(dot(plane.slices[0].normal, plane.slices[0].point - Vec3(5, 8, 9)), 0, 1e-12);
    // the whole box is in the image
    const Camera camera = make_camera(plane.view, plane.width, plane.height, Bounds());
    for (const Vec3& corner : planes.corners) {
      const Vec3 p = *project(camera, corner);
      EXPECT_TRUE(p.x > 0 && p.x < 200 && p.y > 0 && p.y < 150) << names[k];
    }
  }
  // the patient's right is on the left of the axial image, the front on top
  const Camera axial = make_camera(packet.planes[0]->view, 200, 150, Bounds());
  EXPECT_LT(project(axial, {9, 0, 0})->x, project(axial, {-9, 0, 0})->x);
  EXPECT_LT(project(axial, {0, 9, 0})->y, project(axial, {0, -9, 0})->y);
}

TEST_F(PlaneViews, AVolumeWithAThresholdLiesOverTheImageWithItsColors) {
  open(kLeftFirst);
  test::write_file(folder_ / "o.json", R"({"fields": {"t1": {"file": "t1.nii"}, "z": {"file": "t1.nii"}},
      "isosurfaces": [{"field": "t1", "level": 120}],
      "volumes": [{"field": "z", "color": "cool-warm", "range": [-200, 200], "threshold": [[-200, -150], [150, 200]]}]})");
  scene::Scene scene = value_of(scene::read_scene(folder_ / "o.json"));
  FramePacket packet = value_of(make_frame(scene, 200, 150));
  const OrthoPlanes planes = value_of(find_ortho_planes(scene));
  EXPECT_EQ(planes.base, scene::find_field(scene, "t1"));
  value_of(add_plane_views(scene, planes, {}, packet));
  ASSERT_EQ(packet.planes[0]->slices.size(), 2u);
  const SliceItem& over = packet.planes[0]->slices[1];
  EXPECT_EQ(over.threshold, (Threshold{{-200, -150}, {150, 200}}));
  EXPECT_EQ(over.colors.front()[0], -200);
  EXPECT_GT(over.colors.front()[3], over.colors.front()[1]) << "blue";
}

TEST_F(PlaneViews, ObliqueAcquisitionsKeepTheirOwnAxes) {
  // turned by 20 degrees about z, and by a half turn about x
  const float c = 0.9397f, s = 0.3420f;
  scene::Scene scene = open({c, 2 * s, 0, 0, s, -2 * c, 0, 0, 0, 0, -3, 0});
  value_of(make_frame(scene, 64, 64));
  const OrthoPlanes planes = value_of(find_ortho_planes(scene));
  EXPECT_LT(norm(planes.frames[0].right - Vec3(-c, -s, 0)), 1e-3);
  EXPECT_LT(norm(planes.frames[0].up - Vec3(-s, c, 0)), 1e-3) << "the axis that points to the front";
  for (const PlaneFrame& frame : planes.frames) EXPECT_LT(norm(cross(frame.right, frame.up) - frame.back), 1e-12);
}

TEST_F(PlaneViews, ThePageShowsThePlanesBesideTheView) {
  scene::Scene scene = open(kLeftFirst);
  FramePacket packet = value_of(make_frame(scene, 100, 80));
  auto renderer = test::make_renderer();
  value_of(renderer->draw(packet, {}));
  const Image8 alone = value_of(renderer->read_back());
  // the left of the patient, x < 0, is bright: the focus is in the block
  const OrthoPlanes planes = value_of(find_ortho_planes(scene));
  value_of(add_plane_views(scene, planes, {.focus = Vec3(8, 12, 12)}, packet));
  for (int turn = 0; turn < 2; ++turn) {
    value_of(renderer->draw(packet, {}));
    const Image8 page = value_of(renderer->read_back());
    ASSERT_EQ(page.width, 200u);
    ASSERT_EQ(page.height, 160u);
    int different = 0;
    for (std::uint32_t y = 0; y < 80; ++y)
      for (std::uint32_t x = 0; x < 100; ++x) different += std::memcmp(page.pixel(100 + x, y), alone.pixel(x, y), 4) != 0;
    EXPECT_EQ(different, 0) << "the 3D view is at the top right, unchanged";
    const Camera axial = make_camera(packet.planes[0]->view, 100, 80, Bounds());
    const auto gray_at = [&](const Vec3& p) {
      const Vec3 at = *project(axial, p);
      return int(page.pixel(std::uint32_t(at.x), std::uint32_t(at.y))[0]);
    };
    EXPECT_GT(gray_at({7, 11, 12}), 240) << "bright";
    EXPECT_LT(gray_at({-5, -9, 12}), 15) << "dark";
  }
  EXPECT_EQ(renderer->stats().validation_messages, 0u);
}

TEST_F(PlaneViews, TheirStateIsReadAndWritten) {
  const auto read = [](const std::string& views) {
    return scene::parse_scene(R"({"fields": {"v": {"analytic": "sphere"}}, "orthogonal_views": )" + views + "}", "s.json");
  };
  const scene::OrthogonalViews state{Vec3(1, -2, 0.1), std::array{-5.0, 40.0}, 3, std::nullopt};
  EXPECT_EQ(value_of(read(scene::to_json(state))).orthogonal_views, state);
  EXPECT_EQ(value_of(read("{}")).orthogonal_views, scene::OrthogonalViews());
  for (const char* bad : {R"({"window": [4, 4]})", R"({"zoom": 0})", R"({"focus": [1, 2]})", R"({"middle": [1, 2, 3]})", "[]"}) {
    const auto scene = read(bad);
    ASSERT_FALSE(scene) << bad;
    EXPECT_NE(scene.error().message.find("s.json:1: "), std::string::npos);
  }
}

TEST_F(PlaneViews, ASceneWithoutScalarFieldIsRefused) {
  scene::Scene scene = value_of(scene::parse_scene(R"({"fields": {"v": {"analytic": "circle"}}})", "s.json"));
  const auto planes = find_ortho_planes(scene);
  ASSERT_FALSE(planes);
  EXPECT_NE(planes.error().message.find("scalar field"), std::string::npos);
}

}  // namespace catena::render::plane_views_test
