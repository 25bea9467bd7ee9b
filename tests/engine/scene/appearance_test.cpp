// SPDX-License-Identifier: MIT
/// The keys "projection", "color_by" and "jitter" of the scene file.
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::appearance_test {

const std::string kFields = R"({"fields": {"s": {"analytic": "sphere"}, "t": {"analytic": "torus"}},)";

Result<Scene> parse(const std::string& rest) { return parse_scene(kFields + "\n" + rest + "}", "s.json"); }

TEST(SceneAppearance, AVolumesDefaultProjectionIsComposite) {
  const Scene scene = value_of(parse(R"("volumes": [{"field": "s"}])"));
  EXPECT_EQ(only<Volume>(scene).projection, Volume::Projection::composite);
  EXPECT_FALSE(only<Volume>(scene).color_by);
  EXPECT_FALSE(scene.jitter);
  using P = Volume::Projection;
  for (const auto& [word, projection] :
       {std::pair{"composite", P::composite}, {"maximum", P::maximum}, {"minimum", P::minimum}, {"average", P::average}})
    EXPECT_EQ(only<Volume>(value_of(parse("\"volumes\": [{\"field\": \"s\", \"projection\": \"" + std::string(word) + "\"}]"))).projection,
              projection);
}

TEST(SceneAppearance, ColoursByAnotherField) {
  const Scene scene = value_of(parse(R"("jitter": true,
    "volumes": [{"field": "s", "color_by": {"field": "t", "color": [[0, 1, 0, 0], [1, 0, 0, 1]]}}],
    "isosurfaces": [{"field": "s", "level": 1, "color_by": {"field": "t", "color": "inferno", "range": [0, 2]}}])"));
  EXPECT_EQ(scene.jitter, true);
  const auto volume = only<Volume>(scene);
  const auto surface = only<Isosurface>(scene);
  ASSERT_TRUE(volume.color_by && surface.color_by);
  EXPECT_EQ(volume.color_by->field, find_field(scene, "t"));
  EXPECT_EQ(volume.color_by->colors.size(), 2u);
  EXPECT_EQ(surface.color_by->named.map, "inferno");
  EXPECT_EQ((*surface.color_by->named.range)[1], 2);
}

TEST(SceneAppearance, ErrorsNameTheLine) {
  for (const auto& [text, expected] :
       {std::pair{R"("jitter": 1)", "true or false was expected"},
        {R"("volumes": [{"field": "s", "projection": "max"}])", "maximum"},
        {R"("volumes": [{"field": "s", "color_by": "t"}])", "color_by"},
        {R"("volumes": [{"field": "s", "color_by": {"field": "u"}}])", "unknown field \"u\""},
        {R"("volumes": [{"field": "s", "color_by": {"color": "viridis"}}])", "field"},
        {R"("volumes": [{"field": "s", "color_by": {"field": "t", "opacity": 1}}])", "opacity"},
        {R"("volumes": [{"field": "s", "projection": "maximum", "color_by": {"field": "t"}}])", "\"composite\" was expected"},
        {R"("volumes": [{"field": "s", "projection": "average", "gradient_opacity": [[0, 0], [1, 1]]}])", "\"composite\" was expected"},
        {R"("isosurfaces": [{"field": "s", "level": 1, "color_by": {"field": "t", "colour": "viridis"}}])", "colour"}})
    expect_error(parse(text), "s.json:2", {expected});
}

}  // namespace catena::scene::appearance_test
