// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "engine/scene/color_maps.h"
#include "engine/scene/label_groups.h"
#include "engine/scene/labels.h"
#include "engine/scene/opacity_presets.h"
#include "engine/scene/prepare.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::default_visualization_test {

using DefaultVisualization = InFolder;

/// The default scene of a file with one grid.
Scene scene_of_grid(const std::string& path, const field::AnyField& grid) {
  value_of(field::write_vdb(path, {{grid, "g"}}));
  return value_of(scene_for_file(path));
}

/// The default scene of a file with a grid of 32^3 over -1..1; the scene is also prepared for rendering.
template <class Value>
Scene scene_of(const std::string& path, const Value& value, const FileColors& colors = {}) {
  constexpr int kSize = 32;
  const double edge = 2.0 / (kSize - 1);
  std::vector<float> values;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) values.push_back(static_cast<float>(value(edge * Vec3(x, y, z) - Vec3(1.0))));
  const auto grid = field::make_scalar_grid("g", field::Mapping::from_linear(Mat3(edge), Vec3(-1.0)), {kSize, kSize, kSize}, values);
  value_of(field::write_vdb(path, {{{grid, nullptr}, "g"}}));
  Scene scene = value_of(scene_for_file(path, {}, colors));
  value_of(prepare(scene));
  return scene;
}

TEST(OpacityPreset, EveryPresetIsAVolumeOverTheRangeOfTheData) {
  const test::TemporaryFolder folder;
  for (const OpacityPreset& preset : opacity_presets()) {
    const Scene scene = scene_of(folder / "g.vdb", [](const Vec3& p) { return 100 * p.x; }, {.preset = std::string(preset.name)});
    const auto volumes = all_of<Volume>(scene);
    ASSERT_EQ(volumes.size(), 1u) << preset.name;
    const auto& points = volumes[0].transfer.opacities;
    ASSERT_EQ(points.size(), preset.opacities.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = preset.opacities[i].value;
      EXPECT_NEAR(points[i].value, preset.is_relative ? 200 * value - 100 : value, 1e-3) << preset.name;
      EXPECT_EQ(points[i].alpha, preset.opacities[i].alpha);
    }
  }
}

std::vector<double> levels(const Scene& scene) {
  std::vector<double> all;
  for (const Isosurface& surface : all_of<Isosurface>(scene)) all.push_back(surface.level);
  return all;
}

field::AnyField ramp_up_to(double maximum) {
  std::vector<float> values(8);
  values.back() = float(maximum);
  return {field::make_scalar_grid("g", field::Mapping::from_linear(Mat3(1.0), Vec3(0.0)), {2, 2, 2}, values), nullptr};
}

TEST_F(DefaultVisualization, ValuesOutOfTheRangeOfFloatsAreRefused) {
  for (const double maximum : {3e-35, 3e35}) expect_error(scene_for_field(ramp_up_to(maximum)), "", {"the values range from 0 to 3e"});
  EXPECT_TRUE(scene_for_field(ramp_up_to(1e-29)));
}

TEST_F(DefaultVisualization, OutliersAndFillValuesChangeOnlyTheNotes) {
  const auto wave = [](const Vec3& p) { return 1.5 + std::sin(2 * p.x) * std::cos(1.5 * p.y + p.z); };
  const auto is_first = [](const Vec3& p) { return p.x < -0.99 && p.y < -0.99 && p.z < -0.99; };
  const auto text_of_look = [&](const std::string& name, const std::function<double(const Vec3&)>& value) {
    const Scene scene = scene_of(folder_ / name, value);
    std::string text = std::to_string(scene.entities.count<Isosurface>());
    scene.entities.each<Volume>([&](Entity, const Volume& volume) {
      for (const auto& c : volume.transfer.colors) text += fmt::format(" {:.6g}", c.value);
      for (const auto& e : volume.transfer.extinctions) text += fmt::format(" {:.2g}:{:.2g}", e.value, e.sigma);
    });
    return std::pair(text, scene.notes.back());
  };
  const auto [clean, note] = text_of_look("a.vdb", wave);
  EXPECT_EQ(note.find("beyond"), std::string::npos) << note;
  for (const double outlier : {1e20, -1e6, 3.4e38}) {
    const auto [text, why] = text_of_look("b.vdb", [&](const Vec3& p) { return is_first(p) ? outlier : wave(p); });
    EXPECT_EQ(text, clean) << outlier;
    EXPECT_NE(why.find("1 value of"), std::string::npos) << why;
  }
  // The lower third of the values is missing.
  const auto [text, why] = text_of_look("c.vdb", [&](const Vec3& p) { return p.z < -0.35 ? -9999 : wave(p); });
  EXPECT_EQ(text.substr(0, 2), "0 ") << text;
  EXPECT_EQ(text.find("-9999"), std::string::npos) << text;
  EXPECT_NE(why.find("of the values are exactly -9999: perhaps missing data"), std::string::npos) << why;
}

