/// The scene as text: what is edited, undone and saved. The scene file stays as its author wrote it (comments, order, layout); an edit
/// replaces one value in it. The scene that is shown is read from this text again after every edit, and takes over what was loaded.
/// Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

struct DefaultScene;

class Document {
 public:
  /// The history that is kept: so many steps, so much text; the oldest steps go first, the text as it is now never.
  static constexpr std::size_t kMaxUndoSteps = 1000, kMaxHistoryBytes = std::size_t{64} << 20;

  /// A scene file as it is; for a data file a new scene that shows it as scene_for_file does, of its field `grid` (empty: the one that is
  /// looked at first), `colors` included (both go with data files only, overrides with scene files only).
  static Result<Document> open(const std::string& path, const std::vector<FieldOverride>& overrides = {}, const NamedColors& colors = {},
                               const std::string& grid = {});

  /// A scene that is nowhere yet; `path`: where save() without one would put it.
  static Result<Document> create(const std::string& text, const std::string& path);

  const std::string& text() const { return versions_[current_].text; }
  /// The scene file; of a data file's scene: where save() without a path would put it (FILE.json beside it).
  const std::string& path() const { return path_; }
  /// The text is another than the one that was opened or saved last.
  bool is_modified() const { return text() != saved_; }

  /// What is at path() now, against the text that was opened or saved last: somebody else may have written or removed it meanwhile.
  enum class DiskState {
    unchanged,
    changed,    ///< another text
    missing,    ///< nothing is there
    not_a_file  ///< a folder, or what cannot be read
  };
  DiskState disk_state() const;
  /// The text at path() in place of this one, as one step of undo; nothing is modified then. An error (all stays) where it is no scene.
  Outcome reload_from_disk();

  /// The scene of the text, as read_scene reads it. The first one of a data file has it loaded already.
  Result<Scene> read() const;

  /// Replaces the value at an RFC 6901 pointer ("/isosurfaces/0/level", "/widgets/-" appends), or adds the member; parents that lack are
  /// made. `value` is JSON text (write_values.h). `what`: for the menu ("isolevel"). Edits with the same non-empty `drag` that follow each
  /// other become one step of undo; an edit that changes no byte is none.
  /// An error (the text stays) where the value is not JSON, the place cannot be, or the scene that it makes cannot be read.
  Outcome set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  Outcome remove(std::string_view pointer, const std::string& what);

  /// Several edits as one: one step of undo, and only their outcome must be a scene.
  struct Edit {
    std::string pointer;
    std::optional<std::string> value;  ///< none: what is there goes, if anything is
  };
  Outcome apply(const std::vector<Edit>& edits, const std::string& what, const std::string& drag = {});

  bool can_undo() const { return current_ > 0; }
  bool can_redo() const { return current_ + 1 < versions_.size(); }
  const std::string& undo_label() const;  ///< of the step that undo() takes back; empty where there is none
  const std::string& redo_label() const;
  void undo();
  void redo();

  /// The text with the overrides as part of it: what a file at path() has to say for this scene.
  Result<std::string> text_with_overrides() const;
  /// Another text in its place, as one step of undo. An error (all stays) where it is no scene.
  Outcome replace(const std::string& text, const std::string& what) { return push_version(text, what, {}); }

  /// Writes the text, byte for byte, to a .json file: whole or not at all. In another folder than before, relative names of files are
  /// rewritten so that they name the same ones. Overrides become part of the text: their file, the grid that they name, and what of the
  /// field's own "grid" and "valid" the file has. The document goes on under this path, its history with it. Refuses a path that is one
  /// of the files that the scene is made of.
  Outcome save(const std::string& path);
  Outcome save() { return save(path_); }

 private:
  struct Version {
    std::string text, label, drag;
  };
  Outcome push_version(std::string text, const std::string& what, const std::string& drag);

  std::string path_, saved_;
  std::vector<FieldOverride> overrides_;
  std::vector<Version> versions_;
  std::size_t current_ = 0;
  mutable std::shared_ptr<const DefaultScene> loaded_;  ///< for the first read() of a data file
};

/// What `old` has loaded or made and `fresh` describes alike goes over, so that a scene that was read again loads nothing twice: fields
/// and meshes with the same source, the curves that something still uses, lines of the same seeds, automatic colours and opacities, and
/// what other rooms keep beside things whose description did not change. So does what happens: the cursor (but its size), the phase, and
/// the widgets' states; a widget whose place in the text did not change, or is where the hand has put it, stays where it is, and one that
/// was set elsewhere gets a higher revision. `old` is given up.
void transfer_state(Scene& old, Scene& fresh);

}  // namespace catena::scene
