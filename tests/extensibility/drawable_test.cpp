// SPDX-License-Identifier: MIT
// A custom drawable of this test, registered with one row in the scene and one in the extraction: it is read, drawn, picked, counted, and
// known to scalar bars and the schema without further code.
#include <gtest/gtest.h>

#include "engine/app/cli/scene_schema.h"
#include "engine/app/viewer/input/pick.h"
#include "engine/scene/drawable.h"
#include "engine/scene/reader_bindings.h"
#include "render/extract/drawable.h"
#include "render/extract/extract.h"

namespace drawable_test {

using namespace catena;

/// A bead: a ball at a position, colored by its height.
struct Bead {
  json::Node where;
  Vec3 position{0.0};
  double radius = 0.1;
  std::optional<scene::ColorBy> color_by{};
};

const scene::Table<Bead>& bead_table() {
  static const auto table = [] {
    scene::Table<Bead> t;
    t.bind(schema::vec3("at", "world", "Center of the bead.").required(), &Bead::position);
    t.bind(schema::number("radius", "world", "Radius of the bead.").positive(), &Bead::radius);
    t.companion(scene::visible_key());
    return t;
  }();
  return table;
}

scene::Part beads_part() {
  return {scene::make_list_component("beads", "Balls at places.", bead_table()), [](scene::Scene& scene, const json::Node& node) {
            return scene::each_item(node, [&](const json::Node& item) -> Outcome {
              Bead bead;
              bead.where = item;
              CATENA_CHECK(bead_table().read(scene, item, bead));
              const scene::Entity e = scene.entities.create();
              scene.entities.emplace<Bead>(e, std::move(bead));
              return scene::read_visible(scene, e, item);
            });
          }};
}

Outcome extract_beads(const scene::Scene& scene, render::FramePacket& packet) {
  scene.entities.each<Bead>([&](scene::Entity e, const Bead& bead) {
    if (is_hidden(scene.entities, e)) return;
    const std::uint32_t id = packet.add_object("bead", "", bead.where.label);
    auto ball = std::make_shared<render::SphereSet>();
    ball->origin = bead.position;
    ball->offsets = {glm::vec3(0.f)};
    ball->radii = {static_cast<float>(bead.radius)};
    ball->colors = {{1, 0, 0}};
    packet.spheres.push_back({std::move(ball), id});
  });
  return Done{};
}

const bool registered = [] {
  scene::register_drawable(scene::make_drawable<Bead>(beads_part, "beads", "bead", "beads", "bead"));
  render::register_extraction({"beads", nullptr, extract_beads, nullptr});
  return true;
}();

TEST(CustomDrawable, IsReadDrawnPickedAndCounted) {
  ASSERT_TRUE(registered);
  auto scene = scene::parse_scene(R"({"beads": [{"at": [0, 0, 0], "radius": 0.5}, {"at": [3, 0, 0], "visible": false}],
 "camera": {"position": [0, -5, 0], "target": [0, 0, 0]}})",
                                  "s.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene::drawables().back().items(scene->entities).size(), 2u);
  const auto packet = render::make_frame(*scene, 100, 100);
  ASSERT_TRUE(packet) << packet.error().message;
  ASSERT_EQ(packet->spheres.size(), 1u);
  EXPECT_EQ(packet->objects.at(0).kind, "bead");
  EXPECT_TRUE(app::pick_on_cpu(*packet, 50, 50)) << "the bead is in the middle of the image";
  EXPECT_NEAR(render::packet_bounds(*packet).diagonal(), std::sqrt(3.0), 1e-9);
}

TEST(CustomDrawable, IsInTheSchemaAndRefusedWithItsLine) {
  EXPECT_NE(app::scene_json_schema().find("\"beads\""), std::string::npos);
  const auto wrong = scene::parse_scene("{\"beads\": [\n{\"at\": [0, 0, 0], \"radius\": -1}]}", "s.json");
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(wrong.error().message.starts_with("s.json:2: ")) << wrong.error().message;
  const auto bar = scene::parse_scene(R"({"beads": [{"at": [0, 0, 0]}], "scalar_bars": [{"bead": 0}]})", "s.json");
  ASSERT_FALSE(bar);
  EXPECT_NE(bar.error().message.find("this bead shows no values"), std::string::npos) << bar.error().message;
}

}  // namespace drawable_test
