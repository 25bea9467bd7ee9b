// SPDX-License-Identifier: MIT
// A custom constraint and a custom file format of this test, each registered with one line: reader, schema, writer, panel, ruler and
// document know them without further code.
#include <gtest/gtest.h>

#include <map>

#include "engine/app/cli/scene_schema.h"
#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/scene/document.h"
#include "engine/scene/ruler.h"
#include "engine/schema/documents.h"
#include "haptics/build/build_program.h"
#include "haptics/constraints/registry.h"
#include "tests/extensibility/level_ball.h"
#include "tests/support/support.h"

namespace extension_points_test {

using namespace catena;
using namespace catena::haptics;

// ---- the format: eight numbers as text, at the corners of a cube of edge 1 ----

Result<std::vector<field::GridInfo>> describe_corners(const std::string&, int /*step*/) {
  field::GridInfo info;
  info.name = "corners";
  return std::vector<field::GridInfo>{info};
}
Result<field::AnyField> load_corners(const field::LoadRequest& request) {
  field::LoadRequest like;
  CATENA_TRY(const std::string text, read_text_file(request.path, "eight numbers"));
  // writes the numbers as a .raw file, where a reader of a real format would build a grid in memory
  std::vector<float> values;
  std::istringstream in(text);
  for (float v = 0; in >> v;) values.push_back(v);
  if (values.size() != 8) return Error{request.path + ": has " + std::to_string(values.size()) + " numbers; eight were expected"};
  like.path = request.path + ".raw";
  test::write_file(like.path, std::string(reinterpret_cast<const char*>(values.data()), 32));
  like.raw.emplace();
  like.raw->shape = {2, 2, 2};
  return field::load(like);
}

io::Format corners_format() {
  return {.name = "Corners", .extensions = {".corners"}, .volume = {.load = load_corners, .describe = describe_corners}};
}

struct Registered {
  Registered() {
    register_constraint(level_ball_constraint());
    io::register_format(corners_format());
  }
};

struct ExtensionPoints : testing::Test {
  ExtensionPoints() { static const Registered once; }
  test::TemporaryFolder folder;
  std::string scene_text() const {
    test::write_file(folder / "a.corners", "0 1 1 2 1 2 2 3\n");
    return R"({"fields": {"a": {"file": "a.corners"}, "ball": {"analytic": "sphere"}},
 "chain": [{"name": "skin", "type": "shell", "field": "ball", "level": 1, "glow": 2}],
 "widgets": [{"name": "u", "type": "ruler", "from": [1.1, 0, 0], "to": [0, 1.1, 0], "along": ["skin"]}]})";
  }
};

TEST_F(ExtensionPoints, AreReadAndLoaded) {
  auto scene = scene::parse_scene(scene_text(), folder / "s.json");
  ASSERT_TRUE(scene) << scene.error().message;
  const auto program = build_program(*scene);
  ASSERT_TRUE(program) << program.error().message;
  ASSERT_FALSE((*program)->links.empty());
  EXPECT_EQ((*program)->links[0].name, "skin");
  const auto loaded = scene::resolve_field(*scene, scene::find_field(*scene, "a"), {});
  ASSERT_TRUE(loaded) << loaded.error().message;
  field::Cursor cursor;
  EXPECT_EQ(loaded->scalar->sample(Vec3(0.5), cursor).value, 1.5);

  const auto wrong = scene::parse_scene(R"({"fields": {"a": {"file": "a.corner"}}})", folder / "s.json");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("a data file (.vdb"), std::string::npos) << wrong.error().message;
  auto unknown = scene::parse_scene(R"({"fields": {"ball": {"analytic": "sphere"}},
 "chain": [{"name": "skin", "type": "shell", "field": "ball", "level": 1, "glo": 2}]})",
                                    "s.json");
  ASSERT_TRUE(unknown);
  const auto refused = build_program(*unknown);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("did you mean \"glow\"?"), std::string::npos) << refused.error().message;
}

TEST_F(ExtensionPoints, AreInTheSchemaAndTheDocument) {
  const std::string schema = app::scene_json_schema();
  EXPECT_NE(schema.find(R"("type": {"const": "shell"})"), std::string::npos);
  EXPECT_NE(schema.find(R"("glow": {"description": "Of no effect. In candela. Default: 1.", "type": "number", "exclusiveMinimum": 0})"),
            std::string::npos);
  std::map<std::string, std::string> tables;
  for (const schema::Section& component : app::scene_file_components())
    for (auto& [name, table] : schema::markdown_tables(component)) tables.emplace(name, table);
  EXPECT_NE(tables["chain/shell"].find("| `glow` | number | candela | > 0 | `1` | `1` | Of no effect. |"), std::string::npos)
      << tables["chain/shell"];
}

TEST_F(ExtensionPoints, AreInThePanelAndWritten) {
  const std::vector<std::string> types = app::link_types();
  EXPECT_NE(std::find(types.begin(), types.end(), "shell"), types.end());
  auto scene = scene::parse_scene(scene_text(), folder / "s.json");
  ASSERT_TRUE(scene);
  const auto link = app::make_link_json(*scene, "shell", {0.7, 0, 0}, 4);
  ASSERT_TRUE(link) << link.error().message;
  auto document = scene::Document::create(scene_text(), folder / "s.json");
  ASSERT_TRUE(document) << document.error().message;
  EXPECT_TRUE(document->set("/chain/-", *link, "add shell"));
  auto written = document->read();
  ASSERT_TRUE(written) << written.error().message;
  const auto program = build_program(*written);
  EXPECT_TRUE(program) << program.error().message << *link;
}

TEST_F(ExtensionPoints, ARulerMeasuresAlongThem) {
  auto scene = scene::parse_scene(scene_text(), folder / "s.json");
  ASSERT_TRUE(scene);
  const scene::Entity ruler = scene::find_widget(*scene, "u");
  ASSERT_TRUE(scene::resolve_widget(*scene, ruler));
  const auto measure = scene::resolve_ruler(*scene, ruler);
  ASSERT_TRUE(measure) << measure.error().message;
  EXPECT_NEAR(measure->length, 0.5 * 3.14159265, 0.01) << measure->note;
}

}  // namespace extension_points_test
