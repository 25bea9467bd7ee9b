// SPDX-License-Identifier: MIT
#include "engine/io/volume/data_files.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "engine/base/text.h"
#include "engine/io/client.h"
#include "engine/io/formats.h"

namespace catena::field {
namespace {

/// Returns whether a name matches a pattern in which each run of '*' stands for digits.
bool is_like(std::string_view name, std::string_view pattern) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (j < pattern.size()) {
    if (pattern[j] != '*') {
      if (i >= name.size() || name[i++] != pattern[j++]) return false;
      continue;
    }
    while (j < pattern.size() && pattern[j] == '*') ++j;
    const std::size_t begin = i;
    while (i < name.size() && digit(name[i])) ++i;
    if (i == begin) return false;
  }
  return i == name.size();
}

/// Returns whether a file is a text that names other files.
bool names_files(const std::string& path) {
  const io::Format* format = io::find_format(path);
  return format != nullptr && format->layout == io::FileLayout::index;
}

/// Returns all words and quoted strings of a text, each of which may be a file name.
std::set<std::string> names_in(const std::string& text) {
  std::set<std::string> names;
  std::string word;
  for (const char c : text + "\n") {
    if (std::string_view(" \t\r\n\"'<>=,").find(c) == std::string_view::npos) {
      word += c;
    } else if (!word.empty()) {
      names.insert(std::exchange(word, {}));
    }
  }
  for (std::size_t open = text.find('"'); open != std::string::npos;) {
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string::npos) break;
    names.insert(text.substr(open + 1, close - open - 1));
    open = text.find('"', close + 1);
  }
  return names;
}

/// Adds the files that a text file in several parts names, for every time step, and those that these name.
void add_named(const std::string& path, std::set<FileId>& files, int depth = 0) {
  namespace fs = std::filesystem;
  constexpr std::uint64_t kMaxBytes = 4 << 20;
  constexpr int kMaxDepth = 3;
  const auto text = read_text_file(path, "a text", kMaxBytes);
  if (!text) return;
  const fs::path folder = fs::path(path).parent_path();
  for (const std::string& name : names_in(*text)) {
    const fs::path at = folder / name;
    if (name.find('*') == std::string::npos) {
      const auto id = find_file_id(at.string());
      if (id && files.insert(*id).second && depth < kMaxDepth && names_files(at.string())) add_named(at.string(), files, depth + 1);
      continue;
    }
    std::error_code code;
    const fs::path in = at.parent_path().empty() ? fs::path(".") : at.parent_path();
    for (fs::directory_iterator it(in, code), end; !code && it != end; it.increment(code))
      if (is_like(it->path().filename().string(), at.filename().string()))
        if (const auto id = find_file_id(it->path().string())) files.insert(*id);
  }
}

/// Adds the files of an OpenFOAM case: its mesh, its settings and all of its times.
void add_case(const std::string& path, std::set<FileId>& files) {
  namespace fs = std::filesystem;
  const auto belongs = [](const std::string& name) {
    return name == "constant" || name == "system" || name.starts_with("processor") || (!name.empty() && name[0] >= '0' && name[0] <= '9');
  };
  std::error_code code;
  const fs::path folder = openfoam_case_folder(path);
  for (fs::directory_iterator part(folder, code), last; !code && part != last; part.increment(code)) {
    std::error_code ignored;
    if (!belongs(part->path().filename().string()) || !part->is_directory(ignored)) continue;
    for (fs::recursive_directory_iterator at(part->path(), ignored), end; !ignored && at != end; at.increment(ignored))
      if (const auto id = find_file_id(at->path().string())) files.insert(*id);
  }
}

/// Adds the images next to a DICOM file, which may belong to its series.
void add_images_beside(const std::string& path, std::set<FileId>& files) {
  namespace fs = std::filesystem;
  const fs::path parent = fs::path(path).parent_path();
  std::error_code code;
  for (fs::directory_iterator at(parent.empty() ? fs::path(".") : parent, code), end; !code && at != end; at.increment(code)) {
    const std::string one = at->path().string();
    if (!has_extension(one, ".dcm") && !has_dicom_magic(one)) continue;
    if (const auto id = find_file_id(one)) files.insert(*id);
  }
}

}  // namespace

std::vector<FileId> find_data_files(const std::string& path) {
  const io::Format* format = io::find_reader(path, io::DataKind::volume);
  if (format != nullptr && format->volume.files != nullptr) return format->volume.files(path);
  static_cast<void>(read_file_metadata(path));  // the files that it opens are recorded, even if it fails
  std::set<FileId> files = files_opened_by_readers(path);
  if (names_files(path)) add_named(path, files);
  if (!openfoam_case_folder(path).empty()) add_case(path, files);
  if (has_extension(path, ".dcm") || has_dicom_magic(path)) add_images_beside(path, files);
  return {files.begin(), files.end()};
}

bool has_openfoam_mesh(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path constant = fs::path(folder) / "constant";
  std::error_code code, ignored;
  if (fs::is_directory(constant / "polyMesh", ignored)) return true;
  for (fs::directory_iterator region(constant, code), end; !code && region != end; region.increment(code))
    if (fs::is_directory(region->path() / "polyMesh", ignored)) return true;
  return false;
}

bool is_openfoam_case(const std::string& path) {
  std::error_code code;
  const std::filesystem::path folder(path);
  return std::filesystem::exists(folder / "system/controlDict", code) || has_openfoam_mesh(path) ||
         std::filesystem::is_directory(folder / "processor0", code);
}

std::string openfoam_case_folder(const std::string& path) {
  if (is_openfoam_case(path)) return path;
  if (!has_extension(path, ".foam")) return {};
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

bool has_companion_files(const std::string& path) {
  const io::Format* format = io::find_format(path);
  if (format == nullptr && !has_extension(path, ".json")) format = io::find_reader(path, io::DataKind::volume);
  return format != nullptr && format->layout != io::FileLayout::single;
}

}  // namespace catena::field