TEST_F(DefaultVisualization, ValuesTooSmallToRenderHaveANote) {
  for (const double maximum : {1e-35, 1e-29}) {
    ASSERT_TRUE(field::write_vdb(folder_ / "f.vdb", {{ramp_up_to(maximum), "g"}}));
    Scene scene = parsed("{\"fields\": {\"f\": {\"file\": \"f.vdb\"}}}", folder_ / "s.json");
    ASSERT_TRUE(resolve_field(scene, "f", {}));
    const auto says = [](const std::string& note) { return note.find("field \"f\": the largest magnitude is 1e-35") != std::string::npos; };
    EXPECT_EQ(std::ranges::count_if(scene.notes, says), maximum < 1e-30 ? 1 : 0);
  }
}

/// A ball of tissue in a shell of bone in air, in Hounsfield units.
double skull(const Vec3& p) { return norm(p) > 0.9 ? -1000 : norm(p) > 0.7 ? 900 : 40; }

TEST_F(DefaultVisualization, ACtShowsBoneUnderSkin) {
  const Scene scene = scene_of(folder_ / "a.vdb", skull);
  EXPECT_EQ(levels(scene), (std::vector<double>{250, -300}));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("looks like a CT"), std::string::npos) << scene.notes[0];
  EXPECT_EQ(scene.entities.count<Volume>(), 0u);
}

TEST_F(DefaultVisualization, ACtWithoutBoneHasAnOpaqueSkin) {
  const Scene scene = scene_of(folder_ / "a.vdb", [](const Vec3& p) { return norm(p) > 0.9 ? -1000 : 40; });
  ASSERT_EQ(levels(scene), std::vector<double>{-300});
  EXPECT_EQ(only<Isosurface>(scene).opacity, 1);
}

TEST_F(DefaultVisualization, ALevelSetIsShownAtZeroAndASolidBetweenItsPlateaus) {
  EXPECT_EQ(levels(scene_of(folder_ / "a.vdb", [](const Vec3& p) { return norm(p) - 0.6; })), std::vector<double>{0});
  const auto solid = levels(scene_of(folder_ / "b.vdb", [](const Vec3& p) { return 3 + std::tanh(40 * (norm(p) - 0.6)); }));
  ASSERT_EQ(solid.size(), 1u);
  EXPECT_NEAR(solid[0], 3, 0.6);
}

