#include "engine/app/viewer/shell/recent_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"

namespace catena::app {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargestList = 1u << 20;

/// XDG base directories: a relative one counts as not given.
std::string users_path() {
  const char *state = std::getenv("XDG_STATE_HOME"), *home = std::getenv("HOME");
  if (state != nullptr && fs::path(state).is_absolute()) return (fs::path(state) / "catena/recent.json").string();
  if (home != nullptr && fs::path(home).is_absolute()) return (fs::path(home) / ".local/state/catena/recent.json").string();
  return {};
}

std::vector<std::string> read_list(const std::string& path) {
  std::error_code code;
  if (path.empty() || !fs::is_regular_file(path, code) || fs::file_size(path, code) > kLargestList || code) return {};
  const auto text = read_text(path, "a list of files", kMaxJsonBytes);
  const auto root = text ? json::parse(*text, path) : Result<json::Node>(Error{});
  const json::Node* list = root ? root->find("files") : nullptr;
  std::vector<std::string> files;
  if (list == nullptr) return files;
  for (const json::Node& item : list->items)
    if (item.kind == json::Kind::string && files.size() < kMaxRecentFiles) files.push_back(item.string);
  return files;
}

Outcome write_list(const std::string& path, const std::vector<std::string>& files) {
  std::error_code code;
  fs::create_directories(fs::path(path).parent_path(), code);
  CATENA_TRY(OutputFile out, OutputFile::open(path));
  out.write("{\n  \"files\": [");
  for (std::size_t i = 0; i < files.size(); ++i) out.write((i == 0 ? "\n    " : ",\n    ") + json::string_text(files[i]));
  out.write("\n  ]\n}\n");
  return out.commit();
}

}  // namespace

RecentFiles::RecentFiles() : RecentFiles(users_path()) {}
RecentFiles::RecentFiles(std::string path) : path_(std::move(path)), files_(read_list(path_)) {}

std::vector<std::string> RecentFiles::shown() const {
  std::vector<std::string> there;
  std::error_code code;
  for (const std::string& file : files_)
    if (fs::is_regular_file(file, code)) there.push_back(file);
  return there;
}

void RecentFiles::add(const std::string& file) {
  std::error_code code;
  const fs::path whole = fs::absolute(file, code).lexically_normal();
  if (code || file.empty()) return;
  if (std::vector<std::string> now = read_list(path_); !now.empty()) files_ = std::move(now);
  std::erase(files_, whole.string());
  files_.insert(files_.begin(), whole.string());
  if (files_.size() > kMaxRecentFiles) files_.resize(kMaxRecentFiles);
  if (path_.empty()) return;
  // a list that cannot be kept is one of this run
  const Outcome kept = write_list(path_, files_);
  static_cast<void>(kept);
}

}  // namespace catena::app
