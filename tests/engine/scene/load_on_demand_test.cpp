// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/volume/load_field.h"
#include "engine/scene/auto_transfer.h"
#include "engine/scene/prepare.h"
#include "engine/scene/scene.h"
#include "engine/scene/streamlines.h"
#include "tests/support/support.h"

namespace catena::scene {
namespace load_on_demand_test {

Scene scene_of(const std::string& text, const std::string& path = "scene.json") {
  auto scene = parse_scene(text, path);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

template <class T>
std::string message_of(const Result<T>& result) {
  return result ? std::string("no error") : result.error().message;
}

/// Writes a scalar grid of a sphere and a vector grid of a circular flow into one file.
void write_grids(const std::string& path) {
  const auto ball = *field::make_analytic("sphere"), swirl = *field::make_analytic("circle");
  const field::AnyField a{field::sample_on_grid(*ball.scalar, 9, -2, 2), nullptr},
      b{nullptr, field::sample_on_grid(*swirl.vector, 9, -2, 2)};
  const auto written = field::write_vdb(path, {{b, "flow"}, {a, "ball"}});
  ASSERT_TRUE(written) << written.error().message;
}

TEST(FieldOnDemand, LoadsOnlyRequestedGridsAndOnlyOnce) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  Scene scene =
      scene_of("{\"fields\": {\"ball\": {\"file\": \"a.vdb\", \"grid\": \"ball\"}, \"flow\": {\"file\": \"a.vdb\", \"grid\": \"flow\"}}}",
               folder / "s.json");
  const auto before = field::load_counters();
  const auto ball = resolve_field(scene, "ball", {});
  ASSERT_TRUE(ball) << message_of(ball);
  ASSERT_NE(ball->scalar, nullptr);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
  EXPECT_EQ(resolve_field(scene, "ball", {})->scalar, ball->scalar);
  EXPECT_EQ(resolve_rendered_field(scene, find_field(scene, "ball"), {})->scalar, ball->scalar);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
}

TEST(FieldOnDemand, ErrorsNameTheFieldsOwnLine) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  test::write_file(folder / "torn.vdb", "not a vdb");
  Scene scene = scene_of("{\"fields\": {\n\"wrong\": {\"file\": \"a.vdb\", \"grid\": \"bal\"},\n\"torn\": {\"file\": \"torn.vdb\"}}}",
                         folder / "s.json");
  for (const auto& [name, line] : {std::pair{"wrong", ":2: "}, std::pair{"torn", ":3: "}}) {
    const std::string message = message_of(resolve_field(scene, name, {}));
    EXPECT_TRUE(message.starts_with((folder / "s.json") + line)) << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_NE(message_of(resolve_field(scene, "tor", {})).find("wrong, torn (did you mean \"torn\"?)"), std::string::npos);
}

TEST(FieldOnDemand, AnOverridingFileMayLackTheGrid) {
  const test::TemporaryFolder folder;
  const auto ball = *field::make_analytic("sphere");
  ASSERT_TRUE(field::write_vdb(folder / "one.vdb", {{{field::sample_on_grid(*ball.scalar, 9, -2, 2), nullptr}, "other"}}));
  auto scene =
      parse_scene("{\"fields\": {\"a\": {\"file\": \"gone.vdb\", \"grid\": \"density\"}}}", "scene.json", {{"a", folder / "one.vdb", ""}});
  ASSERT_TRUE(scene);
  EXPECT_TRUE(resolve_field(*scene, "a", {}));
}

TEST(DisplayFieldOnDemand, SamplesFormulasOnceForRenderingAndKeepsThemExactForHaptics) {
  Scene scene = scene_of(
      "{\"fields\": {\"ball\": {\"analytic\": \"sphere\", \"resolution\": 9, \"box\": [-1, 1]}}, \"volumes\": [{\"field\": \"ball\"}]}");
  const Entity ball = find_field(scene, "ball");
  const auto drawn = resolve_rendered_field(scene, ball, {});
  ASSERT_TRUE(drawn) << message_of(drawn);
  ASSERT_TRUE(drawn->scalar && drawn->scalar->is_grid());
  EXPECT_EQ(drawn->scalar->index_box().hi.x, 8);
  EXPECT_EQ(resolve_rendered_field(scene, ball, {})->scalar, drawn->scalar);
  EXPECT_FALSE(resolve_field(scene, ball, {})->scalar->is_grid());
  scene.entities.each<Volume>([&](Entity, const Volume& volume) {
    EXPECT_GE(volume.transfer.colors.size(), 2u);
    ASSERT_GE(volume.transfer.extinctions.size(), 2u);
    for (std::size_t i = 1; i < volume.transfer.extinctions.size(); ++i)
      EXPECT_GT(volume.transfer.extinctions[i].value, volume.transfer.extinctions[i - 1].value);
  });
}

TEST(CurveOnDemand, SharesTracedCurvesAndErrorsNameTheLine) {
  Scene scene = scene_of("{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}}}");
  const auto any = resolve_field(scene, "swirl", {});
  ASSERT_TRUE(any);
  const flow::Flow flow{any->vector.get(), false, 0};
  const auto a = resolve_streamline(scene, flow, {1, 0, 0}, {}), b = resolve_streamline(scene, flow, {1, 0, 0}, {});
  ASSERT_TRUE(a) << message_of(a);
  EXPECT_EQ(*a, *b);
  EXPECT_NE(*a, *resolve_streamline(scene, flow, {0.5, 0, 0}, {}));
  EXPECT_NE(*a, *resolve_streamline(scene, flow, {1, 0, 0}, {}, 0.25));
  json::Node where;
  where.line = 7;
  where.file = std::make_shared<const std::string>("scene.json");
  EXPECT_TRUE(message_of(resolve_streamline(scene, flow, {0, 0, 0}, where)).starts_with("scene.json:7: "));
  EXPECT_NE(message_of(resolve_streamline(scene, flow, {std::nan(""), 0, 0}, where)).find("not finite"), std::string::npos);
}

TEST(CheckLevel, TheLevelMustBeInTheFieldsRange) {
  const auto ball = *field::make_analytic("sphere");
  const auto grid = field::sample_on_grid(*ball.scalar, 9, -2, 2);
  json::Node where;
  where.line = 3;
  where.file = std::make_shared<const std::string>("scene.json");
  EXPECT_TRUE(check_level(*grid, 1, where));
  EXPECT_TRUE(check_level(*ball.scalar, 100, where));
  for (double bad : {-0.1, 5.0, std::nan("")}) {
    const std::string message = message_of(check_level(*grid, bad, where));
    EXPECT_TRUE(message.starts_with("scene.json:3: level ")) << message;
    EXPECT_NE(message.find("0..3.4641"), std::string::npos) << message;
  }
}

TEST(DefaultScene, ScalarsBecomeAVolumeWithATransparentBackground) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  auto scene = scene_for_file(folder / "a.vdb");
  ASSERT_TRUE(scene) << message_of(scene);
  EXPECT_EQ(scene->entities.count<Volume>(), 1u);
  EXPECT_EQ(scene->entities.count<StreamlineSet>(), 0u);
  EXPECT_FALSE(scene->camera.is_explicit);
  EXPECT_TRUE(find_field(*scene, "ball"));
}

TEST(DefaultScene, VectorsBecomeStreamlines) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  auto scene = scene_for_file(folder / "a.vdb", "flow");
  ASSERT_TRUE(scene) << message_of(scene);
  EXPECT_EQ(scene->entities.count<Volume>(), 0u);
  scene->entities.each<StreamlineSet>([&](Entity, const StreamlineSet& set) {
    ASSERT_TRUE(set.seeds.pattern);
    EXPECT_EQ(set.seeds.pattern->kind, SeedPattern::Kind::evenly_spaced);
    ASSERT_TRUE(set.color_by);
    EXPECT_EQ(set.color_by->source, ColorBy::Source::speed);
    EXPECT_GT(set.length, 0);
  });
  EXPECT_TRUE(find_field(*scene, "flow"));
}

