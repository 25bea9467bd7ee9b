#include "engine/scene/document.h"

#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/scene/bare_file.h"
#include "engine/scene/named_files.h"

namespace catena::scene {

Result<Document> Document::open(const std::string& path, const std::vector<FieldOverride>& overrides, const NamedColors& colors,
                                const std::string& grid) {
  Document document;
  document.path_ = path;
  document.overrides_ = overrides;
  if (path.ends_with(".json")) {
    if (!colors.is_default()) return Error{one_line(path + ": a scene says its colours; a data file was expected beside a colour map")};
    if (!grid.empty()) return Error{one_line(path + ": a scene names its grids; a data file was expected beside the name of a grid")};
    CATENA_TRY(document.saved_, read_text(path, "a scene file (JSON)", kMaxJsonBytes));
  } else {
    if (!overrides.empty()) return Error{one_line(path + ": a field of a data file cannot be replaced; a scene file (.json) was expected")};
    CATENA_TRY(BareFile bare, describe_bare_file(path, grid, colors));
    document.path_ = bare.scene_path;
    document.saved_ = bare.text;
    document.loaded_ = std::make_shared<const BareFile>(std::move(bare));
  }
  document.versions_.push_back({document.saved_, {}, {}});
  CATENA_CHECK(parse_scene(document.saved_, document.path_, overrides));
  return document;
}

Result<Document> Document::make(const std::string& text, const std::string& path) {
  CATENA_CHECK(parse_scene(text, path));
  Document document;
  document.path_ = path;
  document.saved_ = text;
  document.versions_.push_back({text, {}, {}});
  return document;
}

Result<Scene> Document::read() const {
  CATENA_TRY(Scene scene, parse_scene(text(), path_, overrides_));
  if (const auto loaded = std::exchange(loaded_, nullptr)) adopt_loaded(*loaded, scene);
  return scene;
}

// ---- edits ----

Outcome Document::set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag) {
  return apply({{std::string(pointer), value}}, what, drag);
}

Outcome Document::remove(std::string_view pointer, const std::string& what) {
  CATENA_TRY(std::string edited, json::remove_value(text(), path_, pointer));
  return push(std::move(edited), what, {});
}

Outcome Document::apply(const std::vector<Edit>& edits, const std::string& what, const std::string& drag) {
  std::string edited = text();
  for (const Edit& edit : edits) {
    if (edit.value) {
      CATENA_TRY(edited, json::set_value(edited, path_, edit.pointer, *edit.value));
    } else {
      CATENA_TRY(const json::Node root, json::parse(edited, path_));
      if (json::find_value(root, edit.pointer) == nullptr) continue;
      CATENA_TRY(edited, json::remove_value(edited, path_, edit.pointer));
    }
  }
  return push(std::move(edited), what, drag);
}

Outcome Document::push(std::string edited, const std::string& what, const std::string& drag) {
  if (edited == text()) return Done{};
  CATENA_CHECK(parse_scene(edited, path_, overrides_));
  versions_.resize(now_ + 1);
  if (now_ > 0 && !drag.empty() && versions_[now_].drag == drag) {
    versions_[now_].text = std::move(edited);
  } else {
    versions_.push_back({std::move(edited), what, drag});
    ++now_;
  }
  // the oldest steps go
  std::size_t bytes = 0, kept = 0;
  while (kept <= now_ && kept <= kMaxSteps && (kept == 0 || bytes + versions_[now_ - kept].text.size() <= kMaxBytes))
    bytes += versions_[now_ - kept++].text.size();
  versions_.erase(versions_.begin(), versions_.end() - static_cast<std::ptrdiff_t>(kept));
  now_ = versions_.size() - 1;
  return Done{};
}

namespace {
const std::string kNothing;
}

const std::string& Document::undo_what() const { return can_undo() ? versions_[now_].what : kNothing; }
const std::string& Document::redo_what() const { return can_redo() ? versions_[now_ + 1].what : kNothing; }
void Document::undo() {
  if (can_undo()) --now_;
}
void Document::redo() {
  if (can_redo()) ++now_;
}

// ---- to and from the disk ----

Document::OnDisk Document::on_disk() const {
  std::error_code code;
  const auto status = std::filesystem::status(path_, code);
  if (status.type() == std::filesystem::file_type::not_found) return OnDisk::gone;
  const auto there = read_text(path_, "a scene file (JSON)", kMaxJsonBytes);
  if (!there) return OnDisk::no_file;
  return *there == saved_ ? OnDisk::as_known : OnDisk::changed;
}

Outcome Document::take_from_disk() {
  CATENA_TRY(std::string theirs, read_text(path_, "a scene file (JSON)", kMaxJsonBytes));
  CATENA_CHECK(push(theirs, "the text of the file", {}));
  saved_ = std::move(theirs);
  return Done{};
}

Result<std::string> Document::whole_text() const { return moved_text(text(), path_, path_, overrides_); }

Outcome Document::save(const std::string& path) {
  if (!path.ends_with(".json")) return Error{one_line(path + ": a scene is written to a .json file; such a name was expected")};
  CATENA_TRY(const std::vector<std::string> inputs, files_of(text(), path_, overrides_));
  CATENA_CHECK(check_output(path, inputs));
  std::vector<std::string> texts;
  for (const Version& version : versions_) {
    CATENA_TRY(std::string moved, moved_text(version.text, path_, path, overrides_));
    texts.push_back(std::move(moved));
  }
  CATENA_CHECK(parse_scene(texts[now_], path));

  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(texts[now_]);
  file.sync();
  CATENA_CHECK(file.commit());
  for (std::size_t i = 0; i < versions_.size(); ++i) versions_[i].text = std::move(texts[i]);
  saved_ = text();
  path_ = path;
  overrides_.clear();
  versions_[now_].drag.clear();
  return Done{};
}

}  // namespace catena::scene
