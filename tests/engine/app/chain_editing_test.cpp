// SPDX-License-Identifier: MIT
// Edits of the scene's text by the chain and widget panels.
#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/scene/ruler.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/base/json_edit.h"
#include "haptics/build/build_program.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::chain_editing_test {

using test::fails;
using test::value_of;

constexpr const char* kScene = R"({
  // the flow
  "fields": {"ball": {"analytic": "sphere"}, "flow": {"analytic": "circle"}},
  "chain": [{"name": "line", "type": "streamline", "field": "flow", "seed": [1, 0, 0]},
            {"name": "skin", "type": "anisotropic_friction", "surface": "ball", "level": 1, "field": "flow", "enabled": false}],
  "isosurfaces": [{"field": "ball", "level": 1}]
})";

constexpr const char* kFields = R"({"fields": {"flow": {"analytic": "circle"}, "ball": {"analytic": "sphere"}}})";

struct Fixture {
  explicit Fixture(const std::string& text = kScene) { test::open_scene(folder, text, host); }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const ChainRow& row : make_chain_rows(host->scene(), {})) out.push_back(row.name);
    return out;
  }
  ChainRow row() const { return make_chain_rows(host->scene(), {})[0]; }
  /// Adds a link of the type at the probe, as the panel does; returns its text.
  std::string add_link(const std::string& type, const Vec3& probe) {
    const std::string link = value_of(make_link_json(host->scene(), type, probe, 4));
    const Outcome added = host->set("/chain/-", link, "add");
    EXPECT_TRUE(added) << type << ": " << link << ": " << added.error().message;
    return link;
  }
  void add_validator() {
    host->set_validator([](scene::Scene& scene) -> Outcome {
      CATENA_CHECK(haptics::build_program(scene));
      return Done{};
    });
  }
  test::TemporaryFolder folder;
  std::optional<SceneModel> host;
};

/// The types whose links need no file.
std::vector<std::string> types_without_files() {
  std::vector<std::string> types;
  for (const std::string& type : link_types())
    if (type != "mesh" && type != "curves" && type != "points") types.push_back(type);
  return types;
}

TEST(ChainEdit, RowsAreTheChainItemsWithTheirProgramLinks) {
  const Fixture f;
  const auto rows = make_chain_rows(f.host->scene(), {"line", "skin_surface", "skin_direction", "skin_friction"});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].links, (std::vector<std::size_t>{0}));
  EXPECT_TRUE(rows[0].enabled);
  EXPECT_EQ(rows[1].links, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_FALSE(rows[1].enabled);
  EXPECT_EQ(rows[1].pointer("level"), "/chain/1/level");
}

TEST(ChainEdit, ANewLinkOfEveryTypeBuildsAProgram) {
  for (const std::string& type : types_without_files()) {
    Fixture f(kFields);
    const std::string link = f.add_link(type, Vec3(0.5, 0.25, 0.1));
    f.add_link(type, Vec3(0.5, 0.25, 0.1));  // the second link of a type gets a unique name
    const auto program = haptics::build_program(f.host->scene());
    ASSERT_TRUE(program) << type << ": " << link << ": " << program.error().message;
    EXPECT_EQ(f.names(), (std::vector<std::string>{type, type + "_2"}));
  }
  Fixture f(kFields), bare(R"({"fields": {"ball": {"analytic": "sphere"}}})");
  const auto refused = [](Fixture& in, const char* type) { return make_link_json(in.host->scene(), type, Vec3(0.0), 4).error().message; };
  EXPECT_EQ(refused(f, "mesh"), "a mesh needs a mesh, which the scene does not have");
  EXPECT_EQ(refused(f, "curves"), "curves cannot be felt: the scene has none");
  EXPECT_EQ(refused(f, "points"), "points cannot be felt: the scene has none");
  EXPECT_EQ(refused(bare, "streamline"), "a streamline needs a vector field, which the scene does not have");
}

