// SPDX-License-Identifier: MIT
#include "engine/scene/labels.h"

#include <cmath>
#include <filesystem>

#include "engine/scene/document.h"
#include "engine/scene/label_palette.h"
#include "engine/scene/prepare.h"
#include "engine/scene/referenced_files.h"
#include "tests/engine/scene/scene_fixture.h"
#include "tests/support/nifti_file.h"

namespace catena::scene::labels_test {

/// 16^3 voxels in a raw file: label 3 for x below 5; for other x label 70 for y below 5; and 0 elsewhere.
class LabelScene : public InFolder {
 protected:
  void SetUp() override {
    std::string bytes;
    for (int z = 0; z < 16; ++z)
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) bytes += static_cast<char>(x < 5 ? 3 : y < 5 ? 70 : 0);
    test::write_file(folder_ / "m.raw", bytes);
    test::write_file(folder_ / "m.txt", "3 left\n70 right 255 0 0 0\n");
  }
  Result<Scene> read(const std::string& field, const std::string& more = "") {
    return parse_scene("{\"fields\": {\"m\": {\"file\": \"m.raw\", \"shape\": [16, 16, 16], \"type\": \"uint8\"" + field + "}" + more,
                       folder_ / "s.json");
  }
  void refused(const std::string& field, const std::string& more, const std::string& part) {
    auto scene = read(field, more);
    expect_error(scene ? prepare(*scene) : scene.error(), "", {part});
  }
};

const std::string kTable = ", \"labels\": {\"file\": \"m.txt\"}";

TEST_F(LabelScene, TheDefaultInterpolationIsLinearAndNearestForLabels) {
  for (const auto& [field, wanted] :
       {std::pair{"", field::Interpolation::linear},
        {", \"interpolation\": \"nearest\"", field::Interpolation::nearest},
        {kTable.c_str(), field::Interpolation::nearest},
        {", \"interpolation\": \"linear\", \"labels\": {\"values\": [3], \"names\": [\"a\"]}", field::Interpolation::linear}}) {
    Scene scene = value_of(read(field, "}}"));
    EXPECT_EQ(value_of(resolve_field(scene, "m", {})).scalar->interpolation(), wanted) << field;
    const bool mixed = wanted == field::Interpolation::linear && *field != '\0';
    ASSERT_EQ(scene.notes.size(), mixed ? 1u : 0u) << field;
    for (const std::string& note : scene.notes) EXPECT_TRUE(has(note, "meaningless values between labels"));
  }
}

TEST_F(LabelScene, InterpolatingAFileWithLabelIntentHasANote) {
  test::NiftiFile file({4, 4, 4}, 2, 8);
  file.put(68, std::int16_t{1002});  // the intent
  for (int k = 0; k < 64; ++k) file.append(static_cast<char>(k < 32 ? 3 : 70));
  test::write_file(folder_ / "a.nii", file.bytes());
  for (const auto& [more, notes] : {std::pair{"}", 1u},
                                    {", \"interpolation\": \"cubic\"}", 1u},
                                    {", \"interpolation\": \"nearest\"}", 0u},
                                    {"}, \"left\": {\"label\": 3, \"of\": \"a\"}", 0u}}) {
    Scene scene = parsed(std::string("{\"fields\": {\"a\": {\"file\": \"a.nii\"") + more + "}}", folder_ / "s.json");
    value_of(resolve_field(scene, "a", {}));
    EXPECT_EQ(scene.notes.size(), notes) << more;
    for (const std::string& note : scene.notes) EXPECT_TRUE(has(note, "NIFTI_INTENT_LABEL"));
  }
}

TEST_F(LabelScene, NamesAndColoursComeFromTheTable) {
  Scene scene = value_of(read(kTable, "}}"));
  ASSERT_TRUE(resolve_field(scene, "m", {}));
  const LabelMap* map = find_label_map(scene, find_field(scene, "m"));
  ASSERT_NE(map, nullptr);
  ASSERT_EQ(map->labels.size(), 2u);
  EXPECT_EQ(describe_label(*map, 3), "left (3)");
  EXPECT_EQ(describe_label(*map, 0), "no label");
  EXPECT_EQ(describe_label(*map, 5), "5");
  EXPECT_EQ(map->labels[1].color, (Color{1, 0, 0}));
  EXPECT_EQ(map->labels[0].voxel_count, 5 * 256u);
  EXPECT_EQ(scene.referenced_files.size(), 2u) << "the table is a file that the scene names";
}

