// SPDX-License-Identifier: MIT
#include "engine/scene/auto_transfer.h"
#include "engine/scene/prepare.h"
#include "engine/scene/streamlines.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::load_on_demand_test {

using FieldOnDemand = InFolder;
using DefaultScene = InFolder;
using MeshOnDemand = InFolder;

/// A place on a line of scene.json.
json::Node node_on(int line) {
  json::Node where;
  where.line = line;
  where.file = std::make_shared<const std::string>("scene.json");
  return where;
}

TEST_F(FieldOnDemand, LoadsOnlyRequestedGridsAndOnlyOnce) {
  write_grids(folder_ / "a.vdb");
  Scene scene =
      parsed("{\"fields\": {\"ball\": {\"file\": \"a.vdb\", \"grid\": \"ball\"}, \"flow\": {\"file\": \"a.vdb\", \"grid\": \"flow\"}}}",
             folder_ / "s.json");
  const auto before = field::load_counters();
  const auto ball = resolve_field(scene, "ball", {});
  ASSERT_TRUE(ball) << message_of(ball);
  ASSERT_NE(ball->scalar, nullptr);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
  EXPECT_EQ(resolve_field(scene, "ball", {})->scalar, ball->scalar);
  EXPECT_EQ(resolve_rendered_field(scene, find_field(scene, "ball"), {})->scalar, ball->scalar);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
}

TEST_F(FieldOnDemand, ErrorsNameTheFieldsOwnLine) {
  write_grids(folder_ / "a.vdb");
  test::write_file(folder_ / "torn.vdb", "not a vdb");
  Scene scene = parsed("{\"fields\": {\n\"wrong\": {\"file\": \"a.vdb\", \"grid\": \"bal\"},\n\"torn\": {\"file\": \"torn.vdb\"}}}",
                       folder_ / "s.json");
  for (const auto& [name, line] : {std::pair{"wrong", ":2: "}, std::pair{"torn", ":3: "}})
    expect_error(resolve_field(scene, name, {}), (folder_ / "s.json") + line, {name});
  EXPECT_NE(message_of(resolve_field(scene, "tor", {})).find("wrong, torn (did you mean \"torn\"?)"), std::string::npos);
}

TEST_F(FieldOnDemand, AnOverridingFileMayLackTheGrid) {
  const auto ball = *field::make_analytic("sphere");
  ASSERT_TRUE(field::write_vdb(folder_ / "one.vdb", {{{field::sample_on_grid(*ball.scalar, 9, -2, 2), nullptr}, "other"}}));
  auto scene =
      parse_scene("{\"fields\": {\"a\": {\"file\": \"gone.vdb\", \"grid\": \"density\"}}}", "scene.json", {{"a", folder_ / "one.vdb", ""}});
  ASSERT_TRUE(scene);
  EXPECT_TRUE(resolve_field(*scene, "a", {}));
}

TEST(DisplayFieldOnDemand, SamplesFormulasOnceForRenderingAndKeepsThemExactForHaptics) {
  Scene scene = parsed(
      "{\"fields\": {\"ball\": {\"analytic\": \"sphere\", \"resolution\": 9, \"box\": [-1, 1]}}, \"volumes\": [{\"field\": \"ball\"}]}");
  const Entity ball = find_field(scene, "ball");
  const auto drawn = resolve_rendered_field(scene, ball, {});
  ASSERT_TRUE(drawn) << message_of(drawn);
  ASSERT_TRUE(drawn->scalar && drawn->scalar->is_grid());
  EXPECT_EQ(drawn->scalar->index_box().hi.x, 8);
  EXPECT_EQ(resolve_rendered_field(scene, ball, {})->scalar, drawn->scalar);
  EXPECT_FALSE(resolve_field(scene, ball, {})->scalar->is_grid());
  const TransferFunction transfer = only<Volume>(scene).transfer;
  EXPECT_GE(transfer.colors.size(), 2u);
  ASSERT_GE(transfer.extinctions.size(), 2u);
  for (std::size_t i = 1; i < transfer.extinctions.size(); ++i) EXPECT_GT(transfer.extinctions[i].value, transfer.extinctions[i - 1].value);
}

