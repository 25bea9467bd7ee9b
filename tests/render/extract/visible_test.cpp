// SPDX-License-Identifier: MIT
// "visible": false hides the drawn object and changes nothing else.
#include "tests/render/support/scene_packet.h"
#include "tests/support/support.h"

namespace catena::render::visible_test {

std::string scene_text(const std::string& visible) {
  std::string text = R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}, "v": {"analytic": "circle"}},
    "volumes": [{"field": "s"VISIBLE}, {"field": "s"}],
    "isosurfaces": [{"field": "s", "level": 1VISIBLE}],
    "slices": [{"field": "s", "axis": "z", "at": 0VISIBLE}, {"field": "v", "axis": "x", "at": 0.5}],
    "streamlines": [{"field": "v", "seeds": [[1, 0, 0]], "color_by": {"quantity": "speed"}VISIBLE}],
    "meshes": [{"name": "m", "file": "m.obj"VISIBLE}],
    "scalar_bars": [{"volume": 0}, {"slice": 0}, {"slice": 1}, {"streamlines": 0}]})";
  for (std::size_t at; (at = text.find("VISIBLE")) != std::string::npos;) text.replace(at, 7, visible);
  return text;
}

class VisibleKey : public testing::Test {
 protected:
  FramePacket packet(const std::string& visible) {
    test::write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    scene_ = test::scene_from(scene_text(visible), folder_ / "s.json");
    return test::packet_from(scene_, 32, 32);
  }
  test::TemporaryFolder folder_;
  scene::Scene scene_;
};

TEST_F(VisibleKey, TrueIsTheDefault) {
  for (const char* visible : {"", ", \"visible\": true"}) {
    const FramePacket all = packet(visible);
    EXPECT_EQ(all.volumes.size(), 2u);
    EXPECT_EQ(all.isosurfaces.size(), 1u);
    EXPECT_EQ(all.slices.size(), 2u);
    EXPECT_EQ(all.tubes.size(), 1u);
    EXPECT_EQ(all.meshes.size(), 1u);
    EXPECT_EQ(all.overlay.scalar_bars.size(), 4u);
  }
}

TEST_F(VisibleKey, FalseHidesTheObjectAndItsScalarBar) {
  const FramePacket some = packet(", \"visible\": false");
  EXPECT_EQ(some.volumes.size(), 1u);
  EXPECT_TRUE(some.isosurfaces.empty());
  ASSERT_EQ(some.slices.size(), 1u);
  EXPECT_TRUE(some.tubes.empty());
  EXPECT_TRUE(some.meshes.empty());
  // the bar of the visible slice, in its colours
  ASSERT_EQ(some.overlay.scalar_bars.size(), 1u);
  EXPECT_EQ(some.overlay.scalar_bars[0].colors, some.slices[0].colors);
  EXPECT_EQ(scene_.entities.count<scene::Volume>(), 2u) << "it is still of the scene";
}

TEST_F(VisibleKey, OnlyBooleansAreAccepted) {
  for (const char* list : {R"("volumes": [{"field": "s")", R"("isosurfaces": [{"field": "s", "level": 1)",
                           R"("slices": [{"field": "s", "axis": "z", "at": 0)"}) {
    const auto scene =
        scene::parse_scene(R"({"fields": {"s": {"analytic": "sphere"}}, )" + std::string(list) + ",\n\"visible\": 0}]}", "s.json");
    ASSERT_FALSE(scene) << list;
    EXPECT_EQ(scene.error().message.find("s.json:2: "), 0u) << scene.error().message;
    EXPECT_NE(scene.error().message.find("visible"), std::string::npos) << scene.error().message;
  }
}

}  // namespace catena::render::visible_test
