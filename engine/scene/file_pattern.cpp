// SPDX-License-Identifier: MIT
#include "engine/scene/file_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "engine/base/natural_sort.h"

namespace catena::scene {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The parts of "before{item,item}after".
struct NameList {
  std::string before, after;
  std::vector<std::string> items;
};

std::optional<NameList> list_in(const std::string& name) {
  const std::size_t open = name.find('{'), close = name.find('}', open);
  if (close == std::string::npos) return std::nullopt;
  NameList list{name.substr(0, open), name.substr(close + 1), {}};
  for (std::size_t at = open + 1; at <= close;) {
    const std::size_t end = std::min(name.find(',', at), close);
    list.items.push_back(name.substr(at, end - at));
    at = end + 1;
  }
  return list.items.size() > 1 ? std::optional(list) : std::nullopt;
}

std::vector<std::string> in_folder(std::vector<std::string> names, const fs::path& folder) {
  natural_sort(names);
  for (std::string& one : names) one = (folder / one).string();
  return names;
}

/// Returns whether a name that is not a file looks like a glob pattern of another program.
bool is_other_glob(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  std::error_code code;
  return !is_pattern(path) && !fs::exists(path, code) &&
         (name.find_first_of("?[") != std::string::npos || (name.find('{') != std::string::npos && name.find("..") != std::string::npos));
}

/// Returns the length of the common prefix of two sequences.
template <class A, class B>
std::size_t common_length(A a, A a_end, B b, B b_end) {
  return static_cast<std::size_t>(std::distance(a, std::mismatch(a, a_end, b, b_end).first));
}

}  // namespace

bool is_pattern(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  std::error_code code;
  return (name.find('*') != std::string::npos || list_in(name)) && !fs::exists(path, code);
}

std::vector<std::string> expand_pattern(const std::string& path) {
  const fs::path full_path(path);
  const std::string name = full_path.filename().string();
  if (const auto list = list_in(name)) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const std::string& item : std::set<std::string>(list->items.begin(), list->items.end()))
      if (fs::is_regular_file(full_path.parent_path() / (list->before + item + list->after), ignored))
        names.push_back(list->before + item + list->after);
    return in_folder(std::move(names), full_path.parent_path());
  }
  const std::size_t star_offset = name.find('*');
  const std::string before = name.substr(0, star_offset), after = name.substr(star_offset + 1);
  const fs::path folder = full_path.has_parent_path() ? full_path.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string one = at->path().filename().string();
    std::error_code ignored;
    if (one.size() >= before.size() + after.size() && one.starts_with(before) && one.ends_with(after) && at->is_regular_file(ignored))
      names.push_back(one);
  }
  return in_folder(std::move(names), full_path.parent_path());
}

std::string first_file(const std::string& path) {
  const std::vector<std::string> files = is_pattern(path) ? expand_pattern(path) : std::vector<std::string>();
  return files.empty() ? path : files.front();
}

Result<std::string> make_pattern(std::vector<std::string> files) {
  const auto normalized = [](const std::string& file) { return fs::path(file).lexically_normal().string(); };
  if (files.size() > 1) std::ranges::transform(files, files.begin(), normalized);
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  CATENA_ASSERT(!files.empty());
  if (files.size() == 1 && is_other_glob(files.front()))
    return Error{files.front() + ": there is no such file; a pattern for several files has a * or a list such as {1,2,3}"};
  if (files.size() == 1) return files.front();
  const fs::path folder = fs::path(files.front()).parent_path();
  std::vector<std::string> names;
  for (const std::string& file : files) {
    if (fs::path(file).parent_path() != folder)
      return Error{fmt::format("{} and {} are in different folders; files of one series were expected", files.front(), file)};
    names.push_back(fs::path(file).filename().string());
    std::error_code code;
    if (!fs::exists(file, code))
      return Error{file + (code == std::errc::filename_too_long ? ": the name is too long" : ": there is no such file")};
    if (fs::is_directory(file, code)) return Error{file + ": this is a folder; a single folder, or files of one series, were expected"};
  }
  if (!is_numbered_series(names)) {
    const auto other = std::ranges::find_if(names, [&](const std::string& name) { return !is_numbered_series({names.front(), name}); });
    return Error{fmt::format("{} and {} are not a series; one file, or files whose names differ only in their numbers, were expected",
                             names.front(), *other)};
  }
  // the common prefix and suffix of all names exclude parts of numbers
  const auto is_part = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+'; };
  std::size_t before = names.front().size(), after = names.front().size();
  for (const std::string& name : names) {
    before = std::min(before, common_length(name.begin(), name.end(), names.front().begin(), names.front().end()));
    after = std::min(after, common_length(name.rbegin(), name.rend(), names.front().rbegin(), names.front().rend()));
  }
  const std::string& first = names.front();
  while (before > 0 && is_part(first[before - 1])) --before;
  while (after > 0 && is_digit(first[first.size() - after])) --after;
  natural_sort(names);
  const std::string head = first.substr(0, before), tail = first.substr(first.size() - after);
  if (const std::string pattern = (folder / (head + "*" + tail)).string(); expand_pattern(pattern).size() == names.size()) return pattern;
  std::vector<std::string> middles;
  for (const std::string& name : names) middles.push_back(name.substr(before, name.size() - before - after));
  if (std::ranges::any_of(middles, [](const std::string& m) { return m.find_first_of("{},") != std::string::npos; }))
    return Error{fmt::format("{}: names of a series without commas and braces were expected", names.front())};
  return (folder / fmt::format("{}{{{}}}{}", head, fmt::join(middles, ","), tail)).string();
}

}  // namespace catena::scene
