#include "engine/scene/document.h"
#include "engine/base/text.h"
namespace catena::scene {
Result<Document> Document::open(const std::string& path, const std::vector<FieldOverride>& overrides) {
  Document d; d.path_ = path; d.overrides_ = overrides;
  std::string text;
  if (path.ends_with(".json")) { CATENA_TRY(text, read_text(path, "a scene file")); }
  d.versions_.push_back({text, "", ""});
  return d;
}
Result<Scene> Document::read() const {
  if (path_.ends_with(".json")) return parse_scene(text(), path_, overrides_);
  return scene_for_file(path_);
}
Outcome Document::set(std::string_view, const std::string&, const std::string&, const std::string&) { return Error{"not yet"}; }
Outcome Document::remove(std::string_view, const std::string&) { return Error{"not yet"}; }
const std::string& Document::undo_what() const { return versions_[now_].what; }
const std::string& Document::redo_what() const { return versions_[now_ + 1].what; }
void Document::undo() { --now_; }
void Document::redo() { ++now_; }
Outcome Document::save(const std::string&) { return Error{"not yet"}; }
void carry_over(Scene&, Scene&) {}
}
