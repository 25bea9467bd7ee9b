// SPDX-License-Identifier: MIT
#include "haptics/constraints/presets/mode_presets.h"

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::mode_presets_test {

json::Node node_of(const std::string& text) {
  auto node = json::parse(text, "scene.json");
  EXPECT_TRUE(node) << node.error().message;
  return node ? *node : json::Node{};
}

const std::string kSkin = R"({"name": "skin", "type": "anisotropic_friction",
  "surface": "density",
  "level": 0.45,
  "field": "velocity")";

TEST(ModePresets, AnisotropicFrictionIsThreeLinks) {
  const auto links = expand_link(node_of(kSkin + R"(, "kind": "line", "threshold": 0.02, "tau_min": 0.001,
    "tau_max": 0.01, "law": "as_published", "free": "above", "release": 0.3, "stiffness": 70, "active_when": {"button": 2}, "release_cue": {"type": "detent"}})"));
  ASSERT_TRUE(links) << links.error().message;
  ASSERT_EQ(links->size(), 3u);
  const char* names[] = {"skin_surface", "skin_direction", "skin_friction"};
  const char* types[] = {"isosurface", "friction", "modulated_friction"};
  const std::vector<std::string> keys[] = {
      {"name", "type", "stiffness", "release", "active_when", "release_cue", "field", "level", "free"},
      {"name", "type", "stiffness", "active_when", "field", "kind", "threshold", "surface", "level"},
      {"name", "type", "stiffness", "active_when", "field", "kind", "surface", "level", "tau_min", "tau_max", "law"}};
  for (std::size_t i = 0; i < 3; ++i) {
    const json::Node& link = (*links)[i];
    EXPECT_EQ(link.find("name")->string, names[i]);
    EXPECT_EQ(link.find("type")->string, types[i]);
    std::vector<std::string> found;
    for (const auto& member : link.members) found.push_back(member.first);
    EXPECT_EQ(found, keys[i]);
    EXPECT_EQ(link.find("level")->line, 3);
    EXPECT_EQ(*link.find("level")->file, "scene.json");
    EXPECT_EQ(link.find("stiffness")->number, 70);
  }
  EXPECT_EQ((*links)[0].find("field")->string, "density");
  EXPECT_EQ((*links)[1].find("field")->string, "velocity");
  EXPECT_EQ((*links)[2].find("surface")->string, "density");
}

TEST(ModePresets, AConstraintIsNotExpanded) {
  const auto links = expand_link(node_of(R"({"name": "a", "type": "point", "position": [0, 0, 0]})"));
  ASSERT_TRUE(links);
  ASSERT_EQ(links->size(), 1u);
  EXPECT_EQ((*links)[0].find("name")->string, "a");
}

// every key of a preset is mapped to a key that the constraint's type has
TEST(ModePresets, TheTableMatchesTheRegistry) {
  for (const ModePreset& mode : mode_presets()) {
    EXPECT_EQ(find_constraint_type(mode.type), nullptr);
    EXPECT_EQ(find_mode_preset(mode.type), &mode);
    for (const schema::Key& key : mode.keys) {
      int handed = 0;
      for (const ModePreset::LinkTemplate& part : mode.link_templates) {
        const ConstraintType* type = find_constraint_type(part.type);
        ASSERT_NE(type, nullptr) << part.type;
        for (const ModePreset::KeyMapping& hand : part.keys) {
          handed += hand.from == key.name;
          EXPECT_EQ(std::ranges::count(type->keys, hand.to, &schema::Key::name), 1) << part.type << " " << hand.to;
        }
      }
      EXPECT_GT(handed, 0) << key.name;
    }
  }
}

TEST(ModePresets, ErrorsNameTheLine) {
  const auto refused = [](const std::string& text, int line, const std::string& what) {
    const auto made = expand_link(node_of(text));
    ASSERT_FALSE(made) << text;
    EXPECT_TRUE(made.error().message.starts_with(fmt::format("scene.json:{}: ", line))) << made.error().message;
    EXPECT_NE(made.error().message.find(what), std::string::npos) << made.error().message;
  };
  refused("{\"name\": \"skin\",\n\"type\": \"anisotropic_friction\", \"level\": 1, \"field\": \"v\"}", 1, "\"surface\"");
  refused("{\"name\": \"skin\", \"type\": \"anisotropic_friction\", \"surface\": \"s\", \"field\": \"v\"}", 1, "\"level\"");
  refused(kSkin + ",\n\"treshold\": 1}", 5, "did you mean \"threshold\"");
}

}  // namespace catena::haptics::tests::mode_presets_test
