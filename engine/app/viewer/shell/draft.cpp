#include "engine/app/viewer/shell/draft.h"

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

#include "engine/base/output_file.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kDigits = 12, kLongestName = 180;

/// "scene.json.unsaved-": the beginning of all its drafts' names.
std::string draft_prefix(const std::string& scene_path) {
  std::string name = fs::path(scene_path).filename().string();
  name.resize(std::min(name.size(), kLongestName));
  return name + ".unsaved-";
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
    if (written < 0) return Error{path + ": cannot write: " + std::strerror(errno)};
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return Done{};
}

/// Of a file that its program no longer holds: when it was written.
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

Draft::~Draft() {
  if (lock_ >= 0) ::close(lock_);
}

Outcome Draft::keep(const std::string& scene_path, const std::string& text) {
  if (!path_.empty() && scene_path == scene_path_ && text == text_) return Done{};
  if (scene_path != scene_path_) remove();
  const fs::path folder = fs::path(scene_path).parent_path();
  const std::string path = path_.empty() ? (folder / (draft_prefix(scene_path) + random_digits())).string() : path_;
  CATENA_TRY(PartFile part, PartFile::create(path, true));
  CATENA_CHECK(write_all(part.descriptor(), text, path));
  CATENA_CHECK(part.commit());
  if (lock_ >= 0) ::close(lock_);
  lock_ = part.release();
  scene_path_ = scene_path;
  path_ = path;
  text_ = text;
  return Done{};
}

void Draft::remove() {
  if (!path_.empty()) ::unlink(path_.c_str());
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
  path_.clear();
  text_.clear();
}

std::optional<LeftDraft> find_left_draft(const std::string& scene_path) {
  const std::string prefix = draft_prefix(scene_path);
  fs::path folder = fs::path(scene_path).parent_path();
  if (folder.empty()) folder = ".";
  std::optional<LeftDraft> newest;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    if (!is_draft_name(it->path().filename().string(), prefix)) continue;
    const auto at = time_of_left(it->path().string());
    if (at && (!newest || *at > newest->at_s)) newest = LeftDraft{it->path().string(), {}, *at};
  }
  if (!newest) return std::nullopt;
  auto text = read_text(newest->path, "unsaved work (JSON)", kMaxJsonBytes);
  if (!text) return std::nullopt;
  newest->text = std::move(*text);
  return newest;
}

void remove_left_draft(const LeftDraft& draft) { ::unlink(draft.path.c_str()); }

}  // namespace catena::app
