// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/file_browser.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/app/cli/io_conflicts.h"
#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/data_files.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

namespace fs = std::filesystem;

namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return text;
}

}  // namespace

bool is_scene_path(const std::string& path) { return has_extension(path, ".json"); }

const std::vector<std::string_view>& openable_extensions() {
  static const std::vector<std::string_view> endings = [] {
    std::vector<std::string_view> all{".json"};
    for (const io::Format& format : io::formats())
      if (!format.volume.needs_layout) all.insert(all.end(), format.extensions.begin(), format.extensions.end());
    return all;
  }();
  return endings;
}

bool is_openable(const std::string& path) {
  return std::ranges::any_of(openable_extensions(), [&](std::string_view ending) { return has_extension(path, ending); });
}

std::string resolve_dropped_folder(const std::string& folder) {
  if (field::is_openfoam_case(folder)) return folder;
  const auto entries = list_folder(folder);
  std::vector<std::string> names;
  for (std::size_t k = 0; entries && k < entries->size(); ++k)
    if (const FileEntry& entry = (*entries)[k]; !entry.is_folder && !is_scene_path(entry.name)) names.push_back(entry.name);
  if (names.empty() || std::ranges::any_of(names, [](const std::string& name) { return has_extension(name, ".dcm"); })) return folder;
  if (names.size() == 1) return (fs::path(folder) / names.front()).string();
  for (std::string& name : names) name = (fs::path(folder) / name).string();
  const auto series = scene::make_pattern(names);
  return series ? *series : folder;
}

Result<std::vector<FileEntry>> list_folder(const std::string& folder, bool scenes_only) {
  std::error_code code;
  fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, code);
  if (code)
    return Error{one_line(folder + ": " + describe_errno(code.value()) + "; a readable folder was expected"),
                 is_system_failure(code.value())};
  std::vector<FileEntry> entries;
  for (; it != fs::directory_iterator(); it.increment(code)) {
    if (code || entries.size() >= kMaxEntries) break;
    const std::string name = it->path().filename().string();
    if (name.empty() || name[0] == '.') continue;
    std::error_code ignored;
    if (it->is_directory(ignored)) {
      entries.push_back({name, true, 0});
    } else if (it->is_regular_file(ignored) && (scenes_only ? is_scene_path(name) : is_openable(name))) {
      const auto bytes = it->file_size(ignored);
      entries.push_back({name, false, ignored ? 0 : bytes});
    }
  }
  std::ranges::sort(entries, [](const FileEntry& a, const FileEntry& b) {
    if (a.is_folder != b.is_folder) return a.is_folder;
    const std::string x = lower(a.name), y = lower(b.name);
    return x != y ? x < y : a.name < b.name;
  });
  return entries;
}

std::string resolve_typed_path(const std::string& folder, const std::string& typed) {
  fs::path path(typed);
  if (typed == "~" || typed.starts_with("~/")) {
    const char* home = std::getenv("HOME");
    path = fs::path(home == nullptr ? "/" : home) / typed.substr(std::min<std::size_t>(2, typed.size()));
  } else if (path.is_relative()) {
    path = fs::path(folder) / path;
  }
  return path.lexically_normal().string();
}

std::string complete_path(const std::string& folder, const std::string& typed) {
  const std::size_t slash = typed.rfind('/');
  const std::string before = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
  const std::string begun = typed.substr(before.size());
  const auto entries = list_folder(before.empty() ? folder : resolve_typed_path(folder, before));
  if (!entries) return typed;
  const FileEntry* only = nullptr;
  std::string common;
  int count = 0;
  for (const FileEntry& entry : *entries) {
    if (!entry.name.starts_with(begun)) continue;
    if (count++ == 0) {
      common = entry.name;
      only = &entry;
      continue;
    }
    const auto differ = std::ranges::mismatch(common, entry.name);
    common.erase(differ.in1, common.end());
  }
  if (count == 0) return typed;
  return before + common + (count == 1 && only->is_folder ? "/" : "");
}

std::string unused_file_name(const std::string& folder, const std::string& stem, const std::string& extension) {
  std::error_code code;
  for (int number = 1;; ++number) {
    const fs::path path = fs::path(folder) / fmt::format("{}-{:03}{}", stem, number, extension);
    if (!fs::exists(fs::symlink_status(path, code)) || number == 1'000'000) return path.string();
  }
}

std::string path_stem(const std::string& path) {
  std::string name = fs::path(path).filename().string();
  for (const std::string_view ending : openable_extensions())
    if (has_extension(name, ending)) {
      name.erase(name.size() - ending.size());
      break;
    }
  return name.empty() ? "catena" : name;
}

std::string state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargestList = 1u << 20;

std::string users_path() {
  const std::string folder = state_folder();
  return folder.empty() ? "" : folder + "/recent.json";
}

std::vector<std::string> read_list(const std::string& path) {
  std::error_code code;
  if (path.empty() || !fs::is_regular_file(path, code) || fs::file_size(path, code) > kLargestList || code) return {};
  const auto text = read_text_file(path, "a list of files", kMaxJsonBytes);
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
  for (std::size_t i = 0; i < files.size(); ++i) out.write((i == 0 ? "\n    " : ",\n    ") + json::serialize_string(files[i]));
  out.write("\n  ]\n}\n");
  return out.commit();
}

}  // namespace

RecentFiles::RecentFiles() : RecentFiles(users_path()) {}
RecentFiles::RecentFiles(std::string path) : path_(std::move(path)), files_(read_list(path_)) {}

std::vector<std::string> RecentFiles::existing_files() const {
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
  // a list that cannot be saved is valid for this run only
  const Outcome kept = write_list(path_, files_);
  static_cast<void>(kept);
}

}  // namespace catena::app