TEST(DefaultScene, ErrorsNameTheFile) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  test::write_file(folder / "torn.vdb", "not a vdb");
  for (const auto& [file, grid] :
       {std::pair{"none.vdb", ""}, std::pair{"torn.vdb", ""}, std::pair{"a.vdb", "speed"}, std::pair{"b.raw", ""}}) {
    const std::string message = message_of(scene_for_file(folder / file, grid));
    EXPECT_NE(message.find(file), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

const std::string kQuad = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n";

TEST(MeshOnDemand, IsLoadedOnceAndPlaced) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", kQuad);
  auto scene = parse_scene(R"({"meshes": [{"name": "a", "file": "quad.obj", "scale": 3, "offset": [0, 0, 5], "color": [1, 0, 0]},
                                          {"name": "b", "file": "quad.obj", "visible": false}]})",
                           folder / "s.json");
  ASSERT_TRUE(scene) << message_of(scene);
  EXPECT_EQ(scene->entities.count<MeshSource>(), 2u);
  EXPECT_EQ(scene->entities.count<SurfaceMesh>(), 2u);
  const auto a = resolve_mesh(*scene, "a", {}), again = resolve_mesh(*scene, "a", {}), b = resolve_mesh(*scene, "b", {});
  ASSERT_TRUE(a) << message_of(a);
  EXPECT_EQ(*a, *again);
  EXPECT_NE(*a, *b);
  EXPECT_EQ((*a)->min_corner(), Vec3(0, 0, 5));
  EXPECT_EQ((*a)->max_corner(), Vec3(6, 3, 5));
  EXPECT_EQ((*b)->domain_length(), 2);
  EXPECT_NE(message_of(resolve_mesh(*scene, "c", {})).find("one of the scene's \"meshes\" was expected: a, b"), std::string::npos);
}

