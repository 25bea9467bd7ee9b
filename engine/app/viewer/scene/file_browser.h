// SPDX-License-Identifier: MIT
/// Directory listings for the Open dialog, path completion, unused file names and the list of recent files. Lists only what the user may
/// read; never throws. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

/// An entry of a folder.
struct FileEntry {
  std::string name;  ///< Without its folder.
  bool is_folder = false;
  std::uintmax_t bytes = 0;
};

/// Returns whether `catena view` can open the file, by its extension in any case: .json, .vdb, .nii, .nii.gz, .stl, .obj, ...
bool is_openable(const std::string& path);
/// Returns what a dropped folder opens as: its only data file, or a series of files that differ in a number only ("FOLDER/flow_*.vti");
/// otherwise the folder itself, as also if it contains DICOM images (.dcm) or is an OpenFOAM case.
std::string resolve_dropped_folder(const std::string& folder);
/// Returns whether the name is that of a scene (.json).
bool is_scene_path(const std::string& path);
/// Returns ".json" and the file extensions of all self-describing data files, meshes, curves and points.
const std::vector<std::string_view>& openable_extensions();

/// Maximum number of entries that list_folder() returns.
inline constexpr std::size_t kMaxEntries = 5000;
/// Returns the folders, then the files that Catena can open (or only scenes), each sorted by name, without hidden entries. An Error if the
/// folder cannot be read.
Result<std::vector<FileEntry>> list_folder(const std::string& folder, bool scenes_only = false);

/// Returns the typed path as an absolute path: "~" is the home folder, a relative path starts at `folder`.
std::string resolve_typed_path(const std::string& folder, const std::string& typed);
/// Returns `typed` extended by what all matching entries have in common; a complete folder name ends with "/".
std::string complete_path(const std::string& folder, const std::string& typed);

/// Returns "FOLDER/STEM-001EXTENSION" with the first unused number.
std::string unused_file_name(const std::string& folder, const std::string& stem, const std::string& extension);
/// Returns the name without folder and extension ("carotid" for "a/carotid.vdb", "brain" for "brain.nii.gz"); "catena" for an empty path.
std::string path_stem(const std::string& path);

/// Returns the folder for session state: $XDG_STATE_HOME/catena, else ~/.local/state/catena; empty without a home folder.
std::string state_folder();

/// Maximum length of the list of recent files.
inline constexpr std::size_t kMaxRecentFiles = 10;

/// The most recently opened scenes and data files, stored in $XDG_STATE_HOME/catena/recent.json (else ~/.local/state/catena/recent.json):
/// {"files": [PATH, ...]}, newest first. Never fails: if there is no home folder, the file cannot be written or is foreign, the list is
/// empty or stays unchanged. Frame thread.
class RecentFiles {
 public:
  /// Uses the user's own list.
  RecentFiles();
  /// Uses the list at another path; empty: the list is not stored.
  explicit RecentFiles(std::string path);

  /// Returns the files that exist, as absolute paths, newest first.
  std::vector<std::string> existing_files() const;
  /// Puts a file at the top and writes the list, after reading it again, since other programs add to it as well.
  void add(const std::string& file);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

}  // namespace catena::app
