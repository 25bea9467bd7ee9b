// SPDX-License-Identifier: MIT
#include "engine/scene/document.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/scene/to_json.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::document_test {

namespace fs = std::filesystem;

const std::string kText =
    "\xEF\xBB\xBF// mine\r\n{\r\n  \"fields\": {\"s\": {\"analytic\": \"sphere\"}}, // a ball\r\n"
    "  \"isosurfaces\": [{\"field\": \"s\", \"level\": 1}]\r\n}\r\n";

scene::Document open(const std::string& path, const std::vector<FieldOverride>& overrides = {}) {
  return value_of(scene::Document::open(path, overrides));
}

class Document : public InFolder {
 protected:
  scene::Document open_text(const std::string& text = kText) {
    test::write_file(folder_ / "a.json", text);
    return open(folder_ / "a.json");
  }
};

void expect_done(const Outcome& outcome) { EXPECT_TRUE(outcome) << message_of(outcome); }

TEST_F(Document, OpeningKeepsTheTextUnchanged) {
  auto document = open_text();
  EXPECT_EQ(document.text(), kText);
  EXPECT_EQ(document.path(), folder_ / "a.json");
  EXPECT_FALSE(document.is_modified() || document.can_undo() || document.can_redo());
  EXPECT_EQ(document.undo_label() + document.redo_label(), "");
  document.undo();
  document.redo();
  EXPECT_EQ(document.text(), kText);
  test::write_file(folder_ / "bad.json", "{\n\"fog\": 3}");
  EXPECT_TRUE(message_of(scene::Document::open(folder_ / "bad.json")).starts_with((folder_ / "bad.json") + ":2: "));
  EXPECT_TRUE(message_of(scene::Document::open(folder_ / "none.json")).starts_with((folder_ / "none.json") + ": "));
}

TEST_F(Document, AnEditIsReadAndUndone) {
  auto document = open_text();
  expect_done(document.set("/isosurfaces/0/level", "0.5", "isolevel"));
  expect_done(document.set("/volumes/-", R"({"field": "s"})", "volume"));
  std::string expected = kText;
  expected.replace(expected.find("\"level\": 1") + 9, 1, "0.5");
  expected.insert(expected.find("}]\r\n") + 2, ",\r\n  \"volumes\": [{\"field\": \"s\"}]");
  EXPECT_EQ(document.text(), expected);
  const Scene scene = value_of(document.read());
  EXPECT_EQ(scene.entities.count<Volume>(), 1u);
  EXPECT_EQ(only<Isosurface>(scene).level, 0.5);
  EXPECT_EQ(document.undo_label(), "volume");
  document.undo();
  EXPECT_EQ(document.undo_label(), "isolevel");
  EXPECT_EQ(document.redo_label(), "volume");
  EXPECT_TRUE(document.is_modified());
  document.undo();
  EXPECT_EQ(document.text(), kText);
  EXPECT_FALSE(document.is_modified());
  document.redo();
  document.redo();
  EXPECT_EQ(document.text(), expected);
  expect_done(document.remove("/volumes", "no volumes"));
  expect_done(document.set("/isosurfaces/0/level", "1", "isolevel"));
  EXPECT_EQ(document.text(), kText);
  EXPECT_FALSE(document.is_modified());
  document.undo();
  document.undo();
  expect_done(document.set("/background", "[0, 0, 0]", "background"));
  EXPECT_FALSE(document.can_redo());
}

TEST_F(Document, ADragIsOneUndoStep) {
  auto document = open_text();
  for (const char* level : {"0.5", "0.6", "0.7"}) expect_done(document.set("/isosurfaces/0/level", level, "level", "drag-1"));
  for (const char* level : {"0.8", "0.9"}) expect_done(document.set("/isosurfaces/0/level", level, "level", "drag-2"));
  expect_done(document.set("/isosurfaces/0/level", "0.9", "level"));  // no change
  for (const char* level : {"1.5", "1.6"}) expect_done(document.set("/isosurfaces/0/level", level, "level"));
  std::vector<std::string> levels;
  for (; document.can_undo(); document.undo()) {
    const auto root = json::parse(document.text(), "");
    levels.push_back(to_json(json::find_value(*root, "/isosurfaces/0/level")->number));
  }
  EXPECT_EQ(levels, (std::vector<std::string>{"1.6", "1.5", "0.9", "0.7"}));
  EXPECT_EQ(document.text(), kText);
}

