// SPDX-License-Identifier: MIT
#include "render/extract/extract.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/render/support/scene_packet.h"
#include "tests/support/support.h"

namespace catena::render::extract_test {

using test::packet_error, test::packet_from, test::scene_from;

const std::string kSphere = R"("s": {"analytic": "sphere", "resolution": 9})", kCircle = R"("v": {"analytic": "circle"})";

/// A scene of the fields and of what follows them.
std::string scene_text(const std::string& fields, const std::string& parts) { return R"({"fields": {)" + fields + "}, " + parts + "}"; }

scene::Cursor& show_cursor(scene::Scene& scene, const Vec3& probe) {
  scene::Cursor& cursor = scene.entities.get<scene::Cursor>(scene.cursor);
  cursor.visible = true;
  cursor.probe = probe;
  return cursor;
}

TEST(Extract, AnEmptySceneGivesABackgroundAndAView) {
  const FramePacket packet = packet_from(R"({"fields": {}, "chain": [], "background": [0.1, 0.2, 0.3]})");
  EXPECT_EQ(packet.background, (std::array<float, 4>{0.1f, 0.2f, 0.3f, 1.0f}));
  EXPECT_TRUE(packet.volumes.empty() && packet.isosurfaces.empty() && packet.tubes.empty() && packet.cursors.empty());
  EXPECT_TRUE(is_finite(packet.view.position));
}

TEST(Extract, AMeshIsOneObjectInEveryFrame) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
  scene::Scene scene = scene_from(
      R"({"meshes": [{"name": "a", "file": "quad.obj", "color": [1, 0, 0]}, {"name": "b", "file": "quad.obj", "visible": false}]})",
      folder / "s.json");
  const FramePacket one = packet_from(scene), two = packet_from(scene);
  ASSERT_EQ(one.meshes.size(), 1u);
  EXPECT_EQ(one.meshes[0].geometry, two.meshes[0].geometry);
  EXPECT_EQ(one.meshes[0].geometry->triangles.size(), 6u);
  EXPECT_EQ(one.meshes[0].color.r, 1.0f);
  // the fitted camera looks at the mesh's centre in the image
  EXPECT_LE(norm(one.view.target - Vec3(1, 0.5, 0)), 0.2);
  EXPECT_NEAR(packet_bounds(one).diagonal(), std::sqrt(5.0), 1e-12);
}

TEST(Extract, TransparentBackgroundHasNoAlpha) {
  EXPECT_EQ(packet_from(R"({"fields": {}, "chain": [], "background": "transparent"})").background[3], 0.0f);
}

TEST(Extract, FogSpansTheDrawnObjectsAtAnyScale) {
  for (const double size : {1.0, 1e-9, 1e-12, 1e9}) {
    const test::TemporaryFolder folder;
    test::write_file(folder / "t.obj", fmt::format("v 0 0 0\nv {0:g} 0 0\nv 0 {0:g} 0\nf 1 2 3\n", size));
    const FramePacket packet = packet_from(R"({"meshes": [{"name": "a", "file": "t.obj"}], "fog": true})", folder / "s.json");
    ASSERT_TRUE(packet.fog);
    EXPECT_GT(packet.fog->far - packet.fog->near, 0.1 * size) << size;
    EXPECT_LT(packet.fog->far - packet.fog->near, 1.5 * size) << size;
  }
}

TEST(Extract, FogAndEyesFollowAMovingView) {
  scene::Scene scene = scene_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1}], "fog": true,
      "stereo": {"mode": "left"}, "camera": {"position": [0, -10, 0], "target": [0, 0, 0]})"));
  FramePacket packet = packet_from(scene);
  ASSERT_TRUE(packet.fog);
  EXPECT_NEAR(packet.fog->near, 8, 1e-9);  // the sphere's field spans -2..2
  EXPECT_NEAR(packet.fog->far, 12, 1e-9);
  View far = packet.view;
  far.position = {0, -100, 0};
  set_view(scene, far, packet);
  EXPECT_NEAR(packet.fog->near, 98, 1e-9);
  EXPECT_NEAR(packet.fog->far, 102, 1e-9);
  ASSERT_EQ(packet.eyes.size(), 1u);
  EXPECT_LT(norm(packet.eyes[0].position - far.position), 5);
}

