// SPDX-License-Identifier: MIT
// Unused items of a scene cost nothing: bytes loaded and mirrored, pipelines, images, copies to the device, created grids and
// fetches of the tick equal those of the scene without the items, and so does the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

#include "engine/app/render/frame_stats.h"
#include "engine/io/volume/load_field.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"
#include "tests/support/results.h"
#include "tests/support/support.h"
#include "tests/support/vulkan.h"

namespace catena::app::unused_items_cost_nothing_test {

/// Parts of a scene's text: members of its lists, each followed by a comma, and top-level members.
struct Parts {
  std::string fields{}, volumes{}, isosurfaces{}, slices{}, streamlines{}, glyphs{}, chain{}, widgets{}, members{};
};

std::string scene_text(const Parts& p) {
  return R"({ "fields": {)" + p.fields + R"("ball": {"analytic": "sphere", "resolution": 16}, "flow": {"analytic": "helix"}},
  "volumes": [)" +
         p.volumes + R"({"field": "ball", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}],
  "isosurfaces": [)" +
         p.isosurfaces + R"({"field": "ball", "level": 0.5}],
  "slices": [)" +
         p.slices + R"({"field": "ball", "axis": "z", "at": -1}],
  "streamlines": [)" +
         p.streamlines + R"({"field": "flow", "seeds": [[0.6, 0, -1.2]], "length": 2, "radius": 0.05}],
  "glyphs": [)" +
         p.glyphs +
         R"({"field": "flow", "on": {"plane": {"point": [1, 0, 0], "normal": [1, 0, 0]}}, "spacing": 0.8, "length": 0.4, "radius": 0.03}],
  "chain": [)" +
         p.chain + R"({"name": "curve", "type": "streamline", "follow": "online", "field": "flow", "seed": [0.6, 0, -1.2]}],
  "widgets": [)" +
         p.widgets + "]" + p.members + R"(, "workspace": {"metres_per_unit": 0.05},
  "camera": {"position": [6, -6, 4], "target": [0, 0, 0]} })";
}

/// The work that is counted when a scene is opened, drawn and felt.
struct Work {
  std::map<std::string, std::uint64_t> data;   ///< data that are loaded and read
  std::map<std::string, std::uint64_t> other;  ///< work of links and drawing
  std::vector<std::string> passes;
  std::vector<std::uint8_t> picture;
};

/// The version of a newly created field; versions are consecutive.
std::uint64_t next_version() { return field::make_analytic("constant")->get()->version(); }

class UnusedItems : public testing::Test {
 protected:
  UnusedItems() { test::use_lavapipe(); }

  void measure(const std::string& text, Work& work) {
    const field::LoadCounters before = field::load_counters();
    const std::uint64_t version = next_version();
    auto scene = test::value_of(scene::parse_scene(text, folder_ / "s.json"));
    const auto program = test::value_of(haptics::build_program(scene));
    const auto packet = test::value_of(render::make_frame(scene, 64, 48));
    const field::LoadCounters after = field::load_counters();
    work.other["grids made"] = next_version() - version;
    work.data["files"] = after.files - before.files;
    work.data["masks"] = after.masks - before.masks;
    work.data["bytes"] = loaded_data_bytes(scene);
    work.data["curves"] = scene.traced_curves.size();
    draw(packet, work);
    feel(*program, work);
  }

  static void draw(const render::FramePacket& packet, Work& work) {
    render::vk::DeviceOptions options;
    options.device_filter = test::test_device();
    auto renderer = test::value_of(render::Renderer::create(options));
    const Outcome drawn = renderer->draw(packet);
    ASSERT_TRUE(drawn) << drawn.error().message;
    const render::RenderStats stats = renderer->stats();
    work.data["mirrors"] = stats.resident_grids;
    work.other["GPU bytes"] = stats.gpu_bytes;
    work.other["uploads"] = stats.uploads;
    work.other["upload bytes"] = stats.upload_bytes;
    work.other["pipelines"] = stats.pipelines;
    work.other["allocations"] = renderer->device().counters().allocations;
    work.passes = stats.passes;
    auto picture = renderer->read_back();
    ASSERT_TRUE(picture) << picture.error().message;
    work.picture = std::move(picture->rgba);
  }

  /// Moves a probe along a line for 200 ticks.
  static void feel(const haptics::HapticProgram& program, Work& work) {
    work.other["links"] = program.links.size();
    auto state = std::make_unique<haptics::ChainState>();
    auto scratch = std::make_unique<haptics::ChainScratch>();
    HapticState out;
    for (int k = 0; k < 200; ++k) {
      haptics::tick(program, {0.001 * k, Vec3(0.6, 0.001 * k, -1.2), 0}, *state, *scratch, out);
      for (std::size_t i = 0; i < program.links.size(); ++i) {
        work.data["fetches"] += static_cast<std::uint64_t>(state->links[i].evaluations);
        work.other["steps"] += static_cast<std::uint64_t>(state->links[i].other_work);
      }
    }
  }

