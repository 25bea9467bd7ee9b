// SPDX-License-Identifier: MIT
// Unused items of a scene cost nothing: bytes loaded and mirrored, pipelines, images, copies to the device, created grids and
// fetches of the tick equal those of the scene without the items, and so does the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "engine/app/render/frame_stats.h"
#include "engine/io/volume/load_field.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"
#include "tests/support/support.h"
#include "tests/support/vulkan.h"

namespace catena::app {
namespace unused_items_cost_nothing_test {

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
  std::uint64_t files = 0, masks = 0, grids_made = 0, bytes = 0, curves = 0;
  std::uint64_t gpu_bytes = 0, uploads = 0, upload_bytes = 0, pipelines = 0, allocations = 0, mirrors = 0;
  std::vector<std::string> passes;
  std::size_t links = 0;
  std::int64_t fetches = 0, steps = 0;
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
    auto scene = scene::parse_scene(text, folder_ / "s.json");
    ASSERT_TRUE(scene) << scene.error().message;
    const auto program = haptics::build_program(*scene);
    ASSERT_TRUE(program) << program.error().message;
    const auto packet = render::make_frame(*scene, 64, 48);
    ASSERT_TRUE(packet) << packet.error().message;
    work.grids_made = next_version() - version;
    work.files = field::load_counters().files - before.files;
    work.masks = field::load_counters().masks - before.masks;
    work.bytes = loaded_data_bytes(*scene);
    work.curves = scene->traced_curves.size();
    draw(*packet, work);
    feel(**program, work);
  }

  static void draw(const render::FramePacket& packet, Work& work) {
    render::vk::DeviceOptions options;
    options.device_filter = test::test_device();
    auto renderer = render::Renderer::create(options);
    ASSERT_TRUE(renderer) << renderer.error().message;
    const Outcome drawn = (*renderer)->draw(packet);
    ASSERT_TRUE(drawn) << drawn.error().message;
    const render::RenderStats stats = (*renderer)->stats();
    work.gpu_bytes = stats.gpu_bytes;
    work.uploads = stats.uploads;
    work.upload_bytes = stats.upload_bytes;
    work.pipelines = stats.pipelines;
    work.mirrors = stats.resident_grids;
    work.passes = stats.passes;
    work.allocations = (*renderer)->device().counters().allocations;
    auto picture = (*renderer)->read_back();
    ASSERT_TRUE(picture) << picture.error().message;
    work.picture = std::move(picture->rgba);
  }

  /// Moves a probe along a line for 200 ticks.
  static void feel(const haptics::HapticProgram& program, Work& work) {
    work.links = program.links.size();
    auto state = std::make_unique<haptics::ChainState>();
    auto scratch = std::make_unique<haptics::ChainScratch>();
    HapticState out;
    for (int k = 0; k < 200; ++k) {
      haptics::tick(program, {0.001 * k, Vec3(0.6, 0.001 * k, -1.2), 0}, *state, *scratch, out);
      for (std::size_t i = 0; i < program.links.size(); ++i) {
        work.fetches += state->links[i].evaluations;
        work.steps += state->links[i].other_work;
      }
    }
  }

  static void expect_same_data(const Work& with, const Work& without) {
    EXPECT_EQ(with.files, without.files);
    EXPECT_EQ(with.masks, without.masks);
    EXPECT_EQ(with.bytes, without.bytes);
    EXPECT_EQ(with.mirrors, without.mirrors);
    EXPECT_EQ(with.curves, without.curves);
    EXPECT_EQ(with.fetches, without.fetches);
  }

  static void expect_same(const Work& with, const Work& without) {
    expect_same_data(with, without);
    EXPECT_EQ(with.grids_made, without.grids_made);
    EXPECT_EQ(with.gpu_bytes, without.gpu_bytes);
    EXPECT_EQ(with.uploads, without.uploads);
    EXPECT_EQ(with.upload_bytes, without.upload_bytes);
    EXPECT_EQ(with.pipelines, without.pipelines);
    EXPECT_EQ(with.allocations, without.allocations);
    EXPECT_EQ(with.passes, without.passes);
    EXPECT_EQ(with.links, without.links);
    EXPECT_EQ(with.steps, without.steps);
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
  EXPECT_GT(work.bytes, std::uint64_t{4} * 16 * 16 * 16);
  EXPECT_GT(work.pipelines, 4u);
  EXPECT_GT(work.upload_bytes, 0u);
  EXPECT_GT(work.fetches, 0);
  EXPECT_EQ(work.links, 1u) << "no widgets: none of their links";
  EXPECT_EQ(std::count(work.passes.begin(), work.passes.end(), "widgets"), 0);
  // The counters rise for used items.
  Work more;
  Parts used{.fields = "\"file\": " + numbers() + ", ", .slices = R"({"field": "file", "axis": "z", "at": 3}, )"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(used), more));
  EXPECT_EQ(more.files, work.files + 1);
  EXPECT_GT(more.grids_made, work.grids_made);
  EXPECT_GT(more.bytes, work.bytes);
  EXPECT_GT(more.mirrors, work.mirrors);
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
  expect_same_data(with, without);
  // A level widget of a hidden surface does not load its field.
  unused = {.fields = R"("torus": {"analytic": "torus", "resolution": 48}, )",
            .isosurfaces = R"({"field": "torus", "level": {"widget": "level"}, "visible": false}, )",
            .widgets = R"({"name": "level", "type": "isolevel", "field": "torus", "position": [1.2, 0, 0]})"};
  ASSERT_NO_FATAL_FAILURE(measure(scene_text(unused), followed));
  EXPECT_EQ(followed.bytes, without.bytes) << "the formula is not sampled";
  EXPECT_EQ(followed.mirrors, without.mirrors);
}

}  // namespace unused_items_cost_nothing_test
}  // namespace catena::app
