// SPDX-License-Identifier: MIT
#include "engine/base/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <random>
#include <utility>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/base/result.h"
#include "engine/base/system_failure.h"

namespace catena {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDigits = 12;
constexpr std::size_t kMaxStem = 200;  // of the output's name, in bytes: a file name is limited to 255

Error cannot_write_part(const std::string& path, int code) { return system_error(path + ": cannot write", code); }

/// Returns ".../flow.json.part", the common prefix of the output's temporary files.
std::string prefix_of(const std::string& path) {
  const fs::path full_path(path);
  std::string name = full_path.filename().string();
  name.resize(std::min(name.size(), kMaxStem));
  return (full_path.parent_path() / (name + ".part")).string();
}

/// Returns the process ID from "<pid>-<12 hexadecimal digits>"; 0 for any other text: the file is not one of Catena's.
pid_t process_of(std::string_view after_part) {
  pid_t pid = 0;
  const char* last = after_part.data() + after_part.size();
  const auto [end, error] = std::from_chars(after_part.data(), last, pid);
  if (error != std::errc() || pid <= 0 || static_cast<std::size_t>(last - end) != 1 + kDigits || *end != '-') return 0;
  return std::all_of(end + 1, last, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }) ? pid : 0;
}

bool is_running(pid_t pid) { return ::kill(pid, 0) == 0 || errno != ESRCH; }

/// Returns true for a folder of at least 60 s of age; a younger one may not be locked yet by its creator. If an old folder's lock is free,
/// its program has ended, even if another process has that ID (in containers all programs may have the same one).
bool is_old_folder(const fs::path& path) {
  constexpr std::time_t kYoung_s = 60;
  struct stat about {};
  return ::lstat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode) && std::time(nullptr) - about.st_mtime >= kYoung_s;
}

/// Returns the files that ended programs may have left in a folder. The folder is read at most once a second: the images of a long
/// sequence go into one folder.
std::vector<std::string> leftover_files(const fs::path& folder) {
  static std::mutex mutex;
  static fs::path last_folder;
  static std::chrono::steady_clock::time_point last_time;
  static std::vector<std::string> files;
  const std::lock_guard lock(mutex);
  const auto now = std::chrono::steady_clock::now();
  if (folder == last_folder && now - last_time < std::chrono::seconds(1)) return files;
  last_folder = folder;
  last_time = now;
  files.clear();
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    const std::string name = it->path().filename().string();
    const auto at = name.rfind(".part");
    const pid_t pid = at == std::string::npos ? 0 : process_of(std::string_view(name).substr(at + 5));
    if (pid != 0 && (!is_running(pid) || is_old_folder(it->path()))) files.push_back(it->path().string());
  }
  return files;
}

}  // namespace

std::string temporary_name(const std::string& path) {
  static std::mutex mutex;
  static std::mt19937_64 random{std::random_device{}()};
  const std::lock_guard lock(mutex);
  char suffix[64];
  std::snprintf(suffix, sizeof suffix, "%d-%0*llx", static_cast<int>(::getpid()), static_cast<int>(kDigits),
                static_cast<unsigned long long>(random() & 0xffffffffffffULL));
  return prefix_of(path) + suffix;
}

void remove_stale_temporaries(const std::string& path) {
  const std::string prefix = prefix_of(path);
  const fs::path folder = fs::path(path).parent_path();
  for (const std::string& name : leftover_files(folder.empty() ? fs::path(".") : folder)) {
    const std::string file_name = fs::path(name).filename().string();
    if (!file_name.starts_with(fs::path(prefix).filename().string()) ||
        process_of(file_name.substr(fs::path(prefix).filename().string().size())) == 0)
      continue;
    // another machine or container may write into the same folder: its files are locked
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat about {};
    if (::fstat(descriptor, &about) == 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
      std::error_code ignored;
      if (S_ISREG(about.st_mode)) ::unlink(name.c_str());
      if (S_ISDIR(about.st_mode)) fs::remove_all(name, ignored);
    }
    ::close(descriptor);
  }
}

Result<TemporaryFile> TemporaryFile::create(const std::string& path, bool owner_only) {
  CATENA_CHECK(check_not_input(path));
  remove_stale_temporaries(path);
  struct stat old {};
  const bool replaces = ::stat(path.c_str(), &old) == 0 && S_ISREG(old.st_mode);
  const mode_t mode = owner_only ? 0600 : replaces ? old.st_mode & 0777 : 0666;
  for (int attempt = 0;; ++attempt) {
    // allocates the name before the file exists: its removal must not need memory
    TemporaryFile part(path, temporary_name(path), -1);
    part.descriptor_ = ::open(part.name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (part.descriptor_ < 0) {
      const int code = errno;
      part.name_.clear();
      if (code == EEXIST && attempt < 100) continue;
      return cannot_write_part(path, code);
    }
    if (replaces && !owner_only) static_cast<void>(::fchmod(part.descriptor_, mode));
    static_cast<void>(::flock(part.descriptor_, LOCK_EX | LOCK_NB));
    return part;
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::move(other.path_)), name_(std::exchange(other.name_, {})), descriptor_(std::exchange(other.descriptor_, -1)) {}

TemporaryFile::~TemporaryFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

Outcome TemporaryFile::commit() {
  CATENA_CHECK(check_not_input(path_));
  if (std::rename(name_.c_str(), path_.c_str()) != 0) return cannot_write_part(path_, errno);
  name_.clear();
  return Done{};
}

Result<bool> TemporaryFile::commit_new() {
  if (::link(name_.c_str(), path_.c_str()) != 0) {
    if (errno == EEXIST) return false;
    // the file system has no hard links; without RENAME_NOREPLACE either, another program may create the file in between
    if (::renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0) {
      name_.clear();
      return true;
    }
    if (errno == EEXIST) return false;
    struct stat about {};
    if (::lstat(path_.c_str(), &about) == 0) return false;
    CATENA_CHECK(commit());
    return true;
  }
  ::unlink(name_.c_str());
  name_.clear();
  return true;
}

int TemporaryFile::release() { return std::exchange(descriptor_, -1); }

}  // namespace catena
