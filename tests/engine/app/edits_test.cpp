// SPDX-License-Identifier: MIT
// Edits that panels record: execution in the queue of commands, and grouping into undo steps.
#include "engine/app/viewer/edit/edits.h"

#include <gtest/gtest.h>

#include "engine/app/viewer/edit/window_level.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/prepare.h"
#include "tests/support/results.h"

namespace catena::app::edits_test {

using test::value_of;

constexpr const char* kScene = R"({"fields": {"f": {"analytic": "gaussian"}}, "isosurfaces": [{"field": "f", "level": 0.5}]})";

struct Notes {
  Commands commands;
  EditState state;
  Edits edits{commands, state};

  /// Applies the edits as the session does after each frame.
  void carry_out(SceneModel& host) {
    for (const Command& command : std::exchange(commands, {})) {
      const Edit* edit = std::get_if<Edit>(&command);
      ASSERT_NE(edit, nullptr);
      value_of(host.apply(edit->edits, edit->undo_label, edit->undo_group));
    }
  }
};

SceneModel open_scene() { return value_of(SceneModel::open(value_of(scene::Document::create(kScene, "scene.json")), {})); }

TEST(Edits, AreQueuedAndAppliedInOrder) {
  SceneModel host = open_scene();
  Notes notes;
  notes.edits.set("/isosurfaces/0/opacity", "0.5", "opacity");
  notes.edits.remove("/isosurfaces/0", "remove isosurface");
  EXPECT_EQ(notes.commands.size(), 2u);
  EXPECT_EQ(host.document().text(), kScene);
  notes.carry_out(host);
  EXPECT_EQ(host.scene().entities.count<scene::Isosurface>(), 0u);
  EXPECT_EQ(host.document().undo_label(), "remove isosurface");
  EXPECT_TRUE(host.undo());
  EXPECT_EQ(host.document().undo_label(), "opacity") << "in order, a step each";
}

TEST(Edits, WindowAndLevelMoveTheRangeOfTheFirstVolumeOrSlice) {
  for (const char* item : {R"("volumes": [{"field": "f", "color": "grey", "range": [0.2, 0.6]}])",
                           R"("slices": [{"field": "f", "axis": "z", "at": 0, "range": [0.2, 0.6]}])"}) {
    auto document =
        value_of(scene::Document::create(std::string(R"({"fields": {"f": {"analytic": "gaussian"}}, )") + item + "}", "s.json"));
    scene::Scene scene = value_of(document.read());
    value_of(scene::prepare(scene));
    const DisplayRange whole = field::display_range(scene::rendered_field(scene, scene::find_field(scene, "f")));
    const TextEdits edits = make_window_level_edits(scene, 0.1, -0.05);
    ASSERT_FALSE(edits.empty()) << item;
    value_of(document.apply(edits, "window"));
    const scene::Scene edited = value_of(document.read());
    std::array<double, 2> range{};
    edited.entities.each<scene::Volume>([&](scene::Entity, const scene::Volume& v) { range = *v.transfer.named.range; });
    edited.entities.each<scene::Slice>([&](scene::Entity, const scene::Slice& s) { range = *s.color_by.named.range; });
    const double span = whole.hi - whole.lo;
    EXPECT_NEAR(range[1] - range[0], 0.4 + 0.1 * span, 2e-3);
    EXPECT_NEAR(0.5 * (range[0] + range[1]), 0.4 - 0.05 * span, 2e-3);
  }
  EXPECT_TRUE(make_window_level_edits(value_of(scene::parse_scene("{}", "s.json")), 1, 1).empty());
}

TEST(Edits, EditsOfOneGestureAreOneUndoStep) {
  SceneModel host = open_scene();
  Notes notes;
  for (int frame = 1; frame <= 5; ++frame) {
    notes.edits.drag("/isosurfaces/0/level", std::to_string(0.1 * frame), "isolevel");
    notes.carry_out(host);
  }
  EXPECT_TRUE(host.undo());
  EXPECT_EQ(host.document().text(), kScene);
  EXPECT_FALSE(host.document().can_undo());
}

TEST(Edits, EditsOfDifferentGesturesOrItemsAreSeparateUndoSteps) {
  SceneModel host = open_scene();
  Notes notes;
  notes.edits.drag("/isosurfaces/0/level", "0.1", "isolevel");
  ++notes.state.gesture;
  notes.edits.drag("/isosurfaces/0/level", "0.2", "isolevel");
  notes.edits.drag("/isosurfaces/0/opacity", "0.2", "opacity");
  notes.carry_out(host);
  int steps = 0;
  for (; host.document().can_undo(); ++steps) ASSERT_TRUE(host.undo());
  EXPECT_EQ(steps, 3);
}

TEST(Edits, ASetOfEditsIsAppliedCompletelyOrNotAtAll) {
  SceneModel host = open_scene();
  EXPECT_FALSE(host.apply({{"/isosurfaces/0/level", "0.1"}, {"/isosurfaces/0/opacity", "\"thick\""}}, "level"));
  EXPECT_EQ(host.document().text(), kScene);
}

}  // namespace catena::app::edits_test
