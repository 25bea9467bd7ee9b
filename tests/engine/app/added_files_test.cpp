// SPDX-License-Identifier: MIT
// Every format that can be written here, opened, added to a scene, shown in every way, undone, saved and opened again: formats from the
// registry enter by themselves.
#include <gtest/gtest.h>

#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/volume/units.h"
#include "engine/scene/merge.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/visibility.h"
#include "render/extract/extract.h"
#include "tests/support/curve_files.h"
#include "tests/support/nifti_file.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::added_files_test {

using test::value_of;

constexpr const char* kSources =
    R"({"fields": {"scalar": {"analytic": "sphere", "resolution": 12}, "vector": {"analytic": "circle", "resolution": 12}},
  "streamlines": [{"field": "vector", "seeds": [[1, 0, 0], [0.5, 0, 0.2]]}]})";
// names that the files use, too
constexpr const char* kHost = R"(// mine
{ "fields": {"scalar": {"analytic": "torus", "resolution": 12}, "labels": {"analytic": "sphere", "resolution": 12}},
  "isosurfaces": [{"field": "scalar", "level": 1}], "slices": [{"field": "scalar", "axis": "z", "at": 0}] })";

SceneModel open(const std::string& path) {
  SceneModel model = value_of(SceneModel::open(value_of(scene::Document::open(path)), {}));
  model.set_validator(check_drawable);
  return model;
}

/// Kinds of the rendered items; the bounding box belongs to the scene.
std::vector<std::string> objects_of(SceneModel& model) {
  std::vector<std::string> kinds;
  for (const render::ObjectName& object : value_of(render::make_frame(model.scene(), 64, 64)).objects)
    if (object.kind != "bounding box") kinds.push_back(object.kind);
  return kinds;
}

class AddedFiles : public testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "sources.json", kSources);
    test::write_file(folder_ / "host.json", kHost);
    SceneModel sources = open(folder_ / "sources.json");
    scene::Scene& scene = sources.scene();
    for (const char* name : {"scalar", "vector"}) {
      const scene::Entity entity = scene::find_field(scene, name);
      const auto field = value_of(scene::resolve_rendered_field(scene, entity, {}));
      each(&io::Format::write_volume, name,
           [&](const io::Format& format, const std::string& path) {  // vectors in NIfTI are for other programs
             return format.write_volume(path, field, name, {}) && scene::Document::open(path);
           });
    }
    const mesh::MeshExport triangle{{Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}, {{0, 1, 2}}};
    each(&io::Format::write_mesh, "mesh",
         [&](const io::Format&, const std::string& path) { return bool(mesh::write_mesh(path, triangle)); });
    const auto lines = value_of(scene::resolve_lines(scene, scene::visible_entities<scene::StreamlineSet>(scene.entities).front()));
    const auto flow = value_of(scene::resolve_field(scene, scene::find_field(scene, "vector"), {})).vector;
    each(&io::Format::write_curves, "curves", [&](const io::Format& format, const std::string& path) {
      OutputFile out = value_of(OutputFile::open(path));
      format.write_curves(out, lines, *flow);
      return bool(out.commit()) && format.reads(io::DataKind::curves);
    });
    test::write_file(add("fibres.tck"), test::tck_bytes({{Vec3(0.0), Vec3(1.0), Vec3(2, 1, 1)}}, "Float32LE"));
    test::write_file(add("points.csv"), "x,y,z,v\n0,0,0,1\n1,0,0,2\n0,1,1,3\n");
    test::NiftiFile labels({8, 8, 8}, 2, 8);
    for (int i = 0; i < 512; ++i) labels.append(static_cast<std::uint8_t>(i % 8 < 2 || i % 8 > 5 || i < 64 || i >= 448 ? 0 : i / 256 + 1));
    test::write_file(add("labels.nii"), labels.bytes());
  }
  std::string add(const std::string& name) { return files_.emplace_back(folder_ / name); }
  /// Writes a file for every extension of the formats with that writer.
  template <class Writer, class Write>
  void each(Writer writer, const std::string& name, const Write& write) {
    for (const io::Format& format : io::formats())
      for (const std::string_view extension : format.extensions)
        if (format.*writer != nullptr && write(format, folder_ / (name + std::string(extension)))) add(name + std::string(extension));
  }
  void expect_every_view_of_fields(SceneModel& host) {
    for (const std::string& name : field_names(host.scene()))
      for (const ShowAs as : {ShowAs::volume, ShowAs::isosurface, ShowAs::slice, ShowAs::streamlines, ShowAs::glyphs}) {
        const scene::Entity field = scene::find_field(host.scene(), name);
        const auto values = scene::resolve_rendered_field(host.scene(), field, {});
        if (!values || !can_show(*values, as)) continue;
        const std::size_t before = objects_of(host).size();
        const Outcome done = host.apply(make_item_edits(host.scene(), field, *values, as, {}), to_string(as));
        ASSERT_TRUE(done) << name << " as " << to_string(as) << ": " << done.error().message;
        EXPECT_EQ(objects_of(host).size(), before + 1) << name << " as " << to_string(as);
        value_of(host.undo());
        EXPECT_EQ(objects_of(host).size(), before);
      }
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> files_;
};

