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
/// A scene, by its name.
bool is_scene_name(const std::string& path);
/// ".json", and the endings of the data files and meshes that say their own layout.
const std::vector<std::string_view>& openable_endings();

/// Folders first, then the files that Catena opens, each by name; hidden ones are left out. At most kMaxEntries.
inline constexpr std::size_t kMaxEntries = 5000;
Result<std::vector<FileEntry>> list_folder(const std::string& folder, bool scenes_only = false);

/// What is typed, made absolute: "~" is the home folder, a relative path starts at `folder`.
std::string typed_path(const std::string& folder, const std::string& typed);
/// `typed` with as much added as all fitting entries agree on; a folder that is complete ends with "/".
std::string completed(const std::string& folder, const std::string& typed);

/// "FOLDER/STEM-001.png" with the first number that is free.
std::string free_name(const std::string& folder, const std::string& stem, const std::string& extension);
/// The name without folder and extension ("carotid" of "a/carotid.vdb", "brain" of "brain.nii.gz"); "catena" of an empty path.
std::string stem_of_path(const std::string& path);

}  // namespace catena::app
