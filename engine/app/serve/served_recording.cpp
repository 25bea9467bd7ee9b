#include "engine/app/serve/served_recording.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "engine/app/viewer/shell/scene_files.h"

namespace catena::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFolderPrefix = "catena-serve-";
constexpr std::time_t kYoung_s = 60;  // between mkdtemp and the lock a folder is not held

/// Folders of this user's that no program holds.
void remove_left_behind(const fs::path& temporary) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(temporary, ignored)) {
    const std::string path = entry.path().string();
    struct stat info {};
    if (!entry.path().filename().string().starts_with(kFolderPrefix) || lstat(path.c_str(), &info) != 0) continue;
    if (!S_ISDIR(info.st_mode) || info.st_uid != geteuid() || std::time(nullptr) - info.st_mtime < kYoung_s) continue;
    if (const auto nobody_s = FolderLock::take(path)) fs::remove_all(entry.path(), ignored);
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
  if (mkdtemp(pattern.data()) == nullptr) return Error{pattern + ": cannot be made: " + std::generic_category().message(errno), true};
  folder_ = pattern;
  if (auto lock = FolderLock::take(folder_)) lock_.emplace(std::move(*lock));
  if (lock_ && !FolderLock::take(folder_)) remove_left_behind(temporary);  // locks are known here
  return Done{};
}

Outcome ServedRecording::begin(const SceneHost& scene, HandHost& hand) {
  CATENA_CHECK(end(hand));
  if (folder_.empty()) CATENA_CHECK(make_folder());
  std::error_code error;
  if (!name_.empty()) fs::remove(path(), error);
  name_.clear();
  ++count_;
  return hand.record(folder_ + "/recording-" + std::to_string(count_) + ".catlog", recorded(scene, hand));
}

Outcome ServedRecording::end(HandHost& hand) {
  const std::string path = hand.recording().path();
  if (!hand.recording().running()) return Done{};
  CATENA_CHECK(hand.stop_recording());
  name_ = fs::path(path).filename().string();
  return Done{};
}

bool ServedRecording::is_over(const HandHost& hand) const {
  return hand.recording().running() && (hand.recording().failed() || hand.recording().status().bytes > kMostBytes);
}

}  // namespace catena::app