TEST(Extract, BoundingBoxAndAxesShareEdgesWithoutDuplicates) {
  const auto edges = [](const std::string& aids) {
    const FramePacket packet = packet_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1}], )" + aids));
    int count = 0;
    for (const TubeItem& tube : packet.environment.tubes)
      count += norm(tube.points.back() - tube.points.front()) > 3.9;  // ticks are shorter
    return count;
  };
  EXPECT_EQ(edges(R"("bounding_box": true)"), 12);
  EXPECT_EQ(edges(R"("axes": true)"), 3);
  EXPECT_EQ(edges(R"("bounding_box": true, "axes": true)"), 12);
  EXPECT_EQ(edges(R"("bounding_box": {"field": "s"}, "axes": true)"), 12);
}

TEST(Extract, OpacityIsConvertedToExtinctionAtItsPoints) {
  const FramePacket packet = packet_from(scene_text(kSphere, R"("volumes": [{"field": "s", "color": [[0, 0, 0, 0], [2, 1, 0.5, 0.25]],
                                                   "opacity": [[0, 0], [1, 0.5], [2, 0.1]], "opacity_unit": 0.25, "shade": true}])"));
  ASSERT_EQ(packet.volumes.size(), 1u);
  const VolumeItem& volume = packet.volumes[0];
  EXPECT_TRUE(volume.is_shaded);
  ASSERT_EQ(volume.transfer.extinctions.size(), 3u);
  EXPECT_EQ(volume.transfer.extinctions[0], (std::array<double, 2>{0, 0}));
  EXPECT_DOUBLE_EQ(volume.transfer.extinctions[1][1], std::log(2.0) / 0.25);
  EXPECT_DOUBLE_EQ(volume.transfer.extinctions[2][1], -std::log(0.9) / 0.25);
  EXPECT_EQ(volume.transfer.colors[1], (std::array<double, 4>{2, 1, 0.5, 0.25}));
  EXPECT_NEAR(volume.grid->max_value(), std::sqrt(12.0), 1e-6);
}

TEST(Extract, GradientFactorsReachThePacket) {
  const FramePacket packet = packet_from(scene_text(kSphere, R"("volumes": [{"field": "s", "extinction": [[1, 3]],
    "gradient_opacity": [[0, 0.25], [2, 1]]}])"));
  ASSERT_EQ(packet.volumes.size(), 1u);
  EXPECT_EQ(packet.volumes[0].transfer.gradient_factors, (std::vector<std::array<double, 2>>{{0, 0.25}, {2, 1}}));
}

TEST(Extract, LinesAreColoredByANamedMapOverARange) {
  const FramePacket packet = packet_from(scene_text(kCircle, R"("streamlines": [{"field": "v", "seeds": [[0.5, 0, 0], [1.5, 0, 0]],
    "color_by": {"quantity": "speed", "color": "grey", "range": [0, 1]}}])"));
  ASSERT_EQ(packet.tubes.size(), 2u);
  EXPECT_NEAR(packet.tubes[0].colors[0].g, 0.5, 1e-3);
  EXPECT_EQ(packet.tubes[1].colors[0].g, 1) << "beyond the range: its end";
}

TEST(Extract, TheUnitOfOpacityIsTheSmallestVoxelEdge) {
  EXPECT_DOUBLE_EQ(
      packet_from(scene_text(kSphere, R"("volumes": [{"field": "s", "opacity": [[1, 0.5]]}])")).volumes[0].transfer.extinctions[0][1],
      std::log(2.0) / 0.5);  // 4 / 8 cells
}