TEST_F(Document, ADragAfterASaveIsANewUndoStep) {
  auto document = open_text();
  expect_done(document.set("/isosurfaces/0/level", "0.5", "level", "d"));
  expect_done(document.save());
  const std::string saved = document.text();
  expect_done(document.set("/isosurfaces/0/level", "0.6", "level", "d"));
  document.undo();
  EXPECT_EQ(document.text(), saved);
  EXPECT_FALSE(document.is_modified());
}

TEST_F(Document, AnInvalidEditChangesNothing) {
  auto document = open_text();
  const auto refused = [&](const Outcome& outcome, const char* part) {
    EXPECT_TRUE(has(message_of(outcome), part));
    EXPECT_EQ(document.text(), kText);
    EXPECT_FALSE(document.can_undo());
  };
  refused(document.set("/isosurfaces/0/level", "0.5 6", "x"), "is not JSON");
  refused(document.set("/isosurfaces/0/level", "\"a\"", "x"), "a.json:4: ");
  refused(document.set("/isosurfaces/0/level/x", "1", "x"), "holds nothing");
  refused(document.set("/isosurfaces/2/level", "1", "x"), "is no item");
  refused(document.set("/isosurfaces/0/levels", "1", "x"), "levels");
  refused(document.set("/volumes/-", R"({"field": "t"})", "x"), "unknown field \"t\"");
  refused(document.remove("/fields/s", "x"), "unknown field \"s\"");
  refused(document.remove("/volumes", "x"), "is not there");
  refused(document.apply({{"/background", "[0, 0, 0]"}, {"/fog", "3"}}, "x"), "fog");
}

TEST_F(Document, SeveralEditsAreOneUndoStep) {
  auto document = open_text();
  // Neither edit alone gives a valid scene.
  expect_done(document.apply(
      {{"/fields/t", R"({"analytic": "plane"})"}, {"/isosurfaces/0/field", "\"t\""}, {"/fields/s", std::nullopt}, {"/fog", {}}}, "field"));
  EXPECT_NE(document.text().find("{\"t\": {\"analytic\": \"plane\"}}, // a ball\r\n"), std::string::npos) << document.text();
  document.undo();
  EXPECT_EQ(document.text(), kText);
}

/// The number of undo steps.
std::size_t undo_all(scene::Document& document) {
  std::size_t steps = 0;
  for (; document.can_undo(); document.undo()) ++steps;
  return steps;
}

TEST_F(Document, TheHistoryIsBounded) {
  auto document = open_text();
  for (int i = 0; i < 1050; ++i) expect_done(document.set("/isosurfaces/0/level", std::to_string(2 + i), "level"));
  EXPECT_EQ(undo_all(document), scene::Document::kMaxUndoSteps);
  EXPECT_NE(document.text().find("\"level\": 51}"), std::string::npos) << document.text();
  EXPECT_TRUE(document.is_modified());

  auto large = open_text("{} //" + std::string(scene::Document::kMaxHistoryBytes / 10, ' '));
  for (int i = 0; i < 15; ++i) expect_done(large.set("/jitter", i % 2 == 0 ? "true" : "false", "jitter"));
  EXPECT_EQ(undo_all(large), 8u);  // nine texts of about a tenth of the limit
  EXPECT_TRUE(large.is_modified());

  // A single text above the limit is kept.
  auto huge = open_text("{} //" + std::string(scene::Document::kMaxHistoryBytes + 10, ' '));
  expect_done(huge.set("/jitter", "true", "jitter"));
  EXPECT_NE(huge.text().find("jitter"), std::string::npos);
  EXPECT_FALSE(huge.can_undo());
  EXPECT_TRUE(huge.is_modified());
}