TEST_F(AddedFiles, EveryFileCanBeOpenedAddedUndoneSavedAndOpenedAgain) {
  EXPECT_GE(files_.size(), 15u);
  for (const std::string& file : files_) {
    SCOPED_TRACE(file);
    SceneModel own = open(file);
    const std::vector<std::string> shown = objects_of(own);
    EXPECT_FALSE(shown.empty());
    SceneModel host = open(folder_ / "host.json");
    const std::vector<std::string> before = objects_of(host);
    const std::string text = host.document().text();
    const auto merged = value_of(scene::merge_scene(text, host.document().path(), own.document().text(), own.document().path()));
    const Outcome added = host.apply(merged.edits, "add");
    ASSERT_TRUE(added) << added.error().message;
    const std::vector<std::string> both = objects_of(host);
    EXPECT_EQ(both.size(), before.size() + shown.size());
    for (const std::string& kind : shown) EXPECT_GE(std::ranges::count(both, kind), std::ranges::count(shown, kind)) << kind;
    expect_every_view_of_fields(host);
    value_of(host.undo());
    EXPECT_EQ(host.document().text(), text);
    EXPECT_EQ(objects_of(host), before);
    value_of(host.redo());
    value_of(host.save(folder_ / "saved.json"));
    EXPECT_EQ(test::read_file(folder_ / "saved.json").find("// mine"), 0u);
    SceneModel again = open(folder_ / "saved.json");
    EXPECT_EQ(objects_of(again), both);
  }
}

TEST_F(AddedFiles, AnEditThatCannotBeDrawnIsRefusedAndThePictureGoesOn) {
  SceneModel host = open(folder_ / "host.json");
  const std::vector<std::string> before = objects_of(host);
  for (const char* item : {R"({"field": "scalar", "level": 1e9})", R"({"field": "none", "level": 1})"}) {
    const Outcome refused = host.set("/isosurfaces/-", item, "add");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("host.json"), std::string::npos) << refused.error().message;
    EXPECT_EQ(objects_of(host), before);
    EXPECT_FALSE(host.document().can_undo());
  }
  // the passes cannot mix a projection with another volume
  const Outcome mixed = host.set("/volumes", R"([{"field": "scalar", "projection": "maximum"}, {"field": "scalar"}])", "add");
  ASSERT_FALSE(mixed);
  EXPECT_NE(mixed.error().message.find("projection"), std::string::npos) << mixed.error().message;
  EXPECT_EQ(objects_of(host), before);
}

}  // namespace catena::app::added_files_test
