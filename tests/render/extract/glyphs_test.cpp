// SPDX-License-Identifier: MIT
// Glyphs in the packet against closed forms: position, direction, length and colour; invalid regions; glyphs on moving objects.
#include <cmath>

#include "engine/field/grid/grid.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/document.h"
#include "engine/scene/prepare.h"
#include "engine/scene/widgets.h"
#include "tests/render/support/scene_packet.h"

namespace catena::render::glyphs_test {

constexpr const char* kHead = R"({"fields": {"v": {"analytic": "circle", "resolution": 9}, "s": {"analytic": "sphere", "resolution": 33},
  "w": {"analytic": "uniform", "direction": [0, 0, 3]}}, )";

scene::Scene scene_of(const std::string& parts) { return test::scene_from(kHead + parts + "}"); }

FramePacket packet_of(scene::Scene& scene) { return test::packet_from(scene, 64, 48); }

std::vector<Glyph> glyphs_of(scene::Scene& scene) {
  const FramePacket packet = packet_of(scene);
  return packet.glyphs.empty() ? std::vector<Glyph>() : packet.glyphs[0].glyphs.list();
}

std::vector<Glyph> glyphs_of(const std::string& parts) {
  scene::Scene scene = scene_of(parts);
  return glyphs_of(scene);
}