TEST_F(Document, SavesByteExactlyAndAtomically) {
  auto document = open_text();
  expect_done(document.save(folder_ / "b.json"));
  EXPECT_EQ(test::read_file(folder_ / "b.json"), kText);
  EXPECT_EQ(document.path(), folder_ / "b.json");
  expect_done(document.set("/isosurfaces/0/level", "0.5", "level"));
  for (const std::string& bad : {folder_ / "none/c.json", folder_ / "c.txt", std::string(".json/"), std::string()}) {
    EXPECT_TRUE(has(message_of(document.save(bad)), bad.empty() ? "expected" : bad));
    EXPECT_EQ(document.path(), folder_ / "b.json");
    EXPECT_TRUE(document.is_modified());
  }
  EXPECT_EQ(test::read_file(folder_ / "b.json"), kText);
  expect_done(document.save());
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(test::read_file(folder_ / "b.json"), document.text());
  EXPECT_EQ(test::read_file(folder_ / "a.json"), kText);
  document.undo();
  EXPECT_TRUE(document.is_modified());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

const std::string kFiles = R"({
  "fields": {"b": {"file": "data/a.vdb", "grid": "ball"}, "v": {"file": "./data/../data/a.vdb", "grid": "flow"}},
  "device": {"type": "falcon", "firmware": "data/fw.bin"}, // none is opened here
  "meshes": [{"name": "m", "file": "data/q.obj", "color_by": {"field": "b", "transfer": "data/t.json"}}],
  "volumes": [{"field": "b", "transfer": "data/t.json"}],
  "isosurfaces": [{"field": "b", "level": 1, "color_by": {"field": "b", "transfer": "data/t.json"}}]
})";

void write_files(const test::TemporaryFolder& folder_) {
  fs::create_directories(folder_ / "data");
  write_grids(folder_ / "data/a.vdb");
  test::write_file(folder_ / "data/q.obj", kQuad);
  test::write_file(folder_ / "data/t.json", R"({"color": "magma", "opacity": [[0, 0], [2, 0.5]]})");
}

/// Expects that every string in the text that names a file resolves to the same path.
void expect_same_files(const scene::Document& a, const scene::Document& b) {
  const auto old_root = json::parse(a.text(), ""), new_root = json::parse(b.text(), "");
  for (const char* pointer : {"/fields/b/file", "/fields/v/file", "/device/firmware", "/meshes/0/file", "/meshes/0/color_by/transfer",
                              "/volumes/0/transfer", "/isosurfaces/0/color_by/transfer"}) {
    const fs::path x = json::find_value(*old_root, pointer)->string, y = json::find_value(*new_root, pointer)->string;
    EXPECT_TRUE(y.is_relative()) << y;
    EXPECT_TRUE(is_same_file(fs::path(a.path()).parent_path() / x, fs::path(b.path()).parent_path() / y)) << pointer << " " << y;
  }
}

TEST_F(Document, SavingToAnotherFolderAdaptsPaths) {
  write_files(folder_);
  auto before = open_text(kFiles), document = open(folder_ / "a.json");
  fs::create_directories(folder_ / "x/y");
  fs::create_directory_symlink(folder_ / "x/y", folder_ / "link");
  expect_done(document.set("/isosurfaces/0/level", "1.5", "level"));
  for (const char* place : {"x/y/b.json", "link/c.json", "data/d.json"}) {
    expect_done(document.save(folder_ / place));
    expect_same_files(before, document);
    auto again = open(folder_ / place);
    EXPECT_EQ(again.text(), document.text());
    // The undo history has adapted paths.
    document.undo();
    EXPECT_TRUE(document.read()) << message_of(document.read());
    expect_same_files(before, document);
    document.redo();
  }
  EXPECT_NE(document.text().find("{\"file\": \"a.vdb\", \"grid\": \"ball\"}"), std::string::npos) << document.text();
  EXPECT_NE(document.text().find("// none is opened here"), std::string::npos);
  EXPECT_EQ(test::read_file(folder_ / "a.json"), kFiles);
}

TEST_F(Document, SymbolicLinksKeepTheirNames) {
  fs::create_directories(folder_ / "store");
  fs::create_directories(folder_ / "s");
  write_grids(folder_ / "store/a.vdb");
  fs::rename(folder_ / "store/a.vdb", folder_ / "store/0123");
  fs::create_symlink(folder_ / "store/0123", folder_ / "s/a.vdb");
  auto document = open_text(R"({"fields": {"b": {"file": "s/a.vdb", "grid": "ball"}}})");
  expect_done(document.save(folder_ / "store/b.json"));
  EXPECT_NE(document.text().find("\"../s/a.vdb\""), std::string::npos) << document.text();
}