TEST(ChainEdit, AddedKeysHaveValidValues) {
  for (const std::string& type : types_without_files()) {
    Fixture f(kFields);
    const Vec3 probe(0.5, 0.25, 0.1);
    f.add_link(type, probe);
    f.add_validator();
    for (const schema::Key& key : link_type_keys(type)) {
      const ChainRow row = f.row();
      // Excludes keys that contradict each other.
      if (row.node.find(key.name) != nullptr || key.name == "coefficient" || key.name == "method") continue;
      const auto edits = make_add_key_edits(f.host->scene(), row, key, probe, 4);
      if (edits.empty()) continue;
      const std::string value = *edits[0].value;
      const Outcome done = f.host->apply(edits, "add");
      EXPECT_TRUE(done) << type << " " << key.name << " " << value << ": " << done.error().message;
    }
  }
}

constexpr const char* kDrawn = R"({
  "fields": {"other": {"analytic": "plane"}, "ball": {"analytic": "sphere"}, "flow": {"analytic": "circle"}},
  "widgets": [{"name": "iso", "type": "isolevel", "field": "other", "position": [0, 0, 0.5]}],
  "isosurfaces": [{"field": "ball", "level": 0.3, "visible": false}, {"field": "ball", "level": 1.2345678901}, {"field": "ball", "level": 0.7},
                  {"field": "other", "level": {"widget": "iso"}}]
})";

/// The link's field and level as they are written in its text.
std::pair<std::string, std::string> surface_of(const json::Node& link) {
  const json::Node* level = link.find("level");
  return {scene::level_field_name(link), level == nullptr ? "" : json::serialize_node(*level)};
}

TEST(ChainEdit, ANewLinkLiesOnTheNearestDrawnSurface) {
  int with_level = 0;
  for (const std::string& type : types_without_files()) {
    Fixture f(kDrawn);
    const Vec3 probe(1.1, 0, 0);  // |x| = 1.1: nearer to 1.23 than to 0.7
    f.add_link(type, probe);
    ChainRow row = f.row();
    // Adds the optional key "surface".
    for (const schema::Key& key : link_type_keys(type))
      if (key.name == "surface" && row.node.find("surface") == nullptr) {
        ASSERT_TRUE(f.host->apply(make_add_key_edits(f.host->scene(), row, key, probe, 4), "add")) << type;
        row = f.row();
      }
    const auto [field, level] = surface_of(row.node);
    if (level.empty()) continue;
    ++with_level;
    EXPECT_EQ(field, "ball") << type;
    EXPECT_EQ(level, "1.2345678901") << type << ": all digits of what is drawn";
    // After a change to a field whose surface follows a widget, the link's level follows the same widget.
    for (const schema::Key& key : link_type_keys(type))
      if (key.role == schema::Role::scalar_field) {
        const Outcome done = f.host->apply(make_change_field_edits(f.host->scene(), row, key, "other", probe), "field");
        ASSERT_TRUE(done) << type << ": " << done.error().message;
      }
    EXPECT_EQ(surface_of(f.row().node), (std::pair<std::string, std::string>("other", R"({"widget": "iso"})"))) << type;
    const auto program = haptics::build_program(f.host->scene());
    EXPECT_TRUE(program) << type << ": " << program.error().message;
  }
  EXPECT_GE(with_level, 5) << "isosurface, friction, modulated friction, texture, the ready-made mode";
}

