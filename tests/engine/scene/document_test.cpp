// SPDX-License-Identifier: MIT
#include "engine/scene/document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/to_json.h"
#include "tests/support/support.h"

namespace catena::scene {
namespace document_test {

namespace fs = std::filesystem;

const std::string kText =
    "\xEF\xBB\xBF// mine\r\n{\r\n  \"fields\": {\"s\": {\"analytic\": \"sphere\"}}, // a ball\r\n"
    "  \"isosurfaces\": [{\"field\": \"s\", \"level\": 1}]\r\n}\r\n";

template <class T>
std::string message_of(const Result<T>& result) {
  return result ? std::string("no error") : result.error().message;
}

Document open(const std::string& path, const std::vector<FieldOverride>& overrides = {}) {
  auto document = Document::open(path, overrides);
  EXPECT_TRUE(document) << message_of(document);
  return document ? std::move(*document) : Document();
}

Document open_text(const test::TemporaryFolder& folder, const std::string& text = kText) {
  test::write_file(folder / "a.json", text);
  return open(folder / "a.json");
}

void expect_done(const Outcome& outcome) { EXPECT_TRUE(outcome) << message_of(outcome); }

void write_grids(const std::string& path) {
  const auto ball = *field::make_analytic("sphere"), swirl = *field::make_analytic("circle");
  const field::AnyField a{field::sample_on_grid(*ball.scalar, 9, -2, 2), nullptr},
      b{nullptr, field::sample_on_grid(*swirl.vector, 9, -2, 2)};
  const auto written = field::write_vdb(path, {{b, "flow"}, {a, "ball"}});
  ASSERT_TRUE(written) << written.error().message;
}

const std::string kQuad = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n";

// ---- edits and history ----

TEST(Document, OpeningKeepsTheTextUnchanged) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  EXPECT_EQ(document.text(), kText);
  EXPECT_EQ(document.path(), folder / "a.json");
  EXPECT_FALSE(document.is_modified() || document.can_undo() || document.can_redo());
  EXPECT_EQ(document.undo_label() + document.redo_label(), "");
  document.undo();
  document.redo();
  EXPECT_EQ(document.text(), kText);
  test::write_file(folder / "bad.json", "{\n\"fog\": 3}");
  EXPECT_TRUE(message_of(Document::open(folder / "bad.json")).starts_with((folder / "bad.json") + ":2: "));
  EXPECT_TRUE(message_of(Document::open(folder / "none.json")).starts_with((folder / "none.json") + ": "));
}

TEST(Document, AnEditIsReadAndUndone) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  expect_done(document.set("/isosurfaces/0/level", "0.5", "isolevel"));
  expect_done(document.set("/volumes/-", R"({"field": "s"})", "volume"));
  std::string expected = kText;
  expected.replace(expected.find("\"level\": 1") + 9, 1, "0.5");
  expected.insert(expected.find("}]\r\n") + 2, ",\r\n  \"volumes\": [{\"field\": \"s\"}]");
  EXPECT_EQ(document.text(), expected);
  const auto scene = document.read();
  ASSERT_TRUE(scene) << message_of(scene);
  EXPECT_EQ(scene->entities.count<Volume>(), 1u);
  scene->entities.each<Isosurface>([](Entity, const Isosurface& surface) { EXPECT_EQ(surface.level, 0.5); });
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

TEST(Document, ADragIsOneUndoStep) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
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

TEST(Document, ADragAfterASaveIsANewUndoStep) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  expect_done(document.set("/isosurfaces/0/level", "0.5", "level", "d"));
  expect_done(document.save());
  const std::string saved = document.text();
  expect_done(document.set("/isosurfaces/0/level", "0.6", "level", "d"));
  document.undo();
  EXPECT_EQ(document.text(), saved);
  EXPECT_FALSE(document.is_modified());
}

TEST(Document, AnInvalidEditChangesNothing) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  const auto refused = [&](const Outcome& outcome, const char* part) {
    EXPECT_NE(message_of(outcome).find(part), std::string::npos) << message_of(outcome);
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

TEST(Document, SeveralEditsAreOneUndoStep) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  // Neither edit alone gives a valid scene.
  expect_done(document.apply(
      {{"/fields/t", R"({"analytic": "plane"})"}, {"/isosurfaces/0/field", "\"t\""}, {"/fields/s", std::nullopt}, {"/fog", {}}}, "field"));
  EXPECT_NE(document.text().find("{\"t\": {\"analytic\": \"plane\"}}, // a ball\r\n"), std::string::npos) << document.text();
  document.undo();
  EXPECT_EQ(document.text(), kText);
}