TEST(Extract, AVolumeWithoutATransferFunctionGetsADefault) {
  const TransferTable table = packet_from(scene_text(kSphere, R"("volumes": [{"field": "s"}])")).volumes[0].transfer;
  EXPECT_FALSE(table.colors.empty());
  EXPECT_FALSE(table.extinctions.empty());
}

TEST(Extract, IsosurfacesCarryTheirLevel) {
  const FramePacket packet =
      packet_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1.25, "color": [1, 0, 0], "opacity": 0.5}])"));
  ASSERT_EQ(packet.isosurfaces.size(), 1u);
  EXPECT_EQ(packet.isosurfaces[0].level, 1.25);
  EXPECT_EQ(packet.isosurfaces[0].color.r, 1.0f);
  EXPECT_EQ(packet.isosurfaces[0].opacity, 0.5f);
}

TEST(Extract, TubesShareTheCurveOfTheLink) {
  scene::Scene scene = scene_from(scene_text(kCircle, R"("chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0.5]}],
    "streamlines": [{"field": "v", "seeds": [[1, 0, 0.5]], "color": [0, 1, 0]}])"));
  const auto field = scene::resolve_field(scene, "v", json::Node());
  ASSERT_TRUE(field);
  const auto streamline = scene::resolve_streamline(scene, {field->vector.get()}, {1.0, 0.0, 0.5}, json::Node());
  ASSERT_TRUE(streamline);
  const FramePacket packet = packet_from(scene);
  EXPECT_EQ(scene.traced_curves.size(), 1u) << "one object for the hand and the eye";
  ASSERT_EQ(packet.tubes.size(), 1u);
  const TubeItem& tube = packet.tubes[0];
  EXPECT_NEAR(tube.radius, 0.003 * std::sqrt(48.0), 1e-12);  // L of the box -2..2
  EXPECT_EQ(tube.points.front(), tube.points.back());
  for (const Vec3& p : tube.points) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-8);

  // a second packet reuses the polyline
  EXPECT_EQ(packet_from(scene).tubes[0].points, tube.points);
}

/// Coloured by the ball's |p| with a table from black at 0 to white at 2.
TEST(Extract, TubesAreColoredByAField) {
  const FramePacket packet = packet_from(scene_text(kCircle + ", " + kSphere, R"("streamlines": [{"field": "v",
    "seeds": [[0.5, 0, 0.5], [1.5, 0, 0]], "color_by": {"field": "s", "color": [[0, 0, 0, 0], [2, 1, 1, 1]]}}])"));
  ASSERT_EQ(packet.tubes.size(), 2u);
  for (const TubeItem& tube : packet.tubes) {
    ASSERT_EQ(tube.colors.size(), tube.points.size());
    for (std::size_t i = 0; i < tube.points.size(); ++i) EXPECT_NEAR(tube.colors[i].r, norm(tube.points[i]) / 2, 1e-6);
  }
}

TEST(Extract, TheDefaultSpeedColorsCoverItsRange) {
  const FramePacket packet = packet_from(scene_text(kCircle, R"("streamlines": [{"field": "v", "color_by": {"quantity": "speed"},
    "seeds": {"line": {"from": [0.5, 0, 0], "to": [1.5, 0, 0], "count": 3}}}])"));
  ASSERT_EQ(packet.tubes.size(), 3u);
  // viridis from violet through green to yellow
  EXPECT_NEAR(packet.tubes[0].colors[0].b, 84 / 255.0, 0.01);
  EXPECT_NEAR(packet.tubes[1].colors[0].g, 145 / 255.0, 0.01);
  EXPECT_NEAR(packet.tubes[2].colors[0].r, 253 / 255.0, 0.01);
}

