// SPDX-License-Identifier: MIT
#include "engine/io/levels/level_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/folder_lock.h"
#include "engine/base/hash.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/levels/index_file.h"
#include "engine/io/levels/make_levels.h"
#include "engine/io/stores/store_voxels.h"

namespace catena::field {
namespace {

namespace fs = std::filesystem;
using Cached = std::shared_ptr<const CachedLevels>;

std::optional<std::string> cache_folder;
LevelProgress level_progress;

const StoreGrid& grid_of(const Store& store, int grid) { return store.description().grids[static_cast<std::size_t>(grid)]; }

/// Returns the folder for a grid; empty: there is no cache.
std::string folder_for(const Store& store, int grid, int step) {
  if (!cache_folder || cache_folder->empty()) return {};
  std::error_code code;
  const std::string path = fs::absolute(path_of_store(store), code).lexically_normal().string();
  const std::string key = fmt::format("{}\n{}\n{}", path, grid_of(store, grid).name, step);
  constexpr std::size_t kMaxName = 60;
  std::string name = io::file_stem(path).substr(0, kMaxName);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_' && c != '.') c = '_';
  return fmt::format("{}/{}-{:016x}", *cache_folder, name, hash_bytes(key.data(), key.size()));
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the number of a folder on its disk; 0: there is none. It differs after the folder was deleted and created.
std::uint64_t inode_of(const std::string& folder) {
  struct stat about {};
  return ::stat(folder.c_str(), &about) == 0 ? about.st_ino : 0;
}

/// Removes what a folder of the cache contains, nothing else.
void empty_folder(const std::string& folder) {
  std::error_code code;
  for (const char* name : {CachedLevels::kIndexName, CachedLevels::kStoreName, "/levels.zarr.part", "/ranges", "/source"})
    fs::remove_all(folder + name, code);
  remove_stale_temporaries(folder + CachedLevels::kIndexName);
  remove_stale_temporaries(folder + "/source");
}

Outcome write_identity(const CachePlace& place) {
  auto out = OutputFile::open(place.source());
  if (!out) return Error{out.error().message, true};
  out->write(place.identity);
  if (const Outcome done = out->commit(); !done) return Error{done.error().message, true};
  return Done{};
}

/// Waits until no other process, and no other thread, writes to the folder.
Result<FolderLock> lock_folder(const std::string& folder, const std::string& path) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{fmt::format("{}: cannot be created: {}", one_line(folder), describe_errno(code.value())), true};
  if (::access(folder.c_str(), R_OK | W_OK | X_OK) != 0)
    return Error{fmt::format("{}: cannot write: {}", one_line(folder), describe_errno(errno)), true};
  constexpr std::chrono::milliseconds kWait{100};
  for (;;) {
    auto lock = FolderLock::acquire(folder);
    if (lock || lock.error().system_failure || !fs::exists(folder, code)) return lock;
    if (level_progress) level_progress(path, 0);
    std::this_thread::sleep_for(kWait);
  }
}

/// Returns the levels in a folder, which stay open for the next caller.
Cached open_cached(const CachePlace& place, const std::vector<StoreLevel>& own) {
  struct Opened {
    CachePlace place;
    std::int64_t changed_ns = 0;
    Cached levels;
  };
  static std::mutex mutex;
  static std::list<Opened> opened;  // the last used first
  constexpr std::size_t kMaxOpen = 4;
  struct stat about {};
  if (::stat((place.folder + CachedLevels::kIndexName).c_str(), &about) != 0) return nullptr;
  const std::scoped_lock lock(mutex);
  opened.remove_if([&](const Opened& o) { return o.levels->is_damaged(); });
  const auto found = std::ranges::find_if(opened, [&](const Opened& o) {
    return o.place.folder == place.folder && o.place.identity == place.identity && o.changed_ns == modified_ns(about);
  });
  if (found != opened.end()) {
    opened.splice(opened.begin(), opened, found);
    return opened.front().levels;
  }
  Cached levels = CachedLevels::open(place.folder, place.identity, own);
  if (!levels) return nullptr;
  std::error_code code;
  fs::last_write_time(place.source(), fs::file_time_type::clock::now(), code);  // trim_level_cache()
  opened.remove_if([&](const Opened& o) { return o.place.folder == place.folder; });
  opened.push_front({place, modified_ns(about), levels});
  if (opened.size() > kMaxOpen) opened.pop_back();
  return levels;
}

bool is_disk_full(const std::string& folder) {
  constexpr std::uint64_t kLeastBytes = 4 << 20;
  struct statvfs about {};
  return ::statvfs(folder.c_str(), &about) == 0 && static_cast<std::uint64_t>(about.f_bavail) * about.f_frsize < kLeastBytes;
}

}  // namespace

void set_level_cache(std::string folder, LevelProgress progress) {
  cache_folder = std::move(folder);
  level_progress = std::move(progress);
}

Cached find_cached_levels(const Store& store, int grid, int step) {
  const std::string folder = folder_for(store, grid, step);
  std::error_code code;
  if (folder.empty()) return nullptr;
  const std::uintmax_t bytes = fs::file_size(folder + CachedLevels::kIndexName, code);
  if (code) return nullptr;
  // a store of many files takes long to be recognized: an index without levels is not worth it
  constexpr std::uintmax_t kMaxIndexBytes = 3'000'000;
  if (bytes > kMaxIndexBytes && !fs::exists(folder + CachedLevels::kStoreName, code)) return nullptr;
  return open_cached({folder, identify_stored_grid(store, grid, step)}, grid_of(store, grid).levels);
}

Result<Cached> make_cached_levels(const std::shared_ptr<Store>& store, int grid, int step) {
  if (!cache_folder) return Error{"levels are not cached in this program"};
  if (cache_folder->empty()) return Error{"there is no folder for caches: HOME or XDG_CACHE_HOME was expected to be set"};
  const std::vector<StoreLevel>& own = grid_of(*store, grid).levels;
  constexpr double kMostBricks = 1 << 25;
  if (const auto count = static_cast<double>(brick_count(brick_counts({own.back().size, {}}))); count > kMostBricks)
    return Error{fmt::format("there are {:.3g} bricks of {}^3 voxels, at most {:.3g} were expected", count, kBrickEdge, kMostBricks)};
  const CachePlace place{folder_for(*store, grid, step), identify_stored_grid(*store, grid, step)};
  if (is_path_within(place.folder, store->path())) return Error{one_line(place.folder) + ": lies in the folder of the data"};
  const auto end_progress = [&] {
    if (level_progress) level_progress(store->path(), -1);
  };
  const auto report = [&](double part) {
    if (level_progress) level_progress(store->path(), part);
  };
  Outcome made = Done{};
  bool is_anew = false;
  constexpr int kTries = 3;  // the folder can be deleted at any time
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const auto lock = lock_folder(place.folder, store->path());
    if (!lock) {
      made = lock.error();
      if (made.error().system_failure) break;
      continue;
    }
    if (Cached levels = open_cached(place, own); levels && !levels->levels().empty()) {
      end_progress();
      return levels;
    }
    std::error_code code;
    const std::uint64_t inode = inode_of(place.folder);
    const bool is_continued =
        !is_anew && read_text(place.source()) == place.identity && !fs::exists(place.folder + CachedLevels::kStoreName, code);
    if (!is_continued) {
      empty_folder(place.folder);
      made = write_identity(place);
      if (!made) break;
    }
    made = make_levels(place, store, grid, step, report);
    if (made) fs::remove(place.ranges(), code);
    const bool is_deleted = inode_of(place.folder) != inode;
    if (made || (!is_deleted && (!is_continued || made.error().system_failure))) break;
    is_anew = !is_deleted;
  }
  end_progress();
  if (!made) {
    if (!made.error().system_failure || !is_disk_full(place.folder)) return made.error();
    empty_folder(place.folder);
    return Error{one_line(place.folder) + ": cannot write: " + describe_errno(ENOSPC), true};
  }
  constexpr std::uintmax_t kPartOfDisk = 10;
  std::error_code code;
  if (const fs::space_info disk = fs::space(place.folder, code); !code) trim_level_cache(disk.capacity / kPartOfDisk);
  Cached levels = open_cached(place, own);
  if (!levels) return Error{one_line(place.folder) + ": the levels were made but cannot be read"};
  return levels;
}