TEST(Document, TheHistoryIsBounded) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  for (int i = 0; i < 1050; ++i) expect_done(document.set("/isosurfaces/0/level", std::to_string(2 + i), "level"));
  std::size_t steps = 0;
  for (; document.can_undo(); document.undo()) ++steps;
  EXPECT_EQ(steps, Document::kMaxUndoSteps);
  EXPECT_NE(document.text().find("\"level\": 51}"), std::string::npos) << document.text();
  EXPECT_TRUE(document.is_modified());

  Document large = open_text(folder, "{} //" + std::string(Document::kMaxHistoryBytes / 10, ' '));
  for (int i = 0; i < 15; ++i) expect_done(large.set("/jitter", i % 2 == 0 ? "true" : "false", "jitter"));
  for (steps = 0; large.can_undo(); large.undo()) ++steps;
  EXPECT_EQ(steps, 8u);  // nine texts of about a tenth of the limit
  EXPECT_TRUE(large.is_modified());

  // A single text above the limit is kept.
  Document huge = open_text(folder, "{} //" + std::string(Document::kMaxHistoryBytes + 10, ' '));
  expect_done(huge.set("/jitter", "true", "jitter"));
  EXPECT_NE(huge.text().find("jitter"), std::string::npos);
  EXPECT_FALSE(huge.can_undo());
  EXPECT_TRUE(huge.is_modified());
}

// ---- saving ----

TEST(Document, SavesByteExactlyAndAtomically) {
  const test::TemporaryFolder folder;
  Document document = open_text(folder);
  expect_done(document.save(folder / "b.json"));
  EXPECT_EQ(test::read_file(folder / "b.json"), kText);
  EXPECT_EQ(document.path(), folder / "b.json");
  expect_done(document.set("/isosurfaces/0/level", "0.5", "level"));
  for (const std::string& bad : {folder / "none/c.json", folder / "c.txt", std::string(".json/"), std::string()}) {
    EXPECT_NE(message_of(document.save(bad)).find(bad.empty() ? "expected" : bad), std::string::npos) << message_of(document.save(bad));
    EXPECT_EQ(document.path(), folder / "b.json");
    EXPECT_TRUE(document.is_modified());
  }
  EXPECT_EQ(test::read_file(folder / "b.json"), kText);
  expect_done(document.save());
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(test::read_file(folder / "b.json"), document.text());
  EXPECT_EQ(test::read_file(folder / "a.json"), kText);
  document.undo();
  EXPECT_TRUE(document.is_modified());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

const std::string kFiles = R"({
  "fields": {"b": {"file": "data/a.vdb", "grid": "ball"}, "v": {"file": "./data/../data/a.vdb", "grid": "flow"}},
  "device": {"type": "falcon", "firmware": "data/fw.bin"}, // none is opened here
  "meshes": [{"name": "m", "file": "data/q.obj", "color_by": {"field": "b", "transfer": "data/t.json"}}],
  "volumes": [{"field": "b", "transfer": "data/t.json"}],
  "isosurfaces": [{"field": "b", "level": 1, "color_by": {"field": "b", "transfer": "data/t.json"}}]
})";

void write_files(const test::TemporaryFolder& folder) {
  fs::create_directories(folder / "data");
  write_grids(folder / "data/a.vdb");
  test::write_file(folder / "data/q.obj", kQuad);
  test::write_file(folder / "data/t.json", R"({"color": "magma", "opacity": [[0, 0], [2, 0.5]]})");
}

/// Expects that every string in the text that names a file resolves to the same path.
void expect_same_files(const Document& a, const Document& b) {
  const auto old_root = json::parse(a.text(), ""), new_root = json::parse(b.text(), "");
  for (const char* pointer : {"/fields/b/file", "/fields/v/file", "/device/firmware", "/meshes/0/file", "/meshes/0/color_by/transfer",
                              "/volumes/0/transfer", "/isosurfaces/0/color_by/transfer"}) {
    const fs::path x = json::find_value(*old_root, pointer)->string, y = json::find_value(*new_root, pointer)->string;
    EXPECT_TRUE(y.is_relative()) << y;
    EXPECT_TRUE(is_same_file(fs::path(a.path()).parent_path() / x, fs::path(b.path()).parent_path() / y)) << pointer << " " << y;
  }
}