  static void expect_same(const Work& with, const Work& without) {
    EXPECT_EQ(with.data, without.data);
    EXPECT_EQ(with.other, without.other);
    EXPECT_EQ(with.passes, without.passes);
    EXPECT_EQ(with.picture, without.picture);
  }

  /// The JSON of a field in a file of 16^3 numbers, which is counted when read.
  std::string numbers() {
    test::write_file(folder_ / "n.raw", std::string(std::size_t{4} * 16 * 16 * 16, '\x3f'));
    return R"({"file": "n.raw", "shape": [16, 16, 16]})";
  }
  test::TemporaryFolder folder_;
};

TEST_F(UnusedItems, UsedItemsAreCounted) {
  Work work;
  ASSERT_NO_FATAL_FAILURE(measure(scene_text({}), work));
  EXPECT_GT(work.data["bytes"], std::uint64_t{4} * 16 * 16 * 16);
  EXPECT_GT(work.other["pipelines"], 4u);
  EXPECT_GT(work.other["upload bytes"], 0u);
  EXPECT_GT(work.data["fetches"], 0u);
  EXPECT_EQ(work.other["links"], 1u) << "no widgets: none of their links";
  EXPECT_EQ(std::count(work.passes.begin(), work.passes.end(), "widgets"), 0);
  // The counters rise for used items.
  Work more;
  Parts used{.fields = "\"file\": " + numbers() + ", ", .slices = R"({"field": "file", "axis": "z", "at": 3}, )"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(used), more));
  EXPECT_EQ(more.data["files"], work.data["files"] + 1);
  EXPECT_GT(more.other["grids made"], work.other["grids made"]);
  for (const char* counter : {"bytes", "mirrors"}) EXPECT_GT(more.data[counter], work.data[counter]) << counter;
}

TEST_F(UnusedItems, UnreferencedFieldsAndDevicesAddNothing) {
  Work with, without;
  ASSERT_NO_FATAL_FAILURE(measure(scene_text({}), without));
  const Parts unused{.fields = "\"file\": " + numbers() + R"(, "formula": {"analytic": "torus", "resolution": 64}, )",
                     .members = R"(, "device": {"type": "emulated-falcon"})"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(unused), with));
  expect_same(with, without);
}

TEST_F(UnusedItems, HiddenItemsAddNothing) {
  Work with, without;
  ASSERT_NO_FATAL_FAILURE(measure(scene_text({}), without));
  const std::string hidden = R"(, "visible": false}, )";
  const Parts unused{
      .fields = "\"file\": " + numbers() + R"(, "torus": {"analytic": "torus", "resolution": 32}, "hill": {"analytic": "hill"}, )",
      .volumes = R"({"field": "file")" + hidden,
      .isosurfaces = R"({"field": "torus", "level": 0.1, "opacity": 0.5, "color_by": {"field": "file"})" + hidden,
      .slices = R"({"field": "hill", "axis": "x", "at": 0, "opacity": 0.5)" + hidden,
      .streamlines = R"({"field": "hill", "seeds": [[0, 0.4, 0]])" + hidden,
      .glyphs = R"({"field": "hill", "on": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}}, "spacing": 0.5)" + hidden,
      .members = R"(, "meshes": [{"name": "m", "file": "m.obj", "visible": false}])"};
  test::write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(unused), with));
  expect_same(with, without);
}

TEST_F(UnusedItems, AWidgetWithoutVisibleFollowersLoadsNothing) {
  // A widget is drawn and can be grabbed: it adds links and triangles, but neither data nor fetches.
  Work with, without, followed;
  ASSERT_NO_FATAL_FAILURE(measure(scene_text({}), without));
  Parts unused{.widgets = R"({"name": "seed", "type": "seed", "position": [1.5, 1.5, 1.5]})"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(unused), with));
  EXPECT_EQ(with.data, without.data);
  // A level widget of a hidden surface does not load its field.
  unused = {.fields = R"("torus": {"analytic": "torus", "resolution": 48}, )",
            .isosurfaces = R"({"field": "torus", "level": {"widget": "level"}, "visible": false}, )",
            .widgets = R"({"name": "level", "type": "isolevel", "field": "torus", "position": [1.2, 0, 0]})"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(unused), followed));
  EXPECT_EQ(followed.data["bytes"], without.data["bytes"]) << "the formula is not sampled";
  EXPECT_EQ(followed.data["mirrors"], without.data["mirrors"]);
}

}  // namespace catena::app::unused_items_cost_nothing_test