TEST(CurveOnDemand, SharesTracedCurvesAndErrorsNameTheLine) {
  Scene scene = parsed("{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}}}");
  const auto any = resolve_field(scene, "swirl", {});
  ASSERT_TRUE(any);
  const flow::Flow flow{any->vector.get(), false, 0};
  const auto a = resolve_streamline(scene, flow, {1, 0, 0}, {}), b = resolve_streamline(scene, flow, {1, 0, 0}, {});
  ASSERT_TRUE(a) << message_of(a);
  EXPECT_EQ(*a, *b);
  EXPECT_NE(*a, *resolve_streamline(scene, flow, {0.5, 0, 0}, {}));
  EXPECT_NE(*a, *resolve_streamline(scene, flow, {1, 0, 0}, {}, 0.25));
  const json::Node where = node_on(7);
  expect_error(resolve_streamline(scene, flow, {0, 0, 0}, where), "scene.json:7: ", {});
  expect_error(resolve_streamline(scene, flow, {std::nan(""), 0, 0}, where), "", {"not finite"});
}

TEST(CheckLevel, TheLevelMustBeInTheFieldsRange) {
  const auto ball = *field::make_analytic("sphere");
  const auto grid = field::sample_on_grid(*ball.scalar, 9, -2, 2);
  const json::Node where = node_on(3);
  EXPECT_TRUE(check_level(*grid, 1, where));
  EXPECT_TRUE(check_level(*ball.scalar, 100, where));
  for (const double bad : {-0.1, 5.0, std::nan("")}) expect_error(check_level(*grid, bad, where), "scene.json:3: level ", {"0..3.4641"});
}

TEST_F(DefaultScene, ScalarsBecomeAVolumeWithATransparentBackground) {
  write_grids(folder_ / "a.vdb");
  const Scene scene = value_of(scene_for_file(folder_ / "a.vdb"));
  EXPECT_EQ(scene.entities.count<Volume>(), 1u);
  EXPECT_EQ(scene.entities.count<StreamlineSet>(), 0u);
  EXPECT_FALSE(scene.camera.is_explicit);
  EXPECT_TRUE(find_field(scene, "ball"));
}

TEST_F(DefaultScene, VectorsBecomeStreamlines) {
  write_grids(folder_ / "a.vdb");
  const Scene scene = value_of(scene_for_file(folder_ / "a.vdb", "flow"));
  EXPECT_EQ(scene.entities.count<Volume>(), 0u);
  const auto set = only<StreamlineSet>(scene);
  ASSERT_TRUE(set.seeds.pattern && set.color_by);
  EXPECT_EQ(set.seeds.pattern->kind, SeedPattern::Kind::evenly_spaced);
  EXPECT_EQ(set.color_by->source, ColorBy::Source::speed);
  EXPECT_GT(set.length, 0);
  EXPECT_TRUE(find_field(scene, "flow"));
}

TEST_F(DefaultScene, ErrorsNameTheFile) {
  write_grids(folder_ / "a.vdb");
  test::write_file(folder_ / "torn.vdb", "not a vdb");
  for (const auto& [file, grid] :
       {std::pair{"none.vdb", ""}, std::pair{"torn.vdb", ""}, std::pair{"a.vdb", "speed"}, std::pair{"b.raw", ""}})
    expect_error(scene_for_file(folder_ / file, grid), "", {file});
}

TEST_F(MeshOnDemand, IsLoadedOnceAndPlaced) {
  test::write_file(folder_ / "quad.obj", kQuad);
  Scene scene = parsed(R"({"meshes": [{"name": "a", "file": "quad.obj", "scale": 3, "offset": [0, 0, 5], "color": [1, 0, 0]},
                                          {"name": "b", "file": "quad.obj", "visible": false}]})",
                       folder_ / "s.json");
  EXPECT_EQ(scene.entities.count<MeshSource>(), 2u);
  EXPECT_EQ(scene.entities.count<SurfaceMesh>(), 2u);
  const auto a = resolve_mesh(scene, "a", {}), again = resolve_mesh(scene, "a", {}), b = resolve_mesh(scene, "b", {});
  ASSERT_TRUE(a) << message_of(a);
  EXPECT_EQ(*a, *again);
  EXPECT_NE(*a, *b);
  EXPECT_EQ((*a)->min_corner(), Vec3(0, 0, 5));
  EXPECT_EQ((*a)->max_corner(), Vec3(6, 3, 5));
  EXPECT_EQ((*b)->domain_length(), 2);
  EXPECT_NE(message_of(resolve_mesh(scene, "c", {})).find("one of the scene's \"meshes\" was expected: a, b"), std::string::npos);
}