TEST(MeshOnDemand, BadMeshesAreRefusedWithTheirLine) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", kQuad);
  test::write_file(folder / "torn.stl", "solid a\nfacet");
  const auto refused = [&](const std::string& item, const char* part) {
    const auto scene = parse_scene("{\"meshes\": [\n" + item + "]}", folder / "s.json");
    const std::string message = message_of(scene);
    EXPECT_TRUE(message.starts_with((folder / "s.json") + ":2: ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused(R"({"name": "a", "file": "none.stl"})",
          "does not exist; a .stl, .obj, .vtu, .vtp, .vtm, .vtmb, .pvtp, .vtk, .pvd, .series, .ply or .gii file was expected");
  refused(R"({"name": "a", "file": "quad.x3q"})", "unknown kind");
  refused(R"({"name": "A", "file": "quad.obj"})", "is not allowed");
  refused(R"({"name": "a", "file": "quad.obj", "opacity": 1.5})", "\"opacity\" is 1.5; a number from 0 to 1 was expected");
  refused(R"({"name": "a", "file": "quad.obj", "scale": 0})", "scale");
  refused(R"({"name": "a", "file": "quad.obj", "colour": [1, 0, 0]})", "colour");
  refused(R"({"name": "a", "file": "quad.obj"}, {"name": "a", "file": "quad.obj"})", "the name \"a\" is already used for a mesh");
  auto torn = parse_scene("{\"meshes\": [\n{\"name\": \"a\", \"file\": \"torn.stl\"}]}", folder / "s.json");
  ASSERT_TRUE(torn);
  const std::string message = message_of(resolve_mesh(*torn, "a", {}));
  EXPECT_TRUE(message.starts_with((folder / "s.json") + ":2: mesh \"a\": ")) << message;
  EXPECT_NE(message.find("torn.stl:2: the file ends too early; \"normal\" was expected"), std::string::npos) << message;
}

TEST(DefaultScene, AMeshFileIsDrawnAsASurface) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", kQuad);
  auto scene = scene_for_file(folder / "quad.obj");
  ASSERT_TRUE(scene) << message_of(scene);
  EXPECT_EQ(scene->entities.count<SurfaceMesh>(), 1u);
  EXPECT_FALSE(scene->camera.is_explicit);
  EXPECT_EQ(message_of(scene_for_file(folder / "none.obj")).find((folder / "none.obj") + ": "), 0u);
}

TEST(DefaultScene, RealScansAreTransparentInTheAir) {
  for (const auto& [name, air, tissue] : {std::tuple{"cranium_ct.vdb", -1000.0, 1500.0}, std::tuple{"colin27_brain_mr.vdb", 0.0, 100.0}}) {
    const std::string path = test::shared_data(name);
    if (path.empty()) GTEST_SKIP() << "no shared data";
    auto scene = scene_for_file(path, {}, {"dusk", {}});
    ASSERT_TRUE(scene) << message_of(scene);
    ASSERT_EQ(scene->entities.count<Volume>(), 1u);
    scene->entities.each<Volume>([&, air = air, tissue = tissue](Entity, const Volume& volume) {
      const auto sigma = [&](double value) {
        double best = 1e300, found = 0;
        for (const auto& e : volume.transfer.extinctions)
          if (std::fabs(e.value - value) < best) best = std::fabs(e.value - value), found = e.sigma;
        return found;
      };
      EXPECT_LT(sigma(air), 1e-3 * sigma(tissue));
      EXPECT_GT(sigma(tissue), 0);
    });
  }
}