TEST_F(LabelScene, LabelFieldsAreSelectedByNumberNameOrList) {
  Scene scene = value_of(read(
      kTable, R"(, "a": {"label": 3, "of": "m", "smooth": 0}, "b": {"label": "right", "of": "m"}, "c": {"label": [3, "right"], "of": "m"},
      "d": {"label": "*", "of": "m", "smooth": 0}},
      "isosurfaces": [{"field": "a", "level": 0.5}, {"field": "b", "level": 0.5}, {"field": "c", "level": 0.5}, {"field": "d", "level": 0.5}]})"));
  value_of(prepare(scene));
  field::Cursor cursor;
  const auto at = [&](const char* name, const Vec3& p) {
    return rendered_field(scene, find_field(scene, name)).scalar->sample(p, cursor).value;
  };
  EXPECT_NEAR(at("a", {4.5, 8, 8}), 0.5, 1e-12);
  EXPECT_NEAR(at("d", {4.5, 8, 8}), 0.5, 1e-12);
  EXPECT_EQ(at("d", {4.5, 2, 8}), 1) << "no wall between two labels";
  EXPECT_GT(at("b", {10, 2, 8}), 0.9);
  EXPECT_LT(at("b", {2, 2, 8}), 0.1);
  EXPECT_GT(at("c", {4.5, 2, 8}), 0.9);
  EXPECT_EQ(surface_label_name(scene, "a"), "left");
  EXPECT_EQ(surface_label_name(scene, "b"), "right");
  EXPECT_EQ(surface_label_name(scene, "c"), "");
  for (const char* name : {"a", "b", "c", "d"}) {
    const FieldSource& source = scene.entities.get<FieldSource>(find_field(scene, name));
    EXPECT_EQ(source.loaded.get(), source.rendered.get()) << "what is felt is what is drawn";
  }
}

TEST_F(LabelScene, ErrorsAreOneLine) {
  const std::string surface = "}, \"isosurfaces\": [{\"field\": \"a\", \"level\": 0.5}]}";
  refused(kTable, R"(, "a": {"label": 5, "of": "m"})" + surface,
          "no voxel of \"m\" has the label 5; one of the map's 2 labels was expected");
  refused(kTable, R"(, "a": {"label": "rihgt", "of": "m"})" + surface, "did you mean \"right\"");
  refused(kTable, R"(, "a": {"label": 3, "of": "x"}}})", "\"x\" is not a field from a file");
  refused(kTable, R"(, "a": {"label": 3, "of": "a"}}})", "\"a\" is not a field from a file");
  refused(kTable, R"(, "a": {"label": 1.5, "of": "m"}}})", "a label is not an integer");
  refused(kTable, R"(, "a": {"label": [], "of": "m"}}})", "empty list");
  refused(R"(, "labels": {"values": [1, 1], "names": ["a", "b"]})", "}}", "holds 1 twice");
  refused(R"(, "labels": {"values": [1]})", "}}", "a name for each value");
  refused(R"(, "labels": {"file": "none.txt"})", "}}", "none.txt");
  refused(R"(, "interpolation": "near")", "}}", "nearest");
}

TEST_F(LabelScene, AFieldCanBeCropped) {
  const std::string volume = "}, \"volumes\": [{\"field\": \"m\"}]}";
  Scene shown = value_of(read(R"(, "crop": {"min": [3.5, 2, 2], "max": [9, 9, 9]})", volume));
  ASSERT_TRUE(prepare(shown));
  const FieldSource& source = shown.entities.get<FieldSource>(find_field(shown, "m"));
  EXPECT_EQ(source.loaded.get(), source.rendered.get()) << "what is felt is what is drawn";
  EXPECT_EQ(source.loaded.get()->index_box().hi - source.loaded.get()->index_box().lo, Vec3(6, 7, 7));
  refused(R"(, "crop": {"min": [0, 0, 0], "max": [4, 0, 4]})", "}}", "\"max\" is not above \"min\"");
  refused(R"(, "crop": {"min": [0, 0, 0]})", "}}", "max");
  refused(R"(, "crop": {"min": [20, 0, 0], "max": [30, 4, 4]})", volume, "no voxels");
}