TEST_F(DefaultVisualization, ALabelMapIsOneSurfaceWithLabelColoursAndALegend) {
  test::write_file(folder_ / "a.txt", "1 one\n2 two\n");
  const Scene scene =
      scene_of(folder_ / "a.vdb", [](const Vec3& p) { return norm(p) > 0.9 ? 0 : 1 + int(2 * (p.x + 1)) + 7 * int(2 * (p.y + 1)); });
  ASSERT_EQ(levels(scene), std::vector<double>{0.5});
  const Entity map = find_field(scene, "g");
  const auto surface = only<Isosurface>(scene);
  EXPECT_TRUE(scene.entities.get<FieldSource>(surface.field).label->all_labels);
  ASSERT_TRUE(surface.color_by);
  EXPECT_EQ(surface.color_by->field, map);
  EXPECT_EQ(scene.annotations.scalar_bars.size(), 1u);
  const LabelMap* labels = find_label_map(scene, map);
  ASSERT_NE(labels, nullptr);
  ASSERT_EQ(labels->labels.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(labels->labels[i].color, labels->labels[j].color) << i << " " << j;
  EXPECT_EQ(labels->labels[1].name, "two");
  EXPECT_NE(scene.notes[0].find("names from a.txt"), std::string::npos) << scene.notes[0];
}

TEST_F(DefaultVisualization, ASimulationHasAColourMapAScalarBarAndVisibleLowValues) {
  const Scene scene = scene_of(folder_ / "a.vdb", [](const Vec3& p) { return 1000 + p.x + 0.2 * std::sin(3 * p.y); });
  EXPECT_EQ(scene.annotations.scalar_bars.size(), 1u);
  EXPECT_TRUE(scene.bounding_box);
  const TransferFunction transfer = only<Volume>(scene).transfer;
  EXPECT_EQ(transfer.named.map, kDefaultVolumeColorMap);
  ASSERT_EQ(transfer.extinctions.size(), 3u);
  EXPECT_GT(transfer.extinctions[0].sigma, 0);
  EXPECT_GT(transfer.extinctions[2].sigma, transfer.extinctions[1].sigma);
  EXPECT_NEAR(transfer.extinctions[0].value, 998.8, 0.1);
  EXPECT_NEAR(transfer.extinctions[2].value, 1001.2, 0.1);
}

TEST_F(DefaultVisualization, AStatisticOverAnatomyShowsItsTailsAndTheAnatomyAsAShell) {
  const auto wave = [](const Vec3& p) { return 8 * std::sin(3 * p.x) * std::cos(2 * p.y) * std::exp(-dot(p, p)); };
  scene_of(folder_ / "z.vdb", wave);
  for (const Threshold& stated : {Threshold{}, Threshold{{-1e30, -2.5}, {2.5, 1e30}}}) {
    FileColors colors{.overlay = folder_ / "z.vdb"};
    colors.named.threshold = stated;
    const Scene scene = scene_of(
        folder_ / "t1.vdb", [](const Vec3& p) { return norm(p) - 0.8; }, colors);
    EXPECT_LT(only<Isosurface>(scene).opacity, 1);
    const TransferFunction transfer = only<Volume>(scene).transfer;
    EXPECT_EQ(transfer.named.map, "cool-warm");
    ASSERT_TRUE(transfer.named.range);
    EXPECT_EQ((*transfer.named.range)[0], -(*transfer.named.range)[1]);
    ASSERT_EQ(transfer.named.threshold.size(), 2u);
    EXPECT_EQ(transfer.named.threshold[0][1], -transfer.named.threshold[1][0]);
    if (!stated.empty()) {
      EXPECT_EQ(transfer.named.threshold, stated);
    }
    EXPECT_EQ(scene.entities.get<FieldSource>(only<Volume>(scene).field).file->path, folder_ / "z.vdb");
  }
  FileColors missing{.overlay = folder_ / "none.vdb"};
  expect_error(scene_for_file(folder_ / "t1.vdb", {}, missing), "", {"none.vdb"});
}

TEST(LabelGroups, ALabelHasTheOpacityOfTheLastRequestThatNamesIt) {
  std::vector<field::LabelCount> counts;
  for (const double value : {0, 1, 2, 7, 12}) counts.push_back({value, 5, {}, {}});
  const LabelTable table{{1, "Frontal_L", {}}, {2, "frontal_R", {}}, {7, "Vermis", {}}};
  const auto groups = [&](const std::vector<LabelOpacity>& requests) {
    std::string text;
    for (const LabelGroup& group : value_of(group_labels(counts, table, requests)))
      text += fmt::format("{}: {}; ", group.opacity, to_json(group.values));
    return text;
  };
  EXPECT_EQ(groups({{"Front*", 0.2}}), "1: [7, 12]; 0.2: [1, 2]; ");
  EXPECT_EQ(groups({{"*", 0.3}, {"*_R", 0}, {"7", 1}}), "1: [7]; 0.3: [1, 12]; 0: [2]; ");
  EXPECT_EQ(groups({{"2-7", 0.5}}), "1: [1, 12]; 0.5: [2, 7]; ");
  for (const char* none : {"3", "Front", "8-11", ""})
    expect_error(group_labels(counts, table, std::vector<LabelOpacity>{{none, 1}}), "", {"was expected"});
  std::vector<LabelOpacity> many;
  for (int i = 0; i < 10; ++i) counts.push_back({20.0 + i, 5, {}, {}}), many.push_back({std::to_string(20 + i), 0.1 + 0.01 * i});
  expect_error(group_labels(counts, table, many), "", {"at most 8"});
}

TEST_F(DefaultVisualization, AStatedMapMakesAnyKindAVolume) {
  const Scene scene = scene_of(folder_ / "a.vdb", skull, {"magma", {}});
  EXPECT_TRUE(levels(scene).empty());
  EXPECT_EQ(only<Volume>(scene).transfer.named.map, "magma");
}

TEST_F(DefaultVisualization, AConstantFieldIsAVolume) {
  EXPECT_EQ(scene_of(folder_ / "a.vdb", [](const Vec3&) { return 7; }).entities.count<Volume>(), 1u);
}

TEST_F(DefaultVisualization, FibresHaveOneColorAndNoSpeedBar) {
  for (const auto& [analytic, colored] : {std::pair{"uniform", false}, {"helix", true}}) {
    const auto field = *field::make_analytic(analytic);
    const Scene scene = scene_of_grid(folder_ / "a.vdb", {nullptr, field::sample_on_grid(*field.vector, 12, -1, 1)});
    const auto set = only<StreamlineSet>(scene);
    EXPECT_EQ(set.color_by.has_value(), colored);
    EXPECT_TRUE(set.seeds.pattern);
    EXPECT_EQ(scene.annotations.scalar_bars.size(), colored ? 1u : 0u);
  }
}

TEST_F(DefaultVisualization, ARampAlongAnyAxisIsAVolume) {
  for (int axis = 0; axis < 3; ++axis) {
    const Scene scene = scene_of(folder_ / "a.vdb", [&](const Vec3& p) { return 0.37 * p[axis]; });
    EXPECT_EQ(scene.entities.count<Volume>(), 1u) << axis << scene.notes[0];
    EXPECT_EQ(scene.entities.count<Isosurface>(), 0u) << axis;
  }
}

TEST_F(DefaultVisualization, ASingleImageIsASlice) {
  std::vector<float> values;
  for (int i = 0; i < 2 * 24 * 20; ++i) values.push_back(static_cast<float>(i % 240 - 1000));
  Scene scene = scene_of_grid(folder_ / "a.vdb", {field::make_scalar_grid("g", {}, {24, 20, 2}, values), nullptr});
  EXPECT_EQ(scene.entities.count<Slice>(), 1u);
  EXPECT_EQ(scene.entities.count<Isosurface>(), 0u);
  value_of(prepare(scene));
}

TEST_F(DefaultVisualization, RandomSignsMakeALineField) {
  constexpr int kSize = 24;
  std::vector<float> signs, flow;
  std::uint32_t state = 7;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        state = 1664525 * state + 1013904223;
        const Vec3 v = (1 + 0.05 * x) * Vec3(std::cos(0.1 * y), std::sin(0.1 * y), 0.3);  // lengths vary, as with FA
        const double sign = (state >> 31) != 0 ? -1 : 1;
        for (int a = 0; a < 3; ++a) {
          signs.push_back(static_cast<float>(sign * v[a]));
          flow.push_back(static_cast<float>(v[a]));
        }
      }
  for (const auto& [xyz, line] : {std::pair{signs, true}, {flow, false}}) {
    const Scene scene = scene_of_grid(folder_ / "a.vdb", {nullptr, field::make_vector_grid("v", {}, {kSize, kSize, kSize}, xyz)});
    EXPECT_EQ(only<StreamlineSet>(scene).is_line_field, line);
  }
}