TEST(ChainEdit, DraggingALevelMovesAllLevelsOfTheSurface) {
  Fixture f(R"({
    "fields": {"ball": {"analytic": "sphere"}, "other": {"analytic": "plane"}, "flow": {"analytic": "circle"}},
    "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1},
              {"name": "rough", "type": "texture", "surface": "ball", "level": 1, "wavelength": 0.1},
              {"name": "inner", "type": "isosurface", "field": "ball", "level": 0.5},
              {"name": "easy", "type": "anisotropic_friction", "surface": "ball", "level": 1, "field": "flow"},
              {"name": "flat", "type": "isosurface", "field": "other", "level": 1}],
    "isosurfaces": [{"field": "ball", "level": 1}, {"field": "ball", "level": 0.25}] })");
  const auto rows = make_chain_rows(f.host->scene(), {});
  ASSERT_EQ(rows.size(), 5u);
  // The levels that change with the histogram of the isosurface.
  EXPECT_EQ(find_link_levels(f.host->scene(), "ball", 1), (std::vector<std::string>{"/chain/0/level", "/chain/1/level", "/chain/3/level"}));
  // The levels that change with the key of a link: the isosurface's and the other links'.
  EXPECT_EQ(find_coupled_levels(f.host->scene(), rows[1]),
            (std::vector<std::string>{"/isosurfaces/0/level", "/chain/0/level", "/chain/3/level"}));
  EXPECT_TRUE(find_coupled_levels(f.host->scene(), rows[2]).empty()) << "no surface is drawn there";
  EXPECT_TRUE(find_coupled_levels(f.host->scene(), rows[4]).empty()) << "another field";
}

TEST(ChainEdit, SwappingNeighboursIsOneUndoStepAndKeepsTheOtherText) {
  Fixture f;
  const std::string before = f.host->document().text();
  const auto rows = make_chain_rows(f.host->scene(), {});
  ASSERT_TRUE(f.host->apply(make_swap_edits(rows[0], rows[1]), "move line"));
  EXPECT_EQ(f.names(), (std::vector<std::string>{"skin", "line"}));
  EXPECT_NE(f.host->document().text().find("// the flow"), std::string::npos);
  ASSERT_TRUE(f.host->undo());
  EXPECT_EQ(f.host->document().text(), before);
  EXPECT_FALSE(f.host->document().can_undo());
}

TEST(ChainEdit, AnEditThatBuildsNoProgramChangesNothing) {
  Fixture f;
  ASSERT_TRUE(haptics::build_program(f.host->scene()));
  f.add_validator();
  const auto text = f.host->document().text();
  const auto loaded = [&] {
    return f.host->scene().entities.get<scene::FieldSource>(scene::find_field(f.host->scene(), "ball")).loaded.get();
  };
  const auto before = loaded();
  ASSERT_NE(before, nullptr);
  EXPECT_TRUE(fails(f.host->set("/chain/0/release", "-1", "release"), "release"));
  EXPECT_EQ(f.host->document().text(), text);
  EXPECT_FALSE(f.host->document().can_undo());
  EXPECT_FALSE(f.host->take_changed());
  EXPECT_EQ(f.row().node.find("release"), nullptr);
  EXPECT_EQ(loaded(), before) << "what was loaded is still there";
  EXPECT_TRUE(f.host->set("/chain/0/release", "0.5", "release"));
  EXPECT_TRUE(f.host->take_changed());
}

TEST(NewWidget, EveryTypeIsValidAndHasAUniqueName) {
  Fixture f;
  for (const std::string& type : list_widget_types())
    for (int n = 0; n < (type == "seed" ? 2 : 1); ++n) {
      value_of(f.host->apply(value_of(make_add_widget_edits(f.host->scene(), type, test::cube_bounds(), Vec3(0, -1, 0))), "add"));
    }
  int count = 0;
  f.host->scene().entities.each<scene::Widget>([&](scene::Entity, const scene::Widget&) { ++count; });
  EXPECT_EQ(count, 7);
  EXPECT_TRUE(scene::find_widget(f.host->scene(), "seed_2"));
  EXPECT_TRUE(scene::find_widget(f.host->scene(), "cut"));
  EXPECT_EQ(f.host->scene().clip_planes.size(), 7u) << "the plane and the six faces of the box clip";
}

}  // namespace catena::app::chain_editing_test