/// Checks that glyphs are refused with a message that contains `part`.
void expect_error(const std::string& parts, const std::string& part) {
  const std::string error = test::packet_error(kHead + parts + "}");
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

Vec3 middle(const Glyph& glyph) { return 0.5 * (glyph.tail + glyph.tip); }

TEST(ExtractGlyphs, DirectionAndLengthFollowTheField) {
  // (-y, x, 0) on the square -2..2: the longest glyph has the stated length, the others are proportional to the speed
  const auto glyphs = glyphs_of(R"("glyphs": [{"field": "v", "on": {"plane": {"axis": "z", "at": 0.5}}, "spacing": 0.4, "length": 0.6}])");
  ASSERT_GT(glyphs.size(), 90u);
  double fastest = 0;
  for (const Glyph& glyph : glyphs) fastest = std::max(fastest, norm(Vec3(middle(glyph).x, middle(glyph).y, 0)));
  for (const Glyph& glyph : glyphs) {
    const Vec3 p = middle(glyph), v(-p.y, p.x, 0);
    EXPECT_NEAR(p.z, 0.5, 1e-12);
    EXPECT_LT(norm(glyph.tip - glyph.tail - 0.6 / fastest * v), 1e-12);
    EXPECT_GT(norm(v), 0.3) << "none where the flow stands";
  }
}

TEST(ExtractGlyphs, ScaleLengthAnchorAndMinimumSpeed) {
  const std::string head = R"("glyphs": [{"field": "v", "on": {"plane": {"axis": "z", "at": 0}}, "spacing": 0.5, )";
  for (const Glyph& glyph : glyphs_of(head + R"("scale": "constant"}])")) EXPECT_NEAR(norm(glyph.tip - glyph.tail), 0.5, 1e-12);
  const auto full = glyphs_of(head + R"("reference_speed": 1, "length": 0.25}])");
  for (const Glyph& glyph : full) EXPECT_NEAR(norm(glyph.tip - glyph.tail), 0.25 * norm(middle(glyph)), 1e-12);
  const auto tails = glyphs_of(head + R"("anchor": "tail"}])"), heads = glyphs_of(head + R"("anchor": "head"}])");
  ASSERT_EQ(tails.size(), full.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    EXPECT_LT(norm(tails[i].tail - middle(full[i])), 1e-12);
    EXPECT_LT(norm(heads[i].tip - middle(full[i])), 1e-12);
  }
  for (const Glyph& glyph : glyphs_of(head + R"("min_speed": 1.5}])")) EXPECT_GT(norm(middle(glyph)), 1.5);
}

TEST(ExtractGlyphs, TheShapeFollowsTheRadiusAndALineHasNoHead) {
  const std::string head = R"("glyphs": [{"field": "w", "spacing": 1, "length": 0.5, )";
  scene::Scene scene = scene_of(head + R"("radius": 0.02, "clip": false}])"), line = scene_of(head + R"("kind": "line"}])");
  const FramePacket arrows = packet_of(scene), rods = packet_of(line);
  ASSERT_EQ(arrows.glyphs.size(), 1u);
  const GlyphItem& item = arrows.glyphs[0];
  EXPECT_EQ(item.glyphs.size(), 5u * 5 * 5);
  EXPECT_NEAR(item.shaft_radius, 0.04, 1e-12);
  EXPECT_NEAR(item.head_length, 0.24, 1e-12);
  EXPECT_NEAR(item.head_radius, 0.096, 1e-12);
  EXPECT_FALSE(item.is_clipped);
  EXPECT_EQ(arrows.objects[item.id - 1].kind, "glyphs");
  EXPECT_EQ(arrows.objects[item.id - 1].name, "w");
  EXPECT_EQ(arrows.objects[item.id - 1].scene_path, "glyphs[0]");
  EXPECT_NEAR(norm(item.glyphs[0].tip - item.glyphs[0].tail - Vec3(0, 0, 0.5)), 0, 1e-12);
  ASSERT_EQ(rods.glyphs.size(), 1u);
  EXPECT_EQ(rods.glyphs[0].head_length, 0);
  const Vec3 rod = rods.glyphs[0].glyphs[0].tip - rods.glyphs[0].glyphs[0].tail;
  EXPECT_NEAR(std::fabs(rod.z), 0.5, 1e-12) << "of either sign";
  EXPECT_NEAR(packet_bounds(arrows).hi.z, 2.25, 1e-12);
}

TEST(ExtractGlyphs, ColorsAreThoseOfTheMap) {
  scene::Scene scene = scene_of(R"("glyphs": [{"field": "v", "on": {"plane": {"axis": "z", "at": 0}}, "spacing": 0.5,
      "color_by": {"quantity": "speed", "color": [[0, 0, 0, 0], [2, 1, 0.5, 0]]}},
    {"field": "v", "on": {"plane": {"axis": "z", "at": 0}}, "spacing": 0.5, "color_by": {"field": "s", "color": "magma"}}],
    "scalar_bars": [{"glyphs": 0}, {"glyphs": 1}])");
  const FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.glyphs.size(), 2u);
  double lo = HUGE_VAL, hi = 0;
  for (const Glyph& glyph : packet.glyphs[0].glyphs) {
    const double speed = norm(middle(glyph)), share = std::min(1.0, speed / 2);
    EXPECT_NEAR(glyph.color.r, share, 1e-6);
    EXPECT_NEAR(glyph.color.g, 0.5 * share, 1e-6);
    lo = std::min(lo, speed);
    hi = std::max(hi, speed);
  }
  // the speed is the distance from the origin; the map covers the drawn speeds
  const auto map = scene::make_color_map("magma", lo, hi);
  for (const Glyph& glyph : packet.glyphs[1].glyphs) {
    const double value = norm(middle(glyph));
    std::size_t k = 1;
    while (k + 1 < map.size() && map[k].value < value) ++k;
    const double t = (value - map[k - 1].value) / (map[k].value - map[k - 1].value);
    EXPECT_NEAR(glyph.color.r, map[k - 1].color.r + t * (map[k].color.r - map[k - 1].color.r), 1e-4);
  }
  ASSERT_EQ(packet.overlay.scalar_bars.size(), 2u);
  EXPECT_EQ(packet.overlay.scalar_bars[0].title, "|v|");
  EXPECT_EQ(packet.overlay.scalar_bars[0].colors.back()[0], 2);
  EXPECT_EQ(packet.overlay.scalar_bars[1].title, "s");
  EXPECT_NEAR(packet.overlay.scalar_bars[1].colors.front()[0], lo, 1e-9);
  EXPECT_NEAR(packet.overlay.scalar_bars[1].colors.back()[0], hi, 1e-9);
}