TEST_F(Document, RefusesToOverwriteItsInputs) {
  write_files(folder_);
  fs::create_symlink(folder_ / "data/t.json", folder_ / "t2.json");
  auto document = open_text(kFiles);
  const std::string transfer = test::read_file(folder_ / "data/t.json");
  for (const char* name : {"data/t.json", "t2.json"})
    EXPECT_NE(message_of(document.save(folder_ / name)).find("is also an input"), std::string::npos) << name;
  EXPECT_EQ(test::read_file(folder_ / "data/t.json"), transfer);
}

TEST_F(Document, OverridesApplyAndAreWrittenOnSave) {
  fs::create_directories(folder_ / "data");
  write_grids(folder_ / "data/a.vdb");
  write_grids(folder_ / "data/b.vdb");
  const std::string text = R"({"fields": {
  "analytic": {"analytic": "sphere", "scale": 2}, // by formula
  "kept": {"file": "data/a.vdb", "grid": "ball", "valid": "gone"},
  "wish": {"file": "data/a.vdb", "grid": "pressure"},
  "other": {"file": "data/a.vdb"}
}})";
  test::write_file(folder_ / "a.json", text);
  const std::string b = folder_ / "data/b.vdb";
  const std::vector<FieldOverride> overrides{
      {"analytic", b, "flow"}, {"kept", b, ""}, {"wish", b, ""}, {"other", b, "ball"}, {"added", b, "ball"}};
  auto document = open(folder_ / "a.json", overrides);
  EXPECT_EQ(document.text(), text);
  const auto files = [&](const Result<Scene>& scene) {
    int count = 0;
    EXPECT_TRUE(scene) << message_of(scene);
    if (scene)
      for (const FieldSource& source : all_of<FieldSource>(*scene)) count += source.file && is_same_file(source.file->path, b);
    return count;
  };
  EXPECT_EQ(files(document.read()), 5);
  expect_done(document.set("/background", "[0, 0, 1]", "background"));
  EXPECT_EQ(files(document.read()), 5);
  expect_done(document.save());
  EXPECT_EQ(files(open(folder_ / "a.json").read()), 5);
  EXPECT_EQ(document.text(), test::read_file(folder_ / "a.json"));
  for (const std::string& part : {"\"analytic\": {\"file\": \"" + b + "\", \"grid\": \"flow\"}, // by formula",
                                  "{\"file\": \"" + b + "\", \"grid\": \"ball\", \"valid\": null}", "\"wish\": {\"file\": \"" + b + "\"}"})
    EXPECT_TRUE(has(document.text(), part));
  Scene scene = value_of(document.read());
  for (const char* name : {"analytic", "kept", "other", "added"}) value_of(resolve_field(scene, name, {}));
  document.undo();
  EXPECT_EQ(files(document.read()), 5);
}

TEST_F(Document, ADataFileOpensAsItsDefaultScene) {
  write_grids(folder_ / "a b\"c.vdb");
  const auto before = field::load_counters();
  auto document = open(folder_ / "a b\"c.vdb");
  EXPECT_EQ(document.path(), folder_ / "a b\"c.vdb.json");
  EXPECT_FALSE(document.is_modified());
  Scene scene = value_of(document.read());
  value_of(resolve_rendered_field(scene, find_field(scene, "ball"), {}));
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);  // read once
  const Scene bare = value_of(scene_for_file(folder_ / "a b\"c.vdb"));
  EXPECT_EQ(bare.path, folder_ / "a b\"c.vdb");
  const auto tables = [](const Scene& s) {
    std::string text = to_json(s.background);
    for (const Volume& v : all_of<Volume>(s)) text += to_json(v.transfer.colors) + to_json(v.transfer.extinctions) + to_json(v.shaded);
    return text;
  };
  EXPECT_GT(tables(scene).size(), 200u);
  EXPECT_EQ(tables(scene), tables(bare));
  expect_done(document.set("/volumes/0/extinction", "[[0.2, 0], [0.7, 0.1]]", "extinction"));
  expect_done(document.save());
  EXPECT_EQ(open(document.path()).text(), document.text());
  expect_error(scene::Document::open(folder_ / "a b\"c.vdb", {{"ball", "x.vdb", ""}}), "", {"expected"});
  expect_error(scene::Document::open(document.path(), {}, {"viridis", {}}), "", {"expected"});
}