TEST(Extract, AStraightLineIsSubdividedForItsColors) {
  const TubeItem tube = packet_from(R"({"fields": {"v": {"analytic": "uniform"}}, "streamlines": [{"field": "v", "seeds": [[0, 0, 0]],
    "length": 2, "color_by": {"quantity": "arc_length", "color": [[-2, 0, 0, 0], [2, 1, 0, 0]]}}]})")
                            .tubes.at(0);
  EXPECT_GE(tube.points.size(), 64u);
  for (std::size_t i = 0; i < tube.points.size(); ++i) EXPECT_NEAR(tube.colors[i].r, (tube.points[i].x + 2) / 4, 1e-6);
}

TEST(Extract, ArrowsPointAlongTheLine) {
  const FramePacket packet =
      packet_from(R"({"fields": {"v": {"analytic": "uniform", "direction": [0, 0, 3]}}, "streamlines": [{"field": "v",
    "seeds": [[0, 0, 0]], "length": 2, "radius": 0.01, "arrows": 0.5, "color": [0, 1, 0]}]})");
  ASSERT_EQ(packet.arrows.size(), 8u);
  for (const ArrowItem& arrow : packet.arrows) {
    EXPECT_NEAR(norm(direction(arrow.tip - arrow.base) - Vec3(0, 0, 1)), 0, 1e-12);
    EXPECT_EQ(arrow.color.g, 1.0f);
    EXPECT_GT(arrow.radius, 0.01);
  }
  EXPECT_NEAR(0.5 * (packet.arrows[0].tip.z + packet.arrows[0].base.z), -1.75, 1e-9);
}

TEST(Extract, PulsesMoveWithThePhase) {
  scene::Scene scene = scene_from(R"({"fields": {"v": {"analytic": "uniform"}}, "streamlines": [{"field": "v", "seeds": [[0, 0, 0]],
    "length": 2, "color": [1, 0, 0], "animated_bands": 1}]})");
  const auto brightest_near = [&](double x) {
    const TubeItem tube = packet_from(scene).tubes.at(0);
    double best = 9, at = 0;
    for (std::size_t i = 0; i < tube.points.size(); ++i)
      if (std::fabs(tube.points[i].x - x) < 0.5 && 1 - tube.colors[i].r < best) {
        best = 1 - tube.colors[i].r;
        at = tube.points[i].x;
      }
    return at;
  };
  EXPECT_NEAR(brightest_near(0), 0, 0.05);
  scene.animation_phase = 0.25;
  EXPECT_NEAR(brightest_near(0), 0.25, 0.05);
}

TEST(Extract, TheIndicatorFollowsTheProbe) {
  scene::Scene scene = scene_from(scene_text(kCircle, R"("cursor": {"probe": [1, 0, 0.5]}, "indicator": {"field": "v", "length": 0.4})"));
  FramePacket packet = packet_from(scene);
  ASSERT_EQ(packet.indicators.size(), 1u);
  const IndicatorItem& item = packet.indicators[0];
  EXPECT_NEAR(item.tube.points.front().y, -std::sin(0.2), 1e-5);
  EXPECT_NEAR(item.tube.points.back().y, std::sin(0.2), 1e-5);
  EXPECT_GT(dot(item.arrow.tip - item.arrow.base, Vec3(0, 1, 0)), 0);
  scene.entities.get<scene::Cursor>(scene.cursor).probe = {0, 0, 0};
  EXPECT_TRUE(packet_from(scene).indicators.empty()) << "no line goes through the axis";
}

TEST(Extract, AnIndicatorAheadStartsAtTheProbe) {
  const FramePacket packet =
      packet_from(scene_text(kCircle, R"("cursor": {"probe": [1, 0, 0.5]}, "indicator": {"field": "v", "length": 0.4, "anchor": "tail"})"));
  ASSERT_EQ(packet.indicators.size(), 1u);
  const IndicatorItem& item = packet.indicators[0];
  EXPECT_LT(norm(item.tube.points.front() - Vec3(1, 0, 0.5)), 1e-9);
  // counter-clockwise about the axis, 0.4 along the unit circle
  EXPECT_LT(norm(item.arrow.base - Vec3(std::cos(0.4), std::sin(0.4), 0.5)), 1e-6);
}

