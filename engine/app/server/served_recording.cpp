// SPDX-License-Identifier: MIT
#include "engine/app/server/served_recording.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "engine/app/viewer/scene/scene_files.h"

namespace catena::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFolderPrefix = "catena-serve-";
constexpr std::time_t kYoung_s = 60;  // seconds; a new folder has no lock between mkdtemp and locking

/// Removes temporary folders of this user that no running program has locked.
void remove_left_behind(const fs::path& temporary) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(temporary, ignored)) {
    const std::string path = entry.path().string();
    struct stat info {};
    if (!entry.path().filename().string().starts_with(kFolderPrefix) || lstat(path.c_str(), &info) != 0) continue;
    if (!S_ISDIR(info.st_mode) || info.st_uid != geteuid() || std::time(nullptr) - info.st_mtime < kYoung_s) continue;
    if (const auto nobody_s = FolderLock::acquire(path)) fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

ServedRecording::~ServedRecording() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

Outcome ServedRecording::make_folder() {
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  std::string pattern = (temporary / kFolderPrefix).string() + "XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr)
    return Error{pattern + ": cannot create the folder: " + std::generic_category().message(errno), true};
  folder_ = pattern;
  if (auto lock = FolderLock::acquire(folder_)) lock_.emplace(std::move(*lock));
  if (lock_ && !FolderLock::acquire(folder_)) remove_left_behind(temporary);  // only where the file system supports locks
  return Done{};
}

Outcome ServedRecording::begin(const SceneModel& scene, HapticSession& hand) {
  CATENA_CHECK(end(hand));
  if (folder_.empty()) CATENA_CHECK(make_folder());
  std::error_code error;
  if (!name_.empty()) fs::remove(path(), error);
  name_.clear();
  ++count_;
  return hand.record(folder_ + "/recording-" + std::to_string(count_) + ".catlog", make_recorded_scene(scene, hand));
}

Outcome ServedRecording::end(HapticSession& hand) {
  const std::string path = hand.recording().path();
  if (!hand.recording().is_recording()) return Done{};
  CATENA_CHECK(hand.stop_recording());
  name_ = fs::path(path).filename().string();
  return Done{};
}

bool ServedRecording::must_end(const HapticSession& hand) const {
  return hand.recording().is_recording() && (hand.recording().has_failed() || hand.recording().status().bytes > kMaxBytes);
}

}  // namespace catena::app