TEST(ExtractGlyphs, InvalidRegionsHaveNoGlyphs) {
  // x >= 0 of -2..2 is valid, with one NaN voxel
  std::vector<float> values;
  std::vector<std::uint8_t> valid;
  const field::Mapping mapping = field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0));
  for (int i = 0; i < 17 * 17 * 17; ++i) {
    const bool hole = i == 12 + 17 * (8 + 17 * 8);
    values.insert(values.end(), {hole ? NAN : 1.0f, 0.5f, 0.0f});
    valid.push_back(i % 17 >= 8);
  }
  scene::Scene scene = scene_of(R"("glyphs": [{"field": "v", "spacing": 0.25}])");
  scene::FieldSource& source = scene.entities.get<scene::FieldSource>(scene::find_field(scene, "v"));
  source.loaded.vector = field::make_vector_grid("v", mapping, {17, 17, 17}, values, valid);
  source.rendered = source.loaded;
  std::size_t in_hole = 0;
  const auto glyphs = glyphs_of(scene);
  for (const Glyph& glyph : glyphs) {
    EXPECT_GT(middle(glyph).x, -1e-9);
    in_hole += max_abs(middle(glyph) - Vec3(1, 0, 0)) < 0.2;
  }
  EXPECT_EQ(in_hole, 0u);
  EXPECT_NEAR(static_cast<double>(glyphs.size()), 9 * 17 * 17, 30) << "half of the lattice of 17^3";
}

TEST(ExtractGlyphs, OnASliceTheyStayWithinItsVisiblePart) {
  scene::Scene scene =
      test::scene_from(R"({"fields": {"v": {"analytic": "uniform"}, "s": {"analytic": "sphere", "box": [-1, 1], "resolution": 5}},
    "slices": [{"field": "s", "axis": "y", "at": 0.5}], "glyphs": [{"field": "v", "on": {"slice": 0}, "spacing": 0.2}]})");
  const auto glyphs = glyphs_of(scene);
  EXPECT_NEAR(static_cast<double>(glyphs.size()), 4 / (0.04 * std::sqrt(0.75)), 12);
  for (const Glyph& glyph : glyphs) EXPECT_LE(max_abs(middle(glyph)), 1 + 1e-9);
}

TEST(ExtractGlyphs, OnAnIsosurfaceTheirTailsAreOnIt) {
  const auto glyphs = glyphs_of(R"("isosurfaces": [{"field": "s", "level": 1.5, "visible": false}],
    "glyphs": [{"field": "v", "on": {"isosurface": 0}, "spacing": 0.25, "anchor": "tail"}])");
  ASSERT_GT(glyphs.size(), 250u);
  for (const Glyph& glyph : glyphs) {
    EXPECT_NEAR(norm(glyph.tail), 1.5, 0.01);
    EXPECT_LT(norm(cross(direction(glyph.tip - glyph.tail), direction(Vec3(-glyph.tail.y, glyph.tail.x, 0)))), 1e-9);
  }
}