int trim_level_cache(std::uint64_t max_bytes) {
  struct Entry {
    std::string folder;
    std::uint64_t bytes = 0;
    fs::file_time_type used;
  };
  std::vector<Entry> entries;
  std::uint64_t all = 0;
  std::error_code code;
  for (fs::directory_iterator at(*cache_folder, code), end; !code && at != end; at.increment(code)) {
    std::error_code of_source;
    Entry entry{at->path().string(), 0, fs::last_write_time(at->path() / "source", of_source)};
    if (of_source) continue;  // not ours
    entry.bytes = folder_bytes(entry.folder);
    all += entry.bytes;
    entries.push_back(std::move(entry));
  }
  std::ranges::sort(entries, {}, &Entry::used);
  const auto recent = fs::file_time_type::clock::now() - std::chrono::hours(1);
  int removed = 0;
  for (const Entry& entry : entries) {
    if (all <= max_bytes || entry.used > recent) break;
    const auto lock = FolderLock::acquire(entry.folder);
    if (!lock) continue;
    empty_folder(entry.folder);
    fs::remove(entry.folder, code);
    all -= entry.bytes;
    ++removed;
  }
  return removed;
}

void cache_index(const std::string& path, const BrickIndex& index) {
  constexpr std::uint64_t kFewBricks = 512;
  if (!cache_folder || cache_folder->empty() || brick_count(index.levels.front().counts()) < kFewBricks) return;
  const auto store = Store::open(path, /*is_input=*/false);
  if (!store || (*store)->description().grids.size() != 1) return;
  const CachePlace place{folder_for(**store, 0, 0), identify_stored_grid(**store, 0, 0)};
  std::error_code code;
  fs::create_directories(place.folder, code);
  const auto lock = FolderLock::acquire(place.folder);
  if (code || !lock) return;
  empty_folder(place.folder);
  if (!write_identity(place) || !write_index(place.folder + CachedLevels::kIndexName, place.identity, index)) empty_folder(place.folder);
}

std::uint64_t folder_bytes(const std::string& folder) {
  std::uint64_t bytes = 0;
  std::error_code code, of_file;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
    if (at->is_regular_file(of_file))
      if (const std::uintmax_t size = at->file_size(of_file); !of_file) bytes += size;
  return bytes;
}

}  // namespace catena::field
