// SPDX-License-Identifier: MIT
/// Editable scene file. The text keeps its author's comments, order and layout; an edit replaces one value in it. After every edit the
/// scene is read from this text and takes over the loaded data of the scene before the edit (transfer_state). Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

struct DefaultScene;

/// A scene file with undo history.
class Document {
 public:
  /// Limits of the undo history: number of steps, and bytes of text. The oldest steps are dropped first, the current text never.
  static constexpr std::size_t kMaxUndoSteps = 1000, kMaxHistoryBytes = std::size_t{64} << 20;

  /// Opens a scene file, or a data file with a new scene that shows it as scene_for_file does. `grid` (empty: the default grid) and
  /// `colors` apply to data files only, `overrides` to scene files only. Error: the file cannot be read, the scene is invalid, or an
  /// argument does not apply.
  static Result<Document> open(const std::string& path, const std::vector<FieldOverride>& overrides = {}, const FileColors& colors = {},
                               const std::string& grid = {});

  /// Creates a document that is not on disk yet. `path`: where save() without an argument puts it. Error: `text` is not a valid scene.
  static Result<Document> create(const std::string& text, const std::string& path);

  /// Current text of the scene file.
  const std::string& text() const { return versions_[current_].text; }
  /// Path of the scene file; for the scene of a data file the path to which save() without an argument writes (FILE.json beside the data).
  const std::string& path() const { return path_; }
  /// Returns whether the text differs from the text last opened or saved.
  bool is_modified() const { return text() != saved_; }

  /// State of the file at path(), compared with the text last opened or saved; another program may have changed it.
  enum class DiskState {
    unchanged,
    changed,    ///< A different text
    missing,    ///< No file
    not_a_file  ///< A folder, or an unreadable file
  };
  DiskState disk_state() const;
  /// Replaces the text by the file at path(), as one undo step; the document is then unmodified. Error (nothing changes): no valid scene.
  Outcome reload_from_disk();

  /// Returns the scene of the current text, as read_scene does. For a data file the first call hands over the data loaded by open().
  Result<Scene> read() const;

  /// Replaces the value at an RFC 6901 pointer ("/isosurfaces/0/level"; "/widgets/-" appends), or adds the member; missing parents are
  /// created. `value`: JSON text (to_json.h). `what`: undo label ("isolevel"). Consecutive edits with the same non-empty `drag` are one
  /// undo step; an edit that changes no byte is none. Error (the text is unchanged): `value` is not JSON, the pointer is invalid, or the
  /// resulting text is no valid scene.
  Outcome set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  /// Removes the value at the pointer. Error (the text is unchanged): no such value, or the resulting text is no valid scene.
  Outcome remove(std::string_view pointer, const std::string& what);

  /// One of the edits that apply() makes as one undo step; only the final text must be a valid scene.
  struct Edit {
    std::string pointer;
    std::optional<std::string> value;  ///< JSON text; empty: remove the value if it exists
  };
  /// Applies the edits in order; same `what`, `drag` and errors as set().
  Outcome apply(const std::vector<Edit>& edits, const std::string& what, const std::string& drag = {});

  bool can_undo() const { return current_ > 0; }
  bool can_redo() const { return current_ + 1 < versions_.size(); }
  const std::string& undo_label() const;  ///< Label of the step that undo() reverts; empty if there is none
  const std::string& redo_label() const;  ///< Label of the step that redo() repeats; empty if there is none
  void undo();                            ///< No effect if there is no step
  void redo();

  /// Returns the text with the overrides written into it, as it has to be saved at path().
  Result<std::string> text_with_overrides() const;
  /// Replaces the whole text, as one undo step. Error (nothing changes): no valid scene.
  Outcome replace(const std::string& text, const std::string& what) { return push_version(text, what, {}); }

  /// Writes the text, byte for byte, to a .json file, atomically. If the folder changes, relative file names are rewritten so that they
  /// refer to the same files. Overrides become part of the text: their file and grid; the field's "grid" and "valid" are kept only if the
  /// new file has such grids. The document continues under the new path, with its undo history. Error: not a .json path, a path that is one
  /// of the files of the scene, or a failed write.
  Outcome save(const std::string& path);
  Outcome save() { return save(path_); }

 private:
  /// A text of the history, with the label and drag of the edit that led to it.
  struct Version {
    std::string text, label, drag;
  };
  /// Checks a text, and adds its files to those that are known.
  Outcome check(const std::string& text, const std::string& path);
  Outcome push_version(std::string text, const std::string& what, const std::string& drag);

  std::string path_, saved_;
  std::vector<FieldOverride> overrides_;
  std::vector<std::string> known_files_;  ///< Files that existed when the text first named them; edits work while they are missing
  std::vector<Version> versions_;
  std::size_t current_ = 0;
  mutable std::shared_ptr<const DefaultScene> loaded_;  ///< Data for the first read() of a data file's scene
};

/// Moves loaded and derived data from `old` to `reloaded` where both have the same description, so that a scene read after an edit loads
/// nothing twice: fields, meshes, curves and points with the same source, shared streamlines, automatic colors and opacities, and cached
/// data of objects whose description is unchanged. The current time step, the animation phase, the widgets' states and the cursor are kept
/// as well; the cursor's size, show_occluded, drop_line and crosshair are those of `reloaded`. A widget whose stated pose is unchanged, or
/// equals its current pose, stays where it is; one with another stated pose moves there with a higher revision. `old` must not be used
/// afterwards.
void transfer_state(Scene& old, Scene& reloaded);

}  // namespace catena::scene