TEST_F(DefaultVisualization, FibresAreShownInsideTheirTranslucentBody) {
  const auto body = *field::make_analytic("left-ventricle"), fibre = *field::make_analytic("left-ventricle", {1, {}, "fibre"});
  const auto shape = field::sample_on_grid(*body.scalar, 48, -3, 3);
  ASSERT_TRUE(field::write_vdb(folder_ / "heart.vdb",
                               {{{shape, nullptr}, "density"}, {{nullptr, field::sample_on_grid(*fibre.vector, 48, -3, 3)}, "fibre"}}));
  Scene scene = value_of(scene_for_file(folder_ / "heart.vdb"));
  EXPECT_EQ(scene.entities.count<StreamlineSet>(), 1u) << scene.notes[0];
  EXPECT_LT(only<Isosurface>(scene).opacity, 0.5);
  value_of(prepare(scene));
}

TEST_F(DefaultVisualization, AFieldWithoutLinesIsStillShown) {
  // The velocity is nonzero in a single voxel: the line is shorter than the spacing of lines.
  constexpr int kSize = 80;
  std::vector<float> still(3 * kSize * kSize * kSize, 0.f), dot = still;
  dot[3 * 36 * (1 + kSize + kSize * kSize)] = 1;
  for (const auto& [xyz, slices] : {std::pair{still, 0u}, {dot, 3u}}) {
    Scene scene = scene_of_grid(folder_ / "a.vdb", {nullptr, field::make_vector_grid("v", {}, {kSize, kSize, kSize}, xyz)});
    value_of(prepare(scene));
    EXPECT_EQ(scene.entities.count<StreamlineSet>(), 0u) << slices;
    EXPECT_EQ(scene.entities.count<Slice>(), slices);
  }
}

}  // namespace catena::scene::default_visualization_test