TEST_F(LabelScene, AnEditKeepsLabelFieldsWithEqualLabels) {
  const std::string more =
      ", \"a\": {\"label\": 3, \"of\": \"m\"}}, \"isosurfaces\": [{\"field\": \"a\", \"level\": 0.5, \"color\": [1, 0, 0]}]}";
  auto old = read(kTable, more), fresh = read(kTable, more);
  ASSERT_TRUE(old && fresh);
  ASSERT_TRUE(prepare(*old));
  transfer_state(*old, *fresh);
  const auto grid = [](Scene& scene) { return scene.entities.get<FieldSource>(find_field(scene, "a")).loaded.get(); };
  EXPECT_EQ(grid(*old), grid(*fresh));
  auto other = read(kTable, ", \"a\": {\"label\": 70, \"of\": \"m\"}}}");
  ASSERT_TRUE(other);
  transfer_state(*fresh, *other);
  EXPECT_EQ(grid(*other), nullptr);
  EXPECT_NE(other->entities.get<FieldSource>(find_field(*other, "m")).labels, nullptr);
}

TEST_F(LabelScene, MovingASceneAdaptsTheTablesPath) {
  std::filesystem::create_directory(folder_ / "sub");
  const auto moved = relocate_text("{\"fields\": {\"m\": {\"file\": \"m.raw\", \"labels\": {\"file\": \"m.txt\"}}}}", folder_ / "s.json",
                                   folder_ / "sub/s.json", {});
  ASSERT_TRUE(moved);
  EXPECT_NE(moved->find("../m.txt"), std::string::npos) << *moved;
}

/// CIE 1976 L*, a*, b* for the illuminant D65.
Vec3 cielab(const Color& c) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double r = linear(c.r), g = linear(c.g), b = linear(c.b);
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047), y = f(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double min_distance(int count) {
  double minimum = 1e9;
  for (int n = 1; n < count; ++n)
    for (int m = 0; m < n; ++m)
      minimum =
          std::min(minimum, norm(cielab(palette_color(static_cast<std::size_t>(n))) - cielab(palette_color(static_cast<std::size_t>(m)))));
  return minimum;
}

TEST(LabelColors, PaletteColorsAreDistinct) {
  EXPECT_NEAR(cielab({1, 0, 0}).x, 53.24, 0.02);
  EXPECT_NEAR(cielab({1, 0, 0}).y, 80.09, 0.05);
  EXPECT_NEAR(cielab({1, 0, 0}).z, 67.20, 0.05);
  EXPECT_GT(min_distance(10), 40);
  EXPECT_GT(min_distance(20), 25);
  EXPECT_GT(min_distance(static_cast<int>(kPaletteColors)), 8) << "none twice";
}

TEST_F(LabelScene, AColourDependsOnTheTableNotOnTheMapsLabels) {
  const std::string names = R"(, "labels": {"values": [1, 3, 50, 70], "names": ["a", "b", "c", "d"]})";
  auto scene = read(names, "}}"), bare = read(", \"interpolation\": \"nearest\"", "}}");
  ASSERT_TRUE(scene && bare);
  for (Scene* one : {&*scene, &*bare}) ASSERT_TRUE(resolve_field(*one, "m", {}));
  const LabelMap* map = find_label_map(*scene, find_field(*scene, "m"));
  EXPECT_EQ(map->find(3)->color, palette_color(1));
  EXPECT_EQ(map->find(70)->color, palette_color(3));
  map = find_label_map(*bare, find_field(*bare, "m"));
  EXPECT_EQ(map->find(3)->color, palette_color(0));
  EXPECT_EQ(map->find(70)->color, palette_color(1));
}

}  // namespace catena::scene::labels_test