TEST(ExtractGlyphs, GlyphsFollowTheirWidgets) {
  scene::Scene scene = scene_of(R"("widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0.25], "normal": [0, 0, 1]},
      {"name": "l", "type": "isolevel", "field": "s", "position": [1, 0, 0]}],
    "slices": [{"field": "s", "widget": "cut"}], "isosurfaces": [{"field": "s", "level": {"widget": "l"}}],
    "glyphs": [{"field": "w", "on": {"slice": 0}}, {"field": "w", "on": {"plane": {"widget": "cut"}}}, {"field": "w", "on": {"isosurface": 0}}])");
  const auto move = [&](const char* name, const Vec3& to) {
    ASSERT_TRUE(scene::set_widget_pose(scene, scene::find_widget(scene, name), {{to, Vec3(0.0)}, kIdentityRotation}));
  };
  FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.glyphs.size(), 3u);
  EXPECT_NEAR(middle(packet.glyphs[0].glyphs[0]).z, 0.25, 1e-12);
  EXPECT_NEAR(middle(packet.glyphs[1].glyphs[0]).z, 0.25, 1e-12);
  EXPECT_NEAR(norm(middle(packet.glyphs[2].glyphs[0])), 1, 0.02);
  EXPECT_TRUE(packet_of(scene).glyphs[2].glyphs.shares_storage(packet.glyphs[2].glyphs)) << "made once";
  move("cut", {0, 0, -1});
  move("l", {0, 1.5, 0});
  packet = packet_of(scene);
  EXPECT_NEAR(middle(packet.glyphs[0].glyphs[0]).z, -1, 1e-12);
  EXPECT_NEAR(middle(packet.glyphs[1].glyphs[0]).z, -1, 1e-12);
  EXPECT_NEAR(norm(middle(packet.glyphs[2].glyphs[0])), 1.5, 0.02);
  // outside the domain there are no glyphs
  move("cut", {0, 0, 40});
  packet = packet_of(scene);
  EXPECT_TRUE(packet.glyphs[0].glyphs.empty());
  EXPECT_TRUE(packet.glyphs[1].glyphs.empty());
}

TEST(ExtractGlyphs, OnlyAnEditOfTheirSliceRecomputesThem) {
  const std::string text = R"({"fields": {"w": {"analytic": "uniform"}}, "slices": [{"field": "w", "axis": "z", "at": 0}],
    "glyphs": [{"field": "w", "on": {"slice": 0}}], "title": "a"})";
  scene::Scene first = test::scene_from(text);
  const SharedList<Glyph> before = packet_of(first).glyphs[0].glyphs;
  std::string other = text;
  other.replace(other.find("\"a\""), 3, "\"b\"");
  scene::Scene same = test::scene_from(other);
  scene::transfer_state(first, same);
  EXPECT_TRUE(packet_of(same).glyphs[0].glyphs.shares_storage(before));
  std::string moved = other;
  moved.replace(moved.find("\"at\": 0"), 7, "\"at\": 1");
  scene::Scene third = test::scene_from(moved);
  scene::transfer_state(same, third);
  EXPECT_NEAR(middle(packet_of(third).glyphs[0].glyphs[0]).z, 1, 1e-12);
}

TEST(ExtractGlyphs, TooManyGlyphsAreAnErrorWithTheirNumber) {
  expect_error("\n\"glyphs\": [{\"field\": \"v\",\n\"spacing\": 0.1}]",
               "s.json:4: a \"spacing\" of 0.1 would give about 68921 glyphs; a wider one that gives at most 20000 was expected");
  for (const char* on : {R"("box": {"min": [0, 0, 0], "max": [1, 1, 1]})", R"("plane": {"axis": "x", "at": 0})", R"("isosurface": 0)"})
    for (const char* spacing : {"1e-3", "1e-9", "1e-30"})
      expect_error(std::string(R"("isosurfaces": [{"field": "s", "level": 1}], "glyphs": [{"field": "v", "spacing": )") + spacing +
                       ", \"on\": {" + on + "}}]",
                   "at most 20000 was expected");
  // for a plane that follows a widget the spacing is increased instead
  const auto glyphs = glyphs_of(R"("widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [1, 1, 1]}],
    "glyphs": [{"field": "w", "spacing": 0.01, "on": {"plane": {"widget": "cut"}}}])");
  EXPECT_GT(glyphs.size(), 12000u);
  EXPECT_LE(glyphs.size(), 20000u);
}

TEST(ExtractGlyphs, WrongFieldsAreNamed) {
  expect_error("\n\"glyphs\": [{\"field\": \"s\"}]", "s.json:3: \"s\" is a scalar field; expected a vector field for glyphs");
  expect_error(R"("isosurfaces": [{"field": "s", "level": 99, "visible": false}], "glyphs": [{"field": "v", "on": {"isosurface": 0}}])",
               "level 99 is outside");
}

}  // namespace catena::render::glyphs_test