TEST(DefaultScene, RealFlowsHaveLinesInTheirDomain) {
  for (const char* name : {"combustor_cfd.vdb", "carotid_flow.vdb"}) {
    const std::string path = test::shared_data(name);
    if (path.empty()) GTEST_SKIP() << "no shared data";
    auto scene = scene_for_file(path, "velocity");
    ASSERT_TRUE(scene) << message_of(scene);
    ASSERT_EQ(scene->entities.count<StreamlineSet>(), 1u) << name;
    ASSERT_TRUE(prepare(*scene));
    Entity lines;
    scene->entities.each<StreamlineSet>([&](Entity e, const StreamlineSet&) { lines = e; });
    const auto curves = resolve_lines(*scene, lines);
    ASSERT_TRUE(curves) << message_of(curves);
    EXPECT_GT(curves->size(), 20u) << name;
    const Bounds box = resolve_field(*scene, scene->entities.get<StreamlineSet>(lines).field, {})->get()->world_bounds(),
                 drawn = lines_bounds(*scene, lines);
    EXPECT_TRUE(drawn.lo.x >= box.lo.x - 1e-6 * box.diagonal()) << name;
    EXPECT_LE(drawn.hi.z, box.hi.z + 1e-6 * box.diagonal()) << name;
    EXPECT_GT(drawn.diagonal(), 0.5 * box.diagonal()) << name;
  }
}

TEST(CompleteTransfer, TheMostFrequentValueIsTransparent) {
  // 90 % of the values are a background of 10; a block rises to 110.
  std::vector<float> values(1000, 10.0f);
  for (std::size_t i = 0; i < 100; ++i) values[i] = 11.0f + static_cast<float>(i);
  const auto grid = field::make_scalar_grid("g", field::Mapping{}, {10, 10, 10}, values);
  TransferFunction transfer;
  complete_transfer(transfer, *grid);
  ASSERT_EQ(transfer.extinctions.size(), 17u);
  EXPECT_EQ(transfer.extinctions.front().sigma, 0);
  EXPECT_GT(transfer.extinctions.back().sigma, 0.1);
  EXPECT_NEAR(transfer.colors.front().value, 10, 1e-6);
  const auto colors = transfer.colors.size();
  complete_transfer(transfer, *grid);
  EXPECT_EQ(transfer.colors.size(), colors);
}

TEST(CompleteTransfer, AConstantGridGetsOnePoint) {
  const std::vector<float> values(1000, 3.0f);
  const auto grid = field::make_scalar_grid("g", field::Mapping{}, {10, 10, 10}, values);
  TransferFunction transfer;
  complete_transfer(transfer, *grid);
  ASSERT_EQ(transfer.extinctions.size(), 1u);
  EXPECT_GT(transfer.extinctions[0].sigma, 0);
  EXPECT_EQ(transfer.colors.size(), 1u);
}

TEST(UpdateCursor, FollowsTheState) {
  Scene scene = scene_of("{}");
  EXPECT_FALSE(scene.entities.get<Cursor>(scene.cursor).visible);
  HapticState state;
  state.probe = {1, 2, 3};
  state.force_n = {0, 0, 4};
  state.link_count = 2;
  state.links[1].proxy = {5, 6, 7};
  state.links[1].active = true;
  update_cursor(scene, state);
  const Cursor& cursor = scene.entities.get<Cursor>(scene.cursor);
  EXPECT_TRUE(cursor.visible);
  EXPECT_EQ(cursor.probe, Vec3(1, 2, 3));
  ASSERT_EQ(cursor.proxies.size(), 2u);
  EXPECT_EQ(cursor.proxies[1], Vec3(5, 6, 7));
  EXPECT_FALSE(cursor.active[0]);
  EXPECT_TRUE(cursor.active[1]);
  state.probe.x = std::nan("");
  update_cursor(scene, state);
  EXPECT_EQ(cursor.probe, Vec3(1, 2, 3));
}

}  // namespace load_on_demand_test
}  // namespace catena::scene
