/// The scene as text: what is edited, undone and saved. The scene file stays as its author wrote it (comments, order, layout); an edit
/// replaces one value in it. The scene that is shown is read from this text again after every edit, and takes over what was loaded.
/// Frame thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

class Document {
 public:
  /// A scene file as it is; for a data file a new scene that shows it as scene_for_file does.
  static Result<Document> open(const std::string& path, const std::vector<FieldOverride>& overrides = {});

  const std::string& text() const { return versions_[now_].text; }
  /// The scene file; of a data file's scene: where save() without a path would put it (FILE.json beside it).
  const std::string& path() const { return path_; }
  bool is_modified() const { return saved_ != now_; }

  /// The scene of the text, as read_scene reads it.
  Result<Scene> read() const;

  /// Replaces the value at an RFC 6901 pointer ("/isosurfaces/0/level", "/widgets/-" appends), or adds the member; parents that lack are
  /// made. `value` is JSON text. `what`: for the menu ("isolevel"). Edits with the same non-empty `drag` become one step of undo.
  /// An error (the text stays) where the value is not JSON, the place cannot be, or the scene that it makes cannot be read.
  Outcome set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  Outcome remove(std::string_view pointer, const std::string& what);

  bool can_undo() const { return now_ > 0; }
  bool can_redo() const { return now_ + 1 < versions_.size(); }
  const std::string& undo_what() const;  ///< of the step that undo() takes back
  const std::string& redo_what() const;
  void undo();
  void redo();

  /// Writes the text, byte for byte; another folder than before: relative paths are rewritten so that they name the same files.
  Outcome save(const std::string& path);

 private:
  struct Version {
    std::string text, what, drag;
  };
  std::string path_;
  std::vector<FieldOverride> overrides_;
  std::vector<Version> versions_;
  std::size_t now_ = 0, saved_ = 0;
};

/// What `old` has loaded and `fresh` names alike: fields, meshes, curves, and the poses of widgets that the text did not change.
void carry_over(Scene& old, Scene& fresh);

}  // namespace catena::scene
