// SPDX-License-Identifier: MIT
#include "engine/scene/document.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/scene/default_scene.h"
#include "engine/scene/referenced_files.h"

namespace catena::scene {

Result<Document> Document::open(const std::string& path, const std::vector<FieldOverride>& overrides, const FileColors& colors,
                                const std::string& grid) {
  Document document;
  document.path_ = path;
  document.overrides_ = overrides;
  if (path.ends_with(".json")) {
    if (colors.is_given()) return Error{one_line(path + ": a scene sets its own colours; a data file was expected with a colour map")};
    if (!grid.empty()) return Error{one_line(path + ": a scene names its own grids; a data file was expected with the name of a grid")};
    CATENA_TRY(document.saved_, read_text_file(path, "a scene file (JSON)", kMaxJsonBytes));
  } else {
    if (!overrides.empty()) return Error{one_line(path + ": a field of a data file cannot be replaced; a scene file (.json) was expected")};
    CATENA_TRY(DefaultScene default_scene, make_default_scene(path, grid, colors));
    document.path_ = default_scene.scene_path;
    document.saved_ = default_scene.text;
    document.loaded_ = std::make_shared<const DefaultScene>(std::move(default_scene));
  }
  document.versions_.push_back({document.saved_, {}, {}});
  CATENA_CHECK(document.check(document.saved_, document.path_));
  return document;
}

Result<Document> Document::create(const std::string& text, const std::string& path) {
  Document document;
  CATENA_CHECK(document.check(text, path));
  document.path_ = path;
  document.saved_ = text;
  document.versions_.push_back({text, {}, {}});
  return document;
}

Result<Scene> Document::read() const {
  CATENA_TRY(Scene scene, parse_scene(text(), path_, overrides_, known_files_));
  if (const auto loaded = std::exchange(loaded_, nullptr)) adopt_loaded_data(*loaded, scene);
  return scene;
}

// ---- edits ----

Outcome Document::set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag) {
  return apply({{std::string(pointer), value}}, what, drag);
}

Outcome Document::remove(std::string_view pointer, const std::string& what) {
  CATENA_TRY(std::string edited, json::remove_value(text(), path_, pointer));
  return push_version(std::move(edited), what, {});
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
  return push_version(std::move(edited), what, drag);
}

Outcome Document::check(const std::string& text, const std::string& path) {
  CATENA_TRY(const Scene scene, parse_scene(text, path, overrides_, known_files_));
  for (const std::string& file : scene.referenced_files)
    if (std::ranges::find(known_files_, file) == known_files_.end()) known_files_.push_back(file);
  return Done{};
}

Outcome Document::push_version(std::string edited, const std::string& what, const std::string& drag) {
  if (edited == text()) return Done{};
  CATENA_CHECK(check(edited, path_));
  versions_.resize(current_ + 1);
  if (current_ > 0 && !drag.empty() && versions_[current_].drag == drag) {
    versions_[current_].text = std::move(edited);
  } else {
    versions_.push_back({std::move(edited), what, drag});
    ++current_;
  }
  // drop the oldest undo steps
  std::size_t bytes = 0, kept_count = 0;
  while (kept_count <= current_ && kept_count <= kMaxUndoSteps &&
         (kept_count == 0 || bytes + versions_[current_ - kept_count].text.size() <= kMaxHistoryBytes))
    bytes += versions_[current_ - kept_count++].text.size();
  versions_.erase(versions_.begin(), versions_.end() - static_cast<std::ptrdiff_t>(kept_count));
  current_ = versions_.size() - 1;
  return Done{};
}

namespace {
const std::string kNothing;
}

const std::string& Document::undo_label() const { return can_undo() ? versions_[current_].label : kNothing; }
const std::string& Document::redo_label() const { return can_redo() ? versions_[current_ + 1].label : kNothing; }
void Document::undo() {
  if (can_undo()) --current_;
}
void Document::redo() {
  if (can_redo()) ++current_;
}

// ---- loading and saving ----

Document::DiskState Document::disk_state() const {
  std::error_code code;
  const auto status = std::filesystem::status(path_, code);
  if (status.type() == std::filesystem::file_type::not_found) return DiskState::missing;
  const auto disk_text = read_text_file(path_, "a scene file (JSON)", kMaxJsonBytes);
  if (!disk_text) return DiskState::not_a_file;
  return *disk_text == saved_ ? DiskState::unchanged : DiskState::changed;
}

Outcome Document::reload_from_disk() {
  CATENA_TRY(std::string disk_text, read_text_file(path_, "a scene file (JSON)", kMaxJsonBytes));
  CATENA_CHECK(push_version(disk_text, "reload from the file", {}));
  saved_ = std::move(disk_text);
  return Done{};
}

Result<std::string> Document::text_with_overrides() const { return relocate_text(text(), path_, path_, overrides_); }

Outcome Document::save(const std::string& path) {
  if (!path.ends_with(".json")) return Error{one_line(path + ": a scene file must end in .json; such a name was expected")};
  CATENA_TRY(const std::vector<std::string> inputs, referenced_files(text(), path_, overrides_));
  CATENA_CHECK(check_output(path, inputs));
  std::vector<std::string> texts;
  for (const Version& version : versions_) {
    CATENA_TRY(std::string moved, relocate_text(version.text, path_, path, overrides_));
    texts.push_back(std::move(moved));
  }
  CATENA_CHECK(parse_scene(texts[current_], path, {}, known_files_));

  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(texts[current_]);
  file.sync();
  CATENA_CHECK(file.commit());
  for (std::size_t i = 0; i < versions_.size(); ++i) versions_[i].text = std::move(texts[i]);
  saved_ = text();
  path_ = path;
  overrides_.clear();
  versions_[current_].drag.clear();
  return Done{};
}

}  // namespace catena::scene
