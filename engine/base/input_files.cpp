// SPDX-License-Identifier: MIT
#include "engine/base/input_files.h"

#include <atomic>
#include <mutex>
#include <set>

namespace catena {
namespace {

std::mutex inputs_mutex;
std::set<FileId> inputs_read;
std::atomic<bool> inputs_are_protected{false};

}  // namespace

FileId to_file_id(const struct stat& about) { return {about.st_dev, about.st_ino}; }

std::int64_t modified_ns(const struct stat& about) { return std::int64_t{about.st_mtim.tv_sec} * 1'000'000'000 + about.st_mtim.tv_nsec; }

std::optional<FileId> find_file_id(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
  return to_file_id(about);
}

void register_inputs(const std::vector<FileId>& files) {
  const std::scoped_lock lock(inputs_mutex);
  inputs_read.insert(files.begin(), files.end());
}

void protect_inputs(bool protect) { inputs_are_protected = protect; }

Outcome check_not_input(const std::string& path) {
  if (!inputs_are_protected) return Done{};
  const auto id = find_file_id(path);
  const std::scoped_lock lock(inputs_mutex);
  if (!id || !inputs_read.contains(*id)) return Done{};
  return Error{path + ": is also an input: expected another name for the output"};
}

}  // namespace catena
