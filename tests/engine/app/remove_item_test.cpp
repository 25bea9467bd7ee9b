// SPDX-License-Identifier: MIT
// Removal of an item in the window together with its dependents, and repeated use of Feel.
#include "engine/app/viewer/edit/remove_item.h"

#include <gtest/gtest.h>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/base/json_edit.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::remove_item_test {

class ItemRemoval : public testing::Test {
 protected:
  void show(const std::string& text) { ASSERT_NO_FATAL_FAILURE(test::open_scene(folder_, text, host_)); }
  void remove(const std::string& item) {
    const Outcome done = host_->apply(make_remove_edits_with_links(host_->scene(), host_->document().text(), item), "remove");
    ASSERT_TRUE(done) << item << ": " << done.error().message;
  }
  void feel_item(const std::string& item, const std::optional<Vec3>& at = {}) {
    const auto thing = test::value_of(make_haptic_binding(host_->scene(), item, at, Vec3(5, 6, 7), 4));
    if (!find_bound_link(host_->scene(), thing).empty()) return;
    const Outcome done = host_->apply(make_binding_edits(host_->scene(), item, thing), "feel");
    ASSERT_TRUE(done) << done.error().message;
  }
  /// The value at a JSON pointer in the text, on one line; empty if there is none.
  std::string at(const std::string& pointer) const {
    const auto root = json::parse(host_->document().text(), "s");
    const json::Node* node = root ? json::find_value(*root, pointer) : nullptr;
    return node == nullptr ? "" : json::serialize_node(*node);
  }
  std::size_t links() const { return std::as_const(*host_).scene().entities.count<scene::Link>(); }

  test::TemporaryFolder folder_;
  std::optional<SceneModel> host_;
};

constexpr const char* kNamed = R"({"fields": {"g": {"analytic": "gaussian", "resolution": 8}, "v": {"analytic": "circle", "resolution": 8}},
  "slices": [{"field": "g", "axis": "x", "at": 0.1}, {"field": "g", "axis": "y", "at": 0.2}, {"field": "g", "axis": "z", "at": 0.3}],
  "isosurfaces": [{"field": "g", "level": 0.4}, {"field": "g", "level": 0.6}],
  "glyphs": [{"field": "v", "on": {"slice": 0}}, {"field": "v", "on": {"isosurface": 0}, "color_by": {"quantity": "speed"}},
             {"field": "v", "on": {"isosurface": 1}, "color_by": {"quantity": "speed"}}, {"field": "v", "on": {"slice": 2}}],
  "scalar_bars": [{"slice": 0, "title": "a"}, {"slice": 1, "title": "b"}, {"slice": 2, "title": "c"}, {"glyphs": 1, "title": "d"},
                  {"glyphs": 2, "title": "e"}]})";

TEST_F(ItemRemoval, IndicesOfLaterItemsAreUpdated) {
  show(kNamed);
  remove("slices[1]");
  EXPECT_EQ(at("/slices/1/axis"), "\"z\"");
  EXPECT_EQ(at("/scalar_bars/0"), R"({"slice": 0, "title": "a"})");
  EXPECT_EQ(at("/scalar_bars/1"), R"({"slice": 1, "title": "c"})") << "b went with its slice";
  EXPECT_EQ(at("/glyphs/0/on"), R"({"slice": 0})");
  EXPECT_EQ(at("/glyphs/3/on"), R"({"slice": 1})");
  EXPECT_EQ(at("/scalar_bars/3"), R"({"glyphs": 2, "title": "e"})");
}

TEST_F(ItemRemoval, GlyphsKeepTheirSlicesPlaneAndAreRemovedWithTheirIsosurface) {
  show(kNamed);
  remove("slices[0]");
  EXPECT_EQ(at("/glyphs/0/on"), R"({"plane": {"axis": "x", "at": 0.1}})");
  EXPECT_EQ(at("/glyphs/3/on"), R"({"slice": 1})");
  EXPECT_EQ(at("/scalar_bars/0"), R"({"slice": 0, "title": "b"})");
  remove("isosurfaces[0]");
  EXPECT_EQ(at("/glyphs/1"), R"({"field": "v", "on": {"isosurface": 0}, "color_by": {"quantity": "speed"}})");
  EXPECT_EQ(at("/glyphs/2/on"), R"({"slice": 1})");
  EXPECT_EQ(at("/scalar_bars/2"), R"({"glyphs": 1, "title": "e"})");
  EXPECT_EQ(at("/scalar_bars/3"), "");
  // Each removal is one undo step.
  ASSERT_TRUE(host_->undo());
  ASSERT_TRUE(host_->undo());
  EXPECT_EQ(host_->document().text(), kNamed);
}

