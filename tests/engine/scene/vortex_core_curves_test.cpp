// SPDX-License-Identifier: MIT
#include "engine/scene/vortex_core_curves.h"

#include "engine/scene/document.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::vortex_core_curves_test {

Result<Scene> scene_with(const std::string& curves, const std::string& more = "") {
  return parse_scene(R"({"fields": {"ring": {"analytic": "hill"}, "abc": {"analytic": "abc"}, "still": {"analytic": "uniform"},
    "ball": {"analytic": "sphere"}},
"curves": [{"name": "core", )" +
                         curves + "}]" + more + "}",
                     "scene.json");
}

Result<curves::CurveSetPtr> traced(Scene& scene) { return resolve_curves(scene, find_named<CurvesSource>(scene, "core")); }

TEST(TracedCores, EqualTheCurvesOfLinks) {
  Scene scene = value_of(scene_with(R"("vortex_cores": {"field": "ring"})"));
  const auto set = value_of(traced(scene));
  ASSERT_EQ(set->line_count(), 1u);
  EXPECT_EQ(set->points.front(), set->points.back()) << "closed";
  EXPECT_NE(set->find_values("swirl"), nullptr);
  // The tolerance covers chords, 1e-6 L, and the rounding of single precision.
  for (std::size_t k = 0; k + 1 < set->points.size(); ++k) {
    const Vec3 p = 0.5 * (Vec3(set->points[k]) + Vec3(set->points[k + 1]));
    ASSERT_LE(norm(p - direction(Vec3(p.x, p.y, 0)) * std::sqrt(0.5)), 4e-6 + 2e-7) << k;
  }
  const auto field = resolve_field(scene, "ring", {});
  const auto cores = flow::find_vortex_cores(field->vector, {});
  EXPECT_EQ(scene.entities.get<CurvesSource>(find_named<CurvesSource>(scene, "core")).vortex_cores->cores, *cores) << "one object";
}

TEST(TracedCores, AreKeptByUnrelatedEdits) {
  auto old = scene_with(R"("vortex_cores": {"field": "ring"})");
  const auto set = traced(*old);
  for (const auto& [curves, same] : {std::pair(R"("vortex_cores": {"field": "ring"}, "color": [1, 0, 0])", true),
                                     std::pair(R"("vortex_cores": {"field": "ring", "criterion": "vorticity"})", false)}) {
    auto fresh = scene_with(curves);
    transfer_state(*old, *fresh);
    const auto now = traced(*fresh);
    ASSERT_TRUE(set && now);
    EXPECT_EQ(*now == *set, same) << curves;
    transfer_state(*fresh, *old);
  }
}

TEST(TracedCores, ErrorsNameTheLine) {
  for (const auto& [curves, part] : {std::pair{R"("vortex_cores": {"field": "abc", "criterion": "vorticity"})", "everywhere"},
                                     {R"("vortex_cores": {"field": "still"})", "no vortex core"},
                                     {R"("vortex_cores": {"field": "ball"})", "a vector field was expected"},
                                     {R"("vortex_cores": {"field": "nobody"})", "unknown field"},
                                     {R"("radius": 1)", "neither"}}) {
    auto scene = scene_with(curves);
    expect_error(scene ? traced(*scene) : scene.error(), "scene.json:3:", {part});
  }
}

}  // namespace catena::scene::vortex_core_curves_test