TEST(Extract, LinksAreNotDrawnByDefault) {
  scene::Scene scene =
      scene_from(scene_text(kCircle, R"("chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}])"));
  EXPECT_TRUE(packet_from(scene).tubes.empty());
  EXPECT_TRUE(scene.traced_curves.empty()) << "and nothing is loaded or traced for the eye";
}

TEST(Extract, TheCursorIsExtractedWhenVisible) {
  scene::Scene scene = scene_from(scene_text(kCircle, R"("streamlines": [{"field": "v", "seeds": [[1, 0, 0]], "radius": 0.5}])"));
  EXPECT_TRUE(packet_from(scene).cursors.empty());
  scene::Cursor& cursor = show_cursor(scene, {1.0, 2.0, 3.0});
  cursor.proxies = {{0.0, 0.0, 1.0}, {0.0, 0.0, 2.0}};
  cursor.active = {true};
  cursor.force_n = {0.0, 0.0, 1.0};
  const FramePacket packet = packet_from(scene);
  ASSERT_EQ(packet.cursors.size(), 1u);
  EXPECT_EQ(packet.cursors[0].probe, cursor.probe);
  EXPECT_EQ(packet.cursors[0].proxies, cursor.proxies);
  EXPECT_EQ(packet.cursors[0].link_active.size(), 2u);
  EXPECT_GT(packet.cursors[0].radius * 0.7, 0.5) << "every proxy's ball covers the tube it sits on";

  cursor.size = 0.25;
  EXPECT_EQ(packet_from(scene).cursors[0].radius, 0.25);
  cursor.probe.x = std::nan("");
  EXPECT_TRUE(packet_from(scene).cursors.empty());
}

/// A late update changes only the cursor's state; its appearance, its size and the rest of the packet stay.
TEST(Extract, UpdatingCursorsChangesOnlyTheCursor) {
  scene::Scene scene = scene_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1}],
    "cursor": {"drop_line": true})"));
  scene::Cursor& cursor = show_cursor(scene, {0.1, 0.2, 0.3});
  cursor.proxies = {{0.0, 0.0, 1.0}};
  FramePacket packet = packet_from(scene);
  const CursorItem before = packet.cursors.at(0);
  cursor.probe = {0.4, 0.2, 0.5};
  cursor.proxies = {{0.0, 0.5, 1.0}};
  cursor.force_n = {0.0, 2.0, 0.0};
  const FramePacket anew = packet_from(scene);
  update_cursors(scene, packet);
  EXPECT_NE(packet.cursors, std::vector{before});
  EXPECT_EQ(packet.cursors, anew.cursors);
  EXPECT_EQ(packet.cursors[0].radius, before.radius);
  EXPECT_EQ(packet.objects.size(), anew.objects.size());
  cursor.visible = false;
  update_cursors(scene, packet);
  EXPECT_EQ(packet.cursors, anew.cursors) << "another packet is made for that";
}