TEST_F(ItemRemoval, LinksBoundToAnItemAreRemovedWithIt) {
  test::write_file(folder_ / "ball.stl", test::binary_stl(test::sphere_soup(8, 0.8)));
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 16}, "h": {"analytic": "gaussian", "resolution": 16},
                      "flow": {"analytic": "helix", "resolution": 16}},
    "isosurfaces": [{"field": "g", "level": 0.5}], "volumes": [{"field": "h"}], "slices": [{"field": "g", "axis": "z", "at": 0.25}],
    "streamlines": [{"field": "flow", "seeds": [[0.6, 0, -0.8], [-0.5, 0.2, 0.1]], "length": 1}],
    "meshes": [{"name": "ball", "file": "ball.stl"}],
    "chain": [{"name": "pin", "type": "point", "position": [0, 0, 0]}, {"name": "other", "type": "isosurface", "field": "g", "level": 0.3}]})");
  const std::string before = host_->document().text();
  for (const char* item : {"isosurfaces[0]", "volumes[0]", "slices[0]", "streamlines[0]", "meshes[0]"}) {
    feel_item(item, Vec3(0.3, 0.1, 0.2));
    ASSERT_EQ(links(), 3u) << item;
    remove(item);
    EXPECT_EQ(links(), 2u) << item;
    EXPECT_EQ(at("/chain/0/name"), "\"pin\"");
    EXPECT_EQ(at("/chain/1/name"), "\"other\"");
    ASSERT_TRUE(host_->undo());
    EXPECT_EQ(links(), 3u) << "one step";
    ASSERT_TRUE(host_->undo());
    ASSERT_EQ(host_->document().text(), before);
  }
}

TEST_F(ItemRemoval, ALinkStaysWhileAnotherItemUsesIt) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 16}},
    "isosurfaces": [{"field": "g", "level": 0.5, "opacity": 0.5}, {"field": "g", "level": 0.5}], "volumes": [{"field": "g"}],
    "slices": [{"field": "g", "axis": "z", "at": 0.25}, {"field": "g", "axis": "z", "at": 0.25}]})");
  feel_item("isosurfaces[0]");
  feel_item("slices[0]");
  ASSERT_EQ(links(), 2u);
  remove("volumes[0]");
  remove("isosurfaces[1]");
  remove("slices[0]");
  EXPECT_EQ(links(), 2u);
  remove("isosurfaces[0]");
  remove("slices[0]");
  EXPECT_EQ(links(), 0u);
}

TEST_F(ItemRemoval, ASecondFeelUpdatesTheExistingLink) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 16}, "flow": {"analytic": "helix", "resolution": 16}},
    "isosurfaces": [{"field": "g", "level": 0.5}], "volumes": [{"field": "g"}],
    "streamlines": [{"field": "flow", "seeds": [[0.6, 0, -0.8], [-0.5, 0.2, 0.1]], "length": 1}]})");
  feel_item("isosurfaces[0]");
  feel_item("isosurfaces[0]");
  EXPECT_EQ(links(), 1u);
  feel_item("volumes[0]", Vec3(0.3, 0.1, 0.2));
  ASSERT_EQ(links(), 2u) << "the volume at another level than the surface";
  const std::string level = at("/chain/1/level"), name = at("/chain/1/name");
  ASSERT_TRUE(host_->apply({{"/chain/1/stiffness", "321"}}, "stiffness"));
  feel_item("volumes[0]", Vec3(0.6, 0.1, 0.2));
  ASSERT_EQ(links(), 2u);
  EXPECT_NE(at("/chain/1/level"), level);
  EXPECT_EQ(at("/chain/1/name"), name);
  EXPECT_EQ(at("/chain/1/stiffness"), "321");
  feel_item("streamlines[0]", Vec3(0.6, 0, -0.8));
  const std::string seed = at("/chain/2/seed");
  feel_item("streamlines[0]", Vec3(-0.5, 0.2, 0.1));
  EXPECT_EQ(links(), 3u);
  EXPECT_NE(at("/chain/2/seed"), seed);
}

}  // namespace catena::app::remove_item_test
