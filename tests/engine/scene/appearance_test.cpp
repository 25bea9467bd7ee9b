// SPDX-License-Identifier: MIT
/// The keys "projection", "color_by" and "jitter" of the scene file.
#include <gtest/gtest.h>

#include "engine/scene/scene.h"

namespace catena::scene {
namespace appearance_test {

const std::string kFields = R"({"fields": {"s": {"analytic": "sphere"}, "t": {"analytic": "torus"}},)";

Result<Scene> parse(const std::string& rest) { return parse_scene(kFields + "\n" + rest + "}", "s.json"); }

Volume first_volume(Scene& scene) {
  Volume found;
  scene.entities.each<Volume>([&](Entity, const Volume& volume) { found = volume; });
  return found;
}

TEST(SceneAppearance, AVolumesDefaultProjectionIsComposite) {
  auto scene = parse(R"("volumes": [{"field": "s"}])");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(first_volume(*scene).projection, Volume::Projection::composite);
  EXPECT_FALSE(first_volume(*scene).color_by);
  EXPECT_FALSE(scene->jitter);
  using P = Volume::Projection;
  for (const auto& [word, projection] :
       {std::pair{"composite", P::composite}, {"maximum", P::maximum}, {"minimum", P::minimum}, {"average", P::average}}) {
    auto other = parse("\"volumes\": [{\"field\": \"s\", \"projection\": \"" + std::string(word) + "\"}]");
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_EQ(first_volume(*other).projection, projection);
  }
}

TEST(SceneAppearance, ColoursByAnotherField) {
  auto scene = parse(R"("jitter": true,
    "volumes": [{"field": "s", "color_by": {"field": "t", "color": [[0, 1, 0, 0], [1, 0, 0, 1]]}}],
    "isosurfaces": [{"field": "s", "level": 1, "color_by": {"field": "t", "color": "inferno", "range": [0, 2]}}])");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->jitter, true);
  const Volume volume = first_volume(*scene);
  ASSERT_TRUE(volume.color_by);
  EXPECT_EQ(volume.color_by->field, find_field(*scene, "t"));
  EXPECT_EQ(volume.color_by->colors.size(), 2u);
  int surfaces = 0;
  scene->entities.each<Isosurface>([&](Entity, const Isosurface& surface) {
    ++surfaces;
    ASSERT_TRUE(surface.color_by);
    EXPECT_EQ(surface.color_by->named.map, "inferno");
    EXPECT_EQ((*surface.color_by->named.range)[1], 2);
  });
  EXPECT_EQ(surfaces, 1);
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
        {R"("isosurfaces": [{"field": "s", "level": 1, "color_by": {"field": "t", "colour": "viridis"}}])", "colour"}}) {
    const auto scene = parse(text);
    ASSERT_FALSE(scene) << text;
    EXPECT_NE(scene.error().message.find(expected), std::string::npos) << scene.error().message;
    EXPECT_EQ(scene.error().message.find("s.json:2"), 0u) << scene.error().message;
  }
}

}  // namespace appearance_test
}  // namespace catena::scene