TEST(Document, SavingToAnotherFolderAdaptsPaths) {
  const test::TemporaryFolder folder;
  write_files(folder);
  Document before = open_text(folder, kFiles), document = open(folder / "a.json");
  fs::create_directories(folder / "x/y");
  fs::create_directory_symlink(folder / "x/y", folder / "link");
  expect_done(document.set("/isosurfaces/0/level", "1.5", "level"));
  for (const char* place : {"x/y/b.json", "link/c.json", "data/d.json"}) {
    expect_done(document.save(folder / place));
    expect_same_files(before, document);
    Document again = open(folder / place);
    EXPECT_EQ(again.text(), document.text());
    // The undo history has adapted paths.
    document.undo();
    EXPECT_TRUE(document.read()) << message_of(document.read());
    expect_same_files(before, document);
    document.redo();
  }
  EXPECT_NE(document.text().find("{\"file\": \"a.vdb\", \"grid\": \"ball\"}"), std::string::npos) << document.text();
  EXPECT_NE(document.text().find("// none is opened here"), std::string::npos);
  EXPECT_EQ(test::read_file(folder / "a.json"), kFiles);
}

TEST(Document, SymbolicLinksKeepTheirNames) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "store");
  fs::create_directories(folder / "s");
  write_grids(folder / "store/a.vdb");
  fs::rename(folder / "store/a.vdb", folder / "store/0123");
  fs::create_symlink(folder / "store/0123", folder / "s/a.vdb");
  Document document = open_text(folder, R"({"fields": {"b": {"file": "s/a.vdb", "grid": "ball"}}})");
  expect_done(document.save(folder / "store/b.json"));
  EXPECT_NE(document.text().find("\"../s/a.vdb\""), std::string::npos) << document.text();
}

TEST(Document, RefusesToOverwriteItsInputs) {
  const test::TemporaryFolder folder;
  write_files(folder);
  fs::create_symlink(folder / "data/t.json", folder / "t2.json");
  Document document = open_text(folder, kFiles);
  const std::string transfer = test::read_file(folder / "data/t.json");
  for (const char* name : {"data/t.json", "t2.json"})
    EXPECT_NE(message_of(document.save(folder / name)).find("is also an input"), std::string::npos) << name;
  EXPECT_EQ(test::read_file(folder / "data/t.json"), transfer);
}

// ---- overrides ----

TEST(Document, OverridesApplyAndAreWrittenOnSave) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "data");
  write_grids(folder / "data/a.vdb");
  write_grids(folder / "data/b.vdb");
  const std::string text = R"({"fields": {
  "analytic": {"analytic": "sphere", "scale": 2}, // by formula
  "kept": {"file": "data/a.vdb", "grid": "ball", "valid": "gone"},
  "wish": {"file": "data/a.vdb", "grid": "pressure"},
  "other": {"file": "data/a.vdb"}
}})";
  test::write_file(folder / "a.json", text);
  const std::string b = folder / "data/b.vdb";
  const std::vector<FieldOverride> overrides{
      {"analytic", b, "flow"}, {"kept", b, ""}, {"wish", b, ""}, {"other", b, "ball"}, {"added", b, "ball"}};
  Document document = open(folder / "a.json", overrides);
  EXPECT_EQ(document.text(), text);
  const auto files = [&](const Result<Scene>& scene) {
    int count = 0;
    if (!scene) ADD_FAILURE() << message_of(scene);
    if (scene)
      scene->entities.each<FieldSource>(
          [&](Entity, const FieldSource& source) { count += source.file && is_same_file(source.file->path, b) ? 1 : 0; });
    return count;
  };
  EXPECT_EQ(files(document.read()), 5);
  expect_done(document.set("/background", "[0, 0, 1]", "background"));
  EXPECT_EQ(files(document.read()), 5);
  expect_done(document.save());
  EXPECT_EQ(files(open(folder / "a.json").read()), 5);
  EXPECT_EQ(document.text(), test::read_file(folder / "a.json"));
  EXPECT_NE(document.text().find("\"analytic\": {\"file\": \"" + b + "\", \"grid\": \"flow\"}, // by formula"), std::string::npos)
      << document.text();
  EXPECT_NE(document.text().find("{\"file\": \"" + b + "\", \"grid\": \"ball\", \"valid\": null}"), std::string::npos) << document.text();
  EXPECT_NE(document.text().find("\"wish\": {\"file\": \"" + b + "\"}"), std::string::npos) << document.text();
  Scene scene = *document.read();
  for (const char* name : {"analytic", "kept", "other", "added"})
    EXPECT_TRUE(resolve_field(scene, name, {})) << message_of(resolve_field(scene, name, {}));
  document.undo();
  EXPECT_EQ(files(document.read()), 5);
}

