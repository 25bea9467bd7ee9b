// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/autosave.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/viewer/scene/file_browser.h"
#include "engine/base/hash.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kDigits = 12, kLongestName = 180;

/// Folder in which autosaves lie, and the prefix of their file names.
struct DraftPlace {
  fs::path folder;
  std::string prefix;
};

/// Autosaves next to the scene: "scene.json.unsaved-".
DraftPlace beside_scene(const std::string& scene_path) {
  std::string name = fs::path(scene_path).filename().string();
  name.resize(std::min(name.size(), kLongestName));
  fs::path folder = fs::path(scene_path).parent_path();
  return {folder.empty() ? fs::path(".") : folder, name + ".unsaved-"};
}

/// Autosaves in the user's own folder, the prefix preceded by a hash of the scene's path; std::nullopt if there is no home folder.
std::optional<DraftPlace> in_state_folder(const std::string& scene_path) {
  const std::string state = state_folder();
  if (state.empty()) return std::nullopt;
  std::error_code code;
  const std::string place = fs::weakly_canonical(fs::absolute(scene_path, code), code).string();
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_bytes(place.data(), place.size())));
  return DraftPlace{fs::path(state) / "unsaved", std::string(digits) + "-" + beside_scene(scene_path).prefix};
}

std::string random_digits() {
  std::random_device random;
  char digits[2 * kDigits];
  std::snprintf(digits, sizeof digits, "%06x%06x", random() & 0xffffffu, random() & 0xffffffu);
  return digits;
}

bool is_draft_name(std::string_view name, std::string_view prefix) {
  return name.starts_with(prefix) && name.size() == prefix.size() + kDigits &&
         name.find_first_not_of("0123456789abcdef", prefix.size()) == std::string_view::npos;
}

Outcome write_all(int descriptor, std::string_view text, const std::string& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return system_error(path + ": cannot write", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return Done{};
}

/// Time at which an orphaned autosave was written; std::nullopt if a running program still holds the file.
std::optional<std::int64_t> time_of_left(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  struct stat about {};
  const bool mine = ::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == ::geteuid();
  const bool left = mine && ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  ::close(descriptor);
  return left ? std::optional<std::int64_t>(about.st_mtim.tv_sec) : std::nullopt;
}

}  // namespace

Autosave::~Autosave() {
  if (lock_ >= 0) ::close(lock_);
}

Outcome Autosave::save_text(const std::string& scene_path, const std::string& text) {
  if (!path_.empty() && scene_path == scene_path_ && text == text_) return Done{};
  if (scene_path != scene_path_) remove();
  std::string path = path_;
  if (path.empty()) {
    std::error_code code;
    DraftPlace place = beside_scene(scene_path);
    // a data file's folder is not used for autosaves until a scene has been saved there
    if (const auto own = in_state_folder(scene_path); own && !fs::exists(scene_path, code)) {
      place = *own;
      fs::create_directories(place.folder, code);
    }
    path = (place.folder / (place.prefix + random_digits())).string();
  }
  CATENA_TRY(TemporaryFile part, TemporaryFile::create(path, true));
  CATENA_CHECK(write_all(part.descriptor(), text, path));
  CATENA_CHECK(part.commit());
  if (lock_ >= 0) ::close(lock_);
  lock_ = part.release();
  scene_path_ = scene_path;
  path_ = path;
  text_ = text;
  return Done{};
}

void Autosave::remove() {
  if (!path_.empty()) ::unlink(path_.c_str());
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
  path_.clear();
  text_.clear();
}

std::optional<OrphanedAutosave> find_orphaned_autosave(const std::string& scene_path) {
  std::vector<DraftPlace> places{beside_scene(scene_path)};
  if (auto own = in_state_folder(scene_path)) places.push_back(std::move(*own));
  std::optional<OrphanedAutosave> newest;
  for (const DraftPlace& place : places) {
    std::error_code code;
    for (fs::directory_iterator it(place.folder, code), end; !code && it != end; it.increment(code)) {
      if (!is_draft_name(it->path().filename().string(), place.prefix)) continue;
      const auto at = time_of_left(it->path().string());
      if (at && (!newest || *at > newest->saved_at_s)) newest = OrphanedAutosave{it->path().string(), {}, *at};
    }
  }
  if (!newest) return std::nullopt;
  auto text = read_text_file(newest->path, "unsaved work (JSON)", kMaxJsonBytes);
  if (!text) return std::nullopt;
  newest->text = std::move(*text);
  return newest;
}

void remove_orphaned_autosave(const OrphanedAutosave& draft) { ::unlink(draft.path.c_str()); }

}  // namespace catena::app