TEST(Extract, ADropLineEndsOnTheFloor) {
  const auto foot = [](const std::string& more, const Vec3& probe) {
    scene::Scene scene = scene_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1}])" + more));
    show_cursor(scene, probe);
    const FramePacket packet = packet_from(scene);
    EXPECT_EQ(packet.cursors.size(), 1u);
    EXPECT_TRUE(packet.cursors[0].show_occluded);
    return packet.cursors[0].foot_point;
  };
  const Vec3 probe(0.1, 0.2, 0.3);
  scene::Scene scene = scene_from(scene_text(kSphere, R"("isosurfaces": [{"field": "s", "level": 1}])"));
  const Bounds box = data_bounds(packet_from(scene));
  const std::string line = R"(, "cursor": {"drop_line": true})";
  EXPECT_EQ(foot("", probe), std::nullopt);
  EXPECT_EQ(foot(line, probe), Vec3(0.1, 0.2, box.lo.z));
  EXPECT_EQ(foot(line, {0.1, 0.2, box.lo.z - 0.1}), std::nullopt) << "the hand is below the floor";
  // down is opposite to the world axis nearest to the view's up; a ground is perpendicular to z
  const std::string camera = R"(, "camera": {"position": [0, 0, 9], "target": [0, 0, 0], "up": [0.3, -1, 0]})";
  EXPECT_EQ(foot(line + camera, probe), Vec3(0.1, box.hi.y, 0.3));
  EXPECT_EQ(foot(line + camera + R"(, "ground": {"height": -7})", probe), Vec3(0.1, 0.2, -7));
  EXPECT_LT(foot(line + R"(, "ground": true)", probe)->z, box.lo.z);
  // a scene without drawn objects
  scene::Scene empty = scene_from("{\"cursor\": {\"probe\": [0, 0, 1], \"drop_line\": true, \"show_occluded\": false}}");
  EXPECT_EQ(packet_from(empty).cursors[0].foot_point, std::nullopt);
  EXPECT_FALSE(packet_from(empty).cursors[0].show_occluded);
}

TEST(Extract, TheFittedCameraSeesEverything) {
  const FramePacket packet = packet_from(scene_text(
      kSphere + "," + kCircle, R"("isosurfaces": [{"field": "s", "level": 1}], "streamlines": [{"field": "v", "seeds": [[1, 0, 5]]}])"));
  const Bounds bounds = packet_bounds(packet);
  EXPECT_GT(bounds.hi.z, 5);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, bounds);
  std::vector<Vec3> seen{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const TubeItem& tube : packet.tubes) seen.insert(seen.end(), tube.points.begin(), tube.points.end());
  ASSERT_GT(seen.size(), 20u);
  for (const Vec3& place : seen) {
    const auto p = project(camera, place);
    ASSERT_TRUE(p);
    EXPECT_TRUE(p->x > 10 && p->x < 310 && p->y > 10 && p->y < 230);
    EXPECT_TRUE(p->z > camera.near && p->z < camera.far);
  }
}

TEST(Extract, AStatedCameraIsUsedUnchanged) {
  const View view =
      packet_from(
          R"({"fields": {}, "camera": {"position": [1, 2, 3], "target": [4, 5, 6], "up": [0, 1, 0], "projection": "orthographic", "height": 7}})")
          .view;
  EXPECT_EQ(view.position, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(view.target, Vec3(4.0, 5.0, 6.0));
  EXPECT_EQ(view.up, Vec3(0.0, 1.0, 0.0));
  EXPECT_TRUE(view.orthographic);
  EXPECT_EQ(view.height, 7);
}

TEST(Extract, ErrorsNameTheLineAndTheExpectation) {
  const struct {
    std::string fields, parts, line, expected;
  } cases[] = {
      {kCircle, "\n\"volumes\": [{\"field\": \"v\"}]", "2", "expected a scalar field"},
      {kSphere, "\n\n\"streamlines\": [{\"field\": \"s\", \"seeds\": [[1, 0, 0]]}]", "3", "a vector field was expected"},
      {kSphere, "\n\"isosurfaces\": [{\"field\": \"s\",\n\"level\": 17}]", "3", ""},
      {kCircle, "\n\"streamlines\": [{\"field\": \"v\", \"seeds\": [[1, 0, 0],\n[0, 0, 0]]}]", "3", ""},
      {kCircle, "\"streamlines\": [{\"field\": \"v\", \"seeds\": [[1, 0, 0]],\n\"arrows\": 1e-6}]", "2", "longer spacing was expected"}};
  for (const auto& c : cases) {
    const std::string e = packet_error(scene_text(c.fields, c.parts), "test.json");
    EXPECT_NE(e.find("test.json:" + c.line + ":"), std::string::npos) << e;
    EXPECT_NE(e.find(c.expected), std::string::npos) << e;
  }
}

}  // namespace catena::render::extract_test