// ---- data files ----

TEST(Document, ADataFileOpensAsItsDefaultScene) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a b\"c.vdb");
  const auto before = field::load_counters();
  Document document = open(folder / "a b\"c.vdb");
  EXPECT_EQ(document.path(), folder / "a b\"c.vdb.json");
  EXPECT_FALSE(document.is_modified());
  auto read = document.read();
  ASSERT_TRUE(read) << message_of(read);
  Scene scene = std::move(*read);
  const auto ball = resolve_rendered_field(scene, find_field(scene, "ball"), {});
  ASSERT_TRUE(ball) << message_of(ball);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);  // read once
  const auto bare = scene_for_file(folder / "a b\"c.vdb");
  ASSERT_TRUE(bare) << message_of(bare);
  EXPECT_EQ(bare->path, folder / "a b\"c.vdb");
  const auto tables = [](const Scene& s) {
    std::string text;
    s.entities.each<Volume>(
        [&](Entity, const Volume& v) { text += to_json(v.transfer.colors) + to_json(v.transfer.extinctions) + to_json(v.shaded); });
    text += to_json(s.background);
    return text;
  };
  EXPECT_GT(tables(scene).size(), 500u);
  EXPECT_EQ(tables(scene), tables(*bare));
  expect_done(document.set("/volumes/0/extinction", "[[0.2, 0], [0.7, 0.1]]", "extinction"));
  expect_done(document.save());
  EXPECT_EQ(open(document.path()).text(), document.text());
  EXPECT_NE(message_of(Document::open(folder / "a b\"c.vdb", {{"ball", "x.vdb", ""}})).find("expected"), std::string::npos);
  EXPECT_NE(message_of(Document::open(document.path(), {}, {"viridis", {}})).find("expected"), std::string::npos);
}

TEST(Document, ANamedMapKeepsADataFilesOpacity) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  const auto plain = scene_for_file(folder / "a.vdb", {}, {"grey", {}}), named = scene_for_file(folder / "a.vdb", {}, {"magma", {}});
  ASSERT_TRUE(plain && named) << message_of(named);
  const auto transfer = [](const Scene& s) {
    TransferFunction found;
    s.entities.each<Volume>([&](Entity, const Volume& v) { found = v.transfer; });
    return found;
  };
  const TransferFunction a = transfer(*plain), b = transfer(*named);
  EXPECT_EQ(to_json(a.extinctions), to_json(b.extinctions));
  EXPECT_EQ(a.colors.front().value, b.colors.front().value);
  EXPECT_EQ(a.colors.back().value, b.colors.back().value);
  EXPECT_NE(to_json(a.colors), to_json(b.colors));
}