TEST_F(MeshOnDemand, BadMeshesAreRefusedWithTheirLine) {
  test::write_file(folder_ / "quad.obj", kQuad);
  test::write_file(folder_ / "torn.stl", "solid a\nfacet");
  const auto refused = [&](const std::string& item, const char* part) {
    expect_error(parse_scene("{\"meshes\": [\n" + item + "]}", folder_ / "s.json"), (folder_ / "s.json") + ":2: ", {part});
  };
  refused(R"({"name": "a", "file": "none.stl"})",
          "does not exist; a .stl, .obj, .vtu, .vtp, .vtm, .vtmb, .pvtp, .vtk, .pvd, .series, .ply or .gii file was expected");
  refused(R"({"name": "a", "file": "quad.x3q"})", "unknown kind");
  refused(R"({"name": "A", "file": "quad.obj"})", "is not allowed");
  refused(R"({"name": "a", "file": "quad.obj", "opacity": 1.5})", "\"opacity\" is 1.5; a number from 0 to 1 was expected");
  refused(R"({"name": "a", "file": "quad.obj", "scale": 0})", "scale");
  refused(R"({"name": "a", "file": "quad.obj", "colour": [1, 0, 0]})", "colour");
  refused(R"({"name": "a", "file": "quad.obj"}, {"name": "a", "file": "quad.obj"})", "the name \"a\" is already used for a mesh");
  Scene torn = parsed("{\"meshes\": [\n{\"name\": \"a\", \"file\": \"torn.stl\"}]}", folder_ / "s.json");
  expect_error(resolve_mesh(torn, "a", {}),
               (folder_ / "s.json") + ":2: mesh \"a\": ", {"torn.stl:2: the file ends too early; \"normal\" was expected"});
}

TEST_F(DefaultScene, AMeshFileIsDrawnAsASurface) {
  test::write_file(folder_ / "quad.obj", kQuad);
  const Scene scene = value_of(scene_for_file(folder_ / "quad.obj"));
  EXPECT_EQ(scene.entities.count<SurfaceMesh>(), 1u);
  EXPECT_FALSE(scene.camera.is_explicit);
  expect_error(scene_for_file(folder_ / "none.obj"), (folder_ / "none.obj") + ": ", {});
}

TEST_F(DefaultScene, RealScansAreTransparentInTheAir) {
  for (const auto& [name, air, tissue] : {std::tuple{"cranium_ct.vdb", -1000.0, 1500.0}, std::tuple{"colin27_brain_mr.vdb", 0.0, 100.0}}) {
    const std::string path = test::shared_data(name);
    if (path.empty()) GTEST_SKIP() << "no shared data";
    const auto volume = only<Volume>(value_of(scene_for_file(path, {}, {"dusk", {}})));
    const auto sigma = [&](double value) {
      double best = 1e300, found = 0;
      for (const auto& e : volume.transfer.extinctions)
        if (std::fabs(e.value - value) < best) best = std::fabs(e.value - value), found = e.sigma;
      return found;
    };
    EXPECT_LT(sigma(air), 1e-3 * sigma(tissue));
    EXPECT_GT(sigma(tissue), 0);
  }
}

TEST_F(DefaultScene, RealFlowsHaveLinesInTheirDomain) {
  for (const char* name : {"combustor_cfd.vdb", "carotid_flow.vdb"}) {
    SCOPED_TRACE(name);
    const std::string path = test::shared_data(name);
    if (path.empty()) GTEST_SKIP() << "no shared data";
    Scene scene = value_of(scene_for_file(path, "velocity"));
    ASSERT_EQ(scene.entities.count<StreamlineSet>(), 1u);
    ASSERT_TRUE(prepare(scene));
    const Entity lines = entities_of<StreamlineSet>(scene).at(0);
    EXPECT_GT(value_of(resolve_lines(scene, lines)).size(), 20u);
    const Bounds box = resolve_field(scene, only<StreamlineSet>(scene).field, {})->get()->world_bounds(),
                 drawn = lines_bounds(scene, lines);
    EXPECT_TRUE(drawn.lo.x >= box.lo.x - 1e-6 * box.diagonal());
    EXPECT_LE(drawn.hi.z, box.hi.z + 1e-6 * box.diagonal());
    EXPECT_GT(drawn.diagonal(), 0.5 * box.diagonal());
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
  Scene scene = parsed("{}");
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

}  // namespace catena::scene::load_on_demand_test
