/// This file lists what the Open dialog shows, and finds names of files that are not there yet. It shows only what the person may read, and
/// never throws. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

struct FileEntry {
  std::string name;  ///< without its folder
  bool is_folder = false;
  std::uintmax_t bytes = 0;
};

/// .json .vdb .nii .nii.gz .stl .obj (what `catena view` opens), whatever the case.
bool is_openable(const std::string& path);
/// What a dropped folder opens as: its only data file, or the files of a row that differ in a number alone ("FOLDER/flow_*.vti"); else,
/// and where DICOM images (.dcm) lie in it, or it is an OpenFOAM case, the folder itself.
std::string resolve_dropped_folder(const std::string& folder);
/// A scene, by its name.
bool is_scene_path(const std::string& path);
/// ".json", and the endings of the data files and meshes that say their own layout.
const std::vector<std::string_view>& openable_extensions();

/// Folders first, then the files that Catena opens, each by name; hidden ones are left out. At most kMaxEntries.
inline constexpr std::size_t kMaxEntries = 5000;
Result<std::vector<FileEntry>> list_folder(const std::string& folder, bool scenes_only = false);

/// What is typed, made absolute: "~" is the home folder, a relative path starts at `folder`.
std::string resolve_typed_path(const std::string& folder, const std::string& typed);
/// `typed` with as much added as all fitting entries agree on; a folder that is complete ends with "/".
std::string complete_path(const std::string& folder, const std::string& typed);

/// "FOLDER/STEM-001.png" with the first number that is free.
std::string unused_file_name(const std::string& folder, const std::string& stem, const std::string& extension);
/// The name without folder and extension ("carotid" of "a/carotid.vdb", "brain" of "brain.nii.gz"); "catena" of an empty path.
std::string path_stem(const std::string& path);

/// Where this user's programs keep what is of a session: $XDG_STATE_HOME/catena, else ~/.local/state/catena; empty where there is no home.
std::string state_folder();

/// RecentFiles has the scenes and data files that were opened last, kept from run to run in $XDG_STATE_HOME/catena/recent.json (else
/// ~/.local/state/catena/recent.json): {"files": [PATH, ...]}, the newest first. It never fails the program: where there is no home,
/// nothing can be written or the file is none of ours, the list is empty or stays as it was. Frame thread.
inline constexpr std::size_t kMaxRecentFiles = 10;

class RecentFiles {
 public:
  /// The user's own list.
  RecentFiles();
  /// The list at another place; empty: it is kept nowhere.
  explicit RecentFiles(std::string path);

  /// Those that are there now, whole paths, the newest first.
  std::vector<std::string> existing_files() const;
  /// Puts a file at the top and writes the list, which is read again before: other programs add to it as well.
  void add(const std::string& file);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

}  // namespace catena::app