TEST(Document, MeshAndVectorFilesOpenAsScenes) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "q.obj", kQuad);
  Document document = open(folder / "q.obj");
  EXPECT_EQ(document.text(), "{\n  \"meshes\": [{\"name\": \"mesh\", \"file\": \"q.obj\"}],\n  \"background\": [0.13, 0.15, 0.18]\n}\n");
  Scene scene = *document.read();
  scene.entities.each<MeshSource>([](Entity, const MeshSource& source) { EXPECT_NE(source.loaded, nullptr); });
  const auto swirl = *field::make_analytic("circle");
  expect_done(field::write_vdb(folder / "f.vdb", {{{nullptr, field::sample_on_grid(*swirl.vector, 9, -2, 2)}, "Flow 2"}}));
  const auto bare = scene_for_file(folder / "f.vdb", {}, {"viridis", std::array<double, 2>{0, 1.5}});
  ASSERT_TRUE(bare) << message_of(bare);
  EXPECT_TRUE(find_field(*bare, "flow_2"));
  bare->entities.each<StreamlineSet>([](Entity, const StreamlineSet& set) {
    ASSERT_TRUE(set.color_by);
    EXPECT_EQ(set.color_by->named.map, "viridis");
    EXPECT_EQ((*set.color_by->named.range)[1], 1.5);
    ASSERT_TRUE(set.seeds.pattern);
    EXPECT_EQ(set.seeds.pattern->kind, SeedPattern::Kind::evenly_spaced);
  });
}

// // ---- bundled scenes ----

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
  Document document = open(path);
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
    const Outcome set = document.set(pointer, value, "edit");
    ASSERT_TRUE(set) << pointer << " " << message_of(set);
    const auto now = json::parse(document.text(), "");
    const std::string at = pointer.ends_with("/-") ? pointer.substr(0, pointer.size() - 1) + "0" : pointer;
    ASSERT_NE(json::find_value(*now, at), nullptr) << at;
    // The edit changes one place of the text only.
    std::size_t same = 0;
    while (same < before.size() && before[same] == document.text()[same]) ++same;
    std::size_t tail = 0;
    while (tail < before.size() - same && before[before.size() - 1 - tail] == document.text()[document.text().size() - 1 - tail]) ++tail;
    EXPECT_LT(before.size() - same - tail, json::find_value(*root, pointer) ? text.size() : 3u) << pointer;
    document.undo();
    EXPECT_EQ(document.text(), before);
    document.redo();
  }
  const std::string edited = document.text();
  while (document.can_undo()) document.undo();
  EXPECT_EQ(document.text(), text);

  // The scene is saved to another folder, and its paths resolve to the same files.
  const test::TemporaryFolder folder;
  expect_done(document.save(folder / "moved.json"));
  Document moved = open(folder / "moved.json");
  EXPECT_EQ(moved.text(), document.text());
  const auto here = read_scene(path), there = moved.read();
  ASSERT_TRUE(here && there) << message_of(there);
  std::vector<std::string> files;
  here->entities.each<FieldSource>([&](Entity, const FieldSource& s) { files.push_back(s.file ? s.file->path : s.analytic); });
  here->entities.each<MeshSource>([&](Entity, const MeshSource& s) { files.push_back(s.path); });
  std::size_t i = 0;
  const auto same = [&](const std::string& file) {
    ASSERT_LT(i, files.size());
    EXPECT_TRUE(file == files[i] || is_same_file(file, files[i])) << file << " " << files[i];
    ++i;
  };
  there->entities.each<FieldSource>([&](Entity, const FieldSource& s) { same(s.file ? s.file->path : s.analytic); });
  there->entities.each<MeshSource>([&](Entity, const MeshSource& s) { same(s.path); });
  EXPECT_EQ(i, files.size());
}

TEST(Document, ChangesOnDiskAreDetectedAndReloaded) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.json", mine = R"({"fields": {"a": {"analytic": "circle"}}})",
                    theirs = R"({"fields": {"b": {"analytic": "saddle"}}})";
  test::write_file(path, mine);
  Document document = open(path);
  EXPECT_EQ(document.disk_state(), Document::DiskState::unchanged);
  test::write_file(path, theirs);
  EXPECT_EQ(document.disk_state(), Document::DiskState::changed);
  expect_done(document.reload_from_disk());
  EXPECT_EQ(document.text(), theirs);
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(document.disk_state(), Document::DiskState::unchanged);
  document.undo();
  EXPECT_EQ(document.text(), mine);
  EXPECT_TRUE(document.is_modified());
  test::write_file(path, "{");
  EXPECT_FALSE(document.reload_from_disk());
  EXPECT_EQ(document.text(), mine) << "all stays";
  std::filesystem::remove(path);
  EXPECT_EQ(document.disk_state(), Document::DiskState::missing);
  std::filesystem::create_directory(path);
  EXPECT_EQ(document.disk_state(), Document::DiskState::not_a_file);
}

}  // namespace document_test
}  // namespace catena::scene
