// SPDX-License-Identifier: MIT
#include "engine/io/formats.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/base/text.h"
#include "engine/io/volume/data_files.h"

namespace catena::io {

// all formats, each defined in the file of its reader; remote_formats: those that catena-read-vtk reads, store_formats: catena-read-chunks
Format vdb_format(), nifti_format(), raw_format(), npy_format(), stl_format(), obj_format(), tck_format(), trk_format(), csv_format(),
    table_format();
std::vector<Format> remote_formats(), store_formats();

namespace {

std::vector<Format>& registry() {
  static std::vector<Format> all = [] {
    std::vector<Format> rows{vdb_format(), nifti_format(), raw_format(), npy_format(), stl_format(),
                             obj_format(), tck_format(),   trk_format(), csv_format(), table_format()};
    for (std::vector<Format> more : {remote_formats(), store_formats()})
      for (Format& row : more) rows.push_back(std::move(row));
    return rows;
  }();
  return all;
}

/// Returns the extension of the format that the path has; empty: none of them.
std::string_view matching_extension(const Format& format, std::string_view path) {
  for (const std::string_view extension : format.extensions)
    if (has_extension(path, extension)) return extension;
  return {};
}

}  // namespace

bool Format::reads(DataKind kind) const {
  switch (kind) {
    case DataKind::volume:
      return volume.describe != nullptr;
    case DataKind::mesh:
      return read_mesh != nullptr;
    case DataKind::curves:
      return read_curves != nullptr;
    case DataKind::points:
      return read_points != nullptr;
  }
  return false;
}

bool Format::writes(DataKind kind) const {
  switch (kind) {
    case DataKind::volume:
      return write_volume != nullptr;
    case DataKind::mesh:
      return write_mesh != nullptr;
    case DataKind::curves:
      return write_curves != nullptr;
    case DataKind::points:
      return false;
  }
  return false;
}

void register_format(Format format) { registry().push_back(std::move(format)); }
const std::vector<Format>& formats() { return registry(); }

const Format* find_format(std::string_view path) {
  for (const Format& format : registry())
    if (!matching_extension(format, path).empty()) return &format;
  return nullptr;
}

const Format* find_reader(std::string_view path, DataKind kind) {
  if (const Format* format = find_format(path)) return format->reads(kind) ? format : nullptr;
  std::error_code code;
  if (kind != DataKind::volume || (!std::filesystem::is_directory(path, code) && !field::has_dicom_magic(path))) return nullptr;
  for (const Format& format : registry())
    if (format.volume.recognizes_folder != nullptr && format.volume.recognizes_folder(std::string(path))) return &format;
  const auto found = std::ranges::find_if(registry(), [](const Format& format) { return format.volume.reads_folders; });
  return found == registry().end() ? nullptr : &*found;
}

const Format* find_writer(std::string_view path, DataKind kind) {
  const Format* format = find_format(path);
  return format != nullptr && format->writes(kind) ? format : nullptr;
}

std::vector<std::string_view> readable_extensions(DataKind kind) {
  std::vector<std::string_view> all;
  for (const Format& format : registry())
    if (format.reads(kind)) all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  return all;
}

std::string writable_extensions(DataKind kind) {
  std::vector<std::string_view> all;
  for (const Format& format : registry())
    if (format.writes(kind)) all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  return join_alternatives(all);
}

bool needs_layout(std::string_view path) {
  const Format* format = find_format(path);
  return format != nullptr && format->volume.needs_layout;
}

bool is_numpy_file(std::string_view path) { return has_extension(path, ".npy") || has_extension(path, ".npz"); }

std::string describe_expected(DataKind kind) {
  const auto with_extensions = [&](const char* what) { return what + (" (" + join_alternatives(readable_extensions(kind)) + ")"); };
  switch (kind) {
    case DataKind::volume:
      break;
    case DataKind::mesh:
      return with_extensions("a triangle mesh");
    case DataKind::curves:
      return with_extensions("a file of curves");
    case DataKind::points:
      return with_extensions("a table of points");
  }
  return "a data file (.vdb, .nii, .vti, .vtu, .nrrd, .npy, ..; catena info --formats lists all)";
}

std::string file_stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const Format* format = find_format(name);
  return name.substr(0, format != nullptr ? name.size() - matching_extension(*format, name).size() : name.rfind('.'));
}

}  // namespace catena::io