TEST_F(Document, ANamedMapKeepsADataFilesOpacity) {
  write_grids(folder_ / "a.vdb");
  const auto transfer = [&](const char* map) { return only<Volume>(value_of(scene_for_file(folder_ / "a.vdb", {}, {map, {}}))).transfer; };
  const TransferFunction a = transfer("grey"), b = transfer("magma");
  EXPECT_EQ(to_json(a.extinctions), to_json(b.extinctions));
  EXPECT_EQ(a.colors.front().value, b.colors.front().value);
  EXPECT_EQ(a.colors.back().value, b.colors.back().value);
  EXPECT_NE(to_json(a.colors), to_json(b.colors));
}

TEST_F(Document, EditsGoOnWhileADataFileIsMissing) {
  write_grids(folder_ / "a.vdb");
  auto document = value_of(scene::Document::open(folder_ / "a.vdb"));
  Scene scene = value_of(document.read());
  fs::rename(folder_ / "a.vdb", folder_ / "moved.vdb");
  expect_done(document.set("/background", "[0, 0.5, 0]", "background"));
  Scene edited = value_of(document.read());
  transfer_state(scene, edited);
  EXPECT_NE(edited.entities.get<FieldSource>(only<Volume>(edited).field).loaded.get(), nullptr) << "the loaded data stay";
  document.undo();
  value_of(document.read());
  document.redo();
  expect_done(document.save());
  expect_error(document.set("/fields/other", "{\"file\": \"b.vdb\"}", "field"), "", {"does not exist"});
  expect_error(scene::Document::open(document.path()), "", {"does not exist"});
}

TEST_F(Document, MeshAndVectorFilesOpenAsScenes) {
  test::write_file(folder_ / "q.obj", kQuad);
  auto document = open(folder_ / "q.obj");
  EXPECT_EQ(document.text(), "{\n  \"meshes\": [{\"name\": \"mesh\", \"file\": \"q.obj\"}],\n  \"look\": \"lit\"\n}\n");
  EXPECT_NE(only<MeshSource>(value_of(document.read())).loaded, nullptr);
  const auto swirl = *field::make_analytic("circle");
  expect_done(field::write_vdb(folder_ / "f.vdb", {{{nullptr, field::sample_on_grid(*swirl.vector, 9, -2, 2)}, "Flow 2"}}));
  const Scene bare = value_of(scene_for_file(folder_ / "f.vdb", {}, {"viridis", std::array<double, 2>{0, 1.5}}));
  EXPECT_TRUE(find_field(bare, "flow_2"));
  const auto set = only<StreamlineSet>(bare);
  ASSERT_TRUE(set.color_by && set.seeds.pattern);
  EXPECT_EQ(set.color_by->named.map, "viridis");
  EXPECT_EQ((*set.color_by->named.range)[1], 1.5);
  EXPECT_EQ(set.seeds.pattern->kind, SeedPattern::Kind::evenly_spaced);
}

class SceneDocumentRoundTrip : public testing::TestWithParam<std::string> {};

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  const std::string folder = test::source_dir() + "/assets/scenes";
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".json") names.push_back(fs::relative(entry.path(), folder).replace_extension().string());
  std::sort(names.begin(), names.end());
  return names;
}
INSTANTIATE_TEST_SUITE_P(Document, SceneDocumentRoundTrip, testing::ValuesIn(scene_names()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '/'; }, '_');
  return name;
});

