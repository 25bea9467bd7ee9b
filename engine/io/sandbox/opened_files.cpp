// SPDX-License-Identifier: MIT
#include "engine/io/sandbox/opened_files.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <mutex>

namespace catena::sandbox {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSlower = 20;  // slowdown caused by the sanitizers
#else
constexpr std::uint64_t kSlower = 1;
#endif

struct Counted {
  std::mutex mutex;
  OpenedFiles opened;
  std::uint64_t bytes = 0, max_cpu_s = 0;
  double more_s = 0;
  bool dicom_only = false;
};
Counted counted;
std::atomic<bool> counting{false};

/// Returns whether the file is DICOM, with or without a preamble: group 2 or 8 comes first.
bool is_dicom(int descriptor) {
  char head[132] = {};
  const ssize_t got = ::pread(descriptor, head, sizeof head, 0);
  if (got >= ssize_t{sizeof head} && std::memcmp(head + 128, "DICM", 4) == 0) return true;
  return got >= 8 && ((head[1] == 0 && (head[0] == 2 || head[0] == 8)) || (head[0] == 0 && (head[1] == 2 || head[1] == 8)));
}

void set_time() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_CPU, &limit) != 0) return;
  const std::uint64_t limit_s = cpu_limit_s(counted.bytes) + static_cast<std::uint64_t>(counted.more_s * double{kSlower});
  limit.rlim_cur = std::min<std::uint64_t>(std::max<std::uint64_t>(std::min(limit_s, counted.max_cpu_s), limit.rlim_cur), limit.rlim_max);
  ::setrlimit(RLIMIT_CPU, &limit);
}

}  // namespace

std::uint64_t cpu_limit_s(std::uint64_t bytes) {
  constexpr std::uint64_t kMinCpuS = 5, kBytesPerSecond = 1'000'000 / 60;
  return kSlower * (kMinCpuS + bytes / kBytesPerSecond);
}

void track_opened_files(std::uint64_t max_cpu_s, bool dicom_only) {
  counted.max_cpu_s = max_cpu_s;
  counted.dicom_only = dicom_only;
  counting = true;
}

bool is_tracking_opened_files() { return counting; }

void record_opened(int descriptor, const struct stat& about) {
  const std::scoped_lock lock(counted.mutex);
  const FileId id = to_file_id(about);
  if (std::find(counted.opened.files.begin(), counted.opened.files.end(), id) != counted.opened.files.end()) return;
  if (counted.dicom_only && !is_dicom(descriptor)) return;
  counted.opened.files.push_back(id);
  counted.opened.newest_mtime_ns = std::max(counted.opened.newest_mtime_ns, modified_ns(about));
  // the size on disk excludes the holes of sparse files
  counted.bytes += std::min(static_cast<std::uint64_t>(about.st_size), 512 * static_cast<std::uint64_t>(about.st_blocks));
  set_time();
}

void record_refused(const std::string& path) {
  const std::scoped_lock lock(counted.mutex);
  if (!counted.dicom_only && counted.opened.refused_path.empty())
    counted.opened.refused_path = std::filesystem::path(path).filename().string();
}

void extend_cpu_limit(double seconds) {
  if (!counting) return;
  const std::scoped_lock lock(counted.mutex);
  counted.more_s += seconds;
  set_time();
}

OpenedFiles opened_files() {
  const std::scoped_lock lock(counted.mutex);
  return counted.opened;
}

}  // namespace catena::sandbox
