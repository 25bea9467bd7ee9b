// SPDX-License-Identifier: MIT
#include "engine/io/volume/formats.h"

#include <fmt/format.h>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/base/result.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::field {

namespace {

std::vector<FileFormat>& registry() {
  static std::vector<FileFormat> formats{vdb_format(), nifti_format(), raw_format(), npy_format(), vtk_format()};
  return formats;
}

}  // namespace

bool has_dicom_magic(std::string_view path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  char head[132] = {};
  std::ifstream(std::string(path), std::ios::binary).read(head, sizeof head);
  return std::string_view(head + 128, 4) == "DICM";
}

void register_format(FileFormat format) { registry().push_back(std::move(format)); }

const FileFormat* find_format(std::string_view path, std::string_view* ending) {
  for (const FileFormat& format : registry())
    for (const std::string_view one : format.extensions)
      if (has_extension(path, one)) {
        if (ending != nullptr) *ending = one;
        return &format;
      }
  std::error_code code;
  if (!std::filesystem::is_directory(path, code) && !has_dicom_magic(path)) return nullptr;
  for (const FileFormat& format : registry())
    if (format.reads_folders) {
      if (ending != nullptr) *ending = "";
      return &format;
    }
  return nullptr;
}

bool is_field_file(std::string_view path) { return find_format(path) != nullptr; }

bool needs_layout(std::string_view path) {
  const FileFormat* format = find_format(path);
  return format != nullptr && format->needs_layout;
}

bool is_numpy_file(std::string_view path) { return has_extension(path, ".npy") || has_extension(path, ".npz"); }

std::vector<std::string_view> field_extensions(bool bare) {
  std::vector<std::string_view> out;
  for (const FileFormat& format : registry())
    if (!bare || !format.needs_layout) out.insert(out.end(), format.extensions.begin(), format.extensions.end());
  return out;
}

std::string describe_field_extensions() { return "a data file (.vdb, .nii, .vti, .vtu, .nrrd, .npy, ..; catena info --formats lists all)"; }

Result<std::uint64_t> readable_file_size(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return Error{fmt::format("{}: there is no such file", path)};
  if (std::filesystem::is_directory(status)) return Error{fmt::format("{}: this is a folder, expected a file", path)};
  if (!std::filesystem::is_regular_file(status)) return Error{fmt::format("{}: this is not a regular file", path)};
  const std::uint64_t size = std::filesystem::file_size(path, error);
  errno = 0;
  if (error || !std::ifstream(path, std::ios::binary)) {
    const int why = errno;
    return Error{fmt::format("{}: cannot be opened ({})", path, describe_errno(why)), is_system_failure(why)};
  }
  if (size == 0) return Error{fmt::format("{}: the file is empty", path)};
  return size;
}

std::string file_stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  std::string_view ending;
  return name.substr(0, find_format(name, &ending) != nullptr ? name.size() - ending.size() : name.rfind('.'));
}

}  // namespace catena::field