TEST_P(SceneDocumentRoundTrip, IsEditedUndoneAndSaved) {
  if (GetParam().starts_with("data/") && test::shared_data("combustor_cfd.vdb").empty()) GTEST_SKIP() << "no shared data";
  const std::string path = test::source_dir() + "/assets/scenes/" + GetParam() + ".json", text = test::read_file(path);
  auto document = open(path);
  ASSERT_EQ(document.text(), text);
  const auto root = json::parse(text, path);
  Camera camera;
  camera.position = {0.1, 1.0 / 3, -4};
  std::vector<std::pair<std::string, std::string>> edits{{"/camera", to_json(camera)},
                                                         {"/background", to_json(Color{0.1f, 0.2f, 0.3f})},
                                                         {"/fog/max_opacity", "0.25"},
                                                         {"/quality", "\"draft\""},
                                                         {"/labels/-", R"({"at": [0, 0, 0], "text": "here"})"},
                                                         {"/clip/-", to_json(ClipPlane{{{0.0, 0.0, 0.0}, {0.0, 0.6, 0.8}}})}};
  for (const char* list : {"volumes", "isosurfaces", "streamlines", "slices", "meshes"})
    if (const json::Node* items = root->find(list))
      for (std::size_t i = 0; i < items->items.size(); ++i)
        edits.push_back({"/" + std::string(list) + "/" + std::to_string(i) + "/clip", "false"});
  for (const auto& [pointer, value] : edits) {
    const std::string before = document.text();
    const json::Node* stated = json::find_value(*root, pointer);
    if (stated != nullptr && json::is_equal_value(*stated, *json::parse(value, ""))) continue;
    ASSERT_TRUE(document.set(pointer, value, "edit")) << pointer;
    const auto now = json::parse(document.text(), "");
    const std::string at = pointer.ends_with("/-") ? pointer.substr(0, pointer.size() - 1) + "0" : pointer;
    ASSERT_NE(json::find_value(*now, at), nullptr) << at;
    // The edit changes one place of the text only.
    const std::string& after = document.text();
    const auto same = static_cast<std::size_t>(std::ranges::mismatch(before, after).in1 - before.begin());
    std::size_t tail = 0;
    while (tail < before.size() - same && before[before.size() - 1 - tail] == after[after.size() - 1 - tail]) ++tail;
    EXPECT_LT(before.size() - same - tail, json::find_value(*root, pointer) ? text.size() : 3u) << pointer;
    document.undo();
    EXPECT_EQ(document.text(), before);
    document.redo();
  }
  const std::string edited = document.text();
  undo_all(document);
  EXPECT_EQ(document.text(), text);

  // The scene is saved to another folder, and its paths resolve to the same files.
  const test::TemporaryFolder folder;
  expect_done(document.save(folder / "moved.json"));
  auto moved = open(folder / "moved.json");
  EXPECT_EQ(moved.text(), document.text());
  const auto files = [](const Scene& scene) {
    std::vector<std::string> paths;
    for (const FieldSource& s : all_of<FieldSource>(scene)) paths.push_back(s.file ? s.file->path : s.analytic);
    for (const MeshSource& s : all_of<MeshSource>(scene)) paths.push_back(s.path);
    return paths;
  };
  const std::vector<std::string> here = files(value_of(read_scene(path))), there = files(value_of(moved.read()));
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_TRUE(there[i] == here[i] || is_same_file(there[i], here[i])) << there[i] << " " << here[i];
}

TEST_F(Document, ChangesOnDiskAreDetectedAndReloaded) {
  const std::string path = folder_ / "a.json", mine = R"({"fields": {"a": {"analytic": "circle"}}})",
                    theirs = R"({"fields": {"b": {"analytic": "saddle"}}})";
  test::write_file(path, mine);
  auto document = open(path);
  EXPECT_EQ(document.disk_state(), scene::Document::DiskState::unchanged);
  test::write_file(path, theirs);
  EXPECT_EQ(document.disk_state(), scene::Document::DiskState::changed);
  expect_done(document.reload_from_disk());
  EXPECT_EQ(document.text(), theirs);
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(document.disk_state(), scene::Document::DiskState::unchanged);
  document.undo();
  EXPECT_EQ(document.text(), mine);
  EXPECT_TRUE(document.is_modified());
  test::write_file(path, "{");
  EXPECT_FALSE(document.reload_from_disk());
  EXPECT_EQ(document.text(), mine) << "all stays";
  std::filesystem::remove(path);
  EXPECT_EQ(document.disk_state(), scene::Document::DiskState::missing);
  std::filesystem::create_directory(path);
  EXPECT_EQ(document.disk_state(), scene::Document::DiskState::not_a_file);
}

}  // namespace catena::scene::document_test
